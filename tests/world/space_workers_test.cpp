// SPDX-License-Identifier: MIT
// A world steps to the same bits, and tells the same in the same order, whoever helps and with any kernel.
#include <samestep/circle_shape.h>
#include <samestep/kernel.h>
#include <samestep/poly_shape.h>
#include <samestep/space.h>
#include <samestep/workers.h>

#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

// Later a ball is squeezed between two kinematic shapes, harder than fast numbers hold.
constexpr int kSteps = 40;

struct Kind {
  SolverKind solver = SolverKind::softStep;
  ContactPrecision precision = ContactPrecision::accurate;
  bool handlers = false;
  bool functions = false;
  bool odd = false;  ///< Bodies whose moment the fast kernel has no room for.
};

constexpr Kind kKinds[] = {
    {},
    {SolverKind::softStep, ContactPrecision::fast, false, false},
    {SolverKind::softStep, ContactPrecision::fast, true, true},
    {SolverKind::softStep, ContactPrecision::fast, false, false, true},
    {SolverKind::softStep, ContactPrecision::accurate, true, false},
    {SolverKind::sequentialImpulses, ContactPrecision::accurate, false, false},
};

/// Everything a user can see of a run.
struct Story {
  std::vector<std::uint64_t> hashes;
  std::string events;
  std::uint64_t accurateInstead = 0;
  CollisionStats stats;
};

template <Scalar S>
void tell(Arbiter<S>& arbiter, char what, void* data) {
  *static_cast<std::string*>(data) +=
      what + std::to_string(arbiter.shapeA().index) + "," + std::to_string(arbiter.shapeB().index) + " ";
}

/// A pile that falls upon a random heap, with things that bounce, turn, and move by functions.
template <Scalar S>
void fill(Space<S>& space, const Kind& kind, std::string& events) {
  space.setSolver(kind.solver);
  space.setPrecision(kind.precision);
  if (kind.handlers) {
    CollisionHandler<S> handler;
    handler.data = &events;
    handler.begin = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      tell(arbiter, 'b', data);
      return true;
    };
    handler.preSolve = [](Arbiter<S>& arbiter, Space<S>& world, void* data) {
      tell(arbiter, 'p', data);
      // Callbacks see what those before them changed.
      Body<S>& body = world.body(arbiter.bodyA());
      if (body.isDynamic()) body.setVelocity(body.velocity() * ratio<S>(255, 256));
      return arbiter.shapeB().index % 7 != 0;
    };
    handler.postSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) { tell(arbiter, 'q', data); };
    handler.separate = [](Arbiter<S>& arbiter, Space<S>&, void* data) { tell(arbiter, 's', data); };
    space.registerHandler(1, handler);
    space.addWildcardHandler(1, 1);
  }
  for (std::uint64_t seed = 0; seed < 3; ++seed) fillAtRandom(space, seed);
  space.registerVelocityFunc(2, [](Body<S>& body, const Vector<S>& gravity, S, S dt, void*) {
    body.setVelocity(body.velocity() + gravity * dt);
  });
  space.registerPositionFunc(
      3, [](Body<S>& body, S dt, void*) { body.setPosition(body.position() + body.velocity() * dt); });
  for (int row = 0; row < 6; ++row) {
    for (int i = 0; i < 8; ++i) {
      Body<S> body = kind.odd && row == 3 ? Body<S>(S(2), ratio<S>(1, 500)) : Body<S>();
      body.setPosition({S(2 * i - 7) * ratio<S>(1, 2), S(9 + row)});
      if (kind.functions && i == 3) body.setVelocityFunc(2);
      if (kind.functions && i == 5) body.setPositionFunc(3);
      const BodyId id = space.add(body);
      Shape<S> shape = boxShape(id, BB<S>::forExtents({}, ratio<S>(1, 2), ratio<S>(1, 2)));
      if (!kind.odd || row != 3) shape.setMass(S(1 + (row + i) % 3));
      shape.setFriction(ratio<S>(1, 2));
      shape.setElasticity(i % 3 == 0 ? S(1) : S(0));
      space.add(shape);
    }
  }
}

template <Scalar S>
Story play(const Kind& kind, TaskRunner* runner, KernelTarget kernel = KernelTarget::best,
           int steps = kSteps) {
  Story story;
  Space<S> space;
  space.forceKernel(kernel);
  space.setWorkers(runner, Sharing::always);
  fill(space, kind, story.events);
  for (int i = 0; i < steps; ++i) {
    space.step(kTick<S>);
    story.hashes.push_back(space.hash());
    for (const RangeEvent& event : space.rangeEvents()) {
      story.events += "r" + std::to_string(event.body.index) + ":" + std::to_string(event.held) + " ";
    }
  }
  story.accurateInstead = space.accurateInstead();
  story.stats = space.collisionStats();
  return story;
}

void expectSame(const Story& one, const Story& other, const std::string& what) {
  for (std::size_t i = 0; i < one.hashes.size(); ++i) {
    ASSERT_EQ(one.hashes[i], other.hashes[i]) << what << ", step " << i + 1;
  }
  EXPECT_EQ(one.events, other.events) << what;
  EXPECT_EQ(one.accurateInstead, other.accurateInstead) << what;
  EXPECT_EQ(one.stats.highGjkIterations, other.stats.highGjkIterations) << what;
  EXPECT_EQ(one.stats.highGjkToEpaIterations, other.stats.highGjkToEpaIterations) << what;
  EXPECT_EQ(one.stats.highEpaIterations, other.stats.highEpaIterations) << what;
}

/// Runs tasks one after the other, the last first, as a job system without a free thread may.
class Backwards : public TaskRunner {
 public:
  int workers() const override { return 3; }
  void run(int tasks, void (*task)(int, void*), void* data) override {
    for (int i = tasks - 1; i >= 0; --i) task(i, data);
    ++runs;
  }
  int runs = 0;
};

template <Scalar S>
class SpaceWorkersTest : public ::testing::Test {};
TYPED_TEST_SUITE(SpaceWorkersTest, AllScalars);

TYPED_TEST(SpaceWorkersTest, OneToEightWorkersGiveTheSameHashesEventsAndCounts) {
  using S = TypeParam;
  for (const Kind& kind : kKinds) {
    const Story alone = play<S>(kind, nullptr);
    EXPECT_NE(alone.events.empty(), kind.handlers);
    // All kernels of Fixed take part: the fast one, and the accurate ones in its place.
    EXPECT_EQ(alone.accurateInstead > 0, kind.odd && FixedNumber<S>);
    for (int workers = 1; workers <= 8; ++workers) {
      WorkerPool pool(workers);
      expectSame(alone, play<S>(kind, &pool), std::to_string(workers) + " workers");
    }
  }
}

TYPED_TEST(SpaceWorkersTest, ARunnerOfTheCallersMayRunTasksInAnyOrder) {
  using S = TypeParam;
  for (const Kind& kind : kKinds) {
    Backwards backwards;
    expectSame(play<S>(kind, nullptr), play<S>(kind, &backwards), "backwards");
    EXPECT_GT(backwards.runs, kSteps);
  }
}

TYPED_TEST(SpaceWorkersTest, EveryKernelGivesTheSameHashesAloneAndWithWorkers) {
  using S = TypeParam;
  WorkerPool pool(2);
  for (const Kind& kind : kKinds) {
    const Story best = play<S>(kind, nullptr);
    for (const KernelTarget kernel : availableKernels()) {
      expectSame(best, play<S>(kind, nullptr, kernel), kernelName(kernel));
      expectSame(best, play<S>(kind, &pool, kernel), kernelName(kernel));
    }
  }
}

TYPED_TEST(SpaceWorkersTest, WorkersAndKernelMayChangeBetweenSteps) {
  using S = TypeParam;
  WorkerPool two(2), five(5);
  std::string none;
  Space<S> alone, helped;
  fill(alone, kKinds[1], none);
  fill(helped, kKinds[1], none);
  TaskRunner* const runners[] = {nullptr, &two, &five};
  for (int i = 0; i < kSteps; ++i) {
    helped.setWorkers(runners[i % 3], Sharing::always);
    EXPECT_EQ(helped.workers(), runners[i % 3]);
    helped.setKernel(availableKernels()[static_cast<std::size_t>(i) % availableKernels().size()]);
    alone.step(kTick<S>);
    helped.step(kTick<S>);
    ASSERT_EQ(alone.hash(), helped.hash()) << "step " << i + 1;
  }
}

TYPED_TEST(SpaceWorkersTest, ASavedWorldCarriesNeitherWorkersNorKernel) {
  using S = TypeParam;
  std::string none;
  WorkerPool pool(2);
  Space<S> space;
  fill(space, kKinds[0], none);
  const SavedSpace<S> saved = space.save();
  space.setWorkers(&pool);
  space.setKernel(KernelTarget::portable);

  space.restore(saved);

  EXPECT_EQ(space.workers(), &pool);
  EXPECT_EQ(space.kernel(), KernelTarget::portable);
  EXPECT_EQ(space.hash(), [&] {
    Space<S> other;
    other.registerVelocityFunc(2, [](Body<S>&, const Vector<S>&, S, S, void*) {});
    other.registerPositionFunc(3, [](Body<S>&, S, void*) {});
    other.restore(saved);
    return other.hash();
  }());
}

TYPED_TEST(SpaceWorkersTest, AWorldTooSmallToShareWakesNobody) {
  using S = TypeParam;
  Backwards backwards;
  Space<S> space;
  space.setSolver(SolverKind::softStep);
  fillAtRandom(space, 1);
  space.setWorkers(&backwards);
  for (int i = 0; i < 30; ++i) space.step(kTick<S>);
  EXPECT_EQ(backwards.runs, 0);
}

TYPED_TEST(SpaceWorkersTest, AStepUnderWayKeepsItsWorkersAndKernel) {
  using S = TypeParam;
  Space<S> space;
  space.lock();
  EXPECT_THROW(space.setWorkers(nullptr), SpaceLocked);
  EXPECT_THROW(space.setKernel(KernelTarget::best), SpaceLocked);
  EXPECT_THROW(space.forceKernel(KernelTarget::best), SpaceLocked);
  space.unlock(false);
}

TYPED_TEST(SpaceWorkersTest, AKernelThatIsNotThereIsReplacedAndRemarkedOnUnlessForced) {
  using S = TypeParam;
  Space<S> space;
  std::string log;
  space.remarks().context = &log;
  space.remarks().hook = [](Remark, const char* text, void* context) {
    *static_cast<std::string*>(context) += text;
  };
  std::uint64_t missing = 0;
  for (const KernelTarget kernel : kKernelTargets) {
    space.setKernel(kernel);
    EXPECT_EQ(space.kernel(), nextBestKernel(kernel));
    if (isAvailable(kernel)) {
      EXPECT_NO_THROW(space.forceKernel(kernel));
    } else {
      ++missing;
      space.forceKernel(KernelTarget::portable);
      EXPECT_THROW(space.forceKernel(kernel), KernelUnavailable);
      EXPECT_EQ(space.kernel(), KernelTarget::portable);
    }
    EXPECT_EQ(space.remarks().count(Remark::OtherKernel), missing);
  }
  // No machine has all of them.
  EXPECT_GT(missing, 0u);
  EXPECT_NE(log.find("No result differs."), std::string::npos);
  EXPECT_THROW(space.setKernel(static_cast<KernelTarget>(99)), ValueOutOfRange);
}

TEST(SpaceWorkersCheckedTest, CheckedNumbersAreSteppedByTheCallerAlone) {
  Backwards backwards;
  const Story alone = play<CheckedFixed>(kKinds[0], nullptr, KernelTarget::best, 10);
  expectSame(alone, play<CheckedFixed>(kKinds[0], &backwards, KernelTarget::best, 10), "checked");
  EXPECT_EQ(backwards.runs, 0);
}

// Read-only: a race would be seen by ThreadSanitizer, and another answer here.
TYPED_TEST(SpaceWorkersTest, SeveralThreadsAskOneViewAtTheSameTime) {
  using S = TypeParam;
  Space<S> space;
  fillAtRandom(space, 3);
  for (int i = 0; i < 10; ++i) space.step(kTick<S>);
  const QueryView<S> view = space.queries();
  const Shape<S> asked = boxShape<S>({}, S(2), S(1));
  const auto answers = [&] {
    std::string told;
    for (int i = -8; i <= 8; ++i) {
      SegmentHit<S> hits[8];
      NearHit<S> near[8];
      const std::size_t rays = view.castRay({S(i), S(9)}, {S(-i), S(-9)}, {}, hits);
      for (std::size_t k = 0; k < rays && k < 8; ++k) told += std::to_string(hits[k].shape.index) + " ";
      const std::size_t casts =
          view.castShape(asked, {{}, {S(i), S(9)}, S(0), {S(0), S(-18)}, S(1)}, {}, hits);
      const std::size_t nears = view.nearest(asked, Transform<S>::translation({S(i), S(0)}), S(2), {}, near);
      told += std::to_string(casts) + " " + std::to_string(nears) + "\n";
    }
    return told;
  };
  const std::string expected = answers();
  std::string told[3];
  std::vector<std::thread> threads;
  for (std::string& of : told) threads.emplace_back([&] { of = answers(); });
  for (std::thread& thread : threads) thread.join();
  for (const std::string& of : told) EXPECT_EQ(of, expected);
}

}  // namespace
}  // namespace samestep
