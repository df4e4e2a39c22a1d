// Every pair of values of a 16-bit analogue of the fixed-point number: `fixed_pairs [stride]` takes each
// stride-th first operand, all unless told.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "samestep/fixed_math.h"

namespace samestep {
namespace {

using Small = BasicFixed<std::int16_t, 8, Wrapping>;
constexpr int kLeast = -32768, kMost = 32767;

Small small(int bits) { return Small::fromRaw(static_cast<std::int16_t>(bits)); }

// Everything fits in 32 bits, which makes the four thousand million pairs quick.
bool holds(int a, int b) {
  const Small x = small(a), y = small(b);
  const int exact = a * b;
  const int rest = exact & 255;
  const int product = (exact >> 8) + (rest > 128 || (rest == 128 && (exact & 256) != 0) ? 1 : 0);
  if ((x * y).raw() != static_cast<std::int16_t>(product)) return false;

  const int n = a * 256;
  const int quotient = (x / y).raw();
  if (b == 0) return quotient == (a == 0 ? 0 : a < 0 ? kLeast : kMost);
  // The remainder is at most half of the divisor, and a tie has gone to an even quotient.
  const int twice = 2 * std::abs(n - quotient * b), size = std::abs(b);
  if (twice < size || (twice == size && quotient % 2 == 0)) return true;
  // Saturated: the exact quotient is beyond the end.
  const bool negative = (a < 0) != (b < 0);
  return quotient == (negative ? kLeast : kMost) && std::abs(n) >= std::abs(quotient) * size;
}

}  // namespace
}  // namespace samestep

int main(int argc, char** argv) {
  using namespace samestep;
  const int stride = argc > 1 ? std::atoi(argv[1]) : 1;
  for (int a = kLeast; a <= kMost; a += stride) {
    for (int b = kLeast; b <= kMost; ++b) {
      if (!holds(a, b)) {
        std::printf("a law fails at raw %d, %d\n", a, b);
        return 1;
      }
    }
  }
  std::printf("product and quotient hold for every pair, stride %d\n", stride);
}
