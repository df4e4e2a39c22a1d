// SPDX-License-Identifier: MIT
// How far the functions of math.h on double are from the truth, by MPFR.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "samestep/math.h"

namespace samestep {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kLeast = std::numeric_limits<double>::denorm_min();
constexpr double kLeastNormal = std::numeric_limits<double>::min();

/// A number of 160 bits.
class Exact {
 public:
  Exact() { mpfr_init2(value_, 160); }
  explicit Exact(double x) : Exact() { mpfr_set_d(value_, x, MPFR_RNDN); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  ~Exact() { mpfr_clear(value_); }

  mpfr_ptr get() { return value_; }
  mpfr_srcptr get() const { return value_; }

 private:
  mpfr_t value_;
};

/// The distance of result from truth in units of the last place of truth.
double errorInUlp(double result, const Exact& truth) {
  const double nearest = mpfr_get_d(truth.get(), MPFR_RNDN);
  if (std::isnan(result)) return std::numeric_limits<double>::infinity();
  if (std::isinf(result) || std::isinf(nearest)) {
    return result == nearest ? 0.0 : std::numeric_limits<double>::infinity();
  }
  const long exponent =
      mpfr_zero_p(truth.get()) != 0 ? -1074 : std::max(mpfr_get_exp(truth.get()) - 53L, -1074L);
  Exact difference;
  mpfr_sub_d(difference.get(), truth.get(), result, MPFR_RNDN);
  mpfr_mul_2si(difference.get(), difference.get(), -exponent, MPFR_RNDN);
  return std::abs(mpfr_get_d(difference.get(), MPFR_RNDA));
}

class Random {
 public:
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  int below(int count) { return static_cast<int>(bits_() % static_cast<unsigned>(count)); }
  double anyFinite() {
    return std::ldexp(within(1.0, 2.0), below(2098) - 1074) * (below(2) == 0 ? 1.0 : -1.0);
  }
  double nearOne() { return 1.0 + within(-0.5, 0.5) * std::ldexp(1.0, -below(53)); }

 private:
  std::mt19937_64 bits_{20261122};
};

/// The largest error seen, and where.
class Worst {
 public:
  explicit Worst(const char* function) : function_(function) {}
  Worst(const Worst&) = delete;
  Worst& operator=(const Worst&) = delete;
  ~Worst() {
    std::printf("%-6s %8d points, at most %.4f ulp off, at (%a, %a)\n", function_, count_, error_, x_, y_);
  }

  void add(double error, double x, double y = 0.0) {
    ++count_;
    if (error > error_) {
      error_ = error;
      x_ = x;
      y_ = y;
    }
  }
  double error() const { return error_; }

 private:
  const char* function_;
  int count_ = 0;
  double error_ = 0.0, x_ = 0.0, y_ = 0.0;
};

constexpr int kPoints = 250'000;  // per kind of input; every function has at least four kinds
constexpr double kAllowed = 1.0;

using Input = std::function<double(Random&)>;
using Inputs = std::function<std::pair<double, double>(Random&)>;

void checkSincos(const std::vector<Input>& kinds, const std::vector<double>& edges) {
  Worst sine("sin"), cosine("cos");
  Exact truth;
  const auto check = [&](double angle) {
    const SinCos<double> result = sincos(angle);
    const Exact exactAngle(angle);
    mpfr_sin(truth.get(), exactAngle.get(), MPFR_RNDN);
    sine.add(errorInUlp(result.sin, truth), angle);
    mpfr_cos(truth.get(), exactAngle.get(), MPFR_RNDN);
    cosine.add(errorInUlp(result.cos, truth), angle);
  };
  Random random;
  for (const Input& kind : kinds) {
    for (int i = 0; i < kPoints; ++i) check(kind(random));
  }
  for (const double edge : edges) {
    check(edge);
    check(-edge);
  }
  EXPECT_LE(sine.error(), kAllowed);
  EXPECT_LE(cosine.error(), kAllowed);
}

using Reference = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);

void check(const char* name, double (*function)(double), Reference reference, const std::vector<Input>& kinds,
           const std::vector<double>& edges) {
  Worst worst(name);
  Exact truth;
  const auto checkOne = [&](double x) {
    reference(truth.get(), Exact(x).get(), MPFR_RNDN);
    worst.add(errorInUlp(function(x), truth), x);
  };
  Random random;
  for (const Input& kind : kinds) {
    for (int i = 0; i < kPoints; ++i) checkOne(kind(random));
  }
  for (const double edge : edges) checkOne(edge);
  EXPECT_LE(worst.error(), kAllowed);
}

using Reference2 = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

void check(const char* name, double (*function)(double, double), Reference2 reference, double allowed,
           const std::vector<Inputs>& kinds, const std::vector<std::pair<double, double>>& edges) {
  Worst worst(name);
  Exact truth;
  const auto checkOne = [&](double x, double y) {
    reference(truth.get(), Exact(x).get(), Exact(y).get(), MPFR_RNDN);
    worst.add(errorInUlp(function(x, y), truth), x, y);
  };
  Random random;
  for (const Inputs& kind : kinds) {
    for (int i = 0; i < kPoints; ++i) {
      const auto [x, y] = kind(random);
      checkOne(x, y);
    }
  }
  for (const auto& [x, y] : edges) checkOne(x, y);
  EXPECT_LE(worst.error(), allowed);
}

TEST(MathAccuracyTest, SincosIsWithinOneUlpForEveryFiniteAngle) {
  std::vector<double> edges = {
      0.0, kLeast, kLeastNormal, 0x1p-27, 0x1.921fb54442d18p-1, 0x1p20, std::nextafter(0x1p20, 2e6), kLargest,
      // The doubles nearest to multiples of pi/2: of all, and of those below 2^20.
      0x1.6ac5b262ca1ffp+849, 0x1.6c6cbc45dc8dep+5, 3.0, 22.0, 355.0, 103993.0, 104348.0};
  for (int exponent = -30; exponent < 1024; ++exponent) edges.push_back(std::ldexp(1.0, exponent));
  for (int quarters = 1; quarters < 200'000; ++quarters) edges.push_back(quarters * 0x1.921fb54442d18p+0);
  checkSincos({[](Random& random) { return random.within(-0.8, 0.8); },
               [](Random& random) { return random.within(-10.0, 10.0); },
               [](Random& random) { return random.within(-0x1p20, 0x1p20); },
               [](Random& random) { return random.anyFinite(); }},
              edges);
}

TEST(MathAccuracyTest, Atan2IsWithinOneUlp) {
  std::vector<std::pair<double, double>> edges;
  const std::vector<double> sizes = {kLeast, 3 * kLeast, kLeastNormal, 1e-300, 1.0, 0x1p28, 1e300, kLargest};
  for (const double y : sizes) {
    for (const double x : sizes) {
      for (const double sy : {-1.0, 1.0}) {
        for (const double sx : {-1.0, 0.0, 1.0}) edges.emplace_back(sy * y, sx * x);
      }
    }
  }
  check("atan2", atan2, mpfr_atan2, kAllowed,
        {[](Random& random) { return std::pair(random.anyFinite(), random.anyFinite()); },
         [](Random& random) { return std::pair(random.within(-1.0, 1.0), random.within(-1.0, 1.0)); },
         [](Random& random) {
           const double x = random.anyFinite() * 0x1p-50;
           return std::pair(std::ldexp(x, random.below(80) - 40) * random.nearOne(), x);
         },
         [](Random& random) {  // near the 64ths where the table's cells meet
           return std::pair((random.below(65) + 0.5 + random.within(-1e-6, 1e-6)) / 64.0, 1.0);
         }},
        edges);
}

TEST(MathAccuracyTest, ExpIsWithinOneUlp) {
  check("exp", exp, mpfr_exp,
        {[](Random& random) { return random.within(-746.0, 710.0); },
         [](Random& random) { return random.within(-1.0, 1.0); },
         [](Random& random) { return random.within(-745.2, -708.0); },
         [](Random& random) { return random.within(-50.0, 50.0); },
         [](Random& random) { return std::ldexp(random.within(-1.0, 1.0), -random.below(60)); }},
        {0.0, kLeast, -kLeast, 0x1.62e42fefa39efp+9, -0x1.74910d52d3051p+9, -0x1.74910d52d3052p+9, 709.0,
         -708.4});
}

TEST(MathAccuracyTest, Exp2IsWithinOneUlp) {
  check("exp2", exp2, mpfr_exp2,
        {[](Random& random) { return random.within(-1076.0, 1024.0); },
         [](Random& random) { return random.within(-1.0, 1.0); },
         [](Random& random) { return random.within(-1075.0, -1021.0); },
         [](Random& random) { return std::ldexp(random.within(-1.0, 1.0), -random.below(60)); }},
        {0.0, kLeast, 1023.9999999999999, -1074.5, -1074.9999999999998, -1075.0, -1022.0, -1022.5});
}

TEST(MathAccuracyTest, Log2IsWithinOneUlp) {
  std::vector<double> edges = {kLeast, 3 * kLeast, kLeastNormal, kLargest};
  for (int cell = 0; cell <= 128; ++cell) {
    const double border = 1.0 + cell / 128.0;
    for (const double x : {border, std::nextafter(border, 0.0), std::nextafter(border, 4.0)}) {
      edges.insert(edges.end(), {x, x / 2, x * 8});
    }
  }
  check("log2", log2, mpfr_log2,
        {[](Random& random) { return std::abs(random.anyFinite()); },
         [](Random& random) { return random.within(0.5, 2.0); },
         [](Random& random) { return random.within(0.99, 1.01); },
         [](Random& random) { return random.nearOne(); }},
        edges);
}

TEST(MathAccuracyTest, PowIsWithinOneUlp) {
  const auto withResultInRange = [](Random& random, double base) {
    const double scale = std::log2(base);
    return std::pair(base, scale == 0.0 ? 1.0 : random.within(-1076.0, 1024.0) / scale);
  };
  check("pow", pow, mpfr_pow, kAllowed,
        {[](Random& random) { return std::pair(random.within(0.0, 2.0), random.within(-10.0, 10.0)); },
         [](Random& random) { return std::pair(random.within(0.0, 1e6), random.within(-50.0, 50.0)); },
         [&](Random& random) { return withResultInRange(random, std::abs(random.anyFinite())); },
         [&](Random& random) { return withResultInRange(random, random.nearOne()); },
         [](Random& random) {
           return std::pair(std::abs(random.anyFinite()),
                            std::ldexp(random.within(-1.0, 1.0), -random.below(80)));
         }},
        {{kLargest, 1.0},
         {kLargest, -1.0},
         {kLeast, 1.0},
         {kLeast, -0.953},
         {1.0 + 0x1p-52, 0x1p61},
         {1.0 - 0x1p-53, 0x1p62},
         {1.0 + 0x1p-52, 0x1p70},
         {10.0, 308.0},
         {10.0, -323.0}});
}

TEST(MathAccuracyTest, LengthIsWithinTwoUlp) {
  check("length", length, mpfr_hypot, 2.0,
        {[](Random& random) { return std::pair(random.within(-1.0, 1.0), random.within(-1.0, 1.0)); },
         [](Random& random) {
           const double x = random.anyFinite() * 0.5;
           return std::pair(x, x * random.within(-1.0, 1.0));
         }},
        {{kLargest, 1.0}, {kLeast, kLeast}, {0x1p-480, 0x1p-480}, {0x1p499, 0x1p499}});
}

}  // namespace
}  // namespace samestep
