// Every pair of values of a 16-bit analogue of the fixed-point number: `fixed_pairs [stride]` takes each
// stride-th first operand, all unless told.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "samestep/fixed_math.h"
#include "small_reference.h"

namespace samestep {
namespace {

using Small = BasicFixed<std::int16_t, 8, Wrapping>;
constexpr int kLeast = -32768, kMost = 32767;

Small small(int bits) { return Small::fromRaw(static_cast<std::int16_t>(bits)); }

bool holds(int a, int b) {
  const Small x = small(a), y = small(b);
  const Small product = x * y;
  if (product.raw() != static_cast<std::int16_t>(roundedQuotientOf(std::int64_t{a} * b, 256))) return false;
  if (cross(x, y, y, x) != Small() || dot(x, y, x, -y) != (b == kLeast ? dot(x, y, x, y) : Small()))
    return false;
  return (x / y).raw() == saturatedQuotientOf(std::int64_t{a} * 256, b, kLeast, kMost);
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
  std::printf("product, quotient and fused sums hold for every pair, stride %d\n", stride);
}
