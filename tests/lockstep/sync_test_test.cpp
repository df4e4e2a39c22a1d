// SPDX-License-Identifier: MIT
#include <samestep/sync_test.h>

#include <samestep/circle_shape.h>
#include <samestep/error.h>
#include <samestep/space_game.h>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lockstep/session_pair.h"
#include "support/scalars.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;

template <class S>
class SyncTestTest : public ::testing::Test {};
using Scalars = ::testing::Types<
#ifndef SAMESTEP_FIXED_ONLY
    double,
#endif
    Fixed>;
TYPED_TEST_SUITE(SyncTestTest, Scalars);

/// A falling disc, pushed by the first byte held. `leaks` is a number beside the Space that is not saved.
template <class S>
struct Falling {
  Falling() : game(space, ratio<S>(1, 60), apply, this) {
    space.setGravity({S(0), S(-10)});
    body = space.add(Body<S>(S(1), S(1)));
    space.add(circleShape<S>(body, S(1)));
  }
  static void apply(Space<S>& world, const TickInputs& inputs, void* data) {
    auto& self = *static_cast<Falling*>(data);
    auto& disc = world.body(self.body);
    disc.applyForce({S(inputs.players[0].held[0]), S(0)}, disc.position());
    if (self.broken && inputs.tick == 20) disc.applyForce({S(++self.leaks), S(0)}, disc.position());
  }

  Space<S> space;
  BodyId body{};
  SpaceGame<S> game;
  bool broken = false;
  int leaks = 0;
};

template <class S>
bool play(SyncTest& test, int frames) {
  for (int i = 0; i < frames; ++i) {
    const std::uint8_t held = static_cast<std::uint8_t>(i / 3);
    const PlayerInput player{true, {&held, 1}, {}};
    if (!test.frame({&player, 1})) return false;
  }
  return true;
}

TYPED_TEST(SyncTestTest, AGameThatSavesAllOfItsStatePasses) {
  for (Tick distance = 1; distance <= SyncTest::kMaxDistance; ++distance) {
    Falling<TypeParam> falling;
    SyncTest test(falling.game.functions(), distance);

    EXPECT_TRUE(play<TypeParam>(test, 60));
    EXPECT_EQ(test.tick(), 60u);
  }
}

TYPED_TEST(SyncTestTest, RepeatedStepsAreThoseOfAPlainRun) {
  Falling<TypeParam> tested, plain;
  SyncTest test(tested.game.functions(), 5);
  play<TypeParam>(test, 60);
  const Game game = plain.game.functions();
  for (Tick i = 0; i < 60; ++i) {
    const std::uint8_t held = static_cast<std::uint8_t>(i / 3);
    const PlayerInput player{true, {&held, 1}, {}};
    game.step({i, {&player, 1}}, game.data);
  }

  EXPECT_EQ(tested.space.hash(), plain.space.hash());
}

TYPED_TEST(SyncTestTest, NamesTickBodyAndFieldOfWhatIsNotSaved) {
  Falling<TypeParam> falling;
  falling.broken = true;
  SyncTest test(falling.game.functions());

  EXPECT_FALSE(play<TypeParam>(test, 60));

  EXPECT_FALSE(test.good());
  EXPECT_EQ(test.report().tick, 20u);
  EXPECT_NE(test.report().first, test.report().again);
  EXPECT_THAT(test.report().text, HasSubstr("body 1, "));
  EXPECT_THAT(test.report().text, HasSubstr(".x: "));
  // It stays so.
  EXPECT_FALSE(play<TypeParam>(test, 1));
}

TEST(SyncTestSettingsTest, RefusesAnotherDistanceAndAGameWithoutItsFunctions) {
  AddingGame game;
  EXPECT_THROW(SyncTest(game.functions(), 0), ValueOutOfRange);
  EXPECT_THROW(SyncTest(game.functions(), 9), ValueOutOfRange);
  EXPECT_THROW(SyncTest{Game{}}, ValueOutOfRange);
}

}  // namespace
}  // namespace samestep
