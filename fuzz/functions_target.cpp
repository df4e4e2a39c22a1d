// SPDX-License-Identifier: MIT
// The functions of Fixed against wide integers, 80-bit floats and the laws they obey, and its decimal text.
#include <samestep/decimal.h>
#include <samestep/fixed_math.h>
#include <samestep/fixed_text.h>
#include <samestep/math.h>
#include <samestep/wide.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "check.h"
#include "input.h"

namespace samestep::fuzz {
namespace {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 Unsigned128;
using Extended = long double;

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();

std::int64_t a, b, c;

void describe() {
  std::fprintf(stderr, "a %lld, b %lld, c %lld\n", static_cast<long long>(a), static_cast<long long>(b),
               static_cast<long long>(c));
}

/// Rounds to nearest, ties to even; floor division by 2^32.
Int128 roundedShift(Int128 value) {
  const Int128 floor = value >> 32;
  const auto rest = static_cast<std::uint64_t>(value) & 0xffffffffu;
  const bool up = rest > 0x80000000u || (rest == 0x80000000u && (floor & 1) != 0);
  return floor + (up ? 1 : 0);
}
std::int64_t wrapped(Int128 value) { return static_cast<std::int64_t>(static_cast<std::uint64_t>(value)); }

/// n / d to nearest, ties to even, saturated.
std::int64_t quotient(Int128 n, Int128 d) {
  if (d == 0) return n > 0 ? kMost : n < 0 ? kLeast : 0;
  if (d < 0) {
    n = -n;
    d = -d;
  }
  Int128 floor = n / d, rest = n % d;
  if (rest < 0) {
    rest += d;
    --floor;
  }
  if (2 * rest > d || (2 * rest == d && (floor & 1) != 0)) ++floor;
  return floor > kMost ? kMost : floor < kLeast ? kLeast : static_cast<std::int64_t>(floor);
}

Extended number(std::int64_t raw) { return static_cast<Extended>(raw) * 0x1p-32L; }

/// True if raw is within 1 unit of the last place of an exact value known to 64 bits, or saturated like it.
bool withinUnit(std::int64_t raw, Extended exact) {
  const Extended units = exact * 0x1p32L;
  if (units >= static_cast<Extended>(kMost)) return raw >= kMost - 1;
  if (units <= static_cast<Extended>(kLeast)) return raw == kLeast;
  const Extended slack = 1 + std::fabs(units) * 0x1p-61L;
  return std::fabs(static_cast<Extended>(raw) - units) <= slack;
}

void checkArithmetic() {
  const Fixed x = Fixed::fromRaw(a), y = Fixed::fromRaw(b), z = Fixed::fromRaw(c);
  expect((x * y).raw() == wrapped(roundedShift(Int128{a} * b)),
         "multiply is the exact product, rounded once");
  expect((x + y).raw() == wrapped(Int128{a} + b), "add is exact");
  expect((x - y).raw() == wrapped(Int128{a} - b), "subtract is exact");
  expect((x / y).raw() == quotient(Int128{a} * (Int128{1} << 32), b), "divide is the exact quotient");
  expect(reciprocal(x).raw() == quotient((Int128{1} << 64), a), "reciprocal is the exact quotient");
  expect(mulDiv(x, y, z).raw() == quotient(Int128{a} * b, c), "mulDiv is rounded once");
  expect(mulAdd(x, y, z).raw() == wrapped(roundedShift(Int128{a} * b + Int128{c} * (Int128{1} << 32))),
         "mulAdd is rounded once");
  // Halved, so that the sum of two products fits.
  const Fixed h = Fixed::fromRaw(a >> 1), k = Fixed::fromRaw(b >> 1);
  const Int128 sum = Int128{a >> 1} * (b >> 1) + Int128{c} * (a >> 1);
  const Int128 difference = Int128{a >> 1} * (b >> 1) - Int128{c} * (a >> 1);
  expect(dot(h, k, z, h).raw() == wrapped(roundedShift(sum)), "dot is rounded once");
  expect(cross(h, k, z, h).raw() == wrapped(roundedShift(difference)), "cross is rounded once");
  expect(sign(exactDot(h, k, z, h)) == (sum > 0) - (sum < 0), "exactDot has the sign of the sum");
  expect(sign(exactCross(h, k, z, h)) == (difference > 0) - (difference < 0), "exactCross has its sign");
  if (b != 0 && b != -1) {
    const std::int64_t rest = remainder(x, y).raw();
    expect(rest == a % b, "remainder is exact");
  }
}

/// Number of operations that CheckedFixed reported.
int reports = 0;

void checkChecked() {
  const CheckedFixed x = CheckedFixed::fromRaw(a), y = CheckedFixed::fromRaw(b);
  const OverflowHandler before = setOverflowHandler([](const OverflowReport&) { ++reports; });
  const auto reported = [](auto&& operation) {
    reports = 0;
    operation();
    return reports > 0;
  };
  const auto fits = [](Int128 value) { return value >= kLeast && value <= kMost; };
  expect(reported([&] { return x + y; }) == !fits(Int128{a} + b), "add reports what does not fit");
  expect(reported([&] { return x - y; }) == !fits(Int128{a} - b), "subtract reports what does not fit");
  expect(reported([&] { return x * y; }) == !fits(roundedShift(Int128{a} * b)),
         "multiply reports what does not fit");
  expect(reported([&] { return -x; }) == (a == kLeast), "negate reports what does not fit");
  setOverflowHandler(before);
}

void checkFunctions() {
  const Fixed x = Fixed::fromRaw(a), y = Fixed::fromRaw(b);
  if (a >= 0) {
    const auto root = static_cast<Unsigned128>(static_cast<std::uint64_t>(sqrt(x).raw()));
    // The root is to nearest: (root - 1/2)^2 <= a 2^32 <= (root + 1/2)^2, times 4.
    const auto value = static_cast<Unsigned128>(static_cast<std::uint64_t>(a)) << 34;
    expect(root == 0 || (2 * root - 1) * (2 * root - 1) <= value, "sqrt is not too large");
    expect((2 * root + 1) * (2 * root + 1) >= value, "sqrt is not too small");
  } else {
    expect(sqrt(x) == Fixed(0), "sqrt of a negative number is 0");
  }

  const SinCos<Fixed> turn = sincos(x);
  expect(withinUnit(turn.sin.raw(), std::sin(number(a))), "sin is within a unit");
  expect(withinUnit(turn.cos.raw(), std::cos(number(a))), "cos is within a unit");
  if (a != kLeast) {
    const SinCos<Fixed> mirrored = sincos(-x);
    expect(mirrored.sin == -turn.sin && mirrored.cos == turn.cos, "sin is odd, cos even");
  }
  if (a != 0 || b != 0) {
    expect(withinUnit(atan2(y, x).raw(), std::atan2(number(b), number(a))), "atan2 is within a unit");
  } else {
    expect(atan2(y, x) == Fixed(0), "atan2 of nothing is 0");
  }
  expect(withinUnit(exp2(x).raw(), std::exp2(number(a))), "exp2 is within a unit");
  expect(withinUnit(exp(x).raw(), std::exp(number(a))), "exp is within a unit");
  if (a > 0) {
    expect(withinUnit(log2(x).raw(), std::log2(number(a))), "log2 is within a unit");
    const Extended power = std::pow(number(a), number(b));
    // The long double itself is only as good as its exponent is large.
    if (std::fabs(std::log2(power)) < 31) expect(withinUnit(pow(x, y).raw(), power), "pow is within a unit");
  } else {
    expect(log2(x) == Fixed::lowest(), "log2 of nothing is the lowest number");
  }

  const Fixed size = length(x, y);
  const Extended exact = std::sqrt(number(a) * number(a) + number(b) * number(b));
  if (exact < 0x1p31L - 1) expect(withinUnit(size.raw(), exact), "length is the exact length");
  const Components<Fixed> unit = normalize(x, y);
  if (a == 0 && b == 0) {
    expect(unit.x == Fixed(0) && unit.y == Fixed(0), "nothing has no direction");
  } else {
    expect(withinUnit(unit.x.raw(), number(a) / exact) && withinUnit(unit.y.raw(), number(b) / exact),
           "normalize gives the direction");
  }
}

/// @param withText  also the decimal text, which takes twenty times as long as all the rest
void checkDouble(bool withText) {
  double x = 0, y = 0;
  std::memcpy(&x, &a, sizeof x);
  std::memcpy(&y, &b, sizeof y);
  const Fixed read(x);
  if (x == x && std::fabs(x) < 0x1p31) {
    const Extended units = static_cast<Extended>(x) * 0x1p32L;
    expect(std::fabs(static_cast<Extended>(read.raw()) - units) <= 0.5L,
           "a double becomes the nearest number");
  }
  if (!isFinite(x)) return;
  if (withText) {
    const std::string text = formatDecimal(x);
    double back = 1;
    expect(parseDecimal(std::string_view(text), back) == DecimalStatus::ok, "what is written can be read");
    expect(std::memcmp(&back, &x, sizeof x) == 0, "a double reads back the same");
  }
  if (!isFinite(y)) return;
  if (std::fabs(x) < 0x1p500 && std::fabs(y) < 0x1p500 && std::fabs(x) > 0x1p-500 &&
      std::fabs(y) > 0x1p-500) {
    expectNear(length(x, y) / std::hypot(x, y), 1, 0x1p-50, "length of doubles");
    expectNear(std::fabs(atan2(y, x) - std::atan2(y, x)), 0, 0x1p-50, "atan2 of doubles");
  }
  expectNear(sincos(x).sin, std::sin(x), 0x1p-51, "sin of a double");
  expectNear(sincos(x).cos, std::cos(x), 0x1p-51, "cos of a double");
}

void checkText(std::string_view text) {
  const Fixed x = Fixed::fromRaw(a);
  const std::string written = formatDecimal(x);
  Fixed back(77);
  expect(parseDecimal(std::string_view(written), back) == DecimalStatus::ok, "what is written can be read");
  expect(back == x, "a number reads back the same");

  // Any text gives a number that is the same when written and read again, or leaves it untouched.
  Fixed number(77);
  if (parseDecimal(text, number) == DecimalStatus::ok) {
    Fixed again;
    expect(
        parseDecimal(std::string_view(formatDecimal(number)), again) == DecimalStatus::ok && again == number,
        "a number that was read reads back the same");
    double wide = 0;
    if (text.size() > static_cast<std::size_t>(kMaxDoubleDecimalLength)) return;
    expect(parseDecimal(text, wide) == DecimalStatus::ok, "double reads what Fixed reads");
    expectNear(wide, static_cast<double>(number), 0x1p-33 + std::fabs(wide) * 0x1p-52,
               "both read the same number");
  } else {
    expect(number == Fixed(77), "text that is refused changes nothing");
  }
  double wide = 77;
  if (parseDecimal(text, wide) != DecimalStatus::ok)
    expect(wide == 77, "text that is refused changes nothing");
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep::fuzz;
  describer() = describe;
  Input input(data, size);
  const std::uint64_t head = input.word();
  // Numbers near those that matter, or any 64 bits.
  const auto read = [&](bool any) {
    return any ? static_cast<std::int64_t>(input.word()) : input.number().raw();
  };
  a = read((head & 8) != 0);
  b = read((head & 16) != 0);
  c = read((head & 32) != 0);
  switch (head % 8) {
    case 0:
    case 1:
    case 2:
      checkArithmetic();
      checkChecked();
      break;
    case 3:
    case 4:
      checkFunctions();
      break;
    case 5:
      checkDouble((mixed(data, size) & 7) == 0);
      break;
    default:
      checkText(size > 16 ? std::string_view(reinterpret_cast<const char*>(data) + 16, size - 16) : "");
      break;
  }
  return 0;
}
