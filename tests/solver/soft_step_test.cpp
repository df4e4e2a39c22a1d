// SPDX-License-Identifier: MIT
#include "solver/soft_step/soft_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class SoftStepTest : public ::testing::Test {};
TYPED_TEST_SUITE(SoftStepTest, AllScalarsAndChecked);

// Catto, "Soft Constraints": with w = 2 pi f, a = 2 z + h w and b = h w a, a spring takes w / a of an overlap
// each second, and its impulses are b / (1 + b) of a stiff contact's, less 1 / (1 + b) of what they are
// already.
TYPED_TEST(SoftStepTest, ASpringIsThatOfItsFormula) {
  using S = TypeParam;
  const double hertz = 30, damping = 10, substep = 1.0 / 256;
  const Softness<S> softness = makeSoftness<S>(S(hertz), S(damping), S(substep));
  const double omega = 2 * 3.14159265358979323846 * hertz, a = 2 * damping + substep * omega,
               b = substep * omega * a;
  EXPECT_NEAR(static_cast<double>(softness.biasRate), omega / a, 1e-6);
  EXPECT_NEAR(static_cast<double>(softness.massScale), b / (1 + b), 1e-8);
  EXPECT_NEAR(static_cast<double>(softness.impulseScale), 1 / (1 + b), 1e-8);
}

// A spring without damping takes 1 / h of an overlap each second, which in a substep of one unit does not fit
// Fixed.
TYPED_TEST(SoftStepTest, ASpringTakesNoMoreThanItsLimitInTheShortestSubsteps) {
  using S = TypeParam;
  for (const S damping : {S(0), S(0x1p-32), S(1)}) {
    for (const S substep : {S(0x1p-32), S(0x1p-20), S(0x1p-14)}) {
      const Softness<S> softness = makeSoftness<S>(S(39), damping, substep);
      EXPECT_GE(softness.biasRate, S(0));
      EXPECT_LE(softness.biasRate, S(1 << 14));
      EXPECT_GE(softness.massScale, S(0));
      EXPECT_LE(softness.impulseScale, S(1));
    }
  }
  EXPECT_EQ(makeSoftness<S>(S(39), S(0), S(0x1p-32)).biasRate, S(1 << 14));
}

TYPED_TEST(SoftStepTest, WithoutStiffnessThereIsNoSpring) {
  using S = TypeParam;
  const Softness<S> softness = makeSoftness<S>(S(0), S(10), S(0x1p-8));
  EXPECT_EQ(softness.biasRate, S(0));
}

}  // namespace
}  // namespace samestep
