// SPDX-License-Identifier: MIT
// What a stage of a step leaves to the next is looked at in builds that check expectations.
#include <utility>

#include <gtest/gtest.h>

#include <samestep/expects.h>
#include <samestep/space.h>
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class StageExpectationsTest : public ::testing::Test {
 protected:
  /// Steps a world whose pairs are exchanged after a stage.
  static void stepSpoilt() {
    Space<S> space;
    for (int i = 0; i < 3; ++i) addDisc<S>(space, {ratio<S>(3 * i, 2), S(0)}, S(1), S(1));
    space.step(kTick<S>);
    space.setStageObserver(
        [](const Space<S>& of, Stage stage, void*) {
          auto& pairs = const_cast<WorldState<S>&>(of.state()).pairs;
          if (kExpects && stage == Stage::findPairs) std::swap(pairs[0], pairs[1]);
        },
        nullptr);
    space.step(kTick<S>);
  }
};
TYPED_TEST_SUITE(StageExpectationsTest, AllScalars);

TYPED_TEST(StageExpectationsTest, PairsOutOfOrderEndTheProgramWhereThatIsChecked) {
  if constexpr (kExpects) {
    EXPECT_DEATH(this->stepSpoilt(), "stage_expectations.h:.*does not hold");
  } else {
    EXPECT_NO_THROW(this->stepSpoilt());
  }
}

}  // namespace
}  // namespace samestep
