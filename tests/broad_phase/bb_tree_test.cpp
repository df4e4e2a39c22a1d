// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <samestep/bb_tree.h>
#include <samestep/brute_force_index.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "support/allocation_count.h"
#include "support/random.h"
#include "support/scalars.h"

namespace samestep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Pairs = std::vector<IndexKeyPair>;
using Keys = std::vector<IndexKey>;

template <Scalar S>
BB<S> box(int left, int bottom, int right, int top) {
  return {S(left), S(bottom), S(right), S(top)};
}

/// Objects that drift, jump, come and go, some of them at rest.
template <Scalar S>
struct Crowd {
  enum class Place { none, moving, resting };
  struct Member {
    Place place = Place::none;
    BB<S> box{};
    Vector<S> velocity{};
  };

  Random random;
  std::vector<Member> members;
  S margin = ratio<S>(1, 8);

  Crowd(std::uint64_t seed, std::size_t size) : random(seed), members(size) {
    for (Member& member : members) appear(member);
  }

  void appear(Member& member) {
    const S x = random.number<S>(-20, 20);
    const S y = random.number<S>(-20, 20);
    const int most = random.oneIn(10) ? 30 : 2;
    member.box = {x, y, x + random.number<S>(0, most), y + random.number<S>(0, most)};
    member.velocity = {random.number<S>(-5, 5), random.number<S>(-5, 5)};
    member.place = random.oneIn(4) ? Place::resting : Place::moving;
  }

  void step() {
    for (Member& member : members) {
      if (random.oneIn(60)) {
        member.place = Place::none;
      } else if (random.oneIn(60)) {
        appear(member);
      } else if (member.place == Place::moving) {
        member.box = offset(member.box, member.velocity * ratio<S>(1, 64));
      }
    }
  }

  /// Every pair that must be found, all compared.
  Pairs touching() const {
    Pairs pairs;
    for (IndexKey a = 0; a < members.size(); ++a) {
      for (IndexKey b = a + 1; b < members.size(); ++b) {
        if (touches(a, b)) pairs.push_back({a, b});
      }
    }
    return pairs;
  }

  bool touches(IndexKey a, IndexKey b) const {
    const Member& first = members[a];
    const Member& second = members[b];
    if (first.place == Place::none || second.place == Place::none) return false;
    if (first.place == Place::resting && second.place == Place::resting) return false;
    return intersects(inflate(first.box, margin), inflate(second.box, margin));
  }
};

/// A dynamic and a static tree that follow a crowd.
template <Scalar S>
struct Trees {
  BBTree<S> resting;
  BBTree<S> moving{nullptr, nullptr, &resting};

  explicit Trees(S margin) {
    resting.setMargin(margin);
    moving.setMargin(margin);
  }

  void follow(const Crowd<S>& crowd, const Keys& order) {
    for (const IndexKey key : order) {
      const auto& member = crowd.members[key];
      if (member.place != Crowd<S>::Place::moving) moving.remove(key);
      if (member.place != Crowd<S>::Place::resting) resting.remove(key);
      if (member.place == Crowd<S>::Place::moving) moving.update(key, member.box, member.velocity);
      if (member.place == Crowd<S>::Place::resting) resting.update(key, member.box);
    }
    moving.updatePairs();
  }

  /// Pairs that the Space makes of the candidates.
  Pairs filtered(const Crowd<S>& crowd) const {
    Pairs pairs;
    for (const IndexKeyPair& pair : moving.pairs()) {
      if (crowd.touches(pair.a, pair.b)) pairs.push_back(pair);
    }
    return pairs;
  }
};

Keys inOrder(std::size_t size) {
  Keys keys(size);
  for (IndexKey key = 0; key < size; ++key) keys[key] = key;
  return keys;
}

Keys shuffled(std::size_t size, Random& random) {
  Keys keys = inOrder(size);
  for (std::uint32_t i = static_cast<std::uint32_t>(size); i > 1; --i) {
    std::swap(keys[i - 1], keys[random.below(i)]);
  }
  return keys;
}

template <Scalar S>
class BBTreeTest : public ::testing::Test {};
TYPED_TEST_SUITE(BBTreeTest, AllScalarsAndChecked);

TYPED_TEST(BBTreeTest, CandidatesHoldEveryTouchingPairOnceAndSorted) {
  using S = TypeParam;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Crowd<S> crowd(seed, 120);
    Trees<S> trees(crowd.margin);
    for (int step = 0; step < 100; ++step) {
      trees.follow(crowd, inOrder(120));

      const Pairs& pairs = trees.moving.pairs();
      ASSERT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
      ASSERT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
      ASSERT_EQ(trees.filtered(crowd), crowd.touching()) << "seed " << seed << " step " << step;
      ASSERT_TRUE(trees.moving.boxes().valid());
      ASSERT_TRUE(trees.resting.boxes().valid());
      crowd.step();
    }
  }
}

TYPED_TEST(BBTreeTest, FilteredPairsDoNotDependOnHistory) {
  using S = TypeParam;
  Crowd<S> crowd(7, 100);
  Random order(70);
  Trees<S> forward(crowd.margin);
  Trees<S> mixed(crowd.margin);
  for (int step = 0; step < 60; ++step) {
    forward.follow(crowd, inOrder(100));
    mixed.follow(crowd, shuffled(100, order));
    Trees<S> fresh(crowd.margin);
    fresh.follow(crowd, shuffled(100, order));

    ASSERT_EQ(forward.filtered(crowd), mixed.filtered(crowd));
    ASSERT_EQ(forward.filtered(crowd), fresh.filtered(crowd));
    crowd.step();
  }
}

TYPED_TEST(BBTreeTest, DroppingOrRebuildingAtAnyStepChangesNoFilteredPair) {
  using S = TypeParam;
  Crowd<S> crowd(8, 100);
  Trees<S> kept(crowd.margin);
  Trees<S> dropped(crowd.margin);
  Trees<S> rebuilt(crowd.margin);
  for (int step = 0; step < 60; ++step) {
    if (step % 3 != 1) dropped.moving.clear();
    if (step % 3 != 2) dropped.resting.clear();
    rebuilt.moving.rebuild();
    rebuilt.resting.rebuild();
    for (Trees<S>* trees : {&kept, &dropped, &rebuilt}) trees->follow(crowd, inOrder(100));

    ASSERT_EQ(kept.filtered(crowd), crowd.touching());
    ASSERT_EQ(dropped.filtered(crowd), kept.filtered(crowd)) << "step " << step;
    ASSERT_EQ(rebuilt.moving.pairs(), kept.moving.pairs());
    crowd.step();
  }
}

TYPED_TEST(BBTreeTest, ACopyContinuesAsItsOriginal) {
  using S = TypeParam;
  Crowd<S> crowd(9, 100);
  Trees<S> trees(crowd.margin);
  Trees<S> copy{S(0)};
  for (int step = 0; step < 60; ++step) {
    trees.follow(crowd, inOrder(100));
    if (step == 20) {
      copy.resting.copyFrom(trees.resting);
      copy.moving.copyFrom(trees.moving);
      ASSERT_EQ(copy.moving.margin(), crowd.margin);
    }
    if (step >= 20) {
      copy.follow(crowd, inOrder(100));
      ASSERT_EQ(copy.moving.pairs(), trees.moving.pairs());
    }
    crowd.step();
  }
}

TYPED_TEST(BBTreeTest, TheMarginOfBothBoxesCountsForEveryCandidate) {
  using S = TypeParam;
  BBTree<S> tree;
  tree.update(0, box<S>(0, 0, 1, 1));
  tree.update(1, box<S>(4, 0, 5, 1));
  tree.updatePairs();
  EXPECT_THAT(tree.pairs(), IsEmpty());

  tree.setMargin(ratio<S>(3, 2));
  tree.updatePairs();
  EXPECT_THAT(tree.pairs(), ElementsAre(IndexKeyPair{0, 1}));

  tree.setMargin(S(1));
  tree.updatePairs();
  EXPECT_THAT(tree.pairs(), IsEmpty());
}

TYPED_TEST(BBTreeTest, ASearchThatFindsTooManyEndsAndBeginsAnew) {
  using S = TypeParam;
  BBTree<S> resting, moving{nullptr, nullptr, &resting};
  const Pairs all = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (const IndexKey key : {0u, 1u, 2u}) moving.update(key, box<S>(0, 0, 1, 1));
  resting.update(3, box<S>(0, 0, 1, 1));

  EXPECT_FALSE(moving.updatePairs(5));
  EXPECT_FALSE(moving.updatePairs(5));
  EXPECT_TRUE(moving.updatePairs(6));
  EXPECT_EQ(moving.pairs(), all);
  EXPECT_TRUE(moving.updatePairs(6));
  EXPECT_FALSE(moving.updatePairs(5)) << "nothing has moved, and there are as many";

  // A resting thing is counted, too, wherever it came from.
  resting.update(4, box<S>(0, 0, 1, 1));
  EXPECT_FALSE(moving.updatePairs(8));
  resting.remove(4);
  EXPECT_TRUE(moving.updatePairs(6));
  EXPECT_EQ(moving.pairs(), all);

  // The things that stay are counted where nothing is looked for.
  moving.remove(2);
  EXPECT_FALSE(moving.updatePairs(2));
  EXPECT_TRUE(moving.updatePairs(3));
  EXPECT_EQ(moving.pairs(), (Pairs{{0, 1}, {0, 3}, {1, 3}}));
}

TYPED_TEST(BBTreeTest, ANegativeMarginThrowsAndIsNotTaken) {
  using S = TypeParam;
  BBTree<S> tree;

  EXPECT_THROW(tree.setMargin(S(-1)), NegativeHalfDimensions);

  EXPECT_EQ(tree.margin(), S(0));
}

TYPED_TEST(BBTreeTest, UpdateOfAKeyTooLargeThrowsIndexOutOfBounds) {
  using S = TypeParam;
  BBTree<S> tree;

  EXPECT_THROW(tree.update(1u << 24, box<S>(0, 0, 1, 1)), IndexOutOfBounds);
  EXPECT_THROW(tree.update(kNoKey, box<S>(0, 0, 1, 1), Vector<S>()), IndexOutOfBounds);

  EXPECT_EQ(tree.count(), 0u);
}

// A fifth of a second: twelve steps of 1/60 s, thirteen with the rounding of the last.
TYPED_TEST(BBTreeTest, ADriftingLeafIsPlacedAnewAboutEveryTwelfthStep) {
  using S = TypeParam;
  BBTree<S> tree;
  const Vector<S> velocity(S(5), S(-3));
  BB<S> tight = box<S>(0, 0, 1, 1);
  int placed = 0;
  for (int step = 0; step < 600; ++step) {
    placed += tree.update(0, tight, velocity) ? 1 : 0;
    tight = offset(tight, velocity * ratio<S>(1, 60));
  }

  EXPECT_GE(placed, 600 / 13);
  EXPECT_LE(placed, 600 / 11);
}

TYPED_TEST(BBTreeTest, ALeafMayTrembleByASeventhOfItsSize) {
  using S = TypeParam;
  BBTree<S> tree;
  EXPECT_TRUE(tree.update(0, box<S>(0, 0, 40, 40), Vector<S>()));

  EXPECT_FALSE(tree.update(0, box<S>(5, -5, 45, 35), Vector<S>()));
  EXPECT_FALSE(tree.update(0, box<S>(-5, 5, 35, 45), Vector<S>()));
  EXPECT_TRUE(tree.update(0, box<S>(6, 0, 46, 40), Vector<S>()));
}

TYPED_TEST(BBTreeTest, ARestingLeafIsPlacedAnewOnlyIfItsBoxChanged) {
  using S = TypeParam;
  BBTree<S> tree;

  EXPECT_TRUE(tree.update(3, box<S>(0, 0, 1, 1)));
  EXPECT_FALSE(tree.update(3, box<S>(0, 0, 1, 1)));
  EXPECT_TRUE(tree.update(3, box<S>(0, 0, 1, 2)));
}

TYPED_TEST(BBTreeTest, PairsOfARemovedObjectGoWithTheNextUpdate) {
  using S = TypeParam;
  BBTree<S> tree;
  for (IndexKey key = 0; key < 3; ++key) tree.update(key, box<S>(0, 0, 1, 1));
  tree.updatePairs();
  EXPECT_EQ(tree.pairs().size(), 3u);

  tree.remove(1);
  tree.updatePairs();

  EXPECT_THAT(tree.pairs(), ElementsAre(IndexKeyPair{0, 2}));
}

TYPED_TEST(BBTreeTest, AKeyUsedAgainBetweenUpdatesLosesItsOldPairs) {
  using S = TypeParam;
  BBTree<S> tree;
  tree.update(0, box<S>(0, 0, 1, 1));
  tree.update(1, box<S>(0, 0, 1, 1));
  tree.updatePairs();

  tree.remove(1);
  tree.update(1, box<S>(50, 0, 51, 1));
  tree.updatePairs();

  EXPECT_THAT(tree.pairs(), IsEmpty());
}

TYPED_TEST(BBTreeTest, AnObjectMayGoFromTheDynamicToTheStaticTree) {
  using S = TypeParam;
  BBTree<S> resting;
  BBTree<S> moving(nullptr, nullptr, &resting);
  for (IndexKey key = 0; key < 3; ++key) moving.update(key, box<S>(0, 0, 1, 1));
  moving.updatePairs();

  for (const IndexKey key : {0u, 2u}) {
    moving.remove(key);
    resting.update(key, box<S>(0, 0, 1, 1));
  }
  moving.updatePairs();

  EXPECT_THAT(moving.pairs(), ElementsAre(IndexKeyPair{0, 1}, IndexKeyPair{1, 2}));
}

TYPED_TEST(BBTreeTest, BoxesBeyondTheGridAreStillCandidates) {
  using S = TypeParam;
  BBTree<S> tree;
  const int far = 1 << 22;
  tree.update(0, box<S>(far, far, far + 1, far + 1), {S(1), S(1)});
  tree.update(1, box<S>(far, far, far + 1, far + 1), {S(1), S(1)});
  tree.update(2, box<S>(-far - 1, -far - 1, -far, -far), {S(1), S(1)});
  tree.updatePairs();

  EXPECT_THAT(tree.pairs(), ElementsAre(IndexKeyPair{0, 1}));
  Keys keys;
  tree.collectAlong({S(0), S(0)}, {S(far), S(far)}, S(0), keys);
  EXPECT_THAT(keys, ElementsAre(0, 1));
}

/// NaN, or, where the scalar has none, the edge of the grid.
template <Scalar S>
S notANumber() {
  if constexpr (requires { std::numeric_limits<S>::quiet_NaN(); }) {
    return std::numeric_limits<S>::quiet_NaN();
  } else {
    return S(1 << 20);
  }
}

// The Space refuses what is not a number; an index of one's own must not crash on it.
TYPED_TEST(BBTreeTest, ABoxOfWhatIsNoNumberOverlapsEverything) {
  using S = TypeParam;
  const S edge = S(1 << 20);
  const S odd = notANumber<S>();
  BBTree<S> tree;
  tree.update(0, {-edge, -edge, odd, odd});
  tree.update(1, box<S>(3, 3, 4, 4));
  tree.updatePairs();

  EXPECT_THAT(tree.pairs(), ElementsAre(IndexKeyPair{0, 1}));
}

TYPED_TEST(BBTreeTest, QueriesHoldEveryHitByRisingKey) {
  using S = TypeParam;
  Crowd<S> crowd(10, 150);
  Trees<S> trees(S(0));
  trees.follow(crowd, inOrder(150));
  Random random(100);
  Keys keys;
  for (int round = 0; round < 200; ++round) {
    const Vector<S> a(random.number<S>(-30, 30), random.number<S>(-30, 30));
    const Vector<S> b(random.number<S>(-30, 30), random.number<S>(-30, 30));
    const BB<S> area(min(a.x, b.x), min(a.y, b.y), max(a.x, b.x), max(a.y, b.y));
    Keys inArea, atPoint, alongSegment;
    const Vector<S> middle = lerp(a, b, ratio<S>(1, 4));
    for (IndexKey key = 0; key < 150; ++key) {
      const auto& member = crowd.members[key];
      if (member.place != Crowd<S>::Place::moving) continue;
      if (intersects(member.box, area)) inArea.push_back(key);
      if (contains(member.box, a)) atPoint.push_back(key);
      if (contains(member.box, middle)) alongSegment.push_back(key);
    }
    const auto holds = [&keys](const Keys& needed) {
      return std::is_sorted(keys.begin(), keys.end()) &&
             std::includes(keys.begin(), keys.end(), needed.begin(), needed.end());
    };
    trees.moving.collectIn(area, keys);
    ASSERT_TRUE(holds(inArea));
    const std::size_t inBounds = keys.size();
    trees.moving.collectAt(a, keys);
    ASSERT_TRUE(holds(atPoint));
    trees.moving.collectAlong(a, b, S(0), keys);
    ASSERT_TRUE(holds(alongSegment));
    ASSERT_LE(keys.size(), inBounds);
    trees.moving.collectAlong(a, b, S(100), keys);
    ASSERT_EQ(keys.size(), trees.moving.count());
  }
}

// The oracle: the index that compares all boxes, through the interface of the MIS.
TYPED_TEST(BBTreeTest, ReindexQueryHoldsThePairsOfBruteForceInTheSameOrder) {
  using S = TypeParam;
  Crowd<S> crowd(11, 80);
  crowd.margin = S(0);
  const auto boxOf = [](void* context, IndexKey key) {
    return static_cast<Crowd<S>*>(context)->members[key].box;
  };
  const auto velocityOf = [](void* context, IndexKey key) {
    return static_cast<Crowd<S>*>(context)->members[key].velocity;
  };
  const auto note = [](void* to, IndexKey a, IndexKey b) { static_cast<Pairs*>(to)->push_back({a, b}); };
  BBTree<S> tree(boxOf, &crowd);
  tree.setVelocityFunc(velocityOf, nullptr);
  BruteForceIndex<S> plain(boxOf, &crowd);
  for (auto& member : crowd.members) member.place = Crowd<S>::Place::moving;
  for (IndexKey key = 0; key < 80; ++key) {
    tree.insert(key);
    plain.insert(key);
  }
  for (int step = 0; step < 40; ++step) {
    Pairs candidates, exact;
    tree.reindexQuery(note, &candidates);
    plain.reindexQuery(note, &exact);
    std::erase_if(candidates, [&crowd](const IndexKeyPair& pair) { return !crowd.touches(pair.a, pair.b); });

    ASSERT_EQ(candidates, exact);
    for (auto& member : crowd.members) member.box = offset(member.box, member.velocity * ratio<S>(1, 64));
  }
}

TYPED_TEST(BBTreeTest, AWarmTreeAllocatesNothing) {
  using S = TypeParam;
  Crowd<S> crowd(12, 200);
  for (auto& member : crowd.members) member.place = Crowd<S>::Place::moving;
  Trees<S> trees(crowd.margin);
  const Keys order = inOrder(200);
  std::uint64_t before = 0;
  for (int step = 0; step < 240; ++step) {
    if (step == 120) before = allocationCount;
    // The crowd goes out and back, so that the second half repeats the first.
    for (auto& member : crowd.members) {
      if (step % 60 == 0) member.velocity = -member.velocity;
      member.box = offset(member.box, member.velocity * ratio<S>(1, 64));
    }
    trees.follow(crowd, order);
  }

  EXPECT_EQ(allocationCount, before);
}

}  // namespace
}  // namespace samestep
