// SPDX-License-Identifier: MIT
// The order in which objects come and go does not show where each has an id of the caller's.
#include <samestep/space.h>

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr int kSteps = 90;

/// A body with its shapes, and when it is there: each time under the next generations of the same slots.
template <Scalar S>
struct Actor {
  struct Stay {
    int from;
    int to;
  };
  std::uint32_t slot;
  Body<S> body;
  Vector<S> position;
  std::vector<Shape<S>> shapes;
  std::vector<std::uint32_t> shapeSlots;
  std::vector<Stay> stays;
};

/// Random things in a box, of which many are taken away and put in again, some twice.
template <Scalar S>
std::vector<Actor<S>> actorsOf(std::uint64_t seed) {
  Random random(seed);
  std::vector<Actor<S>> actors;
  std::uint32_t shapeSlot = 3;
  const std::uint32_t count = 10 + random.below(15);
  for (std::uint32_t i = 0; i < count; ++i) {
    Actor<S> actor;
    // The slots have gaps.
    actor.slot = 2 + i + i / 4;
    actor.body = random.oneIn(8) ? Body<S>::kinematic() : Body<S>();
    actor.position = {random.number<S>(-7, 7), random.number<S>(-4, 8)};
    actor.body.setVelocity({random.number<S>(-4, 4), random.number<S>(-4, 4)});
    actor.body.setAngularVelocity(random.number<S>(-3, 3));
    actor.body.setAngle(random.number<S>(-3, 3));
    const int parts = random.between(1, 3);
    for (int part = 0; part < parts; ++part) {
      const Vector<S> offset(random.number<S>(-1, 1), random.number<S>(-1, 1));
      const S size = S(1) + random.number<S>(0, 1);
      Shape<S> shape = random.oneIn(2)
                           ? circleShape<S>({}, size * ratio<S>(1, 2), offset)
                           : boxShape<S>({}, BB<S>::forExtents(offset, size, size * ratio<S>(1, 2)));
      shape.setMass(random.number<S>(0, 3) + S(1));
      shape.setFriction(random.number<S>(0, 1));
      shape.setElasticity(random.number<S>(0, 1));
      if (random.oneIn(8)) shape.setSensor(true);
      actor.shapes.push_back(shape);
      actor.shapeSlots.push_back(shapeSlot);
      shapeSlot += 1 + random.below(2);
    }
    int from = random.oneIn(3) ? random.between(1, 30) : 0;
    while (from < kSteps && actor.stays.size() < 3) {
      const int to = random.oneIn(2) ? from + random.between(5, 40) : kSteps;
      actor.stays.push_back({from, to});
      // It may be taken away and be there again at once.
      from = to + (random.oneIn(3) ? 0 : random.between(1, 10));
    }
    actors.push_back(actor);
  }
  return actors;
}

template <class T>
void shuffle(std::vector<T>& items, Random& random) {
  for (std::size_t i = items.size(); i > 1; --i) {
    std::swap(items[i - 1], items[random.below(static_cast<std::uint32_t>(i))]);
  }
}

template <Scalar S>
void enter(Space<S>& space, const Actor<S>& actor, std::uint32_t generation, Random& random) {
  const BodyId id = space.add(actor.body, {actor.slot, generation});
  std::vector<std::size_t> parts;
  for (std::size_t i = 0; i < actor.shapes.size(); ++i) parts.push_back(i);
  shuffle(parts, random);
  for (const std::size_t part : parts) {
    Shape<S> shape = actor.shapes[part];
    shape.setBody(id);
    ASSERT_EQ(space.add(shape, {actor.shapeSlots[part], generation}),
              (ShapeId{actor.shapeSlots[part], generation}));
  }
  // After its shapes, each of which moves the centre of mass: see docs/determinism.md.
  space.body(id).setPosition(actor.position);
  space.body(id).setVelocity(actor.body.velocity());
}

struct Solver {
  SolverKind kind;
  ContactPrecision precision;
};
constexpr Solver kSolvers[] = {{SolverKind::sequentialImpulses, ContactPrecision::accurate},
                               {SolverKind::softStep, ContactPrecision::accurate},
                               {SolverKind::softStep, ContactPrecision::fast}};

/// Plays what happens to all actors, at each step in another order.
template <Scalar S>
class Play {
 public:
  Play(const std::vector<Actor<S>>& actors, const Solver& solver, std::uint64_t seed, bool sleeps = false)
      : actors_(actors), random_(seed) {
    space_.setSolver(solver.kind);
    space_.setPrecision(solver.precision);
    space_.setGravity({S(0), S(-10)});
    // So early that much of what comes and goes meets sleepers.
    if (sleeps) {
      space_.setSleepTimeThreshold(S(6) * kTick<S>);
      space_.setIdleSpeedThreshold(S(1));
    }
    std::vector<std::uint32_t> walls = {0, 1, 2};
    if (seed != 0) shuffle(walls, random_);
    for (const std::uint32_t wall : walls) {
      const Vector<S> corners[][2] = {
          {{S(-8), S(-6)}, {S(8), S(-5)}}, {{S(-8), S(-6)}, {S(-8), S(8)}}, {{S(8), S(-6)}, {S(8), S(8)}}};
      Shape<S> shape = segmentShape(space_.staticBody(), corners[wall][0], corners[wall][1], ratio<S>(1, 4));
      shape.setFriction(S(1));
      space_.add(shape, {wall, 1});
    }
  }

  void step() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < actors_.size(); ++i) order.push_back(i);
    shuffle(order, random_);
    for (const std::size_t i : order) comeAndGo(actors_[i]);
    ++tick_;
    space_.step(kTick<S>);
  }
  Space<S>& space() { return space_; }

 private:
  void comeAndGo(const Actor<S>& actor) {
    for (std::size_t i = 0; i < actor.stays.size(); ++i) {
      const auto generation = static_cast<std::uint32_t>(2 * i + 1);
      if (actor.stays[i].to == tick_) leave(actor, generation);
      if (actor.stays[i].from == tick_) enter(space_, actor, generation, random_);
    }
  }
  void leave(const Actor<S>& actor, std::uint32_t generation) {
    if (random_.oneIn(2)) {
      space_.removeWithShapes({actor.slot, generation});
      return;
    }
    std::vector<std::uint32_t> slots = actor.shapeSlots;
    shuffle(slots, random_);
    for (const std::uint32_t slot : slots) space_.remove(ShapeId{slot, generation});
    space_.remove(BodyId{actor.slot, generation});
  }

  const std::vector<Actor<S>>& actors_;
  Random random_;
  Space<S> space_;
  int tick_ = 0;
};

template <Scalar S>
class OrderTest : public ::testing::Test {};
TYPED_TEST_SUITE(OrderTest, AllScalars);

template <Scalar S>
std::vector<Body<S>> bodiesOf(const Space<S>& space) {
  std::vector<Body<S>> bodies;
  space.eachBody([&](const Body<S>& body) { bodies.push_back(body); });
  return bodies;
}

/// Plays scenes in several orders, and compares.
/// @return the contacts met and the bodies that slept, over all steps
template <Scalar S>
std::pair<std::size_t, std::size_t> playInAnyOrder(bool sleeps) {
  std::size_t contacts = 0, slept = 0;
  for (std::uint64_t scene = 1; scene <= 6; ++scene) {
    const std::vector<Actor<S>> actors = actorsOf<S>(scene);
    for (const Solver& solver : kSolvers) {
      Play<S> reference(actors, solver, 0, sleeps);
      std::vector<std::uint64_t> hashes;
      std::vector<std::vector<Body<S>>> bodies;
      for (int tick = 0; tick < kSteps; ++tick) {
        reference.step();
        hashes.push_back(reference.space().hash());
        bodies.push_back(bodiesOf(reference.space()));
        reference.space().eachArbiter([&](Arbiter<S>&) { ++contacts; });
        for (const Body<S>& body : bodies.back()) slept += body.isSleeping() ? 1 : 0;
      }
      for (std::uint64_t order = 1; order <= 5; ++order) {
        Play<S> other(actors, solver, order, sleeps);
        for (std::size_t tick = 0; tick < kSteps; ++tick) {
          other.step();
          const std::vector<Body<S>> found = bodiesOf(other.space());
          EXPECT_EQ(found.size(), bodies[tick].size());
          for (std::size_t i = 0; i < std::min(found.size(), bodies[tick].size()); ++i) {
            EXPECT_EQ(found[i].id(), bodies[tick][i].id());
            EXPECT_EQ(found[i].position(), bodies[tick][i].position()) << "tick " << tick;
            EXPECT_EQ(found[i].angle(), bodies[tick][i].angle()) << "tick " << tick;
          }
          EXPECT_EQ(other.space().hash(), hashes[tick])
              << "scene " << scene << ", order " << order << ", tick " << tick;
        }
        EXPECT_EQ(other.space().add(Body<S>(S(1), S(1))), (BodyId{1, 1}));
      }
    }
  }
  return {contacts, slept};
}

TYPED_TEST(OrderTest, ObjectsUnderGivenIdsMayComeAndGoInAnyOrder) {
  const auto [contacts, slept] = playInAnyOrder<TypeParam>(false);
  EXPECT_GT(contacts, 5000u);
  EXPECT_EQ(slept, 0u);
}

TYPED_TEST(OrderTest, SoTheyMayWhereBodiesSleep) {
  const auto [contacts, slept] = playInAnyOrder<TypeParam>(true);
  EXPECT_GT(contacts, 5000u);
  EXPECT_GT(slept, 50u);
}

TEST(OrderOfFixedTest, TheShapesOfABodyMayComeInAnyOrderWhereverItIs) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    Body<Fixed> body;
    body.setPosition({random.number<Fixed>(-900, 900), random.number<Fixed>(-900, 900)});
    body.setAngle(random.number<Fixed>(-3, 3));
    body.setVelocity({random.number<Fixed>(-9, 9), random.number<Fixed>(-9, 9)});
    body.setAngularVelocity(random.number<Fixed>(-9, 9));
    std::vector<std::uint32_t> order = {0, 1, 2, 3, 4};
    std::vector<Shape<Fixed>> shapes;
    for (int i = 0; i < 5; ++i) {
      shapes.push_back(
          circleShape<Fixed>({5, 1}, Fixed(1), {random.number<Fixed>(-3, 3), random.number<Fixed>(-3, 3)}));
      shapes.back().setMass(Fixed(1) + random.number<Fixed>(0, 9));
    }
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 6; ++i) {
      Space<Fixed> space;
      space.add(body, {5, 1});
      for (const std::uint32_t shape : order) space.add(shapes[shape], {shape, 1});
      hashes.push_back(space.hash());
      shuffle(order, random);
    }
    EXPECT_EQ(hashes, std::vector<std::uint64_t>(hashes.size(), hashes[0])) << seed;
  }
}

TYPED_TEST(OrderTest, AGivenIdIsCheckedBeforeAnythingChanges) {
  using S = TypeParam;
  Space<S> space;
  const BodyId body = space.add(Body<S>(), {7, 3});
  Shape<S> shape = circleShape(body, S(1));
  shape.setMass(S(2));
  const ShapeId id = space.add(shape, {4, 1});
  EXPECT_EQ(id, (ShapeId{4, 1}));
  EXPECT_EQ(space.shape(id).id(), id);
  EXPECT_EQ(space.body(body).id(), body);

  expectRefused<IllegalId>(space, [&] { space.add(shape, {4, 3}); });
  expectRefused<IllegalId>(space, [&] { space.add(shape, {5, 2}); });
  expectRefused<IndexOutOfBounds>(space, [&] { space.add(shape, {1u << 16, 1}); });
  expectRefused<IndexOutOfBounds>(space, [&] { space.add(shape, ShapeId{}); });
  expectRefused<IllegalId>(space, [&] { space.add(Body<S>(), {7, 1}); });
  expectRefused<IllegalId>(space, [&] { space.add(Body<S>(), space.staticBody()); });
  expectRefused<IndexOutOfBounds>(space, [&] { space.add(Body<S>(), {4000000000u, 1}); });
  expectRefused<DuplicateBody>(space, [&] { space.add(space.body(body), {8, 1}); });
  expectRefused<DuplicateShape>(space, [&] { space.add(space.shape(id), {8, 1}); });
  shape.setBody({9, 1});
  expectRefused<BodyNotFound>(space, [&] { space.add(shape, {8, 1}); });
  space.lock();
  expectRefused<SpaceLocked>(space, [&] { space.add(Body<S>(), {9, 1}); });
  expectRefused<SpaceLocked>(space, [&] { space.add(shape, {9, 1}); });
  space.unlock(true);
}

}  // namespace
}  // namespace samestep
