// SPDX-License-Identifier: MIT
#include <samestep/body.h>

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samestep/control.h>
#include <samestep/error.h>
#include "state/state_hash.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <Scalar S>
class BodyTest : public ::testing::Test {
 protected:
  using V = Vector<S>;
  static S half() { return ratio<S>(1, 2); }

  /// Numbers that no setter may take: beyond every range, and in double not numbers at all.
  static std::vector<S> wild() {
    std::vector<S> values = {std::numeric_limits<S>::max(), std::numeric_limits<S>::lowest()};
    if constexpr (std::numeric_limits<S>::has_infinity) {
      values.push_back(std::numeric_limits<S>::infinity());
      values.push_back(-std::numeric_limits<S>::infinity());
      values.push_back(std::numeric_limits<S>::quiet_NaN());
    }
    return values;
  }

  template <class E, class Call>
  static void expectRefused(Body<S>& body, Call&& call) {
    const std::uint64_t before = hashOf(body);
    EXPECT_THROW(call(body), E);
    EXPECT_EQ(hashOf(body), before);
  }
};
TYPED_TEST_SUITE(BodyTest, AllScalarsAndChecked);

TYPED_TEST(BodyTest, NewBodyIsDynamicAtRestAtTheOrigin) {
  using S = TypeParam;
  const Body<S> body(S(2), S(3));

  EXPECT_EQ(body.type(), BodyType::dynamicBody);
  EXPECT_TRUE(body.rotates());
  EXPECT_EQ(body.mass(), S(2));
  EXPECT_EQ(body.moment(), S(3));
  EXPECT_EQ(toScalar<S>(body.inverseMass()), ratio<S>(1, 2));
  EXPECT_EQ(body.position(), Vector<S>());
  EXPECT_EQ(body.worldCenter(), Vector<S>());
  EXPECT_EQ(body.centerOfMass(), Vector<S>());
  EXPECT_EQ(body.velocity(), Vector<S>());
  EXPECT_EQ(body.velocityBias(), Vector<S>());
  EXPECT_EQ(body.force(), Vector<S>());
  EXPECT_EQ(body.angle(), S(0));
  EXPECT_EQ(body.rotation(), Vector<S>(S(1), S(0)));
  EXPECT_EQ(body.angularVelocity(), S(0));
  EXPECT_EQ(body.angularVelocityBias(), S(0));
  EXPECT_EQ(body.torque(), S(0));
  EXPECT_EQ(body.positionFunc(), 0u);
  EXPECT_EQ(body.velocityFunc(), 0u);
  EXPECT_EQ(body.userData(), 0u);
  EXPECT_FALSE(body.id().valid());
}

TYPED_TEST(BodyTest, GettersReadBackWhatTheSettersWrote) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setCenterOfMass({S(1), S(2)});
  body.setPosition({S(3), S(-4)});
  body.setVelocity({S(5), S(-6)});
  body.setForce({S(7), S(-8)});
  body.setAngle(S(9));
  body.setAngularVelocity(S(-10));
  body.setTorque(S(11));

  EXPECT_EQ(body.centerOfMass(), Vector<S>(S(1), S(2)));
  EXPECT_EQ(body.velocity(), Vector<S>(S(5), S(-6)));
  EXPECT_EQ(body.force(), Vector<S>(S(7), S(-8)));
  EXPECT_EQ(body.angle(), S(9));
  EXPECT_EQ(body.rotation(), forAngle(S(9)));
  EXPECT_EQ(body.angularVelocity(), S(-10));
  EXPECT_EQ(body.torque(), S(11));
  EXPECT_NEAR(double(body.position().x), 3, 1e-8);
  EXPECT_NEAR(double(body.position().y), -4, 1e-8);
}

// MIS section 4: newBody.
TYPED_TEST(BodyTest, NewBodyRefusesMassesAndMomentsOutOfRange) {
  using S = TypeParam;
  EXPECT_THROW(Body<S>(S(-1), S(1)), NegativeMass);
  EXPECT_THROW(Body<S>(S(1), S(-1)), NegativeMoment);
  EXPECT_THROW(Body<S>(ratio<S>(1, 1001), S(1)), MassOutOfRange);
  EXPECT_THROW(Body<S>(S(1000001), S(1)), MassOutOfRange);
  EXPECT_THROW(Body<S>(S(1), ratio<S>(1, 1 << 21)), MomentOutOfRange);
  EXPECT_THROW(Body<S>(S(1), S((1 << 30) + 1)), MomentOutOfRange);
  EXPECT_NO_THROW(Body<S>(S(0), S(0)));
  EXPECT_NO_THROW(Body<S>(kMinMass<S>, kMinMoment<S>));
  EXPECT_NO_THROW(Body<S>(kMaxMass<S>, kMaxMoment<S>));
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(BodyOfDoubleTest, NewBodyRefusesWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Body<double>(nan, 1), NaNMass);
  EXPECT_THROW(Body<double>(1, nan), NaNMoment);
  EXPECT_THROW(Body<double>(infinity, 1), InfiniteMass);
  EXPECT_THROW(Body<double>(-infinity, 1), NegativeMass);
  EXPECT_THROW(Body<double>(1, infinity), InfiniteMoment);
  EXPECT_THROW(Body<double>(1, -infinity), NegativeMoment);
}

TEST(BodyOfDoubleTest, SetMassAndSetMomentRefuseWhatIsNoNumberAndKeepTheOldOnes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Body<double> body(2, 3);

  EXPECT_THROW(body.setMass(nan), NaNMass);
  EXPECT_THROW(body.setMass(infinity), InfiniteMass);
  EXPECT_THROW(body.setMoment(nan), NaNMoment);
  EXPECT_THROW(body.setMoment(infinity), InfiniteMoment);

  EXPECT_EQ(body.mass(), 2);
  EXPECT_EQ(body.moment(), 3);
}
#endif

// MIS section 4, bodySetMass: a refused mass leaves the body as it was.
TYPED_TEST(BodyTest, SetMassRefusesNegativeAndKeepsOldMass) {
  using S = TypeParam;
  Body<S> body(S(2), S(1));

  this->template expectRefused<NegativeMass>(body, [](auto& b) { b.setMass(S(-1)); });
  this->template expectRefused<MassOutOfRange>(body, [](auto& b) { b.setMass(S(2000000)); });

  EXPECT_EQ(body.mass(), S(2));
  EXPECT_EQ(toScalar<S>(body.inverseMass()), ratio<S>(1, 2));
}

TYPED_TEST(BodyTest, SetMomentRefusesNegativeAndKeepsOldMoment) {
  using S = TypeParam;
  Body<S> body(S(2), S(4));

  this->template expectRefused<NegativeMoment>(body, [](auto& b) { b.setMoment(S(-1)); });
  this->template expectRefused<MomentOutOfRange>(body, [](auto& b) { b.setMoment(ratio<S>(1, 1 << 22)); });

  EXPECT_EQ(body.moment(), S(4));
  EXPECT_EQ(toScalar<S>(body.inverseMoment()), ratio<S>(1, 4));
}

TYPED_TEST(BodyTest, SetMassAndSetMomentChangeTheInverses) {
  using S = TypeParam;
  Body<S> body(S(2), S(4));

  body.setMass(S(8));
  body.setMoment(S(16));

  EXPECT_EQ(toScalar<S>(body.inverseMass()), ratio<S>(1, 8));
  EXPECT_EQ(toScalar<S>(body.inverseMoment()), ratio<S>(1, 16));
}

TYPED_TEST(BodyTest, StaticAndKinematicBodiesHaveNoMassToSet) {
  using S = TypeParam;
  for (Body<S> body : {Body<S>::fixedInPlace(), Body<S>::kinematic()}) {
    EXPECT_EQ(body.mass(), S(0));
    EXPECT_EQ(body.moment(), S(0));
    EXPECT_EQ(body.inverseMass(), Scaled<S>{});
    EXPECT_EQ(body.inverseMoment(), Scaled<S>{});
    this->template expectRefused<StaticBodyMass>(body, [](auto& b) { b.setMass(S(1)); });
    this->template expectRefused<StaticBodyMass>(body, [](auto& b) { b.setMoment(S(1)); });
  }
}

TYPED_TEST(BodyTest, TypeChangesKeepTheMassForLater) {
  using S = TypeParam;
  Body<S> body(S(2), S(4));
  body.setVelocity({S(1), S(2)});
  body.setAngularVelocity(S(3));

  body.setType(BodyType::kinematicBody);
  EXPECT_EQ(body.mass(), S(0));
  EXPECT_EQ(body.velocity(), Vector<S>(S(1), S(2)));

  body.setType(BodyType::staticBody);
  EXPECT_EQ(body.velocity(), Vector<S>());
  EXPECT_EQ(body.angularVelocity(), S(0));

  body.setType(BodyType::dynamicBody);
  EXPECT_EQ(body.mass(), S(2));
  EXPECT_EQ(body.moment(), S(4));
  EXPECT_EQ(body.velocity(), Vector<S>());
}

TYPED_TEST(BodyTest, NonRotatingBodyIsNotTurnedByTorqueOrImpulse) {
  using S = TypeParam;
  Body<S> body = Body<S>::nonRotating(S(2));
  body.setTorque(S(5));

  body.applyImpulse({S(2), S(0)}, {S(0), S(3)});
  body.updateVelocity({}, S(1));

  EXPECT_FALSE(body.rotates());
  EXPECT_EQ(body.inverseMoment(), Scaled<S>{});
  EXPECT_EQ(body.angularVelocity(), S(0));
  EXPECT_EQ(body.velocity(), Vector<S>(S(1), S(0)));
  EXPECT_THROW(Body<S>::nonRotating(S(-1)), NegativeMass);
}

TYPED_TEST(BodyTest, AMomentMakesANonRotatingBodyRotate) {
  using S = TypeParam;
  Body<S> body = Body<S>::nonRotating(S(2));

  body.setMoment(S(4));

  EXPECT_TRUE(body.rotates());
  EXPECT_EQ(toScalar<S>(body.inverseMoment()), ratio<S>(1, 4));
}

TYPED_TEST(BodyTest, SettersRefuseValuesOutOfRange) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setPosition({S(1), S(2)});
  for (const S bad : this->wild()) {
    for (const Vector<S>& v : {Vector<S>(bad, S(0)), Vector<S>(S(0), bad)}) {
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setPosition(v); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setCenterOfMass(v); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setVelocity(v); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setForce(v); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.applyImpulse(v, {}); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.applyImpulse({}, v); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.applyForce(v, {}); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.applyForce({}, v); });
      this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.updateVelocity(v, S(1)); });
    }
    this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setAngle(bad); });
    this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setAngularVelocity(bad); });
    this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setTorque(bad); });
    this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.updatePosition(bad); });
    this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.updateVelocity({}, bad); });
    this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.updateVelocity({}, bad, S(1)); });
  }
  this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.updateVelocity({}, S(-1), S(1)); });
}

TYPED_TEST(BodyTest, SettersTakeTheEndsOfTheirRangesAndNothingBeyond) {
  using S = TypeParam;
  const S more = ratio<S>(1, 1024);
  Body<S> body(S(1), S(1));
  body.setVelocity({kMaxSpeed<S>, -kMaxSpeed<S>});
  body.setAngularVelocity(-kMaxAngularSpeed<S>);
  body.setPosition({-kMaxWorldExtent<S>, kMaxWorldExtent<S>});
  body.setForce({kMaxForce<S>, -kMaxForce<S>});
  body.setTorque(kMaxForce<S>);
  body.setAngle(kMaxAngle<S>);
  EXPECT_EQ(body.position(), Vector<S>(-kMaxWorldExtent<S>, kMaxWorldExtent<S>));
  EXPECT_EQ(body.angle(), kMaxAngle<S>);

  this->template expectRefused<IllegalBody>(body, [&](auto& b) {
    b.setVelocity({kMaxSpeed<S> + more, S(0)});
  });
  this->template expectRefused<IllegalBody>(
      body, [&](auto& b) { b.setAngularVelocity(kMaxAngularSpeed<S> + more); });
  this->template expectRefused<IllegalBody>(body, [&](auto& b) {
    b.setPosition({kMaxWorldExtent<S> + more, S(0)});
  });
  this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setForce({S(0), kMaxForce<S> + more}); });
  this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setTorque(-kMaxForce<S> - more); });
  this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setAngle(kMaxAngle<S> + more); });
  this->template expectRefused<IllegalBody>(body, [&](auto& b) {
    b.setCenterOfMass({kMaxCenterOfMass<S> + more, S(0)});
  });
}

TYPED_TEST(BodyTest, MessagesSayWhatIsInvalid) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  const S bad = std::numeric_limits<S>::max();
  const auto messageOf = [](auto&& call) -> std::string {
    try {
      call();
    } catch (const IllegalBody& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  using ::testing::StartsWith;
  EXPECT_THAT(messageOf([&] {
                body.setPosition({bad, S(0)});
              }),
              StartsWith("Body::setPosition: position is ("));
  EXPECT_THAT(messageOf([&] {
                body.setVelocity({S(2000), S(0)});
              }),
              "Body::setVelocity: velocity is (2000, 0) m/s, allowed are -1024 to 1024 m/s");
  EXPECT_THAT(messageOf([&] { body.setForce({bad, S(0)}); }), StartsWith("Body::setForce: force is ("));
  EXPECT_THAT(messageOf([&] { body.setAngle(bad); }), StartsWith("Body::setAngle: angle is "));
  EXPECT_THAT(messageOf([&] { body.setAngularVelocity(S(-257)); }),
              "Body::setAngularVelocity: angular velocity is -257 rad/s, allowed are -256 to 256 rad/s");
  EXPECT_THAT(messageOf([&] { body.setTorque(bad); }), StartsWith("Body::setTorque: torque is "));
}

TYPED_TEST(BodyTest, StaticBodyDoesNotMove) {
  using S = TypeParam;
  Body<S> body = Body<S>::fixedInPlace();
  this->template expectRefused<IllegalBody>(body, [](auto& b) { b.setVelocity({S(1), S(0)}); });
  this->template expectRefused<IllegalBody>(body, [](auto& b) { b.setAngularVelocity(S(1)); });

  body.updateVelocity({S(0), S(-10)}, S(1));
  body.updatePosition(S(1));
  body.applyImpulse({S(1), S(1)}, {S(2), S(0)});

  EXPECT_EQ(body.velocity(), Vector<S>());
  EXPECT_EQ(body.position(), Vector<S>());
}

TYPED_TEST(BodyTest, MovingTheCenterOfMassLeavesTheOriginInPlace) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setPosition({S(3), S(4)});

  body.setCenterOfMass({S(1), S(2)});

  EXPECT_EQ(body.position(), Vector<S>(S(3), S(4)));
  EXPECT_EQ(body.worldCenter(), Vector<S>(S(4), S(6)));
}

TYPED_TEST(BodyTest, TurningLeavesTheOriginInPlace) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setPosition({S(3), S(4)});
  body.setCenterOfMass({S(1), S(0)});

  body.setAngle(kPi<S> * ratio<S>(1, 2));

  // The sine and cosine of a right angle are off by a few units at most.
  const double slack = 1e-8;
  EXPECT_NEAR(double(body.position().x), 3, slack);
  EXPECT_NEAR(double(body.position().y), 4, slack);
  EXPECT_NEAR(double(body.worldCenter().x), 3, slack);
  EXPECT_NEAR(double(body.worldCenter().y), 5, slack);
  EXPECT_NEAR(double(body.toWorld({S(1), S(0)}).y), 5, slack);
  EXPECT_NEAR(double(body.toLocal({S(3), S(5)}).x), 1, slack);
}

TYPED_TEST(BodyTest, UpdatePositionMovesByVelocityAndBiasAndForgetsTheBias) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setVelocity({S(2), S(-4)});
  body.setAngularVelocity(S(1));

  body.updatePosition(this->half());

  EXPECT_EQ(body.position(), Vector<S>(S(1), S(-2)));
  EXPECT_EQ(body.angle(), this->half());
  EXPECT_EQ(body.rotation(), forAngle(this->half()));
  EXPECT_EQ(body.velocityBias(), Vector<S>());
}

TYPED_TEST(BodyTest, UpdatePositionRefusesToLeaveTheWorld) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setPosition({kMaxWorldExtent<S>, S(0)});
  body.setVelocity({S(1), S(0)});
  this->template expectRefused<IllegalBody>(body, [](auto& b) { b.updatePosition(S(1)); });

  body.setVelocity({S(-1), S(0)});
  body.updatePosition(S(1));
  EXPECT_EQ(body.position().x, kMaxWorldExtent<S> - S(1));
}

TYPED_TEST(BodyTest, UpdateVelocityAddsGravityForceAndTorqueAndClearsThem) {
  using S = TypeParam;
  Body<S> body(S(2), S(4));
  body.setVelocity({S(1), S(0)});
  body.setForce({S(4), S(8)});
  body.setTorque(S(8));

  body.updateVelocity({S(0), S(-10)}, this->half());

  EXPECT_EQ(body.velocity(), Vector<S>(S(2), S(-3)));
  EXPECT_EQ(body.angularVelocity(), S(1));
  EXPECT_EQ(body.force(), Vector<S>());
  EXPECT_EQ(body.torque(), S(0));
}

TYPED_TEST(BodyTest, UpdateVelocityDampsWhatTheBodyHadNotWhatItGains) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setVelocity({S(8), S(0)});
  body.setAngularVelocity(S(4));

  body.updateVelocity({S(0), S(-2)}, this->half(), S(1));

  EXPECT_EQ(body.velocity(), Vector<S>(S(4), S(-2)));
  EXPECT_EQ(body.angularVelocity(), S(2));
}

TYPED_TEST(BodyTest, UpdateVelocityRefusesWhatCannotBeStepped) {
  using S = TypeParam;
  Body<S> massless;
  this->template expectRefused<IllegalBody>(massless, [](auto& b) { b.updateVelocity({}, S(1)); });
  Body<S> momentless(S(1), S(0));
  this->template expectRefused<IllegalBody>(momentless, [](auto& b) { b.updateVelocity({}, S(1)); });
  Body<S> fast(S(1), S(1));
  fast.setVelocity({kMaxSpeed<S>, S(0)});
  this->template expectRefused<IllegalBody>(fast, [](auto& b) { b.updateVelocity({S(1), S(0)}, S(1)); });
  Body<S> spinning(S(1), S(1));
  spinning.setAngularVelocity(kMaxAngularSpeed<S>);
  spinning.setTorque(S(1));
  this->template expectRefused<IllegalBody>(spinning, [](auto& b) { b.updateVelocity({}, S(1)); });
}

TYPED_TEST(BodyTest, TheLargestForceOnTheSmallestMassIsRefusedNotWrapped) {
  using S = TypeParam;
  Body<S> body(kMinMass<S>, kMinMoment<S>);
  body.setForce({kMaxForce<S>, -kMaxForce<S>});
  body.setTorque(kMaxForce<S>);

  this->template expectRefused<IllegalBody>(body, [](auto& b) { b.updateVelocity({}, S(1)); });
}

TYPED_TEST(BodyTest, ImpulsesChangeTheVelocitiesAtOnce) {
  using S = TypeParam;
  Body<S> body(S(2), S(4));
  body.setPosition({S(1), S(1)});

  body.applyImpulse({S(4), S(2)}, {S(3), S(2)});

  EXPECT_EQ(body.velocity(), Vector<S>(S(2), S(1)));
  // r x j = 2 * 2 - 1 * 4 = 0 about the centre (1, 1).
  EXPECT_EQ(body.angularVelocity(), S(0));
  body.applyImpulse({S(0), S(2)}, {S(3), S(1)});
  EXPECT_EQ(body.angularVelocity(), S(1));
}

TYPED_TEST(BodyTest, HugeImpulsesAreHeldAtTheSpeedLimits) {
  using S = TypeParam;
  Body<S> body(kMinMass<S>, kMinMoment<S>);

  body.applyImpulse({kMaxForce<S>, -kMaxForce<S>}, {S(0), kMaxWorldExtent<S>});

  EXPECT_EQ(body.velocity(), Vector<S>(kMaxSpeed<S>, -kMaxSpeed<S>));
  EXPECT_EQ(body.angularVelocity(), -kMaxAngularSpeed<S>);
}

TYPED_TEST(BodyTest, ForcesAtAPointAddUpWithTheirTorque) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));

  body.applyForce({S(0), S(3)}, {S(2), S(0)});
  body.applyForce({S(1), S(0)}, {S(0), S(2)});

  EXPECT_EQ(body.force(), Vector<S>(S(1), S(3)));
  EXPECT_EQ(body.torque(), S(4));
}

TYPED_TEST(BodyTest, ForcesBeyondTheRangeAreRefused) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setForce({kMaxForce<S>, S(0)});
  this->template expectRefused<IllegalBody>(body, [](auto& b) { b.applyForce({S(1), S(0)}, {}); });
  this->template expectRefused<IllegalBody>(body, [](auto& b) {
    b.applyForce({S(0), kMaxForce<S>}, {kMaxWorldExtent<S>, S(0)});
  });
}

TYPED_TEST(BodyTest, VelocityAtAPointIncludesTheSpin) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  body.setPosition({S(1), S(0)});
  body.setVelocity({S(5), S(6)});
  body.setAngularVelocity(S(2));

  EXPECT_EQ(body.velocityAt({S(2), S(3)}), Vector<S>(S(-1), S(8)));
}

// Chipmunk's function gives twice that.
TYPED_TEST(BodyTest, KineticEnergyIsHalfOfMassAndMomentTimesSquares) {
  using S = TypeParam;
  Body<S> body(S(3), S(5));
  body.setVelocity({S(1), S(2)});
  body.setAngularVelocity(S(2));

  EXPECT_EQ(body.kineticEnergy(), ratio<S>(35, 2));
  EXPECT_EQ(Body<S>::kinematic().kineticEnergy(), S(0));
}

TYPED_TEST(BodyTest, KineticEnergySaturates) {
  using S = TypeParam;
  Body<S> body(kMaxMass<S>, kMaxMoment<S>);
  body.setVelocity({kMaxSpeed<S>, kMaxSpeed<S>});

  EXPECT_GE(body.kineticEnergy(), S(2000000000));
}

TYPED_TEST(BodyTest, MassPropertiesOutOfRangeAreRefused) {
  using S = TypeParam;
  Body<S> body(S(1), S(1));
  MassProperties<S> heavy{S(1000001), toScaled(S(1)), {}};
  this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setMassProperties(heavy); });
  MassProperties<S> light{ratio<S>(1, 2000), toScaled(S(1)), {}};
  this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setMassProperties(light); });
  MassProperties<S> far{S(1), toScaled(S(1)), {kMaxCenterOfMass<S> + S(1), S(0)}};
  this->template expectRefused<IllegalBody>(body, [&](auto& b) { b.setMassProperties(far); });
}

TYPED_TEST(BodyTest, DetachedCopyIsTheSameBodyWithoutAnId) {
  using S = TypeParam;
  Body<S> body(S(3), S(5));
  body.setVelocity({S(1), S(2)});
  body.setUserData(77);
  body.setPositionFunc(3);
  body.setVelocityFunc(4);

  const Body<S> copy = body.detached();

  EXPECT_FALSE(copy.id().valid());
  EXPECT_EQ(hashOf(copy), hashOf(body));
  EXPECT_EQ(copy.userData(), 77u);
  EXPECT_EQ(copy.positionFunc(), 3u);
  EXPECT_EQ(copy.velocityFunc(), 4u);
}

}  // namespace
}  // namespace samestep
