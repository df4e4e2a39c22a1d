// Every operation of the fixed-point number beside the same one on double, in one run: throughput (256
// independent calls, load-op-store) and latency (each call waits for the one before). Prints the ratios.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "samestep/fixed.h"
#include "samestep/fixed_math.h"

namespace samestep {
namespace {

constexpr int kCount = 256;

/// The raw operations with nothing but 64-bit integers, as a number type.
struct Portable {
  std::int64_t bits = 0;
  explicit Portable(double value) : bits(Fixed(value).raw()) {}
  explicit Portable(std::int64_t raw) : bits(raw) {}
  Portable() = default;
};

constexpr std::int64_t kLeast = Fixed::lowest().raw(), kMost = Fixed::max().raw();

double lift(double x, std::uint64_t bits) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ bits);
}
Fixed lift(Fixed x, std::uint64_t bits) { return Fixed::fromRaw(x.raw() ^ static_cast<std::int64_t>(bits)); }
Portable lift(Portable x, std::uint64_t bits) { return Portable(x.bits ^ static_cast<std::int64_t>(bits)); }
std::uint64_t bitsOf(double x) { return std::bit_cast<std::uint64_t>(x); }
std::uint64_t bitsOf(Fixed x) { return static_cast<std::uint64_t>(x.raw()); }
std::uint64_t bitsOf(Portable x) { return static_cast<std::uint64_t>(x.bits); }
template <class S>
std::uint64_t bitsOf(const SinCos<S>& x) {
  return bitsOf(x.sin) ^ bitsOf(x.cos);
}
template <class S>
std::uint64_t bitsOf(const Components<S>& x) {
  return bitsOf(x.x) ^ bitsOf(x.y);
}

template <class S>
struct Inputs {
  alignas(64) std::array<S, kCount> a, b, c, d, e, f, g, h;
};

/// Domain from which an operation takes its arguments.
enum class Domain { signedHundred, positive, exponent };

template <class S>
const Inputs<S>& inputs(Domain domain) {
  static const auto make = [](Domain kind) {
    Inputs<S> result{};
    std::uint64_t state = 88172645463325252u;
    const auto next = [&] {
      state ^= state << 13;
      state ^= state >> 7;
      state ^= state << 17;
      return static_cast<double>(state >> 11) / 9007199254740992.0;
    };
    for (int i = 0; i < kCount; ++i) {
      const auto at = static_cast<std::size_t>(i);
      for (std::array<S, kCount>* const column :
           {&result.a, &result.b, &result.c, &result.d, &result.e, &result.f, &result.g, &result.h}) {
        const double unit = next();
        (*column)[at] = kind == Domain::signedHundred ? S(200 * unit - 100)
                        : kind == Domain::positive    ? S(std::exp2(40 * unit - 10) + 0.001)
                                                      : S(20 * unit - 10);
      }
    }
    return result;
  };
  static const std::array<Inputs<S>, 3> all = {make(Domain::signedHundred), make(Domain::positive),
                                               make(Domain::exponent)};
  return all[static_cast<std::size_t>(domain)];
}

template <class Op, class S>
using Result = decltype(Op{}(S{}, S{}, S{}, S{}));

template <class Op, class S>
void throughput(benchmark::State& state) {
  const Inputs<S>* source = &inputs<S>(Op::kDomain);
  benchmark::DoNotOptimize(source);  // not known when compiling
  const Inputs<S>& in = *source;
  alignas(64) std::array<Result<Op, S>, kCount> out{};
  for ([[maybe_unused]] auto round : state) {
    for (std::size_t i = 0; i < kCount; ++i) {
      if constexpr (requires { Op::kRow; }) {
        out[i] = Op{}(in.a[i], in.b[i], in.c[i], in.d[i], in.e[i], in.f[i], in.g[i], in.h[i]);
      } else {
        out[i] = Op{}(in.a[i], in.b[i], in.c[i], in.d[i]);
      }
    }
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
}

template <class Op, class S>
void latency(benchmark::State& state) {
  const Inputs<S>* source = &inputs<S>(Op::kDomain);
  benchmark::DoNotOptimize(source);  // not known when compiling
  const Inputs<S>& in = *source;
  // Zero, but not known to the compiler: makes each call wait for the result of the one before.
  volatile std::uint64_t zero = 0;
  const std::uint64_t mask = zero;
  std::uint64_t chain = 0;
  for ([[maybe_unused]] auto round : state) {
    for (std::size_t i = 0; i < kCount; ++i) {
      chain = bitsOf(Op{}(lift(in.a[i], chain & mask), in.b[i], in.c[i], in.d[i]));
    }
    benchmark::DoNotOptimize(chain);
  }
}

using Words = way::Portable::Words;
using PortableSum = way::Sum<Words, 32>;
using Way = way::Portable;

struct Add {
  static constexpr Domain kDomain = Domain::signedHundred;
  template <class S>
  S operator()(S a, S b, S, S) const {
    return a + b;
  }
  Portable operator()(Portable a, Portable b, Portable, Portable) const { return Portable(a.bits + b.bits); }
};
struct Multiply {
  static constexpr Domain kDomain = Domain::signedHundred;
  template <class S>
  S operator()(S a, S b, S, S) const {
    return a * b;
  }
  Portable operator()(Portable a, Portable b, Portable, Portable) const {
    PortableSum sum;
    sum.plus(a.bits, b.bits);
    return Portable(sum.rounded());
  }
};
struct MulAdd {
  static constexpr Domain kDomain = Domain::signedHundred;
  Fixed operator()(Fixed a, Fixed b, Fixed c, Fixed) const { return mulAdd(a, b, c); }
  double operator()(double a, double b, double c, double) const { return a * b + c; }
  Portable operator()(Portable a, Portable b, Portable c, Portable) const {
    PortableSum sum;
    sum.plus(a.bits, b.bits);
    sum.plus(c.bits);
    return Portable(sum.rounded());
  }
};
struct Dot {
  static constexpr Domain kDomain = Domain::signedHundred;
  Fixed operator()(Fixed a, Fixed b, Fixed c, Fixed d) const { return dot(a, b, c, d); }
  double operator()(double a, double b, double c, double d) const { return a * b + c * d; }
  Portable operator()(Portable a, Portable b, Portable c, Portable d) const {
    PortableSum sum;
    sum.plus(a.bits, b.bits);
    sum.plus(c.bits, d.bits);
    return Portable(sum.rounded());
  }
};
struct Row {
  static constexpr Domain kDomain = Domain::signedHundred;
  static constexpr bool kRow = true;
  Fixed operator()(Fixed a, Fixed b, Fixed c, Fixed d, Fixed e, Fixed f, Fixed g, Fixed h) const {
    return dot4(a, b, c, d, e, f, g, h);
  }
  double operator()(double a, double b, double c, double d, double e, double f, double g, double h) const {
    return a * b + c * d + e * f + g * h;
  }
  Portable operator()(Portable a, Portable b, Portable c, Portable d, Portable e, Portable f, Portable g,
                      Portable h) const {
    PortableSum sum;
    sum.plus(a.bits, b.bits);
    sum.plus(c.bits, d.bits);
    sum.plus(e.bits, f.bits);
    sum.plus(g.bits, h.bits);
    return Portable(sum.rounded());
  }
  template <class S>
  S operator()(S a, S b, S c, S d) const {
    return (*this)(a, b, c, d, d, c, b, c);
  }
};
struct Divide {
  static constexpr Domain kDomain = Domain::signedHundred;
  template <class S>
  S operator()(S a, S b, S, S) const {
    return a / b;
  }
  Portable operator()(Portable a, Portable b, Portable, Portable) const {
    return Portable(raw::divide<Way, 32>(a.bits, b.bits, kLeast, kMost).raw);
  }
};
struct Reciprocal {
  static constexpr Domain kDomain = Domain::signedHundred;
  Fixed operator()(Fixed a, Fixed, Fixed, Fixed) const { return reciprocal(a); }
  double operator()(double a, double, double, double) const { return 1 / a; }
  Portable operator()(Portable a, Portable, Portable, Portable) const {
    return Portable(raw::divide<Way, 64>(1, a.bits, kLeast, kMost).raw);
  }
};
struct Sqrt {
  static constexpr Domain kDomain = Domain::positive;
  Fixed operator()(Fixed a, Fixed, Fixed, Fixed) const { return sqrt(a); }
  double operator()(double a, double, double, double) const { return std::sqrt(a); }
  Portable operator()(Portable a, Portable, Portable, Portable) const {
    return Portable(raw::squareRoot<Way, 32>(a.bits));
  }
};
struct Length {
  static constexpr Domain kDomain = Domain::signedHundred;
  Fixed operator()(Fixed a, Fixed b, Fixed, Fixed) const { return length(a, b); }
  double operator()(double a, double b, double, double) const { return std::sqrt(a * a + b * b); }
  Portable operator()(Portable a, Portable b, Portable, Portable) const {
    return Portable(raw::length<Way>(a.bits, b.bits, kMost).raw);
  }
};
struct Normalize {
  static constexpr Domain kDomain = Domain::signedHundred;
  Components<Fixed> operator()(Fixed a, Fixed b, Fixed, Fixed) const { return normalize(a, b); }
  Components<double> operator()(double a, double b, double, double) const {
    const double inverse = 1 / std::sqrt(a * a + b * b);
    return {a * inverse, b * inverse};
  }
  Components<Portable> operator()(Portable a, Portable b, Portable, Portable) const {
    const raw::RawComponents unit = raw::normalize<Way, 32>(a.bits, b.bits);
    return {Portable(unit.x), Portable(unit.y)};
  }
};
struct SineCosine {
  static constexpr Domain kDomain = Domain::signedHundred;
  SinCos<Fixed> operator()(Fixed a, Fixed, Fixed, Fixed) const { return sincos(a); }
  SinCos<double> operator()(double a, double, double, double) const { return {std::sin(a), std::cos(a)}; }
  SinCos<Portable> operator()(Portable a, Portable, Portable, Portable) const {
    const raw::RawSinCos result = raw::sincos<Way>(a.bits);
    return {Portable(result.sin), Portable(result.cos)};
  }
};
struct Atan2 {
  static constexpr Domain kDomain = Domain::signedHundred;
  Fixed operator()(Fixed a, Fixed b, Fixed, Fixed) const { return atan2(a, b); }
  double operator()(double a, double b, double, double) const { return std::atan2(a, b); }
  Portable operator()(Portable a, Portable b, Portable, Portable) const {
    return Portable(raw::atan2<Way>(a.bits, b.bits));
  }
};
struct Exp {
  static constexpr Domain kDomain = Domain::exponent;
  Fixed operator()(Fixed a, Fixed, Fixed, Fixed) const { return exp(a); }
  double operator()(double a, double, double, double) const { return std::exp(a); }
  Portable operator()(Portable a, Portable, Portable, Portable) const {
    return Portable(raw::exp<Way>(a.bits).raw);
  }
};
struct Exp2 {
  static constexpr Domain kDomain = Domain::exponent;
  Fixed operator()(Fixed a, Fixed, Fixed, Fixed) const { return exp2(a); }
  double operator()(double a, double, double, double) const { return std::exp2(a); }
  Portable operator()(Portable a, Portable, Portable, Portable) const {
    return Portable(raw::exp2<Way>(a.bits).raw);
  }
};
struct Log2 {
  static constexpr Domain kDomain = Domain::positive;
  Fixed operator()(Fixed a, Fixed, Fixed, Fixed) const { return log2(a); }
  double operator()(double a, double, double, double) const { return std::log2(a); }
  Portable operator()(Portable a, Portable, Portable, Portable) const {
    return Portable(raw::log2<Way>(a.bits));
  }
};
struct Pow {
  static constexpr Domain kDomain = Domain::exponent;
  static double base(double x) { return x < 0 ? -x : x; }
  Fixed operator()(Fixed a, Fixed b, Fixed, Fixed) const { return pow(abs(a), b); }
  double operator()(double a, double b, double, double) const { return std::pow(base(a), b); }
  Portable operator()(Portable a, Portable b, Portable, Portable) const {
    return Portable(raw::pow<Way>(a.bits < 0 ? -a.bits : a.bits, b.bits).raw);
  }
};

std::vector<std::string>& order() {
  static std::vector<std::string> names;
  return names;
}

template <class Op>
void add(const std::string& name) {
  order().push_back(name);
  const auto each = [&](const char* type, const char* kind, auto* function) {
    benchmark::RegisterBenchmark((name + "/" + type + "/" + kind).c_str(), function);
  };
  each("double", "throughput", &throughput<Op, double>);
  each("fixed", "throughput", &throughput<Op, Fixed>);
  each("portable", "throughput", &throughput<Op, Portable>);
  each("double", "latency", &latency<Op, double>);
  each("fixed", "latency", &latency<Op, Fixed>);
  each("portable", "latency", &latency<Op, Portable>);
}

/// Prints the fastest repetitions as one Markdown table.
class TableReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      times_[run.run_name.function_name].push_back(run.GetAdjustedCPUTime() / kCount);
    }
  }
  void Finalize() override {
    std::printf(
        "| operation | double ns | Fixed ns | ratio | portable ns | to Fixed | double latency ns | Fixed "
        "latency ns | ratio |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& name : order()) {
      if (times_.count(name + "/fixed/throughput") == 0) continue;
      const double d = best(name + "/double/throughput"), f = best(name + "/fixed/throughput");
      const double p = best(name + "/portable/throughput");
      const double dl = best(name + "/double/latency"), fl = best(name + "/fixed/latency");
      std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n", name.c_str(), d, f,
                  f / d, p, p / f, dl, fl, fl / dl);
    }
  }

 private:
  /// The least disturbed of the repetitions.
  double best(const std::string& name) {
    const std::vector<double>& all = times_[name];
    return all.empty() ? 0 : *std::min_element(all.begin(), all.end());
  }
  std::map<std::string, std::vector<double>> times_;
};

}  // namespace
}  // namespace samestep

int main(int argc, char** argv) {
  using namespace samestep;
  add<Add>("add");
  add<Multiply>("multiply");
  add<MulAdd>("mulAdd");
  add<Dot>("dot");
  add<Row>("dot4");
  add<Divide>("divide");
  add<Reciprocal>("reciprocal");
  add<Sqrt>("sqrt");
  add<Length>("length");
  add<Normalize>("normalize");
  add<SineCosine>("sincos");
  add<Atan2>("atan2");
  add<Exp>("exp");
  add<Exp2>("exp2");
  add<Log2>("log2");
  add<Pow>("pow");
  benchmark::Initialize(&argc, argv);
  TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
