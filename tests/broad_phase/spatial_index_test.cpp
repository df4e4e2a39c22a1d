// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <samestep/bb_tree.h>
#include <samestep/brute_force_index.h>
#include <samestep/spatial_index.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

using ::testing::ElementsAre;

template <Scalar S>
struct World {
  std::vector<BB<S>> boxes;

  static BB<S> boxOf(void* world, IndexKey object) { return static_cast<World*>(world)->boxes[object]; }
};

using Pairs = std::vector<IndexKeyPair>;
void note(void* pairs, IndexKey a, IndexKey b) { static_cast<Pairs*>(pairs)->push_back({a, b}); }

template <Scalar S>
BB<S> box(int left, int bottom, int right, int top) {
  return {S(left), S(bottom), S(right), S(top)};
}

/// Each test runs on both kinds of index and all scalars.
template <class SAndKind>
class SpatialIndexTest : public ::testing::Test {};

template <Scalar S_, template <Scalar> class Index>
struct Kind {
  using S = S_;
  using Type = Index<S>;
};
#ifndef SAMESTEP_FIXED_ONLY
using Kinds = ::testing::Types<Kind<double, BBTree>, Kind<double, BruteForceIndex>, Kind<Fixed, BBTree>,
                               Kind<Fixed, BruteForceIndex>, Kind<CheckedFixed, BBTree>>;
#else
using Kinds = ::testing::Types<Kind<Fixed, BBTree>, Kind<Fixed, BruteForceIndex>, Kind<CheckedFixed, BBTree>>;
#endif
TYPED_TEST_SUITE(SpatialIndexTest, Kinds);

TYPED_TEST(SpatialIndexTest, InsertRemoveContainsAndCountAgree) {
  using S = typename TypeParam::S;
  World<S> world{{box<S>(0, 0, 1, 1), box<S>(5, 5, 6, 6), box<S>(0, 0, 1, 1)}};
  typename TypeParam::Type index(&World<S>::boxOf, &world);

  index.insert(0);
  index.insert(2);
  index.insert(2);
  EXPECT_EQ(index.count(), 2u);
  EXPECT_TRUE(index.contains(0));
  EXPECT_FALSE(index.contains(1));

  index.remove(0);
  index.remove(0);
  index.remove(77);
  EXPECT_EQ(index.count(), 1u);
  EXPECT_FALSE(index.contains(0));
}

TYPED_TEST(SpatialIndexTest, EachVisitsByRisingKey) {
  using S = typename TypeParam::S;
  World<S> world{std::vector<BB<S>>(9, box<S>(0, 0, 1, 1))};
  typename TypeParam::Type index(&World<S>::boxOf, &world);
  for (const IndexKey key : {5u, 2u, 8u, 3u}) index.insert(key);
  std::vector<IndexKey> visited;

  index.each([](void* to, IndexKey key) { static_cast<std::vector<IndexKey>*>(to)->push_back(key); },
             &visited);

  EXPECT_THAT(visited, ElementsAre(2, 3, 5, 8));
}

TYPED_TEST(SpatialIndexTest, QueryFindsOverlapsOtherThanTheObject) {
  using S = typename TypeParam::S;
  World<S> world{{box<S>(0, 0, 1, 1), box<S>(1, 1, 2, 2), box<S>(50, 50, 51, 51)}};
  typename TypeParam::Type index(&World<S>::boxOf, &world);
  for (IndexKey key = 0; key < 3; ++key) index.insert(key);
  std::vector<IndexKey> keys;

  index.collect(box<S>(-1, -1, 1, 1), keys);
  EXPECT_THAT(keys, ElementsAre(0, 1));
  index.collect(box<S>(-1, -1, 1, 1), keys, 0);
  EXPECT_THAT(keys, ElementsAre(1));
  index.collect(box<S>(10, 10, 20, 20), keys);
  EXPECT_TRUE(keys.empty());

  Pairs calls;
  index.query(0, box<S>(-1, -1, 1, 1), note, &calls);
  EXPECT_THAT(calls, ElementsAre(IndexKeyPair{0, 1}));
}

TYPED_TEST(SpatialIndexTest, ReindexObjectAndReindexTakeUpMoves) {
  using S = typename TypeParam::S;
  World<S> world{{box<S>(0, 0, 1, 1), box<S>(10, 10, 11, 11)}};
  typename TypeParam::Type index(&World<S>::boxOf, &world);
  index.insert(0);
  index.insert(1);
  world.boxes = {box<S>(20, 0, 21, 1), box<S>(20, 10, 21, 11)};
  std::vector<IndexKey> keys;

  index.reindexObject(1);
  index.reindexObject(9);
  index.collect(box<S>(20, 0, 21, 20), keys);
  EXPECT_THAT(keys, ElementsAre(1));

  index.reindex();
  index.collect(box<S>(20, 0, 21, 20), keys);
  EXPECT_THAT(keys, ElementsAre(0, 1));
}

TYPED_TEST(SpatialIndexTest, ReindexQueryReportsEachPairOnceInOrder) {
  using S = typename TypeParam::S;
  World<S> world{std::vector<BB<S>>(4, box<S>(0, 0, 1, 1))};
  typename TypeParam::Type index(&World<S>::boxOf, &world);
  for (const IndexKey key : {3u, 0u, 2u}) index.insert(key);
  Pairs pairs;

  index.reindexQuery(note, &pairs);

  EXPECT_THAT(pairs, ElementsAre(IndexKeyPair{0, 2}, IndexKeyPair{0, 3}, IndexKeyPair{2, 3}));
}

TYPED_TEST(SpatialIndexTest, ReindexQueryPairsWithTheStaticIndexButNotWithinIt) {
  using S = typename TypeParam::S;
  World<S> world{std::vector<BB<S>>(5, box<S>(0, 0, 1, 1))};
  typename TypeParam::Type resting(&World<S>::boxOf, &world);
  typename TypeParam::Type index(&World<S>::boxOf, &world, &resting);
  for (const IndexKey key : {0u, 2u}) resting.insert(key);
  for (const IndexKey key : {3u, 1u}) index.insert(key);
  Pairs pairs;

  index.reindexQuery(note, &pairs);
  EXPECT_THAT(pairs, ElementsAre(IndexKeyPair{0, 1}, IndexKeyPair{0, 3}, IndexKeyPair{1, 2},
                                 IndexKeyPair{1, 3}, IndexKeyPair{2, 3}));

  pairs.clear();
  resting.reindexQuery(note, &pairs);
  EXPECT_THAT(pairs, ElementsAre(IndexKeyPair{0, 2}));
}

TYPED_TEST(SpatialIndexTest, CollideStaticReportsByRisingKeys) {
  using S = typename TypeParam::S;
  World<S> world{std::vector<BB<S>>(5, box<S>(0, 0, 1, 1))};
  world.boxes[4] = box<S>(9, 9, 10, 10);
  typename TypeParam::Type resting(&World<S>::boxOf, &world);
  typename TypeParam::Type index(&World<S>::boxOf, &world);
  Pairs pairs;
  index.collideStatic(resting, note, &pairs);
  EXPECT_TRUE(pairs.empty());
  for (const IndexKey key : {2u, 0u, 4u}) resting.insert(key);
  for (const IndexKey key : {3u, 1u}) index.insert(key);

  index.collideStatic(resting, note, &pairs);

  EXPECT_THAT(pairs,
              ElementsAre(IndexKeyPair{1, 0}, IndexKeyPair{1, 2}, IndexKeyPair{3, 0}, IndexKeyPair{3, 2}));
}

TYPED_TEST(SpatialIndexTest, AStaticIndexWithTwoDynamicOnesThrowsAttachedStaticIndex) {
  using S = typename TypeParam::S;
  using Index = typename TypeParam::Type;
  Index resting(&World<S>::boxOf);
  Index index(&World<S>::boxOf, nullptr, &resting);
  EXPECT_EQ(resting.dynamicIndex(), &index);
  EXPECT_EQ(index.staticIndex(), &resting);

  EXPECT_THROW(Index(&World<S>::boxOf, nullptr, &resting), AttachedStaticIndex);

  EXPECT_EQ(resting.dynamicIndex(), &index);
}

TYPED_TEST(SpatialIndexTest, DestroyingOneIndexPartsItFromTheOther) {
  using S = typename TypeParam::S;
  using Index = typename TypeParam::Type;
  World<S> world{std::vector<BB<S>>(3, box<S>(0, 0, 1, 1))};
  auto resting = std::make_unique<Index>(&World<S>::boxOf, &world);
  { const Index brief(&World<S>::boxOf, &world, resting.get()); }
  Index index(&World<S>::boxOf, &world, resting.get());
  resting->insert(0);
  index.insert(1);
  index.insert(2);
  Pairs pairs;
  index.reindexQuery(note, &pairs);
  EXPECT_EQ(pairs.size(), 3u);

  resting.reset();
  pairs.clear();
  index.reindexQuery(note, &pairs);

  EXPECT_EQ(index.staticIndex(), nullptr);
  EXPECT_THAT(pairs, ElementsAre(IndexKeyPair{1, 2}));
}

TYPED_TEST(SpatialIndexTest, WithoutABoxFunctionInsertThrowsMissingCallback) {
  typename TypeParam::Type index(nullptr);

  EXPECT_THROW(index.insert(0), MissingCallback);

  EXPECT_EQ(index.count(), 0u);
}

TYPED_TEST(SpatialIndexTest, AKeyTooLargeThrowsIndexOutOfBounds) {
  using S = typename TypeParam::S;
  typename TypeParam::Type index([](void*, IndexKey) { return box<S>(0, 0, 1, 1); });

  EXPECT_THROW(index.insert(1u << 24), IndexOutOfBounds);

  EXPECT_EQ(index.count(), 0u);
}

template <Scalar S>
Vector<S> fast(void*, IndexKey) {
  return {S(100), S(0)};
}

// The remark NotBBTreeWarn: counted, passed to the hook, and the call has no effect.
TEST(SetVelocityFuncTest, IsRemarkedOnForAnIndexThatIsNoTree) {
  World<Fixed> world{{box<Fixed>(0, 0, 1, 1)}};
  Remarks remarks;
  std::string log;
  remarks.context = &log;
  remarks.hook = [](Remark, const char* text, void* context) { *static_cast<std::string*>(context) += text; };
  BruteForceIndex<Fixed> index(&World<Fixed>::boxOf, &world);
  SpatialIndex<Fixed>& base = index;

  base.setVelocityFunc(&fast<Fixed>, &remarks);
  base.setVelocityFunc(&fast<Fixed>, nullptr);

  EXPECT_EQ(remarks.count(Remark::NotBBTreeWarn), 1u);
  EXPECT_EQ(log, "Ignoring BBTreeSetVelocityFunc() call to non-tree spatial index.");
  EXPECT_EQ(base.asTree(), nullptr);
}

TEST(SetVelocityFuncTest, StretchesTheBoxesOfATreeWithoutRemark) {
  World<Fixed> world{{box<Fixed>(0, 0, 1, 1)}};
  Remarks remarks;
  BBTree<Fixed> tree(&World<Fixed>::boxOf, &world);
  tree.setVelocityFunc(&fast<Fixed>, &remarks);

  tree.insert(0);

  std::vector<IndexKey> keys;
  tree.collect(box<Fixed>(10, 0, 10, 0), keys);
  EXPECT_THAT(keys, ElementsAre(0));
  EXPECT_EQ(remarks.count(Remark::NotBBTreeWarn), 0u);
  EXPECT_EQ(tree.asTree(), &tree);
}

TEST(MixedIndexTest, ATreePairsWithAStaticIndexThatIsNoTree) {
  World<Fixed> world{std::vector<BB<Fixed>>(3, box<Fixed>(0, 0, 1, 1))};
  BruteForceIndex<Fixed> resting(&World<Fixed>::boxOf, &world);
  BBTree<Fixed> tree(&World<Fixed>::boxOf, &world, &resting);
  resting.insert(1);
  tree.insert(0);
  tree.insert(2);
  Pairs pairs;

  tree.reindexQuery(note, &pairs);

  EXPECT_THAT(pairs, ElementsAre(IndexKeyPair{0, 1}, IndexKeyPair{0, 2}, IndexKeyPair{1, 2}));
}

TEST(MixedIndexTest, AnIndexThatIsNoTreePairsWithAStaticTree) {
  World<Fixed> world{std::vector<BB<Fixed>>(3, box<Fixed>(0, 0, 1, 1))};
  BBTree<Fixed> resting(&World<Fixed>::boxOf, &world);
  BruteForceIndex<Fixed> index(&World<Fixed>::boxOf, &world, &resting);
  resting.insert(1);
  index.insert(0);
  index.insert(2);
  Pairs pairs;

  index.reindexQuery(note, &pairs);

  EXPECT_THAT(pairs, ElementsAre(IndexKeyPair{0, 1}, IndexKeyPair{0, 2}, IndexKeyPair{1, 2}));
}

}  // namespace
}  // namespace samestep
