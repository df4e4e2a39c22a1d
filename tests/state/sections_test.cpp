// SPDX-License-Identifier: MIT
// The list of sections of a world is complete, and whatever goes by it sees each of them.
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/error.h>
#include <samestep/space.h>
#include <samestep/space_codec.h>
#include "context/saved_records.h"
#include "state/state_hash.h"
#include "support/fields.h"
#include "support/joints.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class SectionsTest : public ::testing::Test {
 protected:
  SectionsTest() {
    space_.registerHandler(1, {});
    space_.addWildcardHandler(1, 1);
    space_.addCollisionHandler(1, 2, 1);
    for (int i = 0; i < 3; ++i) addDisc<S>(space_, {ratio<S>(3 * i, 2), S(0)}, S(1), S(1));
    addResting(space_, {S(20), S(0)});
    joinNeighbours(space_);
    space_.step(kTick<S>);
  }
  static std::vector<std::uint8_t> bytesOf(const WorldState<S>& world) {
    std::vector<std::uint8_t> bytes;
    encodeWorld(world, bytes);
    return bytes;
  }
  static std::uint64_t hashOfAll(const WorldState<S>& world) {
    return hashOfWorld(world, hashOfShapes(world.shapes));
  }
  /// Calls check(world, name) for worlds each of which differs in one field or section.
  template <class Check>
  void eachChanged(Check&& check) {
    for (int target = 0;; ++target) {
      WorldState<S> world = space_.state();
      const std::string changed = changeSection(world, target);
      if (changed.empty()) return;
      check(world, changed);
    }
  }

  Space<S> space_;
};
TYPED_TEST_SUITE(SectionsTest, AllScalars);

TYPED_TEST(SectionsTest, TheListAccountsForEveryByteOfAWorld) {
  using S = TypeParam;
  const WorldState<S> world;
  std::vector<int> visits(sizeof world);
  const auto note = [&](const auto&, const auto& part) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(&part);
    const auto at = static_cast<std::size_t>(first - reinterpret_cast<const std::uint8_t*>(&world));
    // An id is followed by room up to the next multiple of 8.
    for (std::size_t i = 0; i < (sizeof part + 7) / 8 * 8; ++i) ++visits.at(at + i);
  };
  WorldState<S>::sections(note, world);
  EXPECT_EQ(visits, std::vector<int>(sizeof world, 1));
}

TYPED_TEST(SectionsTest, EachSectionHasALimitOfItsOwn) {
  using S = TypeParam;
  WorldLimits limits{};
  std::uint32_t sections = 0;
  const auto count = [&](const auto& section, const auto&) {
    if constexpr (requires { section.limit; }) limits.*section.limit = ++sections;
  };
  WorldState<S>::sections(count, this->space_.state());
  EXPECT_EQ(sections, 6u);
  std::uint32_t place = 0;
  const auto compare = [&](const auto& section, const auto&) {
    if constexpr (requires { section.limit; }) {
      EXPECT_EQ(limits.*section.limit, ++place);
    }
  };
  WorldState<S>::sections(compare, this->space_.state());
}

TYPED_TEST(SectionsTest, TheHashSeesEachOfThem) {
  const std::uint64_t before = this->hashOfAll(this->space_.state());
  ASSERT_EQ(before, this->space_.hash());
  this->eachChanged(
      [&](const auto& world, const std::string& name) { EXPECT_NE(this->hashOfAll(world), before) << name; });
}

TYPED_TEST(SectionsTest, TheBytesHoldEachOfThem) {
  using S = TypeParam;
  const auto before = this->bytesOf(this->space_.state());
  std::uint64_t offset = 0;
  const WorldState<S> back = decodeWorld<S>(before, offset);
  EXPECT_EQ(offset, before.size());
  EXPECT_EQ(this->bytesOf(back), before);
  EXPECT_EQ(this->hashOfAll(back), this->space_.hash());
  this->eachChanged(
      [&](const auto& world, const std::string& name) { EXPECT_NE(this->bytesOf(world), before) << name; });
}

TYPED_TEST(SectionsTest, ASavedWorldHoldsEachOfThem) {
  using S = TypeParam;
  SavedRecords<S> records;
  WorldState<S> back;
  this->eachChanged([&](const WorldState<S>& world, const std::string& name) {
    records.take(world);
    records.giveTo(back);
    EXPECT_EQ(this->hashOfAll(back), this->hashOfAll(world)) << name;
  });
  records.take(this->space_.state());
  records.giveTo(back);
  EXPECT_EQ(this->hashOfAll(back), this->space_.hash());
}

// Fields, and of a body its rotation: nothing that the next step computes anyway.
TYPED_TEST(SectionsTest, ASavedRecordTakesNoMoreThanItsState) {
  using S = TypeParam;
  const auto bytesOf = [](const WorldState<S>& world) {
    SavedRecords<S> records;
    records.take(world);
    return records.bytes();
  };
  WorldState<S> world = this->space_.state();
  const std::uint64_t all = bytesOf(world);
  world.pairs.pop_back();
  EXPECT_EQ(all - bytesOf(world), leavesOf(Pair<S>()).bytes());
  world = this->space_.state();
  world.bodies.insert(Body<S>());
  EXPECT_EQ(bytesOf(world) - all, leavesOf(Body<S>()).bytes() + sizeof(Vector<S>) + sizeof(std::uint32_t));
}

TYPED_TEST(SectionsTest, AReaderTakesNoMoreOfEachThanItsLimit) {
  using S = TypeParam;
  const WorldState<S>& world = this->space_.state();
  const auto bytes = this->bytesOf(world);
  WorldLimits exact{};
  const auto allow = [&](const auto& section, const auto& records) {
    if constexpr (requires { records.slots(); }) exact.*section.limit = records.slots();
    if constexpr (requires { records.data(); }) {
      exact.*section.limit = static_cast<std::uint32_t>(records.size());
    }
  };
  WorldState<S>::sections(allow, world);
  EXPECT_EQ(flawOf(world, exact), nullptr);
  std::uint64_t offset = 0;
  EXPECT_NO_THROW(decodeWorld<S>(bytes, offset, exact));
  const auto refuse = [&](const auto& section, const auto&) {
    if constexpr (requires { section.limit; }) {
      WorldLimits less = exact;
      --(less.*section.limit);
      EXPECT_STREQ(flawOf(world, less), section.tooMany);
      std::uint64_t from = 0;
      EXPECT_THROW(decodeWorld<S>(bytes, from, less), FormatError) << section.object;
    }
  };
  WorldState<S>::sections(refuse, world);
}

TYPED_TEST(SectionsTest, EachRecordIsChecked) {
  using S = TypeParam;
  const auto flawAfter = [&](auto&& change) {
    WorldState<S> world = this->space_.state();
    change(world);
    return std::string(flawOf(world));
  };
  EXPECT_EQ(flawOf(this->space_.state()), nullptr);
  EXPECT_EQ(flawAfter([](auto& w) { w.settings.iterations = 0; }), "a setting is out of range");
  EXPECT_EQ(flawAfter([](auto& w) { w.timeStep = S(2); }), "the time step is out of range");
  EXPECT_EQ(flawAfter([](auto& w) { w.staticBody.generation += 2; }), "there is no static body");
  const auto noType = [](const char*, auto& field) {
    if constexpr (std::is_same_v<decltype(field), BodyType&>) field = static_cast<BodyType>(9);
  };
  EXPECT_EQ(flawAfter([&](auto& w) { Body<S>::fields(w.bodies.valueAt(1), noType); }), "a body is malformed");
  EXPECT_EQ(flawAfter([](auto& w) {
              w.shapes.valueAt(0).setBody(BodyId{4000, 1});
            }),
            "a shape is on a body that does not exist");
  EXPECT_EQ(flawAfter([](auto& w) { w.pairs[0].count = kMaxContactsPerPair + 1; }), "a pair is malformed");
  EXPECT_EQ(flawAfter([](auto& w) { w.restingPairs[0].count = kMaxContactsPerPair + 1; }),
            "a pair is malformed");
  EXPECT_EQ(flawAfter([](auto& w) { w.pairs.push_back(w.restingPairs[0]); }),
            "a pair rests among those that do not");
  EXPECT_EQ(flawAfter([](auto& w) { w.restingPairs.insert(w.restingPairs.begin(), w.pairs[0]); }),
            "a pair is there twice");
  EXPECT_EQ(flawAfter([](auto& w) { w.handlers[0].number = 0; }), "a handler is malformed");
  EXPECT_EQ(flawAfter([](auto& w) { w.joints.valueAt(0).lower = S(1); }), "a joint is out of range");
  EXPECT_EQ(flawAfter([](auto& w) {
              w.joints.valueAt(0).bodyA = BodyId{4000, 1};
            }),
            "a joint is on a body that does not exist");
  EXPECT_EQ(flawAfter([](auto& w) { w.joints.valueAt(0).bodyA = w.joints.valueAt(0).bodyB; }),
            "a joint is of one body");
}

TYPED_TEST(SectionsTest, AListOutOfOrderIsAFlawOfTheWorld) {
  using S = TypeParam;
  const auto expectFlaw = [&](auto&& change) {
    WorldState<S> world = this->space_.state();
    change(world);
    EXPECT_STREQ(flawOf(world), "a list is not in order");
  };
  expectFlaw([](auto& w) { std::swap(w.pairs[0], w.pairs[1]); });
  expectFlaw([](auto& w) { w.pairs[1] = w.pairs[0]; });
  expectFlaw([](auto& w) { std::swap(w.handlers[0], w.handlers[1]); });
}

TYPED_TEST(SectionsTest, TheBytesOfASavedWorldCountEachOfThem) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  std::uint64_t before = space.save().bytes();
  const auto grown = [&] {
    const std::uint64_t now = space.save().bytes();
    return now - std::exchange(before, now);
  };
  space.addCollisionHandler(3, 4, 1);
  // What was roused is listed beside the records.
  EXPECT_GE(grown(), leavesOf(HandlerBinding()).bytes());
  joinNeighbours(space);
  EXPECT_GE(grown(), 2 * (leavesOf(Joint<S>()).bytes() + sizeof(std::uint32_t)));
  const ShapeId disc = addDisc<S>(space, {S(1), S(1)}, S(1), S(1));
  EXPECT_GE(grown(), leavesOf(Body<S>()).bytes() + sizeof(Shape<S>) + 2 * sizeof(std::uint32_t));
  const std::size_t pairs = space.state().pairs.size();
  space.step(kTick<S>);
  const std::size_t more = space.state().pairs.size() - pairs;
  ASSERT_GT(more, 0u) << disc.index;
  EXPECT_GE(grown(), more * leavesOf(Pair<S>()).bytes());
}

}  // namespace
}  // namespace samestep
