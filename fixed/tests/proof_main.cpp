// Every function of Q32.32 against MPFR: `fixed_proof [points [group]]`: points per function, 10 million
// unless told; a group of functions, all unless told.
// Prints the largest error of each in units of the last place, and fails where one is above its bound.

#include <mpfr.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "samestep/fixed_math.h"
#include "samestep/fixed_tables.h"
#include "test_random.h"

namespace samestep {
namespace {

static_assert(sizeof(long) == 8, "the raw bits are handed to MPFR as long");

// Products of two numbers are exact in 128 bits, sums of four in 130. The tables have 128 bits.
constexpr mpfr_prec_t kExactPrecision = 130;
// Results of the functions that are not correctly rounded have 63 bits.
constexpr mpfr_prec_t kFunctionPrecision = 96;
mpfr_prec_t gPrecision = kExactPrecision;
constexpr std::int64_t kMost = 0x7fffffffffffffff, kLeast = -kMost - 1, kOne = std::int64_t{1} << 32;

/// A number of MPFR; all operations round to nearest at gPrecision bits.
class Real {
 public:
  Real() { mpfr_init2(value_, gPrecision); }
  Real(const Real&) = delete;
  Real& operator=(const Real&) = delete;
  ~Real() { mpfr_clear(value_); }
  mpfr_ptr get() { return value_; }

  /// bits / 2^32.
  void set(std::int64_t bits) {
    mpfr_set_si(value_, bits, MPFR_RNDN);
    mpfr_div_2ui(value_, value_, 32, MPFR_RNDN);
  }

 private:
  mpfr_t value_;
};

/// Zero, units, powers of two and their neighbours, extremes.
std::vector<std::int64_t> edges() {
  std::vector<std::int64_t> result = {0, kMost, kLeast, kLeast + 1, kMost - 1};
  for (int bit = 0; bit < 63; ++bit) {
    const std::int64_t power = std::int64_t{1} << bit;
    for (const std::int64_t near : {power - 1, power, power + 1, power + power / 2}) {
      result.push_back(near);
      result.push_back(-near);
    }
  }
  return result;
}

struct Worst {
  double error = 0;
  std::int64_t a = 0, b = 0;
};

bool gFailed = false;

/// Compares one function of two arguments with MPFR's on edges (every pair) and random points.
class Proof {
 public:
  Proof(const char* name, double bound, std::uint64_t points, bool pairs)
      : name_(name), bound_(bound), points_(points), pairs_(pairs) {}

  /// @param arguments  makes random arguments fall where the function is worth testing
  /// @param fixed      the function under test on raw bits
  /// @param exact      sets its first argument to the exact value, or returns false to leave the point out
  template <class Arguments, class Function, class Exact>
  void run(Arguments arguments, Function fixed, Exact exact) {
    const std::vector<std::int64_t> special = edges();
    for (const std::int64_t a : special) {
      if (!pairs_) check(a, 0, fixed, exact);
      for (std::size_t j = 0; pairs_ && j < special.size(); ++j) check(a, special[j], fixed, exact);
    }
    Random random(20260101);
    while (tested_ < points_) {
      const auto [a, b] = arguments(random);
      check(a, b, fixed, exact);
    }
    const bool good = worst_.error <= bound_;
    gFailed = gFailed || !good;
    std::printf("| %s | %llu | %.6f | %g |%s\n", name_, static_cast<unsigned long long>(tested_),
                worst_.error, bound_, good ? "" : " FAILED");
    if (!good) {
      std::printf("worst at raw %lld, %lld\n", static_cast<long long>(worst_.a),
                  static_cast<long long>(worst_.b));
    }
    std::fflush(stdout);
  }

 private:
  template <class Function, class Exact>
  void check(std::int64_t a, std::int64_t b, Function& fixed, Exact& exact) {
    x_.set(a);
    y_.set(b);
    if (!exact(exact_.get(), x_.get(), y_.get())) return;
    ++tested_;
    const std::int64_t result = fixed(a, b);
    mpfr_mul_2ui(exact_.get(), exact_.get(), 32, MPFR_RNDN);
    // A number that does not fit saturates.
    if (mpfr_cmp_si(exact_.get(), kMost) > 0) {
      mpfr_set_si(exact_.get(), kMost, MPFR_RNDN);
    } else if (mpfr_cmp_si(exact_.get(), kLeast) < 0) {
      mpfr_set_si(exact_.get(), kLeast, MPFR_RNDN);
    }
    mpfr_sub_si(exact_.get(), exact_.get(), result, MPFR_RNDN);
    mpfr_abs(exact_.get(), exact_.get(), MPFR_RNDN);
    const double error = mpfr_get_d(exact_.get(), MPFR_RNDU);
    if (error > worst_.error) worst_ = {error, a, b};
  }

  const char* name_;
  double bound_;
  std::uint64_t points_;
  bool pairs_;
  std::uint64_t tested_ = 0;
  Worst worst_;
  Real x_, y_, exact_;
};

using Pair = std::array<std::int64_t, 2>;

Pair anyPair(Random& random) { return {random.anySize(), random.anySize()}; }

Fixed f(std::int64_t bits) { return Fixed::fromRaw(bits); }

bool fits(mpfr_ptr value) { return mpfr_cmpabs_ui(value, std::uint64_t{1} << 31) < 0; }

/// The largest difference of the tables from MPFR, in their last place.
void proveTables() {
  gPrecision = 256;
  Real exact, difference;
  double worst = 0;
  const auto compare = [&](std::uint64_t high, std::uint64_t low, int bits) {
    // high:low in units of 2^-(bits + 64).
    mpfr_set_ui(difference.get(), high, MPFR_RNDN);
    mpfr_mul_2ui(difference.get(), difference.get(), 64, MPFR_RNDN);
    Real lower;
    mpfr_set_ui(lower.get(), low, MPFR_RNDN);
    mpfr_add(difference.get(), difference.get(), lower.get(), MPFR_RNDN);
    mpfr_mul_2si(exact.get(), exact.get(), bits + 64, MPFR_RNDN);
    mpfr_sub(difference.get(), difference.get(), exact.get(), MPFR_RNDN);
    mpfr_abs(difference.get(), difference.get(), MPFR_RNDN);
    const double error = mpfr_get_d(difference.get(), MPFR_RNDU);
    if (error > worst) worst = error;
  };
  for (unsigned i = 0; i < 64; ++i) {
    mpfr_set_ui(exact.get(), i, MPFR_RNDN);
    mpfr_div_ui(exact.get(), exact.get(), 64, MPFR_RNDN);
    mpfr_exp2(exact.get(), exact.get(), MPFR_RNDN);
    compare(raw::kPowerHigh[i], raw::kPowerLow[i], 63);
    mpfr_set_ui(exact.get(), raw::kInverse[i], MPFR_RNDN);
    mpfr_div_ui(exact.get(), exact.get(), 512, MPFR_RNDN);
    mpfr_log2(exact.get(), exact.get(), MPFR_RNDN);
    mpfr_neg(exact.get(), exact.get(), MPFR_RNDN);
    compare(raw::kInverseLogHigh[i], raw::kInverseLogLow[i], 56);
  }
  mpfr_const_log2(exact.get(), MPFR_RNDN);
  mpfr_ui_div(exact.get(), 1, exact.get(), MPFR_RNDN);
  compare(raw::kLog2eHigh, raw::kLog2eLow, 63);
  mpfr_const_pi(exact.get(), MPFR_RNDN);
  mpfr_ui_div(exact.get(), 1, exact.get(), MPFR_RNDN);
  mpfr_div_2ui(exact.get(), exact.get(), 1, MPFR_RNDN);
  compare(raw::kTurnsHigh, raw::kTurnsLow, 32);
  gPrecision = kExactPrecision;
  const bool good = worst <= 0.5 + 1e-9;
  gFailed = gFailed || !good;
  std::printf("tables: largest error %.6f of their last place%s\n", worst, good ? "" : " FAILED");
}

// Half a unit, and what the bits of the reference leave open.
constexpr double kHalf = 0.5 + 1e-12;
// This is the bound of the functions that are not correctly rounded.
constexpr double kUlp = 1.0;

// The further operands of the sums of products are made from the first two.
std::int64_t third(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) ^ static_cast<std::uint64_t>(b) * 3) >> 7;
}
std::int64_t fourth(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(b) ^ static_cast<std::uint64_t>(a) * 5) >> 9;
}

/// The raw bits of an exact x.
std::int64_t bitsOf(mpfr_ptr x) {
  static Real scaled;
  mpfr_mul_2ui(scaled.get(), x, 32, MPFR_RNDN);
  return mpfr_get_si(scaled.get(), MPFR_RNDN);
}

void setFurther(mpfr_ptr a, mpfr_ptr b, Real& c, Real& d) {
  const std::int64_t aBits = bitsOf(a), bBits = bitsOf(b);
  c.set(third(aBits, bBits));
  d.set(fourth(aBits, bBits));
}

/// Calls a function of four numbers with a, b, third and fourth.
template <class Function>
auto with(Function function) {
  return [=](std::int64_t a, std::int64_t b) {
    return function(f(a), f(b), f(third(a, b)), f(fourth(a, b))).raw();
  };
}

void proveProducts(std::uint64_t points) {
  Proof("multiply", kHalf, points, true)
      .run(
          anyPair, [](auto a, auto b) { return (f(a) * f(b)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
            mpfr_mul(out, a, b, MPFR_RNDN);
            return fits(out);
          });
  {
    // Near ties: products whose fraction is next to half a unit.
    Proof("multiply near ties", kHalf, points / 5, false)
        .run(
            [](Random& random) -> Pair {
              const std::int64_t odd = (random.anySize() >> 20) | 1;
              return {odd, (kOne >> 1) * (1 + static_cast<std::int64_t>(random.next() % 4)) +
                               static_cast<std::int64_t>(random.next() % 3) - 1};
            },
            [](auto a, auto b) { return (f(a) * f(b)).raw(); },
            [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
              mpfr_mul(out, a, b, MPFR_RNDN);
              return fits(out);
            });
  }
  Real c, d, product;
  const auto fused = [&](int terms, int sign) {
    return [&, terms, sign](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
      mpfr_mul(out, a, b, MPFR_RNDN);
      setFurther(a, b, c, d);
      if (terms == 1) {
        mpfr_add(out, out, c.get(), MPFR_RNDN);
        return fits(out);
      }
      const auto addProduct = [&](mpfr_ptr x, mpfr_ptr y) {
        mpfr_mul(product.get(), x, y, MPFR_RNDN);
        if (sign < 0) {
          mpfr_sub(out, out, product.get(), MPFR_RNDN);
        } else {
          mpfr_add(out, out, product.get(), MPFR_RNDN);
        }
      };
      addProduct(c.get(), d.get());
      if (terms >= 3) addProduct(a, c.get());
      if (terms >= 4) addProduct(b, d.get());
      return fits(out);
    };
  };
  Proof("mulAdd", kHalf, points, true)
      .run(anyPair, with([](auto a, auto b, auto e, auto) { return mulAdd(a, b, e); }), fused(1, 1));
  Proof("dot", kHalf, points, true)
      .run(anyPair, with([](auto a, auto b, auto e, auto g) { return dot(a, b, e, g); }), fused(2, 1));
  Proof("cross", kHalf, points, true)
      .run(anyPair, with([](auto a, auto b, auto e, auto g) { return cross(a, b, e, g); }), fused(2, -1));
  Proof("dot3", kHalf, points, true)
      .run(anyPair, with([](auto a, auto b, auto e, auto g) { return dot3(a, b, e, g, a, e); }), fused(3, 1));
  Proof("dot4", kHalf, points, true)
      .run(anyPair, with([](auto a, auto b, auto e, auto g) { return dot4(a, b, e, g, a, e, b, g); }),
           fused(4, 1));
}

void proveQuotients(std::uint64_t points) {
  Proof("divide", kHalf, points, true)
      .run(
          anyPair, [](auto a, auto b) { return (f(a) / f(b)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
            if (mpfr_zero_p(b)) return false;
            mpfr_div(out, a, b, MPFR_RNDN);
            return true;
          });
  Real c, d;
  Proof("mulDiv", kHalf, points, true)
      .run(anyPair, with([](auto a, auto b, auto e, auto) { return mulDiv(a, b, e); }),
           [&](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
             setFurther(a, b, c, d);
             if (mpfr_zero_p(c.get())) return false;
             mpfr_mul(out, a, b, MPFR_RNDN);
             mpfr_div(out, out, c.get(), MPFR_RNDN);
             return true;
           });
  Proof("reciprocal", kHalf, points, false)
      .run(
          anyPair, [](auto a, auto) { return reciprocal(f(a)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            if (mpfr_zero_p(a)) return false;
            mpfr_ui_div(out, 1, a, MPFR_RNDN);
            return true;
          });
}

void proveRoots(std::uint64_t points) {
  Proof("sqrt", kHalf, points, false)
      .run(
          [](Random& random) -> Pair {
            return {random.anySize() & kMost, 0};
          },
          [](auto a, auto) { return sqrt(f(a)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            if (mpfr_sgn(a) < 0) return false;
            mpfr_sqrt(out, a, MPFR_RNDN);
            return true;
          });
  Proof("sqrt near ties", kHalf, points / 5, false)
      .run(
          // n^2 + n is next to (n + 1/2)^2; in units of 2^-32 of the argument.
          [](Random& random) -> Pair {
            const std::uint64_t n = random.next() >> (17 + random.next() % 30);
            const std::uint64_t square = (n * n + n) >> 32;
            return {
                static_cast<std::int64_t>((square + random.next() % 2) & static_cast<std::uint64_t>(kMost)),
                0};
          },
          [](auto a, auto) { return sqrt(f(a)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            mpfr_sqrt(out, a, MPFR_RNDN);
            return true;
          });
  const auto hypotenuse = [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
    mpfr_hypot(out, a, b, MPFR_RNDN);
    return true;
  };
  Proof("length", kHalf, points, true)
      .run(
          anyPair, [](auto a, auto b) { return length(f(a), f(b)).raw(); }, hypotenuse);
  const auto unit = [&](bool second) {
    return [=](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
      mpfr_hypot(out, a, b, MPFR_RNDN);
      if (mpfr_zero_p(out)) return true;
      mpfr_div(out, second ? b : a, out, MPFR_RNDN);
      return true;
    };
  };
  Proof("normalize x", kHalf, points, true)
      .run(
          anyPair, [](auto a, auto b) { return normalize(f(a), f(b)).x.raw(); }, unit(false));
  Proof("normalize y", kHalf, points, true)
      .run(
          anyPair, [](auto a, auto b) { return normalize(f(a), f(b)).y.raw(); }, unit(true));
}

void proveAngles(std::uint64_t points) {
  gPrecision = kFunctionPrecision;
  Proof("sin", kUlp, points, false)
      .run(
          anyPair, [](auto a, auto) { return sincos(f(a)).sin.raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            mpfr_sin(out, a, MPFR_RNDN);
            return true;
          });
  Proof("cos", kUlp, points, false)
      .run(
          anyPair, [](auto a, auto) { return sincos(f(a)).cos.raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            mpfr_cos(out, a, MPFR_RNDN);
            return true;
          });
  Proof("atan2", kUlp, points, true)
      .run(
          [](Random& random) -> Pair {
            // The two are as often near each other in size as not.
            const Pair any = anyPair(random);
            return random.next() % 2 == 0 ? any : Pair{any[0], any[0] + (any[1] >> 4)};
          },
          [](auto a, auto b) { return atan2(f(a), f(b)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
            mpfr_atan2(out, a, b, MPFR_RNDN);
            return true;
          });
}

void provePowers(std::uint64_t points) {
  gPrecision = kFunctionPrecision;
  const auto exponents = [](Random& random) -> Pair {
    return {static_cast<std::int64_t>(random.next() % (std::uint64_t{68} << 32)) - (std::int64_t{35} << 32),
            0};
  };
  Proof("exp2", kUlp, points, false)
      .run(
          exponents, [](auto a, auto) { return exp2(f(a)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            if (mpfr_cmp_ui(a, 64) > 0) return false;
            mpfr_exp2(out, a, MPFR_RNDN);
            return true;
          });
  Proof("exp", kUlp, points, false)
      .run(
          exponents, [](auto a, auto) { return exp(f(a)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            if (mpfr_cmp_ui(a, 64) > 0) return false;
            mpfr_exp(out, a, MPFR_RNDN);
            return true;
          });
  Proof("log2", kUlp, points, false)
      .run(
          [](Random& random) -> Pair {
            return {random.anySize() & kMost, 0};
          },
          [](auto a, auto) { return log2(f(a)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr) {
            if (mpfr_sgn(a) <= 0) return false;
            mpfr_log2(out, a, MPFR_RNDN);
            return true;
          });
  Proof("pow", kUlp, points, true)
      .run(
          [](Random& random) -> Pair {
            // Half of the bases next to 1, where an exponent can be large.
            const std::int64_t any = random.anySize() & kMost;
            const std::int64_t base = random.next() % 2 == 0 ? any : kOne + (random.anySize() >> 31);
            if (base <= 0) return {1, 0};
            // The exponent such that the power stays in range, more often than not.
            const double logarithm = static_cast<double>(log2(f(base)));
            const double room = logarithm == 0 ? 1e9 : 40 / (logarithm < 0 ? -logarithm : logarithm);
            const double fraction = static_cast<double>(random.next() >> 11) / 4503599627370496.0 - 1;
            return {base, Fixed(room * fraction).raw()};
          },
          [](auto a, auto b) { return pow(f(a), f(b)).raw(); },
          [](mpfr_ptr out, mpfr_ptr a, mpfr_ptr b) {
            if (mpfr_sgn(a) < 0 || (mpfr_zero_p(a) && mpfr_sgn(b) < 0)) return false;
            mpfr_pow(out, a, b, MPFR_RNDN);
            return mpfr_number_p(out) != 0;
          });
}

}  // namespace
}  // namespace samestep

int main(int argc, char** argv) {
  using namespace samestep;
  const std::uint64_t points = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
  const std::string_view group = argc > 2 ? argv[2] : "";
  proveTables();
  std::printf("| function | points | largest error, ulp | bound |\n|---|---|---|---|\n");
  struct Group {
    std::string_view name;
    void (*prove)(std::uint64_t);
  };
  for (const Group& one :
       {Group{"products", &proveProducts}, Group{"quotients", &proveQuotients}, Group{"roots", &proveRoots},
        Group{"angles", &proveAngles}, Group{"powers", &provePowers}}) {
    if (group.empty() || group == one.name) one.prove(points);
  }
  return gFailed ? 1 : 0;
}
