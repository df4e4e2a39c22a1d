// SPDX-License-Identifier: MIT
// Names and choice of kernels, and that all of them give the same bits for blocks of any content.
#include <samestep/kernel.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/integer_vectors.h"
#include "solver/kernels/generic/scalar_lanes.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/kernels.h"
#include "support/random.h"

namespace samestep {
namespace {

TEST(KernelTest, NamesAndTargetsNameEachOther) {
  for (const KernelTarget target : kKernelTargets) {
    KernelTarget found = target == KernelTarget::best ? KernelTarget::avx2 : KernelTarget::best;
    EXPECT_TRUE(findKernel(kernelName(target), found));
    EXPECT_EQ(found, target);
  }
  KernelTarget untouched = KernelTarget::sse42;
  EXPECT_FALSE(findKernel("avx", untouched));
  EXPECT_FALSE(findKernel("", untouched));
  EXPECT_EQ(untouched, KernelTarget::sse42);
}

TEST(KernelTest, ThePortableOneIsAlwaysThereAndTheBestIsTheLast) {
  const auto available = availableKernels();
  EXPECT_EQ(available.front(), KernelTarget::portable);
  EXPECT_EQ(nextBestKernel(KernelTarget::best), available.back());
  EXPECT_TRUE(std::is_sorted(available.begin(), available.end()));
  EXPECT_TRUE(isAvailable(KernelTarget::best));
  EXPECT_FALSE(isAvailable(static_cast<KernelTarget>(99)));
}

TEST(KernelTest, TheNextBestIsAvailableAndNoLater) {
  for (const KernelTarget target : kKernelTargets) {
    const KernelTarget next = nextBestKernel(target);
    EXPECT_TRUE(isAvailable(next));
    if (target == KernelTarget::best) continue;
    EXPECT_LE(next, target);
    EXPECT_EQ(next == target, isAvailable(target));
  }
}

constexpr std::uint32_t kBodies = 64;
constexpr std::uint32_t kBlocks = 9;

/// Blocks, the bodies they are about, and what a kernel made of them.
template <class N>
struct Work {
  std::vector<SoftBody<N>> bodies{kBodies};
  std::vector<SoftBody<N>> pushes{kBodies};
  std::vector<SoftDrive<N>> drives{kBodies};
  std::vector<SoftMarks> marks{kBodies};
  std::vector<ContactBlock<N>> blocks{kBlocks};
  std::vector<BlockRest<N>> rests{kBlocks};
  std::vector<BlockInput<N>> inputs{kBlocks};
  SoftConstants<N> constants{};

  /// @return not 0 where a number left the kernel's range
  std::uint64_t prepare(const SoftPasses<N>& passes) {
    std::uint64_t left = 0;
    for (std::uint32_t i = 0; i < kBlocks; ++i) left |= passes.prepare(inputs[i], blocks[i], bodies.data());
    return left;
  }
  std::uint64_t run(const SoftPasses<N>& passes) {
    std::uint64_t left = 0;
    for (int i = 0; i < 3; ++i) {
      const ContactPass<N> springs = i == 0 ? passes.start : passes.solve;
      left |= passes.drive(bodies.data(), drives.data(), marks.data(), kBodies, constants);
      left |= springs(blocks.data(), rests.data(), kBlocks, bodies.data(), constants);
      left |= passes.solve(blocks.data(), rests.data(), kBlocks, bodies.data(), constants);
      left |= passes.push(blocks.data(), rests.data(), kBlocks, pushes.data(), constants);
      left |= passes.move(bodies.data(), drives.data(), marks.data(), kBodies, constants);
      left |= passes.relax(blocks.data(), rests.data(), kBlocks, bodies.data(), constants);
    }
    return left;
  }
};

/// Random numbers of a kernel: `size` is a power of two that they stay below, where they have a unit of a
/// step, in bits.
struct DoubleSource {
  using Numbers = PlainNumbers<double, false>;
  Random random;
  double number(double most) {
    return most * (static_cast<double>(random.next() >> 11) / 4503599627370496.0 - 1.0);
  }
  double unit() { return number(1); }
  double moment() { return 16 * part(); }
  double present() { return 1; }
  double part() { return (number(1) + 1) / 2; }
  std::pair<double, double> direction() {
    const double x = unit();
    return {x, (random.oneIn(2) ? 1 : -1) * std::sqrt(1 - x * x)};
  }
  double friction() { return 2 * part(); }
  double speed() { return number(16); }
  double way() { return number(0.25); }
  double push() { return speed(); }
  double surface() { return speed(); }
  double bend() { return way(); }
  double separation() { return way(); }
  double sum() { return number(4); }
  double positive() { return 4 * part(); }
  double limit() { return 8 + 64 * part(); }
  double kept() { return random.oneIn(2) ? 1 : part(); }
  std::uint8_t bendBits() { return 0; }
  void constants(SoftConstants<Numbers>& to) {
    to.softness[0] = {20, 0.75, 0.25};
    to.softness[1] = {30, 0.5, 0.5};
    to.perSubstep = 240;
    to.pushSpeed = 3;
    to.mostSum = 1e6;
    to.substep = 1.0 / 240;
  }
};

template <class N>
struct IntegerSource {
  using Numbers = N;
  using Speed = typename N::Speed;
  Random random;
  static constexpr bool kWide = std::same_as<N, WideNumbers>;
  /// Bits of speeds, ways and impulses.
  int bits = 20;
  int momentBits = 3;
  Speed upTo(int most) { return static_cast<Speed>(wide(std::min(bits, most))); }
  std::int64_t wide(int width) { return static_cast<std::int64_t>(random.next()) >> (63 - width); }
  std::int32_t number(int width) { return static_cast<std::int32_t>(wide(width)); }
  std::int32_t unit() { return number(N::kUnitBits); }
  /// Random moment up to 2^momentBits.
  std::int32_t moment() {
    const int width = N::kSpinBits + momentBits;
    return number(width) & static_cast<std::int32_t>((std::uint32_t{1} << width) - 1);
  }
  std::int32_t present() { return -1; }
  std::int32_t part() { return number(N::kUnitBits) & ((1 << N::kUnitBits) - 1); }
  std::pair<std::int32_t, std::int32_t> direction() {
    const std::int64_t x = random.oneIn(8) ? std::int64_t{1} << N::kUnitBits : unit();
    // The whole root, so that every machine tries the same.
    const std::uint64_t square = (std::uint64_t{1} << 2 * N::kUnitBits) - static_cast<std::uint64_t>(x * x);
    std::uint64_t root = 0;
    for (std::uint64_t bit = std::uint64_t{1} << N::kUnitBits; bit != 0; bit >>= 1) {
      if ((root + bit) * (root + bit) <= square) root += bit;
    }
    const auto y = static_cast<std::int32_t>(root);
    return {static_cast<std::int32_t>(x), random.oneIn(2) ? y : -y};
  }
  std::int32_t friction() {
    const int width = kWide ? 31 : N::kFrictionBits;
    return number(width) & static_cast<std::int32_t>((std::int64_t{1} << width) - 1);
  }
  std::int32_t spin() { return kWide ? number(31) : unit() >> 4; }
  // Each up to its own end of the wide kernel's range.
  Speed speed() { return upTo(58); }
  Speed push() { return upTo(62); }
  Speed surface() { return upTo(44); }
  Speed way() { return upTo(57); }
  Speed bend() { return upTo(53); }
  Speed separation() { return upTo(56); }
  typename N::Sum sum() { return upTo(53); }
  typename N::Sum positive() {
    const typename N::Sum any = sum();
    return std::max(any, ~any);
  }
  Speed limit() { return static_cast<Speed>(wide(bits + 1) & ((std::int64_t{2} << bits) - 1)); }
  Speed kept() {
    if constexpr (std::same_as<N, FastNumbers>) return random.oneIn(2) ? 1 << N::kUnitBits : part();
    return static_cast<Speed>(random.oneIn(2) ? std::int64_t{1} << 32 : wide(32) & 0xffffffff);
  }
  std::uint8_t bendBits() {
    return static_cast<std::uint8_t>(std::same_as<N, FastNumbers> ? random.between(1, 63)
                                                                  : random.between(0, 24));
  }
  void constants(SoftConstants<N>& to) {
    const std::int32_t one = 1 << N::kUnitBits;
    to.softness[0] = {20 << 16, one / 4 * 3, one / 4};
    to.softness[1] = {30 << 16, one / 2, one / 2};
    to.perSubstep = 240 << 16;
    to.pushSpeed = 3 << 18;
    to.mostSum = std::numeric_limits<typename N::Sum>::max() / 2;
    to.mostGap = (1 << 28) / 4;
    to.mostOverlap = 1 << 28;
    if constexpr (kWide) {
      to.mostGap = to.mostOverlap = std::int64_t{1} << 43;
      to.mostSum = std::int64_t{1} << 52;
    }
    // The time is that of more than three substeps in a step.
    to.substep = kept() >> 2;
  }
};
using FastSource = IntegerSource<FastNumbers>;
using WideSource = IntegerSource<WideNumbers>;

/// Fills what a lane is prepared from: rotations and a normal, which are of length 1 at most, as arms are.
template <class Source, class N = typename Source::Numbers>
void fillInput(Source& from, BlockInput<N>& input, int lane, int points) {
  const auto direction = [&](auto& x, auto& y) {
    const auto [cosine, sine] = from.direction();
    x[lane] = cosine;
    y[lane] = sine;
  };
  direction(input.cosA, input.sinA);
  direction(input.cosB, input.sinB);
  direction(input.normalX, input.normalY);
  input.momentA[lane] = from.moment();
  input.momentB[lane] = from.moment();
  for (int k = 0; k < points; ++k) {
    auto& point = input.point[k];
    direction(point.armAX, point.armAY);
    direction(point.armBX, point.armBY);
    point.present[lane] = from.present();
  }
}

template <class Source, class N = typename Source::Numbers>
Work<N> randomWork(Source& from) {
  Work<N> work;
  for (auto& body : work.bodies) {
    for (int k = 0; k < 3; ++k) {
      body.velocity[k] = from.speed();
      body.moved[k] = from.way();
    }
    body.moved[3] = from.bend();
  }
  for (auto& body : work.pushes) {
    for (int k = 0; k < 3; ++k) body.velocity[k] = from.speed();
  }
  for (auto& drive : work.drives) {
    for (int k = 0; k < 3; ++k) {
      drive.push[k] = from.push();
      drive.base[k] = from.speed();
      drive.limit[k] = from.limit();
    }
    drive.limit[3] = from.kept();
  }
  for (SoftMarks& mark : work.marks) mark.bendBits = from.bendBits();
  from.constants(work.constants);
  Random& random = from.random;
  for (std::uint32_t i = 0; i < kBlocks; ++i) {
    ContactBlock<N>& block = work.blocks[i];
    block = {};
    work.rests[i] = {};
    // Lanes share no body but the first, which nothing moves.
    const int used = random.between(1, N::kLanes);
    std::uint32_t next = 1 + random.below(20);
    for (int lane = 0; lane < N::kLanes; ++lane) {
      const auto bit = static_cast<std::uint16_t>(1 << lane);
      const auto mark = [&](std::uint16_t& bits, bool set) {
        if (set) bits = static_cast<std::uint16_t>(bits | bit);
      };
      const bool standsA = random.oneIn(4), standsB = !standsA && random.oneIn(4);
      mark(block.fixedA, lane >= used || standsA);
      mark(block.fixedB, lane >= used || standsB);
      if (lane >= used) continue;
      block.bodyA[lane] = standsA ? 0 : next++;
      block.bodyB[lane] = standsB ? 0 : next++;
      mark(block.roundA, random.oneIn(3));
      mark(block.roundB, random.oneIn(3));
      mark(block.stiff, standsA || standsB);
      mark(block.stays, i % 2 == 0 && random.oneIn(3));
      mark(block.pushed, (block.stays >> lane & 1) != 0 && random.oneIn(2));
      block.count[lane] = static_cast<std::uint8_t>(random.between(1, 2));
      block.points = std::max(block.points, block.count[lane]);
      block.normalX[lane] = from.unit();
      block.normalY[lane] = from.unit();
      block.shareA[lane] = from.part();
      block.pushAX[lane] = from.part();
      block.pushAY[lane] = from.part();
      block.friction[lane] = from.friction();
      block.surface[lane] = from.surface();
      if constexpr (!N::kStoresSpins) {
        block.moments.momentA[lane] = from.part();
        block.moments.momentB[lane] = from.part();
      }
      for (int k = 0; k < block.count[lane]; ++k) {
        BlockPoint<N>& point = block.point[k];
        for (auto* axis : {&point.normal, &point.tangent}) {
          axis->armA[lane] = from.unit();
          axis->armB[lane] = from.unit();
          axis->mass[lane] = from.part();
          if constexpr (N::kStoresSpins) {
            axis->spinA[lane] = from.spin();
            axis->spinB[lane] = from.spin();
          }
        }
        point.normal.sum[lane] = from.positive();
        point.tangent.sum[lane] = from.sum();
        point.separation[lane] = from.separation();
      }
      fillInput(from, work.inputs[i], lane, block.count[lane]);
    }
  }
  return work;
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// The kernels of the list that this machine runs, with their names.
template <class N>
using NamedPasses = std::vector<std::pair<std::string, const SoftPasses<N>*>>;

/// Passes of the accurate kernel, one number at a time.
template <class S>
constexpr SoftPasses<WideNumbers> kWideBy1 =
    kPassesOf<WideScalarLanes<S>, CoefficientLanes<OneAtATime, WideNumbers>>;

NamedPasses<WideNumbers> wideKernels() {
  NamedPasses<WideNumbers> all;
  if (isAvailable(KernelTarget::sse42)) all.emplace_back("sse42", kernels::wideSse42);
  if (isAvailable(KernelTarget::avx2)) all.emplace_back("avx2", kernels::wideAvx2);
  if (isAvailable(KernelTarget::avx512)) all.emplace_back("avx512", kernels::wideAvx512);
  if (isAvailable(KernelTarget::neon)) all.emplace_back("neon", kernels::wideNeon);
  if (isAvailable(KernelTarget::simd128)) all.emplace_back("simd128", kernels::wideSimd128);
  return all;
}

NamedPasses<FastNumbers> fastKernels() {
  NamedPasses<FastNumbers> all;
  if (isAvailable(KernelTarget::sse42)) all.emplace_back("sse42", kernels::fastSse42);
  if (isAvailable(KernelTarget::avx2)) all.emplace_back("avx2", kernels::fastAvx2);
  if (isAvailable(KernelTarget::avx512)) all.emplace_back("avx512", kernels::fastAvx512);
  if (isAvailable(KernelTarget::neon)) all.emplace_back("neon", kernels::fastNeon);
  if (isAvailable(KernelTarget::simd128)) all.emplace_back("simd128", kernels::fastSimd128);
  return all;
}

/// Fails unless kernels prepare the blocks to the same bits, and say alike whether a number left the range.
/// @return whether one did
template <class N>
bool expectPreparedAlike(const Work<N>& start, const SoftPasses<N>& portable, const NamedPasses<N>& kernels,
                         std::uint64_t seed) {
  Work<N> expected = start;
  const bool left = expected.prepare(portable) != 0;
  EXPECT_FALSE(sameBytes(expected.blocks, start.blocks)) << "seed " << seed;
  EXPECT_FALSE(sameBytes(expected.bodies, start.bodies)) << "seed " << seed;
  for (const auto& [name, passes] : kernels) {
    Work<N> work = start;
    EXPECT_EQ(work.prepare(*passes) != 0, left) << name << ", seed " << seed;
    if (left) continue;
    EXPECT_TRUE(sameBytes(work.blocks, expected.blocks)) << name << ", seed " << seed;
    EXPECT_TRUE(sameBytes(work.bodies, expected.bodies)) << name << ", seed " << seed;
  }
  return left;
}

TEST(FastKernelTest, EveryKernelPreparesTheSameBitsAndFindsTheSameNumbersOutOfRange) {
  int within = 0, beyond = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    FastSource source{Random(seed)};
    source.bits = source.random.between(8, 28);
    source.momentBits = source.random.between(0, 5);
    ++(expectPreparedAlike(randomWork(source), kernels::fastBy1, fastKernels(), seed) ? beyond : within);
  }
  // Both sides of the limit have been tried.
  EXPECT_GT(within, 300);
  EXPECT_GT(beyond, 300);
}

TEST(WideKernelTest, EveryKernelPreparesTheBitsOfCheckedNumbers) {
  NamedPasses<WideNumbers> all = wideKernels();
  all.emplace_back("portable", &kWideBy1<Fixed>);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    WideSource source{Random(seed)};
    source.bits = source.random.between(8, 48);
    source.momentBits = source.random.between(0, 5);
    EXPECT_FALSE(expectPreparedAlike(randomWork(source), kWideBy1<CheckedFixed>, all, seed));
  }
}

TEST(FastKernelTest, EveryKernelGivesTheSameBitsAndFindsTheSameNumbersOutOfRange) {
  int within = 0, beyond = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    FastSource source{Random(seed)};
    source.bits = source.random.between(8, 30);
    const Work<FastNumbers> start = randomWork(source);
    Work<FastNumbers> expected = start;
    const bool left = expected.run(kernels::fastBy1) != 0;
    ++(left ? beyond : within);
    for (const auto& [name, passes] : fastKernels()) {
      Work<FastNumbers> work = start;
      ASSERT_EQ(work.run(*passes) != 0, left) << name << ", seed " << seed;
      // A result that has left the range is worth nothing.
      if (left) continue;
      ASSERT_TRUE(sameBytes(work.bodies, expected.bodies)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.pushes, expected.pushes)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.drives, expected.drives)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.marks, expected.marks)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.blocks, expected.blocks)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.rests, expected.rests)) << name << ", seed " << seed;
    }
  }
  // Both sides of the limit have been tried.
  EXPECT_GT(within, 300);
  EXPECT_GT(beyond, 300);
}

TEST(WideKernelTest, EveryKernelGivesTheBitsOfCheckedNumbersWhichReportNothing) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    WideSource source{Random(seed)};
    // The numbers go up to the ends of all ranges.
    source.bits = source.random.between(8, 58);
    const Work<WideNumbers> start = randomWork(source);
    Work<WideNumbers> expected = start;
    ASSERT_NO_THROW(expected.run(kWideBy1<CheckedFixed>)) << "seed " << seed;
    ASSERT_FALSE(sameBytes(expected.bodies, start.bodies));
    NamedPasses<WideNumbers> all = wideKernels();
    all.emplace_back("portable", &kWideBy1<Fixed>);
    for (const auto& [name, passes] : all) {
      Work<WideNumbers> work = start;
      ASSERT_EQ(work.run(*passes), 0u);
      ASSERT_TRUE(sameBytes(work.bodies, expected.bodies)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.pushes, expected.pushes)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.drives, expected.drives)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.marks, expected.marks)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.blocks, expected.blocks)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.rests, expected.rests)) << name << ", seed " << seed;
    }
  }
}

#ifndef SAMESTEP_FIXED_ONLY
using Doubles = PlainNumbers<double, false>;

NamedPasses<Doubles> doubleKernels() {
  NamedPasses<Doubles> all{{"portable", &kernels::doubleBy2}};
  if (isAvailable(KernelTarget::avx2)) all.emplace_back("avx2", kernels::doubleAvx2);
  if (isAvailable(KernelTarget::avx512)) all.emplace_back("avx512", kernels::doubleAvx512);
  return all;
}

TEST(DoubleKernelTest, EveryKernelPreparesTheSameBits) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    DoubleSource source{Random(seed)};
    expectPreparedAlike(randomWork(source), kernels::doubleBy2, doubleKernels(), seed);
  }
}

TEST(DoubleKernelTest, EveryKernelGivesTheSameBits) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    DoubleSource source{Random(seed)};
    const Work<Doubles> start = randomWork(source);
    Work<Doubles> expected = start;
    ASSERT_EQ(expected.run(kernels::doubleBy2), 0u);
    ASSERT_FALSE(sameBytes(expected.bodies, start.bodies));
    for (const auto& [name, passes] : doubleKernels()) {
      Work<Doubles> work = start;
      ASSERT_EQ(work.run(*passes), 0u);
      ASSERT_TRUE(sameBytes(work.bodies, expected.bodies)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.pushes, expected.pushes)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.drives, expected.drives)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.marks, expected.marks)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.blocks, expected.blocks)) << name << ", seed " << seed;
      ASSERT_TRUE(sameBytes(work.rests, expected.rests)) << name << ", seed " << seed;
    }
  }
}
#endif

}  // namespace
}  // namespace samestep
