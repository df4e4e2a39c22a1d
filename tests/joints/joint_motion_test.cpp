// SPDX-License-Identifier: MIT
// What joints do, against what is known: exact motions, statics, the same motion in far smaller steps.
#include <samestep/space.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr SolverKind kSolvers[] = {SolverKind::softStep, SolverKind::sequentialImpulses};

template <Scalar S>
BodyId addBody(Space<S>& space, const Vector<S>& position, S mass, S moment) {
  Body<S> body(mass, moment);
  body.setPosition(position);
  return space.add(body);
}

/// Distance of the anchors of the worst joint, m.
template <Scalar S>
double worstGap(const Space<S>& space) {
  double worst = 0;
  space.eachJoint([&](JointId, const Joint<S>& joint) {
    const Vector<S> gap =
        space.body(joint.bodyB).toWorld(joint.anchorB) - space.body(joint.bodyA).toWorld(joint.anchorA);
    worst = std::max(worst, std::hypot(double(gap.x), double(gap.y)));
  });
  return worst;
}

template <Scalar S>
class JointMotionTest : public ::testing::Test {};
TYPED_TEST_SUITE(JointMotionTest, AllScalars);

// The period from 90 degrees on a rod of 1 m at 10 m/s^2 is 4 K(sin 45 degrees) / sqrt(10) s.
TYPED_TEST(JointMotionTest, APendulumKeepsTheTimeOfItsSwingAndItsEnergy) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setGravity({S(0), S(-10)});
    Body<S> point = Body<S>::nonRotating(S(2));
    point.setPosition({S(1), S(0)});
    const BodyId bob = space.add(point);
    space.add(distanceJoint<S>(space.staticBody(), bob, {}, {}, S(1)));
    const double period = 4 * 1.8540746773013719 / std::sqrt(10.0);
    double last = 1, crossed = 0, energy = 0;
    int crossings = 0;
    for (int i = 1; i <= 600; ++i) {
      space.step(ratio<S>(1, 60));
      const Body<S>& body = space.body(bob);
      const double x = double(body.position().x), y = double(body.position().y);
      const double vx = double(body.velocity().x), vy = double(body.velocity().y);
      energy = std::max(energy, std::abs(10 * y + (vx * vx + vy * vy) / 2));
      if (last > 0 && x <= 0) ++crossings, crossed = (i - x / (x - last)) / 60;
      last = x;
    }
    ASSERT_EQ(crossings, 5);
    const bool soft = solver == SolverKind::softStep;
    EXPECT_NEAR(crossed / (period * (crossings - 0.75)), 1, soft ? 0.0005 : 0.02);
    EXPECT_LT(energy, soft ? 0.1 : 1.5);
  }
}

// Before it is chaotic: the same motion with 64 substeps.
TYPED_TEST(JointMotionTest, ADoublePendulumFollowsItsConvergedMotion) {
  using S = TypeParam;
  const auto run = [](int substeps) {
    Space<S> space;
    space.setSubsteps(substeps);
    space.setGravity({S(0), S(-10)});
    const Vector<S> half(ratio<S>(1, 2), S(0));
    const BodyId upper = addBody<S>(space, half, S(1), ratio<S>(1, 12));
    const BodyId lower = addBody<S>(space, half * S(3), S(1), ratio<S>(1, 12));
    space.add(revoluteJoint<S>(space.staticBody(), upper, {}, -half));
    space.add(revoluteJoint<S>(upper, lower, half, -half));
    std::vector<double> places;
    for (int i = 0; i < 60; ++i) {
      space.step(ratio<S>(1, 60));
      places.push_back(double(space.body(lower).position().x));
      places.push_back(double(space.body(lower).position().y));
    }
    return places;
  };
  const std::vector<double> exact = run(64), coarse = run(4), fine = run(8);
  double coarseError = 0, fineError = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    coarseError = std::max(coarseError, std::abs(coarse[i] - exact[i]));
    fineError = std::max(fineError, std::abs(fine[i] - exact[i]));
  }
  EXPECT_LT(coarseError, 0.03);
  EXPECT_LT(fineError, coarseError);
}

/// A chain of links of half a metre, hung up at one end, with a load at the other.
template <Scalar S>
double greatestStretch(int links, S load, int substeps, int steps) {
  Space<S> space;
  space.setSubsteps(substeps);
  space.setGravity({S(0), S(-10)});
  const Vector<S> half(ratio<S>(1, 4), S(0));
  BodyId last = space.staticBody();
  Vector<S> anchor;
  for (int i = 0; i < links; ++i) {
    const BodyId link = addBody<S>(space, half * S(2 * i + 1), S(1), ratio<S>(1, 48));
    space.add(revoluteJoint<S>(last, link, anchor, -half));
    last = link;
    anchor = half;
  }
  const BodyId weight = addBody<S>(space, half * S(2 * links + 2), load, load * ratio<S>(1, 8));
  space.add(revoluteJoint<S>(last, weight, anchor, -half * S(2)));
  double most = 0;
  for (int i = 0; i < steps; ++i) {
    space.step(ratio<S>(1, 60));
    const Vector<S> end = space.body(weight).toWorld(-half * S(2));
    most = std::max(most, std::hypot(double(end.x), double(end.y)) / (0.5 * links) - 1);
    most = std::max(most, worstGap(space));
  }
  return most;
}

// A taut link swings aside at 2 sqrt(T / (m L)): 490 rad/s under a thousand links, which takes 8 substeps.
TYPED_TEST(JointMotionTest, ARopeWithAHeavyLoadStretchesByLessThanOnePercent) {
  EXPECT_LT(greatestStretch<TypeParam>(10, TypeParam(100), 4, 240), 0.01);
  EXPECT_LT(greatestStretch<TypeParam>(10, TypeParam(1000), 8, 240), 0.01);
}

// The chain is twice as long as its nails are apart: sinh(1 / 2c) 2c = 2 gives the sag in parts of that.
TYPED_TEST(JointMotionTest, AChainHangsAsACatenary) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(0), S(-10)});
  space.setDamping(ratio<S>(1, 8));
  constexpr int kLinks = 40;
  const Vector<S> half(ratio<S>(1, 8), S(0));
  BodyId last = space.staticBody();
  Vector<S> anchor;
  std::vector<BodyId> links;
  for (int i = 0; i < kLinks; ++i) {
    // Zigzag, so that it is as long as it is to be between nails 5 m apart.
    const bool up = i % 2 == 0;
    Body<S> body(S(1), ratio<S>(1, 192));
    const S angle = up ? kPi<S> * ratio<S>(1, 3) : -kPi<S> * ratio<S>(1, 3);
    body.setPosition({ratio<S>(2 * i + 1, 16), half.x * sincos(kPi<S> * ratio<S>(1, 3)).sin});
    body.setAngle(angle);
    const BodyId link = space.add(body);
    space.add(revoluteJoint<S>(last, link, anchor, -half));
    last = link;
    anchor = half;
    links.push_back(link);
  }
  space.add(revoluteJoint<S>(space.staticBody(), last, {S(5), S(0)}, half));
  for (int i = 0; i < 1200; ++i) space.step(ratio<S>(1, 60));
  double c = 0.2;
  for (int i = 0; i < 100; ++i) c = 0.5 / std::asinh(1.0 / c);
  const double sag = 5 * c * (std::cosh(0.5 / c) - 1);
  double lowest = 0;
  for (const BodyId link : links) {
    lowest = std::min(lowest, double(space.body(link).toWorld(half).y));
  }
  EXPECT_NEAR(-lowest / sag, 1, 0.01);
  EXPECT_LT(worstGap(space), 0.001);
}

// A motor that is too weak to lift its arm lets it sink and rest on the limit, with all its torque against
// it.
TYPED_TEST(JointMotionTest, AMotorStallsAtItsGreatestTorque) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setGravity({S(0), S(-10)});
    const BodyId arm = addBody<S>(space, {S(1), S(0)}, S(3), S(1));
    Joint<S> joint = revoluteJoint<S>(space.staticBody(), arm, {}, {S(-1), S(0)});
    joint.motor = joint.limited = 1;
    joint.motorSpeed = S(2);
    joint.lower = S(0);
    joint.upper = S(1);
    joint.motorMax = S(20);
    const JointId id = space.add(joint);
    for (int i = 0; i < 120; ++i) space.step(ratio<S>(1, 60));
    EXPECT_NEAR(double(space.body(arm).angle()), 0, 0.002);
    EXPECT_NEAR(double(space.joint(id).torque), 30, 0.1);
    space.change(id, [](Joint<S>& changed) { changed.motorMax = S(40); });
    for (int i = 0; i < 120; ++i) space.step(ratio<S>(1, 60));
    EXPECT_NEAR(double(space.body(arm).angle()), 1, 0.002);
  }
}

TYPED_TEST(JointMotionTest, GearsTurnByTheirRatio) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    const BodyId drive = addBody<S>(space, {S(0), S(0)}, S(1), S(1));
    const BodyId driven = addBody<S>(space, {S(3), S(0)}, S(8), S(16));
    space.add(revoluteJoint<S>(space.staticBody(), drive, {}, {}));
    space.add(revoluteJoint<S>(space.staticBody(), driven, {S(3), S(0)}, {}));
    space.add(gearJoint<S>(drive, driven, S(0), S(-4)));
    space.add(motorJoint<S>(space.staticBody(), drive, S(8), S(50)));
    for (int i = 0; i < 600; ++i) space.step(ratio<S>(1, 60));
    EXPECT_NEAR(double(space.body(drive).angularVelocity()), 8, 0.001);
    EXPECT_NEAR(double(space.body(driven).angularVelocity()), -2, 0.001);
    EXPECT_NEAR(-4 * double(space.body(driven).angle()) - double(space.body(drive).angle()), 0, 0.001);
    EXPECT_GT(double(space.body(drive).angle()), 60);
  }
}

TYPED_TEST(JointMotionTest, ARatchetHoldsFromToothToTooth) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    const BodyId wheel = addBody<S>(space, {}, S(1), S(1));
    space.add(revoluteJoint<S>(space.staticBody(), wheel, {}, {}));
    const JointId id = space.add(ratchetJoint<S>(space.staticBody(), wheel, S(0), ratio<S>(1, 4)));
    space.body(wheel).setAngularVelocity(S(1));
    for (int i = 0; i < 64; ++i) space.step(kTick<S>);
    EXPECT_NEAR(double(space.body(wheel).angle()), 1, 0.05);
    space.body(wheel).setAngularVelocity(S(-3));
    for (int i = 0; i < 64; ++i) space.step(kTick<S>);
    EXPECT_GE(double(space.body(wheel).angle()), double(space.joint(id).latch) - 0.01);
    EXPECT_GE(double(space.joint(id).latch), 0.75);
  }
}

// A spring of 2 hertz and a quarter of the critical damping swings with 2 sqrt(1 - 1/16) hertz.
TYPED_TEST(JointMotionTest, ASpringSwingsAtItsFrequency) {
  using S = TypeParam;
  Space<S> space;
  space.setSubsteps(8);
  const BodyId bob = addBody<S>(space, {ratio<S>(3, 2), S(0)}, S(5), S(1));
  Joint<S> joint = springJoint<S>(space.staticBody(), bob, {}, {}, S(1), S(2), ratio<S>(1, 8));
  space.add(joint);
  double last = 0.5, crossed = 0;
  int crossings = 0;
  for (int i = 1; i <= 120; ++i) {
    space.step(ratio<S>(1, 60));
    const double x = double(space.body(bob).position().x) - 1;
    if (last < 0 && x >= 0 && ++crossings == 2) crossed = (i - x / (x - last)) / 60;
    last = x;
  }
  const double period = 1 / (2 * std::sqrt(1 - 1.0 / 64));
  ASSERT_GE(crossings, 2);
  EXPECT_NEAR(crossed / (1.75 * period), 1, 0.03);
}

TYPED_TEST(JointMotionTest, ATargetPullsWithNoMoreThanItsForceInAnyDirection) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    const BodyId puck = addBody<S>(space, {}, S(2), S(1));
    space.add(frictionJoint<S>(space.staticBody(), puck, S(6), S(3)));
    space.body(puck).setVelocity({S(3), S(4)});
    space.body(puck).setAngularVelocity(S(6));
    for (int i = 0; i < 64; ++i) space.step(kTick<S>);
    // 3 m/s^2 against 5 m/s along (3, 4); 3 rad/s^2.
    EXPECT_NEAR(double(space.body(puck).velocity().x), 1.2, 0.02);
    EXPECT_NEAR(double(space.body(puck).velocity().y), 1.6, 0.02);
    EXPECT_NEAR(double(space.body(puck).angularVelocity()), 3, 0.02);
    for (int i = 0; i < 128; ++i) space.step(kTick<S>);
    EXPECT_EQ(space.body(puck).velocity(), Vector<S>());
  }
}

TYPED_TEST(JointMotionTest, AMouseDrawsABodyToItsPlace) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(0), S(-10)});
  const BodyId box = addBody<S>(space, {}, S(2), S(1));
  const JointId id = space.add(
      targetJoint<S>(space.staticBody(), box, {S(1), S(2)}, {ratio<S>(1, 2), S(0)}, S(5), S(1), S(400)));
  for (int i = 0; i < 240; ++i) space.step(ratio<S>(1, 60));
  const Vector<S> held = space.body(box).toWorld({ratio<S>(1, 2), S(0)});
  EXPECT_NEAR(double(held.x), 1, 0.02);
  EXPECT_NEAR(double(held.y), 2, 0.05);
  space.change(id, [](Joint<S>& joint) { joint.anchorA = {S(-1), S(1)}; });
  for (int i = 0; i < 240; ++i) space.step(ratio<S>(1, 60));
  EXPECT_NEAR(double(space.body(box).toWorld({ratio<S>(1, 2), S(0)}).x), -1, 0.05);
}

// Against a free flight: what holds nothing changes nothing, and what joints give A they take from B.
TYPED_TEST(JointMotionTest, JointsKeepMomentum) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    Random random(3);
    std::vector<BodyId> bodies;
    for (int i = 0; i < 8; ++i) {
      const BodyId id = addBody<S>(space, {S(i), random.number<S>(-1, 1)}, S(random.between(1, 8)), S(2));
      space.body(id).setVelocity({random.number<S>(-2, 2), random.number<S>(-2, 2)});
      bodies.push_back(id);
      if (i > 0) {
        space.add(distanceJoint<S>(bodies[static_cast<std::size_t>(i - 1)], id, {S(0), ratio<S>(1, 2)},
                                   {ratio<S>(1, 4), S(0)}, S(1)));
      }
    }
    const auto momentum = [&] {
      double x = 0, y = 0;
      for (const BodyId id : bodies) {
        x += double(space.body(id).mass()) * double(space.body(id).velocity().x);
        y += double(space.body(id).mass()) * double(space.body(id).velocity().y);
      }
      return std::pair(x, y);
    };
    const auto before = momentum();
    for (int i = 0; i < 300; ++i) space.step(kTick<S>);
    EXPECT_NEAR(momentum().first, before.first, 1e-4);
    EXPECT_NEAR(momentum().second, before.second, 1e-4);
  }
}

TYPED_TEST(JointMotionTest, AWeldedBeamCarriesALoad) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(0), S(-10)});
  const Vector<S> half(ratio<S>(1, 2), S(0));
  BodyId last = space.staticBody();
  Vector<S> anchor;
  for (int i = 0; i < 4; ++i) {
    const BodyId part = addBody<S>(space, half * S(2 * i + 1), i == 3 ? S(20) : S(1), ratio<S>(1, 8));
    space.add(weldJoint<S>(last, part, anchor, -half, S(0)));
    last = part;
    anchor = half;
  }
  for (int i = 0; i < 120; ++i) space.step(ratio<S>(1, 60));
  EXPECT_NEAR(double(space.body(last).position().y), 0, 0.05);
  EXPECT_LT(worstGap(space), 0.02);
}

}  // namespace
}  // namespace samestep
