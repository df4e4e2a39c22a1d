// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <samestep/body.h>
#include <samestep/collision.h>
#include <samestep/error.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class CollisionImpulsesTest : public ::testing::Test {
 protected:
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
  /// 2 kg, 4 kg m^2, its centre at (10, 20).
  static Body<S> body() {
    Body<S> result(S(2), S(4));
    result.setPosition(at(10, 20));
    return result;
  }
};
TYPED_TEST_SUITE(CollisionImpulsesTest, AllScalarsAndChecked);

// MIS section 13, relative_velocity and normal_relative_velocity.
TYPED_TEST(CollisionImpulsesTest, RelativeVelocityIsThatOfTheMaterialAtThePlace) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  Body<S> a = TestFixture::body(), b = TestFixture::body();
  a.setVelocity(at(1, 2));
  a.setAngularVelocity(S(3));
  b.setVelocity(at(5, 0));
  b.setAngularVelocity(S(-1));
  // a: (1, 2) + 3 (-1, 2) = (-2, 8); b: (5, 0) - (0, 4) = (5, -4).
  EXPECT_EQ(relativeVelocity(a, b, at(2, 1), at(4, 0)), at(7, -12));
  EXPECT_EQ(normalRelativeVelocity(a, b, at(2, 1), at(4, 0), at(0, -1)), S(12));
}

TYPED_TEST(CollisionImpulsesTest, ImpulsesPushAndTurnBothBodiesInOppositeWays) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  Body<S> a = TestFixture::body(), b = TestFixture::body();
  applyImpulses(a, b, at(0, 0), at(2, 0), at(0, 4));
  EXPECT_EQ(a.velocity(), at(0, -2));
  EXPECT_EQ(a.angularVelocity(), S(0));
  EXPECT_EQ(b.velocity(), at(0, 2));
  EXPECT_EQ(b.angularVelocity(), S(2));
  EXPECT_EQ(b.velocityBias(), at(0, 0));
  applyImpulse(b, at(0, -4), at(2, 0));
  EXPECT_EQ(b.velocity(), at(0, 0));
  EXPECT_EQ(b.angularVelocity(), S(0));
}

TYPED_TEST(CollisionImpulsesTest, BiasImpulsesLeaveTheVelocitiesAlone) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  Body<S> a = TestFixture::body(), b = TestFixture::body();
  applyBiasImpulses(a, b, at(0, 0), at(2, 0), at(0, 4));
  EXPECT_EQ(a.velocityBias(), at(0, -2));
  EXPECT_EQ(b.velocityBias(), at(0, 2));
  EXPECT_EQ(b.angularVelocityBias(), S(2));
  EXPECT_EQ(b.velocity(), at(0, 0));
  EXPECT_EQ(b.angularVelocity(), S(0));
  applyBiasImpulse(b, at(0, 100000000), at(0, 0));
  EXPECT_EQ(b.velocityBias(), at(0, 1024));

  Body<S> wall = Body<S>::fixedInPlace();
  applyBiasImpulse(wall, at(0, 4), at(1, 0));
  EXPECT_EQ(wall.velocityBias(), at(0, 0));
}

TYPED_TEST(CollisionImpulsesTest, InverseMassAlongAddsWhatTurningGives) {
  using S = TypeParam;
  const auto at = [](int x, int y) { return TestFixture::at(x, y); };
  const Body<S> a = TestFixture::body(), wall = Body<S>::fixedInPlace();
  // 1/2 + 2^2 / 4
  EXPECT_EQ(toScalar<S>(inverseMassAlong(a, at(2, 7), at(0, 1))), ratio<S>(3, 2));
  EXPECT_EQ(toScalar<S>(inverseMassAlong(a, a, at(2, 7), at(0, 0), at(0, 1))), S(2));
  EXPECT_EQ(toScalar<S>(inverseMassAlong(a, wall, at(0, 0), at(9, 9), at(0, 1))), ratio<S>(1, 2));
}

// MIS section 13, UnsolvableCollision.
TYPED_TEST(CollisionImpulsesTest, TwoBodiesThatCannotMoveAreUnsolvable) {
  using S = TypeParam;
  const Body<S> wall = Body<S>::fixedInPlace();
  EXPECT_THROW(inverseMassAlong(wall, wall, Vector<S>(), Vector<S>(), TestFixture::at(1, 0)),
               UnsolvableCollision);
}

}  // namespace
}  // namespace samestep
