// SPDX-License-Identifier: MIT
#include "solver/sequential_impulse/sequential_impulse.h"

#include <gtest/gtest.h>

#include "support/scalars.h"

namespace samestep {
namespace {

/// Two bodies of 1 kg that meet head on along the x axis and overlap by half a metre.
template <Scalar S>
class ImpulseSolverTest : public ::testing::Test {
 protected:
  ImpulseSolverTest() {
    a_.setVelocity({S(2), S(0)});
    b_.setPosition({S(2), S(0)});
    b_.setVelocity({S(-2), S(0)});
    pair_.localNormal = {S(1), S(0)};
    pair_.count = 1;
    pair_.contacts[0].anchorA = {ratio<S>(5, 4), S(0)};
    pair_.contacts[0].anchorB = {ratio<S>(-5, 4), S(0)};
    pair_.elasticity = ratio<S>(1, 2);
    solver_.bodies.resize(2);
    solver_.bodies[0].velocity = a_.velocity();
    solver_.bodies[1].velocity = b_.velocity();
  }

  void preStep() { solver_.preStep(pair_, 0, 1, a_, b_, ratio<S>(1, 4), S(4)); }

  Body<S> a_{S(1), S(1)};
  Body<S> b_{S(1), S(1)};
  Pair<S> pair_;
  ImpulseSolver<S> solver_;
};
TYPED_TEST_SUITE(ImpulseSolverTest, AllScalarsAndChecked);

TYPED_TEST(ImpulseSolverTest, PreStepTakesBiasFromTheOverlapAndBounceFromTheApproach) {
  using S = TypeParam;
  this->preStep();
  ASSERT_EQ(this->solver_.rows.size(), 1u);
  const ImpulseRow<S>& row = this->solver_.rows[0];
  EXPECT_EQ(row.bias, S(1));
  EXPECT_EQ(row.bounce, S(-2));
  EXPECT_EQ(row.speedA, ratio<S>(1, 2));
  EXPECT_EQ(row.speedB, ratio<S>(1, 2));
  EXPECT_EQ(row.normalSum, S(0));
}

TYPED_TEST(ImpulseSolverTest, WarmStartAppliesTheKeptImpulseTimesTheRatioOfTheSteps) {
  using S = TypeParam;
  this->pair_.contacts[0].normalSpeed = S(3);
  this->preStep();
  this->solver_.warmStart(this->solver_.rows[0], S(1));
  EXPECT_EQ(this->solver_.bodies[0].velocity, Vector<S>(S(-1), S(0)));
  EXPECT_EQ(this->solver_.bodies[1].velocity, Vector<S>(S(1), S(0)));
  this->solver_.warmStart(this->solver_.rows[0], ratio<S>(1, 2));
  EXPECT_EQ(this->solver_.bodies[0].velocity, Vector<S>(ratio<S>(-5, 2), S(0)));
}

TYPED_TEST(ImpulseSolverTest, APassTurnsTheApproachRoundAndPushesTheOverlapApart) {
  using S = TypeParam;
  this->preStep();
  this->solver_.iterate();
  EXPECT_EQ(this->solver_.bodies[0].velocity, Vector<S>(S(-1), S(0)));
  EXPECT_EQ(this->solver_.bodies[1].velocity, Vector<S>(S(1), S(0)));
  EXPECT_EQ(this->solver_.bodies[0].biasVelocity, Vector<S>(ratio<S>(-1, 2), S(0)));
  EXPECT_EQ(this->solver_.bodies[1].biasVelocity, Vector<S>(ratio<S>(1, 2), S(0)));
  // A second pass finds nothing left to do.
  this->solver_.iterate();
  EXPECT_EQ(this->solver_.bodies[1].velocity, Vector<S>(S(1), S(0)));
  EXPECT_EQ(this->solver_.bodies[1].biasVelocity, Vector<S>(ratio<S>(1, 2), S(0)));
}

// A contact near the centre of a body that turns very easily spins it fast, and one far from the centre makes
// a high speed of that: with the largest impulses kept, more than Fixed holds.
TYPED_TEST(ImpulseSolverTest, TheLargestKeptImpulsesStayInRange) {
  using S = TypeParam;
  const Body<S> light(S(1), ratio<S>(1, 1 << 18));
  Pair<S> near = this->pair_, far = this->pair_;
  near.contacts[0].anchorB.y = ratio<S>(1, 512);
  far.contacts[0].anchorB.y = S(200);
  for (Pair<S>* pair : {&far, &near}) {
    pair->friction = S(1 << 10);
    pair->contacts[0].normalSpeed = kMaxSum<S>;
    pair->contacts[0].tangentSpeed = -kMaxSum<S>;
    this->solver_.preStep(*pair, 0, 1, this->a_, light, ratio<S>(1, 4), S(4));
  }
  for (ImpulseBody<S>& body : this->solver_.bodies) {
    body.biasVelocity = {kMaxSpeed<S>, -kMaxSpeed<S>};
    body.biasAngularVelocity = kMaxAngularSpeed<S>;
  }
  EXPECT_NO_THROW({
    for (ImpulseRow<S>& row : this->solver_.rows) this->solver_.warmStart(row, S(1));
    for (int i = 0; i < 100; ++i) this->solver_.iterate();
  });
  if constexpr (kIsFixed<S>) {
    for (const ImpulseBody<S>& body : this->solver_.bodies) {
      EXPECT_TRUE(within(body.velocity, S(1 << 22)));
      EXPECT_TRUE(within(body.angularVelocity, S(1 << 19)));
    }
  }
}

}  // namespace
}  // namespace samestep
