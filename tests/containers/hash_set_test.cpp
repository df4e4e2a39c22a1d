// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <samestep/hash_set.h>

#include <algorithm>
#include <vector>

#include "support/random.h"

namespace samestep {
namespace {

using ::testing::ElementsAre;

struct Item {
  int key = -1;
  int value = 0;

  friend bool operator==(const Item&, const Item&) = default;
};

struct KeyEquals {
  bool operator()(int key, const Item& item) const { return key == item.key; }
  bool operator()(const Item& a, const Item& b) const { return a.key == b.key; }
};

using Items = HashSet<Item, KeyEquals>;

// Few buckets for many keys: collisions are the rule.
HashValue hashOf(int key) { return static_cast<HashValue>(key % 7); }

std::vector<int> keys(const Items& set) {
  std::vector<int> all;
  set.each([&all](const Item& item) { all.push_back(item.key); });
  return all;
}

Items setOf(std::initializer_list<int> list) {
  Items set;
  for (const int key : list) set.insert(hashOf(key), Item{key, 10 * key});
  return set;
}

TEST(HashSetTest, HashPairIsSymmetricAnd64BitsWide) {
  EXPECT_EQ(hashPair(3, 5), hashPair(5, 3));
  EXPECT_EQ(hashPair(0, HashValue{1} << 32), kHashCoef << 32);
  static_assert(kHashCoef == 3344921057u);
}

TEST(HashSetTest, SizeBeyondTheLimitThrowsIllegalSize) {
  EXPECT_THROW(Items(std::size_t{1610612742}), IllegalSize);
}

struct Huge {
  char bytes[33 * 1024] = {};
};
struct HugeEquals {
  bool operator()(int, const Huge&) const { return false; }
};

TEST(HashSetTest, ElementsLargerThanABufferThrowInsufficientBufferSize) {
  HashSet<Huge, HugeEquals> set;

  EXPECT_THROW(set.insert(1, 1, [](int) { return Huge(); }), InsufficientBufferSize);

  EXPECT_EQ(set.count(), 0u);
}

TEST(HashSetTest, InsertStoresWhatTheTransformMakes) {
  Items set(3);

  const Item& stored = set.insert(hashOf(4), 4, [](int key) { return Item{key, 44}; });

  EXPECT_EQ(stored, (Item{4, 44}));
  EXPECT_EQ(set.find(hashOf(4), 4), (Item{4, 44}));
  EXPECT_EQ(set.count(), 1u);
}

TEST(HashSetTest, InsertOfAnEqualElementReturnsTheOldOne) {
  Items set = setOf({4});

  const Item& stored = set.insert(hashOf(4), Item{4, 99});

  EXPECT_EQ(stored.value, 40);
  EXPECT_EQ(set.count(), 1u);
}

TEST(HashSetTest, FindOfAbsentElementGivesTheDefaultValue) {
  Items set = setOf({4});
  EXPECT_EQ(set.find(hashOf(5), 5), Item());

  set.setDefaultValue({-7, -7});

  EXPECT_EQ(set.find(hashOf(5), 5), (Item{-7, -7}));
  EXPECT_EQ(set.defaultValue(), (Item{-7, -7}));
  EXPECT_EQ(Items().find(0, 0), Item());
}

TEST(HashSetTest, LookupGivesAPointerOrNull) {
  Items set = setOf({4});

  set.lookup(hashOf(4), 4)->value = 5;

  EXPECT_EQ(set.find(hashOf(4), 4).value, 5);
  EXPECT_EQ(set.lookup(hashOf(5), 5), nullptr);
}

TEST(HashSetTest, RemoveReturnsTheElementOrNothing) {
  Items set = setOf({1, 8, 15});

  EXPECT_EQ(set.remove(hashOf(8), 8), (Item{8, 80}));
  EXPECT_EQ(set.remove(hashOf(8), 8), std::nullopt);
  EXPECT_EQ(Items().remove(0, 0), std::nullopt);

  EXPECT_EQ(set.count(), 2u);
  EXPECT_EQ(set.find(hashOf(15), 15).value, 150);
}

TEST(HashSetTest, EachVisitsInOrderOfInsertionAndErasingKeepsTheOrder) {
  Items set = setOf({9, 2, 7, 1, 5});
  EXPECT_THAT(keys(set), ElementsAre(9, 2, 7, 1, 5));

  set.remove(hashOf(7), 7);
  EXPECT_THAT(keys(set), ElementsAre(9, 2, 1, 5));
  set.insert(hashOf(7), Item{7, 0});

  EXPECT_THAT(keys(set), ElementsAre(9, 2, 1, 5, 7));
}

TEST(HashSetTest, FilterKeepsWhatTheTestAcceptsAskedInOrder) {
  Items set = setOf({9, 2, 7, 1, 4});
  std::vector<int> asked;

  set.filter([&asked](const Item& item) {
    asked.push_back(item.key);
    return item.key % 2 == 1;
  });

  EXPECT_THAT(asked, ElementsAre(9, 2, 7, 1, 4));
  EXPECT_THAT(keys(set), ElementsAre(9, 7, 1));
  EXPECT_EQ(set.find(hashOf(2), 2), Item());
}

TEST(HashSetTest, ClearEmptiesAndTheSetWorksOn) {
  Items set = setOf({1, 2, 3});

  set.clear();
  set.insert(hashOf(2), Item{2, 5});

  EXPECT_THAT(keys(set), ElementsAre(2));
}

// The model: a vector in order of insertion.
TEST(HashSetTest, AgreesWithAPlainListUnderRandomOperations) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Items set;
    std::vector<Item> model;
    for (int step = 0; step < 3000; ++step) {
      const int key = random.between(0, 60);
      const auto at =
          std::find_if(model.begin(), model.end(), [key](const Item& item) { return item.key == key; });
      const std::uint32_t action = random.below(100);
      if (action < 50) {
        const Item stored = set.insert(hashOf(key), Item{key, step});
        const Item expected = at == model.end() ? Item{key, step} : *at;
        if (at == model.end()) model.push_back(expected);
        ASSERT_EQ(stored, expected);
      } else if (action < 98) {
        const std::optional<Item> removed = set.remove(hashOf(key), key);
        ASSERT_EQ(removed.has_value(), at != model.end());
        if (at != model.end()) model.erase(at);
      } else {
        const int divisor = random.between(2, 5);
        const auto keep = [divisor](const Item& item) { return item.value % divisor != 0; };
        set.filter(keep);
        std::erase_if(model, [&keep](const Item& item) { return !keep(item); });
      }
      ASSERT_EQ(set.count(), model.size());
    }
    std::vector<Item> visited;
    set.each([&visited](const Item& item) { visited.push_back(item); });
    ASSERT_EQ(visited, model) << "seed " << seed;
  }
}

TEST(HashSetTest, ACopyHasTheOrderOfItsOriginal) {
  Items set = setOf({9, 2, 7});
  set.remove(hashOf(2), 2);

  Items copy = set;
  copy.insert(hashOf(3), Item{3, 0});

  EXPECT_THAT(keys(copy), ElementsAre(9, 7, 3));
  EXPECT_THAT(keys(set), ElementsAre(9, 7));
}

}  // namespace
}  // namespace samestep
