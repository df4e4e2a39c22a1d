// SPDX-License-Identifier: MIT
// What postSolve and visits tell of a contact is what the solver did, told of the bodies where they are.
#include <samestep/space.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/methods.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

/// Report of one contact.
template <class S>
struct Told {
  Vector<S> impulse, normal;
  S depth{};
  int times = 0;
};

template <class S>
class ReportTest : public ::testing::Test {
 public:
  static void use(const Method& method, Space<S>& space) {
    space.setSolver(method.solver);
    space.setPrecision(method.precision);
    space.setGravity({S(0), S(-10)});
  }
  /// A few units of what contacts compute a speed of some metres per second in: directions and shares of
  /// Fixed have 30 bits.
  static double unitOf(const Method& method) {
    return !kIsFixed<S> ? 0x1p-36 : method.precision == ContactPrecision::fast ? 0x1p-16 : 0x1p-24;
  }
  /// Report of the only contact there is, of the first of its bodies against the second.
  static Told<S> visited(Space<S>& space, BodyId first) {
    Told<S> told;
    space.eachArbiter([&](Arbiter<S>& arbiter) {
      const S sign = S(arbiter.bodyA() == first ? 1 : -1);
      told = {arbiter.totalImpulse() * sign, arbiter.normal() * sign, arbiter.depth(0), told.times + 1};
    });
    return told;
  }
  static double of(S x) { return static_cast<double>(x); }
};
TYPED_TEST_SUITE(ReportTest, AllScalarsAndChecked);

TYPED_TEST(ReportTest, ABallThatSpinsWithoutFrictionTellsItsWeightAndLiesOnTheFloor) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    for (const bool ballFirst : {false, true}) {
      Space<S> space;
      this->use(method, space);
      BodyId floor, ball;
      const auto addFloor = [&] {
        floor = space.add(Body<S>::fixedInPlace());
        space.add(boxShape<S>(floor, BB<S>{S(-8), S(-1), S(8), S(0)}));
      };
      const auto addBall = [&] {
        Body<S> body;
        body.setPosition({S(0), ratio<S>(1, 2)});
        ball = space.add(body);
        Shape<S> shape = circleShape(ball, ratio<S>(1, 2));
        shape.setMass(S(2));
        space.add(shape);
        space.body(ball).setAngularVelocity(S(60));
      };
      ballFirst ? addBall() : addFloor();
      ballFirst ? addFloor() : addBall();
      const std::string what = std::string(method.name) + (ballFirst ? ", ball first" : ", floor first");
      for (int i = 0; i < 100; ++i) {
        space.step(kTick<S>);
        if (i < 60) continue;
        const Told<S> told = this->visited(space, floor);
        ASSERT_EQ(told.times, 1) << what;
        EXPECT_NEAR(this->of(told.impulse.x), 0, 0x1p-20) << what;
        EXPECT_NEAR(this->of(told.impulse.y), 20.0 / 64, 0x1p-16) << what;
        EXPECT_NEAR(this->of(told.normal.x), 0, 0x1p-28) << what;
        EXPECT_NEAR(this->of(told.normal.y), 1, 0x1p-28) << what;
        EXPECT_NEAR(this->of(told.depth), 0, 0.006) << what;
      }
    }
  }
}

// A rounded shape turns below its point, and its ends go where the body goes.
TYPED_TEST(ReportTest, ACapsuleThatSpinsTellsTheDepthsOfItsEnds) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    for (const bool capsuleFirst : {false, true}) {
      Space<S> space;
      this->use(method, space);
      BodyId capsule;
      const auto addCapsule = [&] {
        Body<S> body;
        body.setPosition({S(0), S(2)});
        capsule = space.add(body);
        Shape<S> shape = segmentShape(capsule, Vector<S>(S(-1), S(0)), Vector<S>(S(1), S(0)), ratio<S>(1, 4));
        shape.setMass(S(2));
        space.add(shape);
        space.body(capsule).setAngularVelocity(S(20));
      };
      if (capsuleFirst) addCapsule();
      space.add(boxShape<S>(space.add(Body<S>::fixedInPlace()), BB<S>{S(-99), S(-1), S(99), S(0)}));
      if (!capsuleFirst) addCapsule();
      int told = 0;
      for (int i = 0; i < 200; ++i) {
        space.step(kTick<S>);
        const Body<S>& body = space.body(capsule);
        space.eachArbiter([&](Arbiter<S>& arbiter) {
          for (int k = 0; k < arbiter.count(); ++k, ++told) {
            const double depth = this->of(arbiter.depth(k));
            double off = 1;
            for (const S end : {S(-1), S(1)}) {
              const double above = this->of(body.toWorld({end, S(0)}).y) - 0.25;
              off = std::min(off, std::abs(depth - above));
            }
            EXPECT_LT(off, 0.001) << method.name << " step " << i;
          }
        });
      }
      EXPECT_GT(told, 10);
    }
  }
}

/// Steps a space and expects that of each body the impulses of its contacts are what its momentum changed by,
/// but for gravity.
template <class S, class Test>
void expectMomentumTold(Test& test, Space<S>& space, const Method& method, const std::vector<BodyId>& bodies,
                        int steps) {
  double most = 0;
  for (int i = 0; i < steps; ++i) {
    std::map<std::uint32_t, std::pair<Vector<S>, Vector<S>>> velocity;  // Velocities before and as told.
    for (const BodyId id : bodies) velocity[id.index].first = space.body(id).velocity();
    const S dt = i % 7 == 3 ? kTick<S> * ratio<S>(1, 2) : kTick<S>;
    space.step(dt);
    space.eachArbiter([&](Arbiter<S>& arbiter) {
      velocity[arbiter.bodyA().index].second -= arbiter.totalImpulse();
      velocity[arbiter.bodyB().index].second += arbiter.totalImpulse();
    });
    for (const BodyId id : bodies) {
      const auto& [before, told] = velocity[id.index];
      const S mass = space.body(id).mass();
      const Vector<S> changed = space.body(id).velocity() - before - Vector<S>(S(0), S(-10)) * dt;
      const double unit = test.unitOf(method) * test.of(mass);
      ASSERT_NEAR(test.of(told.x), test.of(changed.x * mass), unit) << method.name << " step " << i;
      ASSERT_NEAR(test.of(told.y), test.of(changed.y * mass), unit) << method.name << " step " << i;
      most = std::max(most, test.of(abs(told.x) + abs(told.y)));
    }
  }
  EXPECT_GT(most, 1) << "nothing has touched";
}

TYPED_TEST(ReportTest, TheImpulsesOfABoxAreTheChangeOfItsMomentum) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    for (const S elasticity : {S(0), ratio<S>(3, 4)}) {
      Space<S> space;
      this->use(method, space);
      Shape<S> floor = segmentShape<S>(space.staticBody(), {S(-20), S(0)}, {S(20), S(0)}, S(0));
      floor.setFriction(S(1));
      floor.setElasticity(S(1));
      space.add(floor);
      Body<S> body;
      body.setPosition({S(0), S(2)});
      body.setVelocity({S(3), S(-2)});
      body.setAngle(ratio<S>(3, 10));
      const BodyId box = space.add(body);
      Shape<S> shape = boxShape<S>(box, S(1), S(2));
      shape.setMass(S(3));
      shape.setFriction(ratio<S>(1, 2));
      shape.setElasticity(elasticity);
      space.add(shape);
      space.body(box).setAngularVelocity(S(12));
      expectMomentumTold(*this, space, method, {box}, 200);
    }
  }
}

TYPED_TEST(ReportTest, TheImpulsesOfAHeapAreTheChangeOfEachMomentum) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    Space<S> space;
    this->use(method, space);
    addWall<S>(space, {S(-20), S(0)}, {S(20), S(0)}, ratio<S>(1, 4));
    Random random(5);
    std::vector<BodyId> bodies;
    for (int i = 0; i < 10; ++i) {
      const Vector<S> at(random.number<S>(-1, 1), S(1 + i));
      const S mass = S(1 << (i % 3));
      const ShapeId shape = i % 3 == 0 ? addDisc<S>(space, at, ratio<S>(1, 2), mass)
                                       : addBox<S>(space, at, S(1), ratio<S>(3, 4), mass);
      space.change(shape, [](Shape<S>& of) { of.setFriction(ratio<S>(1, 2)); });
      bodies.push_back(bodyOf(space, shape));
      space.body(bodies.back()).setAngularVelocity(random.number<S>(-20, 20));
    }
    expectMomentumTold(*this, space, method, bodies, 150);
  }
}

TYPED_TEST(ReportTest, PostSolveTellsWhatAVisitTellsAndBeginAndPreSolveTellNoImpulse) {
  using S = TypeParam;
  struct Heard {
    Vector<S> before, after, normal;
    S depth{};
    int times = 0;
  };
  for (const Method& method : kMethods) {
    Space<S> space;
    this->use(method, space);
    addWall<S>(space, {S(-8), S(0)}, {S(8), S(0)});
    const ShapeId disc = addDisc<S>(space, {S(0), ratio<S>(1, 2)}, ratio<S>(1, 2), S(1));
    space.body(bodyOf(space, disc)).setAngularVelocity(S(50));
    Heard heard;
    CollisionHandler<S> handler;
    handler.data = &heard;
    handler.preSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      static_cast<Heard*>(data)->before += arbiter.totalImpulse();
      return true;
    };
    handler.postSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      auto& to = *static_cast<Heard*>(data);
      to = {to.before, arbiter.totalImpulse(), arbiter.normal(), arbiter.depth(0), to.times + 1};
    };
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
    for (int i = 0; i < 20; ++i) space.step(kTick<S>);
    EXPECT_GT(heard.times, 10);
    EXPECT_EQ(heard.before, Vector<S>());
    space.eachArbiter([&](Arbiter<S>& arbiter) {
      EXPECT_EQ(arbiter.totalImpulse(), heard.after) << method.name;
      EXPECT_EQ(arbiter.normal(), heard.normal) << method.name;
      EXPECT_EQ(arbiter.depth(0), heard.depth) << method.name;
    });
    EXPECT_NE(heard.after, Vector<S>());
  }
}

}  // namespace
}  // namespace samestep
