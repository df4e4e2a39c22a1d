// SPDX-License-Identifier: MIT
// Anything may happen to sleepers: worlds that are saved, reloaded and stripped of what can be computed again
// go on alike, and who sleeps would not move if it were awake.
#include <samestep/snapshot.h>
#include <samestep/space.h>
#include <samestep/workers.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
std::unique_ptr<Space<S>> worldOf(std::uint64_t seed, SolverKind solver) {
  auto space = std::make_unique<Space<S>>();
  fillAtRandom(*space, seed);
  space->setSolver(solver);
  space->setSleepTimeThreshold(ratio<S>(1, 4));
  space->setIdleSpeedThreshold(ratio<S>(1, 8));
  return space;
}

/// One of the things that a game does, the same to each world.
template <Scalar S>
void disturb(Space<S>& space, Random random) {
  std::vector<BodyId> bodies;
  std::vector<ShapeId> shapes;
  std::as_const(space).eachBody([&](const Body<S>& body) {
    if (body.id() != space.staticBody()) bodies.push_back(body.id());
  });
  std::as_const(space).eachShape([&](const Shape<S>& shape) { shapes.push_back(shape.id()); });
  if (bodies.empty() || shapes.empty()) return;
  const BodyId body = bodies[random.below(static_cast<std::uint32_t>(bodies.size()))];
  const ShapeId shape = shapes[random.below(static_cast<std::uint32_t>(shapes.size()))];
  const Vector<S> some(random.number<S>(-3, 3), random.number<S>(-3, 3));
  const bool isStatic = std::as_const(space).body(body).type() == BodyType::staticBody;
  switch (random.below(14)) {
    case 0:
      return space.removeWithShapes(body);
    case 1:
      return space.remove(shape);
    case 2:
      return space.body(body).setPosition(some * S(2));
    case 3:
      if (!isStatic) space.body(body).setVelocity(some);
      return;
    case 4:
      return space.body(body).setForce(some * S(100));
    case 5:
      return space.change(shape, [](Shape<S>& s) { s.setSensor(!s.sensor()); });
    case 6:
      return space.change(shape, [&](Shape<S>& s) { s.setFilter({random.below(3), ~0u, ~0u}); });
    case 7:
      return space.setType(body, static_cast<BodyType>(random.below(3)));
    case 8:
      addDisc<S>(space, some, ratio<S>(1, 2), S(1));
      return;
    case 9:
      space.add(circleShape(space.staticBody(), ratio<S>(1, 2), some));
      return;
    case 10:
      return space.filterArbiters(body);
    case 11:
      return space.body(body).setAngle(random.number<S>(-3, 3));
    case 12:
      return space.body(body).activate();
    default:
      return space.setDamping(S(1) - random.number<S>(0, 1) * ratio<S>(1, 8));
  }
}

/// A body without mass cannot be stepped.
template <Scalar S>
void giveMass(Space<S>& space) {
  std::vector<BodyId> massless;
  std::as_const(space).eachBody([&](const Body<S>& body) {
    if (body.isDynamic() && body.mass() == S(0)) massless.push_back(body.id());
  });
  for (const BodyId id : massless) {
    space.body(id).setMass(S(1));
    space.body(id).setMoment(S(1));
  }
}

template <Scalar S>
std::uint32_t sleepersOf(const Space<S>& space) {
  std::uint32_t count = 0;
  space.eachBody([&](const Body<S>& body) { count += body.isSleeping() ? 1 : 0; });
  return count;
}

template <Scalar S>
class DisturbedTest : public ::testing::Test {
 protected:
  /// Plays a world, calling after(space) for each step, and returns the hashes.
  template <class After>
  static std::vector<std::uint64_t> play(std::uint64_t seed, SolverKind solver, After&& after) {
    auto space = worldOf<S>(seed, solver);
    std::vector<std::uint64_t> hashes;
    Random random(seed);
    for (int i = 0; i < 400; ++i) {
      if (i > 60 && random.oneIn(12)) {
        disturb(*space, random);
        giveMass(*space);
        // The call also comes between the change and the step.
        after(*space);
      }
      space->step(kTick<S>);
      hashes.push_back(space->hash());
      after(*space);
    }
    return hashes;
  }
};
TYPED_TEST_SUITE(DisturbedTest, AllScalars);

TYPED_TEST(DisturbedTest, AWorldSavedAndReloadedAllTheTimeGoesOnAlike) {
  using S = TypeParam;
  std::uint64_t slept = 0;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const auto plain = this->play(seed, solver, [&](Space<S>& space) { slept += sleepersOf(space); });
      SavedSpace<S> saved;
      EXPECT_EQ(this->play(seed, solver,
                           [&](Space<S>& space) {
                             space.save(saved);
                             space.restore(saved);
                           }),
                plain)
          << "restored, seed " << seed;
      EXPECT_EQ(this->play(seed, solver, [&](Space<S>& space) { space.dropCache(); }), plain) << seed;
      EXPECT_EQ(this->play(seed, solver,
                           [&](Space<S>& space) {
                             std::vector<std::uint8_t> bytes(saveSnapshot(space, {}));
                             saveSnapshot(space, bytes);
                             loadSnapshot(space, bytes);
                           }),
                plain)
          << "as bytes, seed " << seed;
      EXPECT_EQ(this->play(seed, solver,
                           [&](Space<S>& space) {
                             // Looking changes nothing.
                             space.eachArbiter([](Arbiter<S>& arbiter) {
                               const bool moves =
                                   arbiter.bodyDataA().isDynamic() || arbiter.bodyDataB().isDynamic();
                               if (moves) arbiter.totalKE();
                             });
                             std::vector<ShapeId> hits;
                             space.boxQuery(BB<S>::forExtents({}, S(9), S(9)), {}, hits);
                             std::vector<BodyId> ids;
                             std::as_const(space).eachBody([&](const Body<S>& b) { ids.push_back(b.id()); });
                             for (const BodyId id : ids) space.body(id).position();
                           }),
                plain)
          << "looked at, seed " << seed;
    }
  }
  EXPECT_GT(slept, 1000u);
}

// If a sleeper were awake it would hardly move: asleep it hides no fall. The bound is what bodies of this
// speed make in the time, and what a contact that is not yet at rest gives way.
TYPED_TEST(DisturbedTest, WhoSleepsWouldNotMoveIfItWereAwake) {
  using S = TypeParam;
  int looked = 0;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      SavedSpace<S> saved;
      int tick = 0;
      this->play(seed, solver, [&](Space<S>& space) {
        if (++tick % 10 != 0) return;
        space.save(saved);
        Space<S> other;
        other.restore(saved);
        // A body that was changed since the last step wakes in the next.
        other.step(kTick<S>);
        std::vector<std::pair<BodyId, Vector<S>>> sleepers;
        other.eachBody([&](const Body<S>& body) {
          if (body.isSleeping()) sleepers.push_back({body.id(), body.worldCenter()});
        });
        // Alone with what is static: what is awake now might come along.
        std::vector<BodyId> others;
        other.eachBody([&](const Body<S>& body) {
          const bool rests = body.activity() == Activity::asleep;
          if (!rests && body.type() != BodyType::staticBody) others.push_back(body.id());
        });
        for (const BodyId id : others) other.removeWithShapes(id);
        for (const auto& [id, place] : sleepers) other.body(id).activate();
        for (int i = 0; i < 32; ++i) other.step(kTick<S>);
        for (const auto& [id, place] : sleepers) {
          const Vector<S> moved = std::as_const(other).body(id).worldCenter() - place;
          EXPECT_LT(std::hypot(double(moved.x), double(moved.y)), 0.1)
              << "seed " << seed << ", look " << tick << ", body " << id.index << ", solver " << int(solver);
          ++looked;
        }
      });
    }
  }
  EXPECT_GT(looked, 100);
}

TYPED_TEST(DisturbedTest, WorkersAndKernelsMakeNoDifference) {
  using S = TypeParam;
  const auto run = [](std::uint64_t seed, TaskRunner* runner, KernelTarget kernel) {
    auto space = worldOf<S>(seed, SolverKind::softStep);
    space->setPrecision(ContactPrecision::fast);
    space->setWorkers(runner, Sharing::always);
    if (isAvailable(kernel)) space->forceKernel(kernel);
    return hashesOf(*space, 200);
  };
  WorkerPool workers(3);
  for (std::uint64_t seed = 11; seed < 14; ++seed) {
    const auto plain = run(seed, nullptr, KernelTarget::portable);
    EXPECT_EQ(run(seed, &workers, KernelTarget::portable), plain);
    for (const KernelTarget kernel : {KernelTarget::sse42, KernelTarget::avx2, KernelTarget::avx512}) {
      EXPECT_EQ(run(seed, &workers, kernel), plain);
    }
  }
}

}  // namespace
}  // namespace samestep
