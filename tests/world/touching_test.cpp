// SPDX-License-Identifier: MIT
// What counts as touching: overlap or a push, not nearness.
#include <samestep/space.h>

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

template <Scalar S>
S deepest(const Arbiter<S>& arbiter) {
  S least = arbiter.depth(0);
  for (int i = 1; i < arbiter.count(); ++i) least = min(least, arbiter.depth(i));
  return least;
}

/// Functions that a handler has.
enum class Asked { all, postSolveAndSeparate };

template <Scalar S>
class TouchingTest : public ::testing::Test {
 protected:
  void bind(Space<S>& space, Asked asked) {
    CollisionHandler<S> handler;
    handler.data = &log_;
    const auto note = [](void* data, const char* what) {
      static_cast<std::vector<std::string>*>(data)->push_back(what);
    };
    static constexpr auto kNote = note;
    if (asked == Asked::all) {
      handler.begin = [](Arbiter<S>&, Space<S>&, void* data) { return kNote(data, "begin"), true; };
      handler.preSolve = [](Arbiter<S>&, Space<S>&, void* data) { return kNote(data, "preSolve"), true; };
    }
    handler.postSolve = [](Arbiter<S>&, Space<S>&, void* data) { kNote(data, "postSolve"); };
    handler.separate = [](Arbiter<S>&, Space<S>&, void* data) { kNote(data, "separate"); };
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
  }
  std::vector<std::string> step(Space<S>& space) {
    log_.clear();
    space.step(kTick<S>);
    return log_;
  }
  static int visited(Space<S>& space) {
    int count = 0;
    space.eachArbiter([&](Arbiter<S>&) { ++count; });
    return count;
  }

  std::vector<std::string> log_;
};
TYPED_TEST_SUITE(TouchingTest, AllScalarsAndChecked);

TYPED_TEST(TouchingTest, ShapesWithinTheMarginThatRestAreNotTold) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    for (const Asked asked : {Asked::all, Asked::postSolveAndSeparate}) {
      Space<S> space;
      space.setSolver(solver);
      this->bind(space, asked);
      const S gap = ratio<S>(1, 100);
      addBox<S>(space, {}, S(1), S(1), S(1));
      addBox<S>(space, {S(1) + gap, S(0)}, S(1), S(1), S(1));
      addDisc<S>(space, {S(0), S(1) + gap}, ratio<S>(1, 2), S(1));
      const ShapeId sensor = addBox<S>(space, {S(0), -S(1) - gap}, S(1), S(1), S(1));
      space.change(sensor, [](Shape<S>& shape) { shape.setSensor(true); });
      for (int i = 0; i < 5; ++i) {
        EXPECT_THAT(this->step(space), IsEmpty());
        EXPECT_EQ(this->visited(space), 0);
      }
    }
  }
}

TYPED_TEST(TouchingTest, ShapesThatJustMeetTouch) {
  using S = TypeParam;
  Space<S> space;
  this->bind(space, Asked::all);
  addBox<S>(space, {}, S(1), S(1), S(1));
  addBox<S>(space, {S(1), S(0)}, S(1), S(1), S(1));
  EXPECT_THAT(this->step(space), ElementsAre("begin", "preSolve", "postSolve"));
  EXPECT_THAT(this->step(space), ElementsAre("preSolve", "postSolve"));
  EXPECT_EQ(this->visited(space), 1);
}

// It ends where it meets the wall, pushed before it overlaps it.
TYPED_TEST(TouchingTest, AnImpulseBeforeAnOverlapIsTold) {
  using S = TypeParam;
  Space<S> space;
  this->bind(space, Asked::postSolveAndSeparate);
  space.add(boxShape<S>(space.staticBody(), BB<S>(S(0), S(-1), S(1), S(1))));
  // 12 mm before it, at 5 mm a step.
  const S speed = ratio<S>(32, 100);
  const ShapeId id = addBox<S>(space, {ratio<S>(-512, 1000), S(0)}, S(1), S(1), S(1), {speed, S(0)});
  EXPECT_THAT(this->step(space), IsEmpty());
  EXPECT_EQ(this->visited(space), 0);
  EXPECT_THAT(this->step(space), IsEmpty());
  EXPECT_THAT(this->step(space), ElementsAre("postSolve"));
  EXPECT_EQ(this->visited(space), 1);
  EXPECT_NEAR(double(space.body(bodyOf(space, id)).velocity().x), 0, 1e-2);
  space.body(bodyOf(space, id)).setVelocity({-speed, S(0)});
  int separated = 0;
  for (int i = 0; i < 10; ++i) {
    for (const std::string& what : this->step(space)) {
      if (what == "separate") ++separated;
    }
  }
  EXPECT_EQ(separated, 1);
  EXPECT_EQ(this->visited(space), 0);
}

// A handler that may refuse is asked when the shapes touch, and before anything has pushed.
TYPED_TEST(TouchingTest, BeginIsAskedInTouchAndBeforeAnImpulse) {
  using S = TypeParam;
  struct Seen {
    int begun = 0;
    S depth{1}, speed{};
  } seen;
  for (const bool refuses : {false, true}) {
    Space<S> space;
    space.setGravity({S(0), S(-10)});
    CollisionHandler<S> handler;
    struct Context {
      Seen* seen;
      bool refuses;
    } context{&seen, refuses};
    seen = {};
    handler.data = &context;
    handler.begin = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      auto& c = *static_cast<Context*>(data);
      ++c.seen->begun;
      c.seen->depth = deepest(arbiter);
      c.seen->speed = arbiter.bodyDataB().velocity().y;
      return !c.refuses;
    };
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
    space.add(boxShape<S>(space.staticBody(), BB<S>(S(-5), S(-1), S(5), S(0))));
    const ShapeId id = addBox<S>(space, {S(0), ratio<S>(51, 100)}, S(1), S(1), S(1));
    for (int i = 0; i < 64; ++i) space.step(kTick<S>);
    EXPECT_EQ(seen.begun, 1);
    EXPECT_LE(double(seen.depth), 1e-6);
    EXPECT_LT(double(seen.speed), -0.3);
    const Body<S>& body = space.body(bodyOf(space, id));
    if (refuses) {
      EXPECT_NEAR(double(body.velocity().y), -10, 0.01);
    } else {
      EXPECT_NEAR(double(body.position().y), 0.5, 1e-3);
    }
  }
}

// It comes from below, which a platform lets pass for as long as they touch, and is 4 mm above it at the top
// of its way.
TYPED_TEST(TouchingTest, AOneWayPlatformHoldsWhoClearedItByMillimetres) {
  using S = TypeParam;
  for (const bool round : {false, true}) {
    Space<S> space;
    space.setGravity({S(0), S(-10)});
    CollisionHandler<S> handler;
    handler.begin = [](Arbiter<S>& arbiter, Space<S>&, void*) {
      return arbiter.bodyDataB().velocity().y <= S(0) || arbiter.ignore();
    };
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
    space.add(boxShape<S>(space.staticBody(), BB<S>(S(-5), ratio<S>(-1, 4), S(5), S(0))));
    const S half = ratio<S>(1, 4), top = half + ratio<S>(4, 1000);
    const ShapeId id = round ? addDisc<S>(space, {S(0), S(-1)}, half, S(1))
                             : addBox<S>(space, {S(0), S(-1)}, half + half, half + half, S(1));
    const BodyId mover = bodyOf(space, id);
    space.body(mover).setVelocity({S(0), S(6)});
    const auto seen = [&]() -> const Body<S>& { return std::as_const(space).body(mover); };
    while (seen().position().y <= half && seen().velocity().y > S(0)) space.step(kTick<S>);
    ASSERT_GT(seen().position().y, half);
    space.body(mover).setPosition({S(0), top});
    space.body(mover).setVelocity({});
    for (int i = 0; i < 128; ++i) space.step(kTick<S>);
    EXPECT_NEAR(double(space.body(bodyOf(space, id)).position().y), double(half), 1e-2) << round;
  }
}

// A heap of everything keeps this: what is begun touches, what is visited touches or was pushed, and each
// begin has its separate.
TYPED_TEST(TouchingTest, AllThatIsToldOfAHeapTouches) {
  using S = TypeParam;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Space<S> space;
    struct Life {
      int open = 0, begun = 0, separated = 0;
      bool good = true;
    } life;
    CollisionHandler<S> handler;
    handler.data = &life;
    handler.begin = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      auto& l = *static_cast<Life*>(data);
      ++l.begun;
      ++l.open;
      l.good = l.good && double(deepest(arbiter)) <= 1e-5;
      return true;
    };
    handler.separate = [](Arbiter<S>&, Space<S>&, void* data) {
      --static_cast<Life*>(data)->open;
      ++static_cast<Life*>(data)->separated;
    };
    const bool handled = seed % 2 == 0;
    if (handled) {
      space.registerHandler(1, handler);
      space.addDefaultCollisionHandler(1);
    }
    fillAtRandom(space, seed);
    for (int i = 0; i < 120; ++i) {
      const WorldState<S> before = space.state();
      const auto placeOf = [&](ShapeId id) {
        const Body<S>& body = before.bodies.valueAt(before.shapes.valueAt(id.index).body().index);
        return body.transform();
      };
      space.step(kTick<S>);
      space.eachArbiter([&](Arbiter<S>& arbiter) {
        const Pair<S>& pair = arbiter.pair();
        const auto on = [&](ShapeId id, const Vector<S>& anchor) {
          const Body<S>& body = before.bodies.valueAt(before.shapes.valueAt(id.index).body().index);
          return body.position() + rotate(anchor, body.rotation());
        };
        bool touched = false;
        for (int k = 0; k < pair.count; ++k) {
          const Contact<S>& contact = pair.contacts[k];
          touched = touched || contact.normalTotal != S(0);
          // Or just meet.
          const Vector<S> between = on(pair.b, contact.anchorB) - on(pair.a, contact.anchorA);
          touched = touched || max(abs(between.x), abs(between.y)) <= ratio<S>(1, 1 << 20);
        }
        touched = touched || shapesCollide(arbiter.shapeDataA(), placeOf(arbiter.shapeA()),
                                           arbiter.shapeDataB(), placeOf(arbiter.shapeB()))
                                     .count > 0;
        EXPECT_TRUE(touched) << "seed " << seed << ", step " << i;
      });
      int touching = 0;
      for (const Pair<S>& pair : space.state().pairs) {
        touching += pair.state != ArbiterState::apart && pair.state != ArbiterState::cached ? 1 : 0;
      }
      EXPECT_TRUE(!handled || life.open == touching) << "seed " << seed << ", step " << i;
    }
    EXPECT_TRUE(life.good);
    EXPECT_EQ(life.separated > 0, handled);
  }
}

// Found while nothing meets, kept while the bodies hardly move, and solved as it is when they do meet.
TYPED_TEST(TouchingTest, AContactTakenAsItIsHasTheSurfacesOfItsShapes) {
  using S = TypeParam;
  for (const bool handled : {false, true}) {
    Space<S> space;
    space.setBounceThreshold(S(0));
    Shape<S> floor = segmentShape<S>(space.staticBody(), {S(-8), S(0)}, {S(8), S(0)});
    floor.setElasticity(S(1));
    space.add(floor);
    const S gap = ratio<S>(1, 2048), speed = ratio<S>(1, 100);
    const ShapeId box = addBox<S>(space, {S(0), ratio<S>(1, 2) + gap}, S(1), S(1), S(1), {S(0), -speed});
    space.change(box, [](Shape<S>& shape) { shape.setElasticity(S(1)); });
    if (handled) this->bind(space, Asked::postSolveAndSeparate);
    for (int i = 0; i < 10; ++i) space.step(kTick<S>);
    EXPECT_GT(space.body(bodyOf(space, box)).velocity().y, speed * ratio<S>(1, 2)) << handled;
  }
}

}  // namespace
}  // namespace samestep
