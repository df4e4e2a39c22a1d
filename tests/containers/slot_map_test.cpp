// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <samestep/slot_map.h>

#include <map>
#include <vector>

#include "support/random.h"

namespace samestep {
namespace {

using ::testing::ElementsAre;

using Map = SlotMap<int, BodyId>;

std::vector<std::uint32_t> indices(const Map& map) {
  std::vector<std::uint32_t> all;
  map.each([&all](BodyId id, int) { all.push_back(id.index); });
  return all;
}

TEST(SlotMapTest, IdsCountUpAndNameTheirValues) {
  Map map;

  const BodyId a = map.insert(10);
  const BodyId b = map.insert(11);

  EXPECT_EQ(a, (BodyId{0, 1}));
  EXPECT_EQ(b, (BodyId{1, 1}));
  EXPECT_EQ(map.at<Fault::BodyNotFound>(a, "a test"), 10);
  EXPECT_EQ(*map.find(b), 11);
  EXPECT_EQ(map.size(), 2u);
}

TEST(SlotMapTest, AnErasedIdNamesNothingEvenWhenItsSlotIsUsedAgain) {
  Map map;
  const BodyId old = map.insert(10);
  EXPECT_TRUE(map.erase(old));
  EXPECT_FALSE(map.contains(old));
  EXPECT_EQ(map.valueAt(0), 0);

  const BodyId fresh = map.insert(20);

  EXPECT_EQ(fresh, (BodyId{0, 3}));
  EXPECT_FALSE(map.contains(old));
  EXPECT_THROW(map.at<Fault::BodyNotFound>(old, "a test"), BodyNotFound);
  EXPECT_EQ(map.find(old), nullptr);
  EXPECT_FALSE(map.erase(old));
  EXPECT_EQ(map.size(), 1u);
}

TEST(SlotMapTest, ForeignIdsThrowTheChosenFault) {
  const Map map;

  EXPECT_THROW(map.at<Fault::BodyNotFound>(BodyId{}, "a test"), BodyNotFound);
  EXPECT_THROW(map.at<Fault::ShapeNotFound>(BodyId{5, 1}, "a test"), ShapeNotFound);
  EXPECT_FALSE(map.contains(BodyId{0, 0}));
}

TEST(SlotMapTest, AnEvenGenerationNeverNamesAFreeSlot) {
  Map map;
  map.erase(map.insert(1));

  EXPECT_FALSE(map.contains(BodyId{0, 2}));
}

TEST(SlotMapTest, TheLowestFreeSlotIsUsedNext) {
  for (const auto& order : {std::vector<std::size_t>{1, 3, 0}, {0, 1, 3}, {3, 0, 1}}) {
    Map map;
    std::vector<BodyId> ids;
    for (int i = 0; i < 4; ++i) ids.push_back(map.insert(i));
    for (const std::size_t gone : order) map.erase(ids[gone]);

    EXPECT_EQ(map.nextId(), (BodyId{0, 3}));
    EXPECT_EQ(map.insert(7), (BodyId{0, 3}));
    EXPECT_EQ(map.insert(7), (BodyId{1, 3}));
    EXPECT_EQ(map.insert(7), (BodyId{3, 3}));
    EXPECT_EQ(map.insert(7), (BodyId{4, 1}));
  }
}

TEST(SlotMapTest, AGivenIdNamesItsValueAndLeavesFreeSlotsBelow) {
  Map map;

  map.insertAt({3, 5}, 42);

  EXPECT_EQ(map.slots(), 4u);
  EXPECT_EQ(map.size(), 1u);
  EXPECT_EQ(map.at<Fault::BodyNotFound>({3, 5}, "a test"), 42);
  EXPECT_EQ(map.insert(1), (BodyId{0, 1}));
  map.insertAt({2, 1}, 2);
  EXPECT_EQ(map.insert(3), (BodyId{1, 1}));
  EXPECT_EQ(map.insert(4), (BodyId{4, 1}));
  EXPECT_TRUE(map.erase({3, 5}));
  EXPECT_EQ(map.nextId(), (BodyId{3, 7}));
}

TEST(SlotMapTest, AnIdIsGivenOnceAndNoHigherThanMemoryAllows) {
  Map map;
  map.insertAt({2, 3}, 1);
  map.erase(map.insert(0));
  const Map before = map;

  EXPECT_THROW(map.insertAt({2, 3}, 7), IllegalId);
  EXPECT_THROW(map.insertAt({2, 5}, 7), IllegalId) << "in use";
  EXPECT_THROW(map.insertAt({0, 1}, 7), IllegalId) << "was in use";
  EXPECT_THROW(map.insertAt({0, 4}, 7), IllegalId) << "even";
  EXPECT_THROW(map.insertAt({1, 0}, 7), IllegalId) << "even";
  EXPECT_THROW(map.insertAt({1, 0xffffffffu}, 7), IllegalId) << "past the last one";
  EXPECT_THROW(map.insertAt({Map::kMaxGivenSlots, 1}, 7), IndexOutOfBounds);
  EXPECT_THROW(map.insertAt({}, 7), IndexOutOfBounds);
  EXPECT_EQ(map, before);
  EXPECT_EQ(map.slots(), 3u);

  map.insertAt({1, Map::kRetired - 1}, 7);
  EXPECT_TRUE(map.erase({1, Map::kRetired - 1}));
  EXPECT_THROW(map.insertAt({1, 1}, 7), IllegalId);
  map.insertAt({Map::kMaxGivenSlots - 1, 1}, 7);
  EXPECT_EQ(map.slots(), Map::kMaxGivenSlots);
}

// Objects that come and go under the same ids do not tell in which order.
TEST(SlotMapTest, TheOrderOfGivenIdsDoesNotShow) {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    Map first, second;
    for (Map* map : {&first, &second}) {
      std::vector<std::uint32_t> slots;
      for (std::uint32_t i = 0; i < 20; ++i) slots.push_back(i);
      const auto shuffle = [&] {
        for (std::size_t i = slots.size(); i > 1; --i) {
          std::swap(slots[i - 1], slots[random.below(static_cast<std::uint32_t>(i))]);
        }
      };
      shuffle();
      for (const std::uint32_t slot : slots) map->insertAt({slot, 1}, static_cast<int>(slot));
      shuffle();
      for (const std::uint32_t slot : slots) {
        if (slot % 3 != 0) map->erase({slot, 1});
      }
      shuffle();
      for (const std::uint32_t slot : slots) {
        if (slot % 3 == 1) map->insertAt({slot, 3}, static_cast<int>(slot));
      }
    }
    ASSERT_EQ(first, second);
    for (int i = 0; i < 10; ++i) ASSERT_EQ(first.insert(i), second.insert(i));
  }
}

TEST(SlotMapTest, EachVisitsByRisingIndex) {
  Map map;
  std::vector<BodyId> ids;
  for (int i = 0; i < 5; ++i) ids.push_back(map.insert(i));
  map.erase(ids[3]);
  map.erase(ids[1]);
  map.insert(9);

  EXPECT_THAT(indices(map), ElementsAre(0, 1, 2, 4));
}

TEST(SlotMapTest, ARestoredStateGivesOutTheSameIds) {
  Random random(5);
  Map map;
  std::vector<BodyId> ids;
  for (int i = 0; i < 200; ++i) {
    if (ids.empty() || random.oneIn(2)) {
      ids.push_back(map.insert(i));
    } else {
      map.erase(ids[random.below(static_cast<std::uint32_t>(ids.size()))]);
    }
  }
  Map restored;
  ASSERT_TRUE(restored.restore(map.values(), map.generations()));
  Map copy = map;
  EXPECT_EQ(restored, map);

  for (int i = 0; i < 200; ++i) {
    const BodyId id = map.insert(i);
    ASSERT_EQ(restored.insert(i), id);
    ASSERT_EQ(copy.insert(i), id);
  }
}

TEST(SlotMapTest, RestoreRefusesBrokenStatesAndKeepsTheOldOne) {
  Map map;
  map.insert(42);
  const Map before = map;
  using Numbers = std::vector<std::uint32_t>;

  EXPECT_FALSE(map.restore({0, 0}, Numbers{1}));                     // A generation is missing.
  EXPECT_FALSE(map.restore({0, 0}, Numbers{1, Map::kRetired + 1}));  // One is too high.
  EXPECT_EQ(map, before);

  EXPECT_TRUE(map.restore({5, 6}, Numbers{1, 2}));
  EXPECT_EQ(map.valueAt(1), 0);
  EXPECT_EQ(map.size(), 1u);
}

// A restore uses this: values of slots in use may stay, those of slots that are free now may not.
TEST(SlotMapTest, SlotsSetInPlaceGiveOutTheSameIds) {
  Map map;
  for (int i = 0; i < 40; ++i) map.insert(i + 1);
  for (std::uint32_t i = 0; i < 40; i += 3) map.erase(map.idAt(i));
  map.insert(7);
  for (const int before : {0, 5, 40, 80}) {
    Map set;
    for (int i = 0; i < before; ++i) set.insert(100 + i);
    if (before > 6) set.erase(set.idAt(6));
    set.setSlots(map.slots(), [&](std::uint32_t slot) { return map.generationAt(slot); });
    EXPECT_EQ(set.size(), map.size());
    for (std::uint32_t slot = 0; slot < set.slots(); ++slot) {
      if (!set.aliveAt(slot)) {
        EXPECT_EQ(set.valueAt(slot), 0);
      } else {
        set.valueAt(slot) = map.valueAt(slot);
      }
    }
    EXPECT_EQ(set, map);
    Map again = map;
    for (int i = 0; i < 30; ++i) ASSERT_EQ(set.insert(i), again.insert(i));
  }
}

TEST(SlotMapTest, ASlotWhoseGenerationsAreUsedUpIsNeverUsedAgain) {
  Map map;
  ASSERT_TRUE(map.restore({5}, {Map::kRetired - 1}));

  EXPECT_TRUE(map.erase(map.idAt(0)));

  EXPECT_EQ(map.insert(6), (BodyId{1, 1}));
  Map restored;
  EXPECT_TRUE(restored.restore(map.values(), map.generations()));
}

TEST(SlotMapTest, ClearForgetsAllIds) {
  Map map;
  map.erase(map.insert(1));

  map.clear();

  EXPECT_EQ(map, Map());
  EXPECT_EQ(map.insert(1), (BodyId{0, 1}));
}

// The model: a map from every id ever given out to its value.
TEST(SlotMapTest, AgreesWithAPlainMapUnderRandomOperations) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    Map map;
    std::map<BodyId, int> model;
    std::vector<BodyId> given;
    for (int step = 0; step < 2000; ++step) {
      if (given.empty() || random.oneIn(2)) {
        const BodyId id = map.insert(step);
        ASSERT_EQ(model.count(id), 0u);
        model[id] = step;
        given.push_back(id);
      } else {
        const BodyId id = given[random.below(static_cast<std::uint32_t>(given.size()))];
        ASSERT_EQ(map.erase(id), model.erase(id) == 1);
      }
      ASSERT_EQ(map.size(), model.size());
    }
    for (const BodyId id : given) {
      const auto at = model.find(id);
      ASSERT_EQ(map.contains(id), at != model.end());
      if (at != model.end()) {
        ASSERT_EQ(map.at<Fault::BodyNotFound>(id, "a test"), at->second);
      }
    }
  }
}

}  // namespace
}  // namespace samestep
