// SPDX-License-Identifier: MIT
// The modes of the processor that change what double gives.
#include <samestep/environment.h>
#include <samestep/fingerprint.h>
#include <samestep/snapshot.h>

#include <cfenv>
#include <string>
#include <utility>
#include <vector>

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr int kModes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

/// Another rounding mode while it lives.
class Rounding {
 public:
  explicit Rounding(int mode) { std::fesetround(mode); }
  ~Rounding() { std::fesetround(FE_TONEAREST); }
};

#ifdef __SSE2__
/// Bits of MXCSR while it lives: 0x8000 flushes results to zero, 0x0040 takes operands for zero.
class Mxcsr {
 public:
  explicit Mxcsr(unsigned bits) : before_(_mm_getcsr()) { _mm_setcsr(before_ | bits); }
  ~Mxcsr() { _mm_setcsr(before_); }

 private:
  unsigned before_;
};
constexpr unsigned kFlushes[] = {0x8000u, 0x0040u, 0x8040u};
#endif

/// Calls try in every mode in which double is not what it should be.
template <class Try>
int inEachUnsoundMode(Try&& call) {
  int modes = 0;
  for (const int mode : kModes) {
    const Rounding rounding(mode);
    call();
    ++modes;
  }
#ifdef __SSE2__
  for (const unsigned bits : kFlushes) {
    const Mxcsr flush(bits);
    call();
    ++modes;
  }
#endif
  return modes;
}

/// Hashes of a scene and of what a game asks for in between: nothing of it may depend on the mode in Fixed.
template <Scalar S>
std::vector<std::uint64_t> hashesOfScene(std::uint64_t seed) {
  Space<S> space;
  fillAtRandom(space, seed);
  if (seed % 2 == 1) space.setPrecision(ContactPrecision::fast);
  return hashesOf(space, 60);
}

TEST(EnvironmentTest, FixedGivesTheSameInEveryMode) {
  const std::uint64_t usual = fingerprint<Fixed>();
  const std::vector<std::uint64_t> hashes[] = {hashesOfScene<Fixed>(1), hashesOfScene<Fixed>(2)};

  const int modes = inEachUnsoundMode([&] {
    EXPECT_EQ(fingerprint<Fixed>(), usual);
    EXPECT_EQ(hashesOfScene<Fixed>(1), hashes[0]);
    EXPECT_EQ(hashesOfScene<Fixed>(2), hashes[1]);
    EXPECT_NO_THROW(requireSoundArithmetic<Fixed>());
  });

  EXPECT_GE(modes, 3);
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(EnvironmentTest, DoubleIsSoundUnlessSomebodyChangedTheMode) {
  EXPECT_EQ(doubleFlaw(), nullptr);
  EXPECT_NO_THROW(requireSoundArithmetic<double>());
  inEachUnsoundMode([] { EXPECT_NE(doubleFlaw(), nullptr); });
  EXPECT_EQ(doubleFlaw(), nullptr);
}

TEST(EnvironmentTest, TheFlawIsNamed) {
  for (const int mode : kModes) {
    const Rounding rounding(mode);
    EXPECT_NE(std::string(doubleFlaw()).find("nearest"), std::string::npos) << mode;
  }
#ifdef __SSE2__
  for (const unsigned bits : kFlushes) {
    const Mxcsr flush(bits);
    EXPECT_NE(std::string(doubleFlaw()).find("subnormal"), std::string::npos) << bits;
  }
#endif
}

TEST(EnvironmentTest, DoubleRefusesToStepAndNothingChanges) {
  Space<double> space;
  fillAtRandom(space, 3);
  hashesOf(space, 20);
  const std::uint64_t before = space.hash();

  inEachUnsoundMode([&] {
    EXPECT_THROW(space.step(kTick<double>), UnsoundArithmetic);
    EXPECT_FALSE(space.isLocked());
    EXPECT_EQ(space.hash(), before);
  });

  Space<double> other;
  fillAtRandom(other, 3);
  hashesOf(other, 20);
  EXPECT_EQ(hashesOf(space, 20), hashesOf(other, 20));
}

// A body's rotation, which the file does not hold, would come out differently.
TEST(EnvironmentTest, DoubleRefusesToLoadASnapshot) {
  Space<double> space;
  fillAtRandom(space, 3);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(saveSnapshot(space, {})));
  saveSnapshot(space, bytes);

  inEachUnsoundMode([&] { EXPECT_THROW(loadSnapshot(space, bytes), UnsoundArithmetic); });

  EXPECT_NO_THROW(loadSnapshot(space, bytes));
}

TEST(EnvironmentTest, TheFingerprintOfDoubleTellsTheModesApartFromTheUsualOne) {
  const std::uint64_t usual = fingerprint<double>();

  inEachUnsoundMode([&] { EXPECT_NE(fingerprint<double>(), usual); });

  EXPECT_EQ(fingerprint<double>(), usual);
}
#endif

}  // namespace
}  // namespace samestep
