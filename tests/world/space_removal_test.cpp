// SPDX-License-Identifier: MIT
#include <samestep/space.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class SpaceRemovalTest : public ::testing::Test {
 protected:
  /// A bar of boxes side by side on one body, on a floor of boxes that are bodies of their own.
  static BodyId layBar(Space<S>& space, int count) {
    space.setGravity({S(0), S(-10)});
    const BodyId bar = space.add(Body<S>());
    for (int i = 0; i < count; ++i) {
      const Vector<S> at(S(i), S(0));
      Shape<S> box = boxShape(bar, BB<S>::forExtents(at, ratio<S>(1, 2), ratio<S>(1, 2)));
      box.setMass(S(1));
      space.add(box);
      Body<S> block = Body<S>::fixedInPlace();
      block.setPosition({S(i), S(-1)});
      space.add(boxShape(space.add(block), S(1), S(1)));
    }
    return bar;
  }
};
TYPED_TEST_SUITE(SpaceRemovalTest, AllScalars);

TYPED_TEST(SpaceRemovalTest, ABodyGoesAsIfItsShapesHadGoneOneByOne) {
  using S = TypeParam;
  Space<S> at, oneByOne;
  for (Space<S>* space : {&at, &oneByOne}) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) fillAtRandom(*space, seed);
  }
  const BodyId bar = this->layBar(at, 12);
  const BodyId same = this->layBar(oneByOne, 12);
  ASSERT_EQ(same, bar);
  for (Space<S>* space : {&at, &oneByOne}) hashesOf(*space, 20);
  const std::size_t pairs = at.state().pairs.size();

  at.removeWithShapes(bar);
  std::vector<ShapeId> shapes;
  oneByOne.eachShape(same, [&](const Shape<S>& shape) { shapes.push_back(shape.id()); });
  for (const ShapeId shape : shapes) oneByOne.remove(shape);
  oneByOne.remove(same);

  EXPECT_LT(at.state().pairs.size(), pairs);
  EXPECT_EQ(at.hash(), oneByOne.hash());
  EXPECT_EQ(hashesOf(at, 20), hashesOf(oneByOne, 20));
}

TYPED_TEST(SpaceRemovalTest, SeparateIsToldOfEachPairOnceByRisingIdsWhileAllIsStillThere) {
  using S = TypeParam;
  struct Told {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    BodyId bar;
    S mass{};
    bool removing = false;
    bool allThere = true;
  } told;
  Space<S> space;
  CollisionHandler<S> handler;
  handler.data = &told;
  handler.separate = [](Arbiter<S>& arbiter, Space<S>& world, void* data) {
    Told& to = *static_cast<Told*>(data);
    // Corners that just meet at the seams of the bar part when it settles.
    EXPECT_EQ(arbiter.isRemoval(), to.removing);
    if (!to.removing) return;
    to.pairs.emplace_back(arbiter.shapeA().index, arbiter.shapeB().index);
    to.allThere = to.allThere && world.contains(arbiter.shapeA()) && world.contains(arbiter.shapeB());
    to.mass = std::as_const(world).body(to.bar).mass();
  };
  space.registerHandler(1, handler);
  space.addDefaultCollisionHandler(1);
  told.bar = this->layBar(space, 6);
  hashesOf(space, 10);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> touching;
  space.eachArbiter(told.bar, [&](Arbiter<S>& arbiter) {
    touching.emplace_back(arbiter.shapeA().index, arbiter.shapeB().index);
  });
  ASSERT_GT(touching.size(), 5u);

  told.removing = true;
  space.removeWithShapes(told.bar);

  EXPECT_EQ(told.pairs, touching);
  EXPECT_TRUE(told.allThere);
  EXPECT_EQ(told.mass, S(6));
  EXPECT_TRUE(space.state().pairs.empty());
}

// Each pair that stays has to be moved down past those that go.
TYPED_TEST(SpaceRemovalTest, PairsOfOthersStayInOrderWhereEveryOtherOneGoes) {
  using S = TypeParam;
  Space<S> space;
  const BodyId first = this->layBar(space, 5);
  Body<S> other;
  other.setPosition({ratio<S>(1, 4), S(0)});
  const BodyId second = space.add(other);
  for (int i = 0; i < 5; ++i) {
    Shape<S> box = boxShape(second, BB<S>::forExtents({S(i), S(0)}, ratio<S>(1, 2), ratio<S>(1, 2)));
    box.setMass(S(1));
    space.add(box);
  }
  space.step(kTick<S>);
  std::vector<std::pair<ShapeId, ShapeId>> kept;
  for (const Pair<S>& pair : space.state().pairs) {
    if (bodyOf(space, pair.a) == first || bodyOf(space, pair.b) == first) continue;
    kept.emplace_back(pair.a, pair.b);
  }
  ASSERT_GT(kept.size(), 3u);

  space.removeWithShapes(first);

  std::vector<std::pair<ShapeId, ShapeId>> left;
  for (const Pair<S>& pair : space.state().pairs) left.emplace_back(pair.a, pair.b);
  EXPECT_EQ(left, kept);
  std::size_t visited = 0;
  space.eachArbiter(second, [&](Arbiter<S>&) { ++visited; });
  EXPECT_EQ(visited, kept.size());
}

TYPED_TEST(SpaceRemovalTest, EachOfThousandsOfHandlersIsFound) {
  using S = TypeParam;
  constexpr std::uint32_t kTypes = 60;
  Space<S> space;
  std::vector<std::uint32_t> called(kTypes * kTypes + 1, 0);
  CollisionHandler<S> handler;
  handler.begin = [](Arbiter<S>&, Space<S>&, void* data) {
    ++*static_cast<std::uint32_t*>(data);
    return false;
  };
  // They go from the last to the first, so that each goes before all others.
  for (std::uint32_t i = kTypes * kTypes; i-- > 0;) {
    handler.data = &called[i];
    space.registerHandler(i + 1, handler);
    if (i / kTypes < i % kTypes) space.addCollisionHandler(i / kTypes, i % kTypes, i + 1);
  }
  handler.data = &called.back();
  space.registerHandler(9999, handler);
  space.addDefaultCollisionHandler(9999);
  for (std::uint32_t i = 0; i < kTypes; ++i) {
    const ShapeId disc = addDisc<S>(space, {}, S(1), S(1));
    space.change(disc, [&](Shape<S>& shape) { shape.setCollisionType(i); });
  }

  space.step(kTick<S>);

  for (std::uint32_t i = 0; i < kTypes * kTypes; ++i) {
    EXPECT_EQ(called[i], i / kTypes < i % kTypes ? 1u : 0u) << i;
  }
  EXPECT_EQ(called.back(), 0u);
  const SavedSpace<S> saved = space.save();
  Space<S> other;
  EXPECT_THROW(other.restore(saved), MissingCallback);
  for (std::uint32_t i = 0; i < kTypes * kTypes; ++i) {
    handler.data = &called[i];
    other.registerHandler(i + 1, handler);
  }
  other.registerHandler(9999, handler);
  other.restore(saved);
  std::fill(called.begin(), called.end(), 0u);
  for (std::uint32_t i = 0; i < kTypes; ++i) {
    other.filterArbiters(other.shape(other.state().shapes.idAt(i)).body());
  }
  other.step(kTick<S>);
  EXPECT_EQ(called[1], 1u);
}

TYPED_TEST(SpaceRemovalTest, KeysOfManyPostStepCallbacksAreEachAcceptedOnce) {
  using S = TypeParam;
  constexpr std::uint64_t kKeys = 20000;
  Space<S> space;
  std::vector<std::uint64_t> called;
  const auto note = [](Space<S>&, std::uint64_t key, void* data) {
    static_cast<std::vector<std::uint64_t>*>(data)->push_back(key);
  };
  std::vector<std::uint64_t> keys;
  // Keys as alike as addresses are.
  for (std::uint64_t i = 0; i < kKeys; ++i) keys.push_back((i * 7919 % kKeys) << 20);

  space.lock();
  for (const std::uint64_t key : keys) EXPECT_TRUE(space.addPostStepCallback(note, key, &called));
  for (const std::uint64_t key : keys) EXPECT_FALSE(space.addPostStepCallback(note, key, &called));
  space.unlock(true);

  EXPECT_EQ(called, keys);
  EXPECT_TRUE(space.addPostStepCallback(note, keys[5], &called));
  EXPECT_EQ(called.size(), keys.size() + 1);
}

TYPED_TEST(SpaceRemovalTest, AKeyIsFreeAgainWhenItsPostStepCallbackRuns) {
  using S = TypeParam;
  struct Context {
    int left = 3;
    int called = 0;
  } context;
  const auto again = [](Space<S>& world, std::uint64_t key, void* data) {
    Context& to = *static_cast<Context*>(data);
    ++to.called;
    const auto next = [](Space<S>&, std::uint64_t, void* of) { ++static_cast<Context*>(of)->called; };
    EXPECT_TRUE(world.addPostStepCallback(next, key, data));
    EXPECT_FALSE(world.addPostStepCallback(next, key, data));
    if (--to.left == 0) throw std::runtime_error("stop");
  };
  Space<S> space;
  space.lock();
  for (std::uint64_t key = 1; key <= 5; ++key) {
    ASSERT_TRUE(space.addPostStepCallback(again, key, &context));
  }
  EXPECT_THROW(space.unlock(true), std::runtime_error);
  EXPECT_EQ(context.called, 3);
  // Two are waiting as they were, three anew.
  for (std::uint64_t key = 1; key <= 5; ++key) {
    EXPECT_FALSE(space.addPostStepCallback(again, key, &context)) << key;
  }
}

}  // namespace
}  // namespace samestep
