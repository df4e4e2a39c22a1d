// SPDX-License-Identifier: MIT
#include <samestep/replay_diff.h>
#include <samestep/state_diff.h>

#include <gtest/gtest.h>

#include "support/fields.h"
#include "support/joints.h"
#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class StateDiffTest : public ::testing::Test {};
TYPED_TEST_SUITE(StateDiffTest, AllScalars);

TYPED_TEST(StateDiffTest, EqualWorldsHaveNoDifferences) {
  Space<TypeParam> a;
  Space<TypeParam> b;
  for (Space<TypeParam>* space : {&a, &b}) {
    fillAtRandom(*space, 4);
    hashesOf(*space, 30);
  }

  EXPECT_TRUE(differences(a.state(), b.state()).empty());
}

TYPED_TEST(StateDiffTest, NamesObjectFieldAndBothValues) {
  Space<TypeParam> a;
  Space<TypeParam> b;
  fillSmall(a);
  const BodyId player = fillSmall(b);
  b.body(player).setVelocity({TypeParam(0), ratio<TypeParam>(5, 2)});

  const std::vector<FieldDifference> found = differences(a.state(), b.state());

  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].object, "body " + std::to_string(player.index));
  EXPECT_EQ(found[0].field, "velocity.y");
  EXPECT_EQ(found[0].a, "0 (0x0000000000000000)");
  EXPECT_EQ(found[0].b.substr(0, 7), "2.5 (0x");
}

TYPED_TEST(StateDiffTest, TellsWhatOnlyOneWorldHas) {
  Space<TypeParam> a;
  Space<TypeParam> b;
  fillSmall(a);
  fillSmall(b);
  const BodyId extra = applyCommand<TypeParam>(a, discToSpawn<TypeParam>());

  const std::vector<FieldDifference> found = differences(a.state(), b.state());

  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].object, "body " + std::to_string(extra.index));
  EXPECT_EQ(found[0].field, "exists");
  EXPECT_EQ(found[0].a, "yes");
  EXPECT_EQ(found[0].b, "no");
}

TYPED_TEST(StateDiffTest, TellsOfEachSection) {
  using S = TypeParam;
  Space<S> space;
  registerNamedHandlers(space);
  fillAtRandom(space, 4);
  space.addWildcardHandler(1, 4);
  joinNeighbours(space);
  hashesOf(space, 60);
  int place = 0;
  for (;; ++place) {
    WorldState<S> changed = space.state();
    const std::string name = changeSection(changed, place);
    if (name.empty()) break;
    EXPECT_FALSE(differences(space.state(), changed).empty()) << name;
  }
  EXPECT_EQ(place, 10);
}

// They tell which ids come next.
TYPED_TEST(StateDiffTest, NamesFreeSlotsThatDiffer) {
  using S = TypeParam;
  Space<S> a;
  Space<S> b;
  for (Space<S>* space : {&a, &b}) {
    for (std::uint32_t i = 1; i < 4; ++i) space->remove(space->add(Body<S>(), BodyId{i, 1}));
  }
  EXPECT_TRUE(differences(a.state(), b.state()).empty());
  b.remove(b.add(Body<S>(), BodyId{2, 3}));

  std::vector<FieldDifference> found = differences(a.state(), b.state());

  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].object, "body 2");
  EXPECT_EQ(found[0].field, "generation");
  EXPECT_EQ(found[0].a, "2");
  EXPECT_EQ(found[0].b, "4");
  b.remove(b.add(Body<S>(), BodyId{4, 1}));
  found = differences(a.state(), b.state());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].object, "body 4");
  EXPECT_EQ(found[1].a, "none");
}

TYPED_TEST(StateDiffTest, StopsAfterAsManyAsAskedFor) {
  Space<TypeParam> a;
  Space<TypeParam> b;
  fillAtRandom(a, 4);
  fillAtRandom(b, 5);

  EXPECT_EQ(differences(a.state(), b.state(), 3).size(), 3u);
}

/// A match in which a command is given at tick 10 or not.
template <Scalar S>
Bytes matchWith(bool pushed, bool late = false) {
  Space<S> space;
  const BodyId player = fillSmall(space);
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes);
  for (int tick = 1; tick <= 30; ++tick) {
    if (tick == 5) recorder.apply(ApplyForce<S>{player, {S(1), S(0)}, {}});
    if (tick == 10 && pushed) recorder.apply(ApplyImpulse<S>{player, {S(1), S(0)}, {}});
    if (tick == 20 && late) recorder.apply(SetVelocity<S>{player, {S(3), S(3)}});
    recorder.step();
  }
  recorder.finish();
  return bytes;
}

TYPED_TEST(StateDiffTest, FindsTheCommandThatMadeTwoMatchesPart) {
  const ReplayDifference found = findDifference<TypeParam>(
      matchWith<TypeParam>(false), matchWith<TypeParam>(true), namedHandlerWiring<TypeParam>(), 1);

  EXPECT_TRUE(found.worldsDiffer);
  EXPECT_EQ(found.tick, 10u);
  EXPECT_EQ(found.stage, "commands");
  ASSERT_EQ(found.fields.size(), 1u);
  EXPECT_EQ(found.fields[0].field, "velocity.x");
  EXPECT_EQ(found.commandTick, 10u);
  EXPECT_TRUE(found.onlyA.empty());
  ASSERT_EQ(found.onlyB.size(), 1u);
  EXPECT_EQ(found.onlyB[0].substr(0, 8), "impulse:");
}

/// A match with a game's own input, which changes nothing in the world but its user data.
template <Scalar S>
Bytes matchWithInput(const std::vector<std::uint8_t>& input) {
  Space<S> space;
  fillSmall(space);
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes, testWiring<S>());
  for (int tick = 1; tick <= 10; ++tick) {
    if (tick == 4) recorder.apply(UserInput{input});
    recorder.step();
  }
  recorder.finish();
  return bytes;
}

TYPED_TEST(StateDiffTest, InputsThatDifferInTheirBytesAreTold) {
  using S = TypeParam;
  std::vector<std::uint8_t> longer(300, 1);
  std::vector<std::uint8_t> other = longer;
  other[299] = 2;
  for (const auto& [inputA, inputB] :
       {std::pair(std::vector<std::uint8_t>{1, 2}, std::vector<std::uint8_t>{1, 10}),
        std::pair(longer, other)}) {
    const ReplayDifference found =
        findDifference<S>(matchWithInput<S>(inputA), matchWithInput<S>(inputB), testWiring<S>(), 1);

    EXPECT_FALSE(found.worldsDiffer);
    EXPECT_EQ(found.commandTick, 4u);
    ASSERT_EQ(found.onlyA.size(), 1u);
    ASSERT_EQ(found.onlyB.size(), 1u);
    EXPECT_NE(found.onlyA[0], found.onlyB[0]);
  }
}

TYPED_TEST(StateDiffTest, AnInputIsShownByItsBytes) {
  EXPECT_EQ(describe<TypeParam>(UserInput{{1, 10, 255}}), "input: 3 bytes: 01 0a ff");
}

TYPED_TEST(StateDiffTest, TheSameMatchTwiceHasNoDifference) {
  const Bytes bytes = matchWith<TypeParam>(true, true);

  const ReplayDifference found = findDifference<TypeParam>(bytes, bytes, namedHandlerWiring<TypeParam>(), 1);

  EXPECT_FALSE(found.worldsDiffer);
  EXPECT_EQ(found.tick, 30u);
  EXPECT_EQ(found.commandTick, 0u);
}

// A handler that goes by something outside of the world is the desync every game fears. Here the Spaces wired
// second and fourth stray from tick 11 on.
TYPED_TEST(StateDiffTest, FindsTheStageAndFieldInWhichAHandlerStrays) {
  using S = TypeParam;
  static int wired;
  static int strays = 1;
  Wiring<S> wiring;
  wiring.connect = [](Space<S>& space, void*) {
    CollisionHandler<S> handler;
    handler.preSolve = [](Arbiter<S>& arbiter, Space<S>& world, void* straying) {
      if (straying != nullptr && world.stamp() > 10) {
        ContactPointSet<S> set = arbiter.contactPointSet();
        set.points[0].pointB.y += ratio<S>(1, 1024);
        arbiter.setContactPointSet(set);
      }
      return true;
    };
    handler.data = wired++ % 2 == 1 ? &strays : nullptr;
    space.registerHandler(1000, handler);
  };
  Space<S> space;
  wired = 0;
  wiring.connect(space, nullptr);
  space.setGravity({S(0), S(-10)});
  addWall(space, {S(-20), S(0)}, {S(20), S(0)});
  addBox(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1));
  space.addDefaultCollisionHandler(1000);
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes, wiring);
  for (int i = 0; i < 30; ++i) recorder.step();
  recorder.finish();
  wired = 0;

  const ReplayDifference found = findDifference<S>(bytes, bytes, wiring, 1);

  EXPECT_TRUE(found.worldsDiffer);
  EXPECT_EQ(found.tick, 11u);
  EXPECT_EQ(found.stage, stageName(Stage::collide));
  ASSERT_EQ(found.fields.size(), 1u);
  EXPECT_EQ(found.fields[0].object, "pair of shapes 0 and 1");
  EXPECT_EQ(found.fields[0].field.substr(0, 18), "contact[0].anchorB");
  EXPECT_EQ(found.commandTick, 0u);
}

}  // namespace
}  // namespace samestep
