// SPDX-License-Identifier: MIT
// What a Space lists of contacts: that it agrees with what handlers are told, and depends on nothing else.
#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/space.h>

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The shapes of a list, as "begin 3 9".
std::vector<std::string> words(const char* what, std::span<const ContactEvent> events) {
  std::vector<std::string> all;
  for (const ContactEvent& event : events) {
    all.push_back(what + (" " + std::to_string(event.shapeA.index)) + " " +
                  std::to_string(event.shapeB.index));
  }
  return all;
}
template <Scalar S>
std::vector<std::string> listed(const Space<S>& space) {
  std::vector<std::string> all = words("begin", space.contactEvents().begins);
  for (const std::string& end : words("end", space.contactEvents().ends)) all.push_back(end);
  return all;
}
/// Events, sorted: handlers hear of ends after begins, but of removals between the steps.
std::vector<std::string> sorted(std::vector<std::string> all) {
  std::stable_sort(all.begin(), all.end());
  return all;
}

/// A handler for everything that notes what it is told, in words, and refuses some.
template <Scalar S>
struct Told {
  std::vector<std::string> words;

  static void note(void* data, const char* what, const Arbiter<S>& arbiter) {
    static_cast<Told*>(data)->words.push_back(what + (" " + std::to_string(arbiter.shapeA().index)) + " " +
                                              std::to_string(arbiter.shapeB().index));
  }
  void handle(Space<S>& space) {
    CollisionHandler<S> handler;
    handler.begin = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      note(data, "begin", arbiter);
      return (arbiter.shapeA().index + arbiter.shapeB().index) % 5 != 0;
    };
    handler.separate = [](Arbiter<S>& arbiter, Space<S>&, void* data) { note(data, "end", arbiter); };
    handler.data = this;
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
  }
};

template <Scalar S>
void listAll(Space<S>& space) {
  space.setEventListing({true, true, S(0)});
}

/// Disturbs the world as a game does between steps.
template <Scalar S>
void disturb(Space<S>& space, Random& random) {
  std::vector<BodyId> bodies;
  space.eachBody([&](const Body<S>& body) { bodies.push_back(body.id()); });
  const BodyId chosen = bodies[random.below(static_cast<std::uint32_t>(bodies.size()))];
  if (chosen == space.staticBody()) return;
  switch (random.below(6)) {
    case 0:
      return space.removeWithShapes(chosen);
    case 1:
      return space.filterArbiters(chosen);
    case 2:
      return space.setType(chosen, random.oneIn(2) ? BodyType::staticBody : BodyType::dynamicBody);
    case 3:
      return space.body(chosen).setPosition({random.number<S>(-7, 7), random.number<S>(-5, 8)});
    default:
      addDisc(space, Vector<S>(random.number<S>(-7, 7), random.number<S>(-5, 8)), S(1), S(1));
  }
}

template <Scalar S>
class ContactEventsTest : public ::testing::Test {};
TYPED_TEST_SUITE(ContactEventsTest, AllScalars);

TYPED_TEST(ContactEventsTest, NothingIsListedUntilAskedFor) {
  Space<TypeParam> space;
  fillAtRandom(space, 1);
  hashesOf(space, 60);
  EXPECT_EQ(space.contactEvents().tick, 0u);
  EXPECT_TRUE(space.contactEvents().begins.empty());
  EXPECT_TRUE(space.contactEvents().impacts.empty());
}

TYPED_TEST(ContactEventsTest, ListsAgreeWithWhatHandlersAreTold) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    Space<TypeParam> space;
    fillAtRandom(space, seed);
    if (seed % 2 != 0) space.setSolver(SolverKind::sequentialImpulses);
    Told<TypeParam> told;
    told.handle(space);
    listAll(space);
    Random random(seed);
    for (int tick = 0; tick < 90; ++tick) {
      if (random.oneIn(6)) disturb(space, random);
      space.step(kTick<TypeParam>);
      ASSERT_EQ(sorted(listed(space)), sorted(told.words)) << "seed " << seed << " tick " << tick;
      ASSERT_EQ(space.contactEvents().tick, space.stamp());
      told.words.clear();
    }
  }
}

TYPED_TEST(ContactEventsTest, ListsChangeNoResult) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Space<TypeParam> plain, listing;
    fillAtRandom(plain, seed);
    fillAtRandom(listing, seed);
    listAll(listing);
    EXPECT_EQ(hashesOf(plain, 60), hashesOf(listing, 60));
  }
}

TYPED_TEST(ContactEventsTest, ListsRiseByIds) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Space<TypeParam> space;
    fillAtRandom(space, seed);
    listAll(space);
    Random random(seed);
    const auto rises = [](const auto& a, const auto& b) {
      return std::pair(a.shapeA, a.shapeB) < std::pair(b.shapeA, b.shapeB);
    };
    for (int tick = 0; tick < 60; ++tick) {
      disturb(space, random);
      disturb(space, random);
      space.step(kTick<TypeParam>);
      const ContactEvents<TypeParam> events = space.contactEvents();
      for (const auto& list : {events.begins, events.ends}) {
        EXPECT_TRUE(std::is_sorted(list.begin(), list.end(), rises));
        for (const ContactEvent& event : list) EXPECT_LT(event.shapeA, event.shapeB);
      }
      EXPECT_TRUE(std::is_sorted(events.impacts.begin(), events.impacts.end(), rises));
    }
  }
}

/// A pile of objects with given ids, put in forwards or backwards.
template <Scalar S>
void fillGiven(Space<S>& space, bool backwards) {
  space.setGravity({S(0), S(-10)});
  constexpr std::uint32_t kCount = 300;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const std::uint32_t index = 1 + (backwards ? kCount - 1 - i : i);
    Body<S> body = index == 1 ? Body<S>::fixedInPlace() : Body<S>();
    if (index != 1) body.setPosition({S(static_cast<int>(index % 20)), S(static_cast<int>(2 + index / 20))});
    const BodyId id = space.add(body, {index, 1});
    Shape<S> shape = index == 1 ? boxShape(id, S(80), S(2)) : circleShape(id, ratio<S>(9, 16));
    if (index != 1) shape.setMass(S(1));
    shape.setElasticity(ratio<S>(1, 2));
    space.add(shape, {index, 1});
  }
}

template <Scalar S>
void expectSameLists(const Space<S>& a, const Space<S>& b) {
  const auto same = [](const auto& one, const auto& other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end());
  };
  EXPECT_TRUE(same(a.contactEvents().begins, b.contactEvents().begins));
  EXPECT_TRUE(same(a.contactEvents().ends, b.contactEvents().ends));
  EXPECT_TRUE(same(a.contactEvents().impacts, b.contactEvents().impacts));
}

TYPED_TEST(ContactEventsTest, ListsDependOnNeitherOrderOfCreationNorWorkers) {
  WorkerPool pool(3);
  Space<TypeParam> forwards, backwards;
  fillGiven(forwards, false);
  fillGiven(backwards, true);
  backwards.setWorkers(&pool, Sharing::always);
  listAll(forwards);
  listAll(backwards);
  std::size_t listedInAll = 0;
  for (int tick = 0; tick < 60; ++tick) {
    forwards.step(kTick<TypeParam>);
    backwards.step(kTick<TypeParam>);
    ASSERT_NO_FATAL_FAILURE(expectSameLists(forwards, backwards));
    listedInAll += forwards.contactEvents().begins.size() + forwards.contactEvents().impacts.size();
  }
  EXPECT_GT(listedInAll, 100u);
}

TYPED_TEST(ContactEventsTest, ARestoredWorldListsWhatItListedBefore) {
  Space<TypeParam> space, twin;
  fillAtRandom(space, 5);
  fillAtRandom(twin, 5);
  listAll(space);
  listAll(twin);
  hashesOf(space, 20);
  hashesOf(twin, 20);
  const SavedSpace<TypeParam> saved = space.save();
  hashesOf(space, 15);
  space.restore(saved);
  EXPECT_EQ(space.contactEvents().tick, 0u);
  for (int tick = 0; tick < 15; ++tick) {
    space.step(kTick<TypeParam>);
    twin.step(kTick<TypeParam>);
    expectSameLists(space, twin);
  }
}

TYPED_TEST(ContactEventsTest, WhatIsTakenBackIsNotListed) {
  using S = TypeParam;
  Space<S> space;
  addBox(space, Vector<S>(S(0), S(0)), S(1), S(1), S(1));
  const ShapeId other = addBox(space, Vector<S>(ratio<S>(3, 4), S(0)), S(1), S(1), S(1));
  listAll(space);
  space.step(kTick<S>);
  EXPECT_THAT(listed(space), ElementsAre("begin 0 1"));
  const SavedSpace<S> saved = space.save();
  space.remove(other);
  space.restore(saved);
  space.step(kTick<S>);
  EXPECT_THAT(listed(space), IsEmpty());
}

TYPED_TEST(ContactEventsTest, ARemovedShapeEndsItsContactsInTheNextStep) {
  using S = TypeParam;
  Space<S> space;
  addBox(space, Vector<S>(S(0), S(0)), S(1), S(1), S(1));
  const ShapeId other = addBox(space, Vector<S>(ratio<S>(3, 4), S(0)), S(1), S(1), S(1));
  const BodyId body = bodyOf(space, other);
  listAll(space);
  space.step(kTick<S>);
  space.removeWithShapes(body);
  EXPECT_THAT(listed(space), ElementsAre("begin 0 1"));
  space.step(kTick<S>);
  EXPECT_THAT(listed(space), ElementsAre("end 0 1"));
  const ContactEvent& end = space.contactEvents().ends[0];
  EXPECT_EQ(end.shapeB, other);
  EXPECT_EQ(end.bodyB, body);
  EXPECT_EQ(end.removal, 1);
  space.step(kTick<S>);
  EXPECT_THAT(listed(space), IsEmpty());
}

TYPED_TEST(ContactEventsTest, ASensorListsWhatEntersIt) {
  using S = TypeParam;
  Space<S> space;
  Shape<S> gate = boxShape(space.staticBody(), S(4), S(1));
  gate.setSensor(true);
  space.add(gate);
  addDisc(space, Vector<S>(S(0), S(2)), ratio<S>(1, 4), S(1), Vector<S>(S(0), S(-8)));
  listAll(space);
  std::vector<std::string> all;
  for (int tick = 0; tick < 64; ++tick) {
    space.step(kTick<S>);
    for (const std::string& word : listed(space)) all.push_back(word);
    for (const ContactEvent& event : space.contactEvents().begins) EXPECT_EQ(event.sensor, 1);
    EXPECT_TRUE(space.contactEvents().impacts.empty());
  }
  EXPECT_THAT(all, ElementsAre("begin 0 1", "end 0 1"));
}

TYPED_TEST(ContactEventsTest, AnImpactTellsPlaceDirectionSpeedAndImpulse) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    Space<S> space;
    space.setSolver(solver);
    addWall(space, Vector<S>(S(-5), S(0)), Vector<S>(S(5), S(0)));
    addDisc(space, Vector<S>(S(0), S(2)), S(1), S(3), Vector<S>(S(0), S(-8)));
    listAll(space);
    int impacts = 0;
    for (int tick = 0; tick < 40; ++tick) {
      space.step(kTick<S>);
      for (const ImpactEvent<S>& impact : space.contactEvents().impacts) {
        if (++impacts > 1) continue;
        EXPECT_EQ(impact.speed, S(8));
        EXPECT_NEAR(static_cast<double>(impact.normal.y), 1, 1e-6);
        EXPECT_NEAR(static_cast<double>(impact.point.y), 0, 1.0 / 8);
        // It takes all of 3 kg at 8 m/s.
        EXPECT_NEAR(static_cast<double>(impact.impulse), 24, 2);
      }
    }
    EXPECT_GE(impacts, 1);
  }
}

TYPED_TEST(ContactEventsTest, SlowImpactsAndRestAreNotListed) {
  using S = TypeParam;
  Space<S> space;
  space.setGravity({S(0), S(-10)});
  addWall(space, Vector<S>(S(-5), S(0)), Vector<S>(S(5), S(0)));
  addBox(space, Vector<S>(S(0), S(1)), S(1), S(1), S(1));
  space.setEventListing({false, true, S(1)});
  int impacts = 0;
  for (int tick = 0; tick < 120; ++tick) {
    space.step(kTick<S>);
    impacts += static_cast<int>(space.contactEvents().impacts.size());
    EXPECT_TRUE(space.contactEvents().begins.empty());
  }
  EXPECT_GE(impacts, 1);
  EXPECT_LE(impacts, 3);
  space.setEventListing({false, true, S(2000)});
  addDisc(space, Vector<S>(S(3), S(3)), S(1), S(1), Vector<S>(S(0), S(-100)));
  for (int tick = 0; tick < 30; ++tick) {
    space.step(kTick<S>);
    EXPECT_TRUE(space.contactEvents().impacts.empty());
  }
}

TYPED_TEST(ContactEventsTest, AStepThatIsRefusedLeavesTheLists) {
  using S = TypeParam;
  Space<S> space;
  addBox(space, Vector<S>(S(0), S(0)), S(1), S(1), S(1));
  addBox(space, Vector<S>(ratio<S>(3, 4), S(0)), S(1), S(1), S(1));
  listAll(space);
  space.step(kTick<S>);
  addBox(space, Vector<S>(S(0), ratio<S>(3, 4)), S(1), S(1), S(1));
  space.setMaxPairs(1);
  EXPECT_THROW(space.step(kTick<S>), TooManyPairs);
  EXPECT_THAT(listed(space), ElementsAre("begin 0 1"));
  space.setMaxPairs(100);
  space.step(kTick<S>);
  EXPECT_THAT(listed(space), ::testing::Not(IsEmpty()));
}

TYPED_TEST(ContactEventsTest, RefusesSpeedsOutOfRangeAndALockedSpace) {
  using S = TypeParam;
  Space<S> space;
  expectRefused<ValueOutOfRange>(space, [&] { space.setEventListing({true, true, S(-1)}); });
  expectRefused<ValueOutOfRange>(space, [&] { space.setEventListing({true, true, S(2049)}); });
  EXPECT_FALSE(space.eventListing().contacts);
  space.lock();
  expectRefused<SpaceLocked>(space, [&] { space.setEventListing({true, true, S(1)}); });
  space.unlock(false);
}

}  // namespace
}  // namespace samestep
