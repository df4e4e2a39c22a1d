// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <samestep/box_tree.h>

#include <algorithm>
#include <map>
#include <vector>

#include "support/random.h"

namespace samestep {
namespace {

using Keys = std::vector<BoxTree::Key>;

GridBox square(int x, int y, int size) { return {x, y, x + size, y + size}; }

template <class Area>
Keys found(const BoxTree& tree, const Area& area) {
  Keys keys;
  tree.query(area, [&keys](BoxTree::Key key) { keys.push_back(key); });
  std::sort(keys.begin(), keys.end());
  return keys;
}

GridBox randomBox(Random& random) {
  const int size = random.oneIn(20) ? 3000 : 60;
  const int left = random.between(-1000, 1000);
  const int bottom = random.between(-1000, 1000);
  return {left, bottom, left + random.between(0, size), bottom + random.between(0, size)};
}

TEST(BoxTreeTest, AnEmptyTreeFindsNothing) {
  const BoxTree tree;

  EXPECT_TRUE(found(tree, GridBox{-kGridLimit, -kGridLimit, kGridLimit, kGridLimit}).empty());
  EXPECT_TRUE(tree.valid());
  EXPECT_EQ(tree.root(), BoxTree::kNone);
}

TEST(BoxTreeTest, TouchingBoxesOverlap) {
  BoxTree tree;
  tree.insert(3, square(0, 0, 10));

  EXPECT_EQ(found(tree, square(10, 10, 5)), Keys{3});
  EXPECT_TRUE(found(tree, square(11, 0, 5)).empty());
}

TEST(BoxTreeTest, TheLimitsOverlapEachOther) {
  BoxTree tree;
  tree.insert(0, {-kGridLimit, -kGridLimit, kGridLimit, kGridLimit});
  tree.insert(1, {kGridLimit, kGridLimit, kGridLimit, kGridLimit});
  tree.insert(2, {-kGridLimit, -kGridLimit, -kGridLimit, -kGridLimit});

  EXPECT_EQ(found(tree, GridBox{kGridLimit, kGridLimit, kGridLimit, kGridLimit}), (Keys{0, 1}));
  EXPECT_EQ(found(tree, GridBox{-kGridLimit, -kGridLimit, kGridLimit, kGridLimit}), (Keys{0, 1, 2}));
}

// The model: a map of boxes, all compared.
TEST(BoxTreeTest, AgreesWithAPlainListUnderRandomOperations) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    BoxTree tree;
    std::map<BoxTree::Key, GridBox> model;
    for (int step = 0; step < 1500; ++step) {
      const BoxTree::Key key = random.below(150);
      const GridBox box = randomBox(random);
      if (!tree.contains(key)) {
        tree.insert(key, box);
        model[key] = box;
      } else if (random.oneIn(3)) {
        tree.remove(key);
        model.erase(key);
      } else {
        tree.move(key, box);
        model[key] = box;
      }
      if (random.oneIn(200)) tree.rebuild();
      if (step % 10 != 0) continue;
      ASSERT_TRUE(tree.valid());
      ASSERT_EQ(tree.count(), model.size());
      const GridBox area = randomBox(random);
      Keys expected;
      for (const auto& [k, b] : model) {
        if (overlaps(b, area)) expected.push_back(k);
      }
      ASSERT_EQ(found(tree, area), expected) << "seed " << seed << " step " << step;
    }
    for (const auto& [key, box] : model) ASSERT_EQ(tree.box(key), box);
  }
}

TEST(BoxTreeTest, StaysLowForBoxesInARowAndForEqualBoxes) {
  BoxTree row;
  BoxTree heap;
  BoxTree nested;
  for (BoxTree::Key key = 0; key < 4096; ++key) {
    const int i = static_cast<int>(key);
    row.insert(key, square(1000 * i, 0, 900));
    heap.insert(key, square(0, 0, 100));
    nested.insert(key, square(-i, -i, 2 * i));
  }

  EXPECT_LE(row.height(), 24u);
  EXPECT_LE(heap.height(), 24u);
  EXPECT_LE(nested.height(), BoxTree::kMaxHeight);
  EXPECT_TRUE(row.valid() && heap.valid() && nested.valid());
}

// Each of them goes above all others: by perimeter alone the tree would be a list.
TEST(BoxTreeTest, BoxesOneInTheOtherAreSortedInWithoutRebuildingTheTreeForEachFew) {
  for (const bool outwards : {true, false}) {
    BoxTree tree;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
      const int half = outwards ? i : kCount - i;
      tree.insert(static_cast<BoxTree::Key>(i), square(-half, -half, 2 * half));
    }

    EXPECT_LE(tree.rebuilds(), 2u);
    EXPECT_LE(tree.height(), BoxTree::kMaxHeight);
    EXPECT_TRUE(tree.valid());
  }
}

// Moves take leaves from where they keep the tree low.
TEST(BoxTreeTest, ATreeAsHighAsItMayBeStaysSoundWhenLeavesMove) {
  BoxTree tree;
  Random random(5);
  constexpr int kCount = 600;
  int half[kCount];
  for (int i = 0; i < kCount; ++i) {
    half[i] = 2 * i;
    tree.insert(static_cast<BoxTree::Key>(i), square(-half[i], -half[i], 2 * half[i]));
  }
  for (int step = 0; step < 20000; ++step) {
    const int i = random.between(0, kCount - 1);
    half[i] = random.oneIn(2) ? 2 * kCount + step : random.between(0, 2 * kCount);
    tree.move(static_cast<BoxTree::Key>(i), square(-half[i], -half[i], 2 * half[i]));
    if (step % 500 == 0) {
      ASSERT_TRUE(tree.valid());
      ASSERT_EQ(tree.count(), static_cast<std::uint32_t>(kCount));
    }
  }

  EXPECT_LE(tree.height(), BoxTree::kMaxHeight);
  EXPECT_LE(tree.rebuilds(), 20u);
  EXPECT_EQ(found(tree, square(0, 0, 0)).size(), static_cast<std::size_t>(kCount));
}

TEST(BoxTreeTest, RebuildGivesTheLeastHeightAndTheSameAnswers) {
  Random random(3);
  BoxTree tree;
  for (BoxTree::Key key = 0; key < 1000; ++key) tree.insert(key, randomBox(random));
  const GridBox area = square(-200, -200, 500);
  const Keys before = found(tree, area);

  tree.rebuild();

  EXPECT_EQ(tree.height(), 10u);
  EXPECT_TRUE(tree.valid());
  EXPECT_EQ(found(tree, area), before);
}

// Boxes in boxes, each twice as large: the worst that greedy placing can do.
TEST(BoxTreeTest, NeverGetsHigherThanItsLimit) {
  BoxTree tree;
  std::uint32_t highest = 0;
  for (BoxTree::Key key = 0; key < 200; ++key) {
    const int far = key < 30 ? 1 << key : static_cast<int>(key);
    tree.insert(key, {-far, -far, far, far});
    highest = std::max(highest, tree.height());
  }

  EXPECT_LE(highest, BoxTree::kMaxHeight);
  EXPECT_EQ(found(tree, square(0, 0, 0)).size(), 200u);
}

TEST(BoxTreeTest, ReplacingAChildOfALeafThrowsLeafError) {
  BoxTree tree;
  tree.insert(0, square(0, 0, 1));

  EXPECT_THROW(tree.replaceChild(BoxTree::kLeaf | 0, 0, 0), LeafError);
}

TEST(BoxTreeTest, ReplacingWhatIsNotAChildThrowsInvalidChild) {
  BoxTree tree;
  for (BoxTree::Key key = 0; key < 3; ++key) tree.insert(key, square(10 * static_cast<int>(key), 0, 1));
  const BoxTree::Ref root = tree.root();

  EXPECT_THROW(tree.replaceChild(root, root, tree.child(root, 0)), InvalidChild);
  EXPECT_THROW(tree.replaceChild(12345, root, root), InvalidChild);

  EXPECT_TRUE(tree.valid());
}

TEST(BoxTreeTest, AFullTreeThrowsInsufficientBufferSize) {
  BoxTree tree(2);
  tree.insert(0, square(0, 0, 1));
  tree.insert(1, square(0, 0, 1));

  EXPECT_THROW(tree.insert(2, square(0, 0, 1)), InsufficientBufferSize);

  EXPECT_EQ(tree.count(), 2u);
  EXPECT_TRUE(tree.valid());
}

TEST(BoxTreeTest, AKeyTooLargeThrowsIndexOutOfBounds) {
  BoxTree tree;

  EXPECT_THROW(tree.insert(BoxTree::kMaxKeys, square(0, 0, 1)), IndexOutOfBounds);
}

TEST(BoxTreeTest, ClearEmptiesAndTheTreeWorksOn) {
  BoxTree tree;
  for (BoxTree::Key key = 0; key < 10; ++key) tree.insert(key, square(0, 0, 5));

  tree.clear();
  EXPECT_EQ(tree.count(), 0u);
  EXPECT_FALSE(tree.contains(3));
  tree.insert(4, square(0, 0, 5));

  EXPECT_EQ(found(tree, square(0, 0, 1)), Keys{4});
}

GridSegment segment(int x0, int y0, int x1, int y1, int reach) {
  return {{std::min(x0, x1) - reach, std::min(y0, y1) - reach, std::max(x0, x1) + reach,
           std::max(y0, y1) + reach},
          {x0, x1},
          {y0, y1},
          reach,
          true};
}

TEST(BoxTreeTest, ASegmentPassesBoxesThatItsBoundsHold) {
  BoxTree tree;
  tree.insert(0, square(900, 0, 50));      // The box lies below the diagonal.
  tree.insert(1, square(480, 480, 50));    // On it.
  tree.insert(2, square(0, 900, 50));      // The box lies above it.
  tree.insert(3, square(2000, 2000, 50));  // The box lies beyond its end.

  EXPECT_EQ(found(tree, segment(0, 0, 1000, 1000, 0)), Keys{1});
  EXPECT_EQ(found(tree, segment(1000, 1000, 0, 0, 600)), (Keys{0, 1, 2}));
}

TEST(BoxTreeTest, ASegmentNeverMissesABoxThatOneOfItsPointsIsIn) {
  Random random(11);
  for (int round = 0; round < 2000; ++round) {
    const int spread = random.oneIn(2) ? 100 : 1 << 28;
    const auto coordinate = [&] { return random.between(-spread, spread); };
    const GridSegment s =
        segment(coordinate(), coordinate(), coordinate(), coordinate(), random.between(0, 4) * 7);
    const std::int64_t t = random.below(1025);
    const auto along = [t](const std::int32_t(&ends)[2]) {
      return static_cast<std::int32_t>((ends[0] * (1024 - t) + ends[1] * t) / 1024);
    };
    const int x = along(s.x) + random.between(-s.reach, s.reach);
    const int y = along(s.y) + random.between(-s.reach, s.reach);

    ASSERT_TRUE(overlaps(s, square(x - 3, y - 3, 3)));
  }
}

}  // namespace
}  // namespace samestep
