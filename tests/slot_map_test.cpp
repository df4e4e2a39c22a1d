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
  EXPECT_EQ(map.at<Fault::BodyNotFound>(a), 10);
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
  EXPECT_THROW(map.at<Fault::BodyNotFound>(old), BodyNotFound);
  EXPECT_EQ(map.find(old), nullptr);
  EXPECT_FALSE(map.erase(old));
  EXPECT_EQ(map.size(), 1u);
}

TEST(SlotMapTest, ForeignIdsThrowTheChosenFault) {
  const Map map;

  EXPECT_THROW(map.at<Fault::BodyNotFound>(BodyId{}), BodyNotFound);
  EXPECT_THROW(map.at<Fault::ShapeNotFound>(BodyId{5, 1}), ShapeNotFound);
  EXPECT_FALSE(map.contains(BodyId{0, 0}));
}

TEST(SlotMapTest, AnEvenGenerationNeverNamesAFreeSlot) {
  Map map;
  map.erase(map.insert(1));

  EXPECT_FALSE(map.contains(BodyId{0, 2}));
}

TEST(SlotMapTest, FreedSlotsComeBackLastInFirstOut) {
  Map map;
  std::vector<BodyId> ids;
  for (int i = 0; i < 4; ++i) ids.push_back(map.insert(i));
  map.erase(ids[1]);
  map.erase(ids[3]);
  map.erase(ids[0]);
  EXPECT_THAT(map.freeList(), ElementsAre(1, 3, 0));

  EXPECT_EQ(map.nextId(), (BodyId{0, 3}));
  EXPECT_EQ(map.insert(7), (BodyId{0, 3}));
  EXPECT_EQ(map.insert(7), (BodyId{3, 3}));
  EXPECT_EQ(map.insert(7), (BodyId{1, 3}));
  EXPECT_EQ(map.insert(7), (BodyId{4, 1}));
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
  ASSERT_TRUE(restored.restore(map.values(), map.generations(), map.freeList()));
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

  EXPECT_FALSE(map.restore({0, 0}, Numbers{1}, Numbers{}));            // A generation is missing.
  EXPECT_FALSE(map.restore({0, 0}, Numbers{1, 2}, Numbers{}));         // A free slot is not listed.
  EXPECT_FALSE(map.restore({0, 0}, Numbers{1, 2}, Numbers{0}));        // One in use is.
  EXPECT_FALSE(map.restore({0, 0}, Numbers{2, 2}, Numbers{1, 1}));     // One is listed twice.
  EXPECT_FALSE(map.restore({0, 0}, Numbers{1, 2}, Numbers{1, 2}));     // One does not exist.
  EXPECT_FALSE(map.restore({0}, Numbers{Map::kRetired}, Numbers{0}));  // A retired one is listed.
  EXPECT_EQ(map, before);

  EXPECT_TRUE(map.restore({5, 6}, Numbers{1, 2}, Numbers{1}));
  EXPECT_EQ(map.valueAt(1), 0);
  EXPECT_EQ(map.size(), 1u);
}

TEST(SlotMapTest, ASlotWhoseGenerationsAreUsedUpIsNeverUsedAgain) {
  Map map;
  ASSERT_TRUE(map.restore({5}, {Map::kRetired - 1}, {}));

  EXPECT_TRUE(map.erase(map.idAt(0)));

  EXPECT_EQ(map.insert(6), (BodyId{1, 1}));
  Map restored;
  EXPECT_TRUE(restored.restore(map.values(), map.generations(), map.freeList()));
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
        ASSERT_EQ(map.at<Fault::BodyNotFound>(id), at->second);
      }
    }
  }
}

}  // namespace
}  // namespace samestep
