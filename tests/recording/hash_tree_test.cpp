// SPDX-License-Identifier: MIT
// Matches as trees of hashes, in which two sides find where they part by few questions.
#include <samestep/hash_tree.h>

#include <string>

#include <gtest/gtest.h>

#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

/// A match of `ticks` steps in which a box is pushed before step `when`.
template <Scalar S>
Bytes pushed(std::uint32_t ticks, std::uint32_t when, S push, bool spawns = false) {
  Space<S> space;
  const BodyId box = fillSmall(space);
  Bytes bytes;
  Recorder<S> recorder(space, kTick<S>, bytes, testWiring<S>());
  recorder.setKeyframes({16, 1u << 20});
  for (std::uint32_t tick = 1; tick <= ticks; ++tick) {
    if (tick == when) recorder.apply(ApplyImpulse<S>{box, {push, S(2)}, {}});
    if (tick == when && spawns) recorder.apply(discToSpawn<S>());
    recorder.step();
  }
  recorder.finish();
  return bytes;
}

template <class S>
class HashTreeTest : public ::testing::Test {};
TYPED_TEST_SUITE(HashTreeTest, AllScalars);

TYPED_TEST(HashTreeTest, TwoSidesFindTheFirstFieldByFewQuestions) {
  using S = TypeParam;
  const Bytes one = pushed<S>(200, 131, S(1));
  const Bytes other = pushed<S>(200, 131, S(2));
  RecordingTree<S> a(one, testWiring<S>());
  RecordingTree<S> b(other, testWiring<S>());
  const auto difference = firstDifference(a, b);
  ASSERT_TRUE(difference.has_value());
  EXPECT_FALSE(difference->onlyInOne);
  ASSERT_EQ(difference->path.size(), 5u);
  const auto nameOf = [&](std::size_t level) {
    return a.name({difference->path.begin(), difference->path.begin() + static_cast<std::ptrdiff_t>(level)});
  };
  EXPECT_EQ(nameOf(1), "tick 131");
  EXPECT_EQ(nameOf(2), "commands");
  EXPECT_EQ(nameOf(3), "body");
  EXPECT_EQ(nameOf(4), "body 2");
  EXPECT_EQ(nameOf(5), "velocity.x");
  EXPECT_NE(a.value(difference->path), b.value(difference->path));
  // 200 ticks, and thousands of values: a handful for each level.
  EXPECT_LE(difference->questions, 45u);
}

TYPED_TEST(HashTreeTest, TheSameMatchHasTheSameTree) {
  using S = TypeParam;
  const Bytes bytes = recordSmallMatch<S>(24);
  RecordingTree<S> a(bytes, testWiring<S>());
  RecordingTree<S> b(bytes, testWiring<S>());
  EXPECT_FALSE(firstDifference(a, b).has_value());
}

TYPED_TEST(HashTreeTest, AnObjectOrTickThatOneLacksIsTheDifference) {
  using S = TypeParam;
  const Bytes one = pushed<S>(40, 20, S(1));
  const Bytes longer = pushed<S>(60, 20, S(1));
  RecordingTree<S> a(one, testWiring<S>());
  RecordingTree<S> b(longer, testWiring<S>());
  const auto shorter = firstDifference(a, b);
  ASSERT_TRUE(shorter.has_value());
  EXPECT_TRUE(shorter->onlyInOne);
  EXPECT_EQ(shorter->path, TreePath{41});
  EXPECT_EQ(b.name(shorter->path), "tick 41");

  const Bytes spawned = pushed<S>(40, 20, S(1), true);
  RecordingTree<S> c(spawned, testWiring<S>());
  const auto object = firstDifference(a, c);
  ASSERT_TRUE(object.has_value());
  EXPECT_EQ(object->path[0], 20u);
  EXPECT_EQ(a.name({20, 0}), "commands");
}

TYPED_TEST(HashTreeTest, RecordedHashesOfAnotherBuildEndAtTheTick) {
  using S = TypeParam;
  const Bytes bytes = recordSmallMatch<S>(24);
  by_hand::Recording parts = by_hand::takeApart(bytes);
  // The last hash of the ticks is another one.
  for (by_hand::Section& section : parts.sections) {
    if (section.kind == by_hand::kTicks) section.payload[section.payload.size() - 1] ^= 1;
  }
  const Bytes other = by_hand::putTogether(parts);
  RecordingTree<S> a(bytes, testWiring<S>());
  RecordingTree<S> b(other, testWiring<S>());
  const auto difference = firstDifference(a, b);
  ASSERT_TRUE(difference.has_value());
  EXPECT_EQ(difference->path, TreePath{24});
  EXPECT_FALSE(difference->onlyInOne);
}

TYPED_TEST(HashTreeTest, PlacesThatAreNoneHaveNothing) {
  using S = TypeParam;
  const Bytes bytes = recordSmallMatch<S>(9);
  RecordingTree<S> tree(bytes, testWiring<S>());
  for (const TreePath& path : {TreePath{10}, TreePath{3, 99}, TreePath{3, 0, 99}, TreePath{3, 0, 0, 99},
                               TreePath{3, 0, 0, 0, 99}, TreePath{3, 0, 0, 0, 0, 0}}) {
    EXPECT_EQ(tree.children(path), 0u);
    EXPECT_EQ(tree.value(path), "");
    EXPECT_EQ(tree.hashOfFirst(path, 4000000000u), 0u);
  }
  EXPECT_EQ(tree.hashOfFirst({}, 4000000000u), 0u);
}

}  // namespace
}  // namespace samestep
