// SPDX-License-Identifier: MIT
// Overlaps that no weight holds go away and leave no velocity behind.
#include <samestep/space.h>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/methods.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <class S>
class PushApartTest : public ::testing::Test {
 public:
  static void use(const Method& method, Space<S>& space) {
    space.setSolver(method.solver);
    space.setPrecision(method.precision);
  }
  static void stepFor(Space<S>& space, int steps) {
    for (int i = 0; i < steps; ++i) space.step(kTick<S>);
  }
  static void expectAtRest(const Space<S>& space, const std::vector<ShapeId>& shapes,
                           const std::string& what) {
    for (const ShapeId shape : shapes) {
      const Body<S>& body = space.body(bodyOf(space, shape));
      EXPECT_EQ(body.velocity(), Vector<S>()) << what;
      EXPECT_EQ(body.angularVelocity(), S(0)) << what;
    }
  }
};
TYPED_TEST_SUITE(PushApartTest, AllScalarsAndChecked);

TYPED_TEST(PushApartTest, TwoBoxesThatOverlapAreAtRestOnceApart) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    for (const S otherMass : {S(1), S(1000), ratio<S>(1, 1000)}) {
      for (const S shift : {S(0), ratio<S>(1, 16)}) {
        Space<S> space;
        this->use(method, space);
        const ShapeId a = addBox<S>(space, {}, S(1), S(1), S(1));
        const ShapeId b = addBox<S>(space, {ratio<S>(1, 2), shift}, S(1), S(1), otherMass);
        this->stepFor(space, 400);
        this->expectAtRest(space, {a, b}, method.name);
        const Vector<S> between =
            space.body(bodyOf(space, b)).position() - space.body(bodyOf(space, a)).position();
        EXPECT_GT(between.x, S(1) - ratio<S>(1, 100)) << method.name;
        EXPECT_LT(between.x, S(1) + ratio<S>(1, 50)) << method.name;
      }
    }
  }
}

// The masses are 1 and 1000 in turn, nine on one place half, in a row.
TYPED_TEST(PushApartTest, ARowOfBodiesThatOverlapIsAtRestOnceApart) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    for (const bool discs : {false, true}) {
      for (const S otherMass : {S(1), S(1000)}) {
        Space<S> space;
        this->use(method, space);
        std::vector<ShapeId> row;
        for (int i = 0; i < 9; ++i) {
          const Vector<S> at(ratio<S>(i * 3, 4), ratio<S>(i % 3, 32));
          const S mass = i % 2 == 0 ? S(1) : otherMass;
          row.push_back(discs ? addDisc<S>(space, at, ratio<S>(1, 2), mass)
                              : addBox<S>(space, at, S(1), S(1), mass));
        }
        this->stepFor(space, 1000);
        this->expectAtRest(space, row, method.name);
      }
    }
  }
}

TYPED_TEST(PushApartTest, AHeapOfBodiesThatOverlapLeavesWithoutVelocity) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    Space<S> space;
    this->use(method, space);
    Random random(3);
    std::vector<ShapeId> heap;
    for (int i = 0; i < 12; ++i) {
      const Vector<S> at(random.number<S>(-1, 1), random.number<S>(-1, 1));
      heap.push_back(i % 3 == 0 ? addDisc<S>(space, at, ratio<S>(1, 2), S(1))
                                : addBox<S>(space, at, S(1), ratio<S>(3, 4), S(2)));
      space.body(bodyOf(space, heap.back())).setAngle(random.number<S>(-2, 2));
    }
    this->stepFor(space, 1000);
    this->expectAtRest(space, heap, method.name);
  }
}

// The momentum of a pair is what it was: pushing adds nothing to a velocity that bodies have.
TYPED_TEST(PushApartTest, BodiesThatMoveTogetherKeepTheirVelocityWhilePushedApart) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    Space<S> space;
    this->use(method, space);
    const Vector<S> velocity(S(2), S(-1));
    const ShapeId a = addBox<S>(space, {}, S(1), S(1), S(1), velocity);
    const ShapeId b = addBox<S>(space, {ratio<S>(1, 2), ratio<S>(1, 8)}, S(1), S(1), S(8), velocity);
    this->stepFor(space, 400);
    for (const ShapeId shape : {a, b}) {
      const Body<S>& body = space.body(bodyOf(space, shape));
      EXPECT_EQ(body.velocity(), velocity) << method.name;
      EXPECT_EQ(body.angularVelocity(), S(0)) << method.name;
    }
  }
}

TYPED_TEST(PushApartTest, ABoxDeepInTheFloorRisesToItsSurfaceAndRests) {
  using S = TypeParam;
  for (const Method& method : kMethods) {
    Space<S> space;
    this->use(method, space);
    space.setGravity({S(0), S(-10)});
    addWall<S>(space, {S(-8), S(-1)}, {S(8), S(-1)}, S(1));
    const ShapeId box = addBox<S>(space, {S(0), ratio<S>(1, 4)}, S(1), S(1), S(1));
    S highest = S(0);
    for (int i = 0; i < 400; ++i) {
      space.step(kTick<S>);
      highest = max(highest, space.body(bodyOf(space, box)).position().y);
    }
    EXPECT_NEAR(static_cast<double>(highest), 0.5, 0.01) << method.name;
    EXPECT_NEAR(static_cast<double>(space.body(bodyOf(space, box)).position().y), 0.5, 0.01) << method.name;
  }
}

}  // namespace
}  // namespace samestep
