// SPDX-License-Identifier: MIT
// A step of a world that has warmed up takes no memory, and where there is none nothing comes out wrong.
#include <samestep/space.h>
#include <samestep/workers.h>

#include <malloc.h>

#include <atomic>
#include <concepts>
#include <cstdlib>
#include <new>
#include <string>

#include <gtest/gtest.h>

#include "support/midway.h"
#include "support/scalars.h"
#include "support/world.h"

namespace {
std::atomic<long> allocations = 0;
std::atomic<std::size_t> live = 0;
std::atomic<std::size_t> mostLive = 0;

/// Number of further calls that take memory before one fails; none fails below 0.
std::atomic<long> untilFailure = -1;

/// Null where the call is to fail, or there is no memory.
void* countedOrNull(void* memory) noexcept {
  ++allocations;
  if (untilFailure >= 0 && untilFailure-- == 0) {
    std::free(memory);
    return nullptr;
  }
  if (memory == nullptr) return nullptr;
  const std::size_t now = live += malloc_usable_size(memory);
  std::size_t most = mostLive;
  while (now > most && !mostLive.compare_exchange_weak(most, now)) {
  }
  return memory;
}

void* counted(void* memory) {
  void* given = countedOrNull(memory);
  if (given == nullptr) throw std::bad_alloc();
  return given;
}

void release(void* memory) {
  if (memory != nullptr) live -= malloc_usable_size(memory);
  std::free(memory);
}

void* aligned(std::size_t size, std::align_val_t alignment) {
  const auto to = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(to, (size + to - 1) / to * to));
}
}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size)); }
void* operator new[](std::size_t size) { return counted(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) { return aligned(size, alignment); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return aligned(size, alignment); }
// Sorting takes its buffer through this form; without it, another library's would answer to `delete` below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return countedOrNull(std::malloc(size));
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return countedOrNull(std::malloc(size));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace samestep {
namespace {

/// Bytes that a Space takes at the worst for each pair, with all that belongs to its shapes.
template <Scalar S>
double mostBytesPerPair(SolverKind solver, ContactPrecision precision) {
  if (solver == SolverKind::sequentialImpulses) return 1450;
  if (std::floating_point<S>) return 2800;
  return precision == ContactPrecision::fast ? 3300 : 2400;
}

/// Something that is done to a Space, and the world that it is done to.
template <Scalar S>
struct Operation {
  const char* name;
  void (*act)(Space<S>& space);
  /// True if nothing was computed of the world yet.
  bool cold = false;
};

constexpr ShapeId kBox{3, 1};

template <Scalar S>
BodyId bodyAt(Space<S>& space, std::uint32_t shape) {
  return bodyOf(space, space.state().shapes.idAt(shape));
}

/// Removes the only shape of a body, which then weighs nothing: the step refuses one that is dynamic. The
/// change of type takes no memory after the removal.
template <Scalar S>
void removeBox(Space<S>& space) {
  const BodyId body = space.shape(kBox).body();
  space.remove(kBox);
  space.setType(body, BodyType::kinematicBody);
}

/// Changes of bodies and shapes.
template <Scalar S>
std::vector<Operation<S>> changes() {
  return {
      {"step", [](Space<S>& space) { space.step(kTick<S>); }},
      {"first step", [](Space<S>& space) { space.step(kTick<S>); }, true},
      {"add body", [](Space<S>& space) { space.add(Body<S>(S(1), S(1))); }},
      {"add body under an id",
       [](Space<S>& space) {
         space.add(Body<S>(S(1), S(1)), {700, 1});
       }},
      {"add disc", [](Space<S>& space) { space.add(circleShape<S>(bodyAt(space, 4), S(1))); }, true},
      {"add polygons",
       [](Space<S>& space) {
         Shape<S> box = boxShape<S>(bodyAt(space, 4), S(3), S(2));
         box.setMass(S(2));
         box.setFriction(ratio<S>(1, 3));
         space.add(box);
       }},
      {"add shape under an id",
       [](Space<S>& space) {
         space.add(circleShape<S>(bodyAt(space, 4), S(1)), {900, 1});
       }},
      {"remove shape", removeBox<S>},
      {"remove shape without what was computed", removeBox<S>, true},
      {"remove body with shapes", [](Space<S>& space) { space.removeWithShapes(bodyAt(space, 3)); }},
      {"replace geometry",
       [](Space<S>& space) {
         Shape<S> other = boxShape<S>({}, S(2), S(1));
         other.setMass(S(5));
         space.replace(kBox, other);
       }},
      {"replace surface",
       [](Space<S>& space) {
         space.change(kBox, [](Shape<S>& shape) { shape.setFriction(ratio<S>(1, 7)); });
       }},
      {"set type", [](Space<S>& space) { space.setType(bodyAt(space, 3), BodyType::kinematicBody); }, true},
      {"settings", [](Space<S>& space) { space.setContactMargin(ratio<S>(1, 8)); }},
      {"accumulate mass", [](Space<S>& space) { space.accumulateMassFromShapes(bodyAt(space, 3)); }, true},
      {"filter arbiters", [](Space<S>& space) { space.filterArbiters(space.staticBody()); }},
  };
}

template <Scalar S>
std::vector<Operation<S>> otherCalls() {
  return {
      {"bind a handler", [](Space<S>& space) { space.addCollisionHandler(1, 2, 2); }},
      {"register handlers",
       [](Space<S>& space) {
         for (CallbackNumber i = 5; i < 9; ++i) {
           space.registerHandler(i, {});
           space.registerPositionFunc(i, [](Body<S>&, S, void*) {});
           space.registerVelocityFunc(i, [](Body<S>&, const Vector<S>&, S, S, void*) {});
         }
       }},
      {"post-step callbacks",
       [](Space<S>& space) {
         struct Unlocked {
           Space<S>& space;
           ~Unlocked() { space.unlock(false); }
         };
         {
           space.lock();
           const Unlocked unlocked{space};
           for (std::uint64_t key = 0; key < 40; ++key) {
             space.addPostStepCallback([](Space<S>&, std::uint64_t, void*) {}, key);
           }
         }
         space.lock();
         space.unlock(true);
       }},
      {"step with workers",
       [](Space<S>& space) {
         static WorkerPool pool(2);
         space.setWorkers(&pool, Sharing::always);
         space.step(kTick<S>);
         space.setWorkers(nullptr);
       }},
      {"queries",
       [](Space<S>& space) {
         std::vector<PointHit<S>> points;
         std::vector<SegmentHit<S>> segments;
         std::vector<ShapeId> boxes;
         space.body(bodyAt(space, 3));
         space.pointQuery({}, S(20), {}, points);
         space.segmentQuery({S(-9), S(0)}, {S(9), S(0)}, S(1), {}, segments);
         space.boxQuery({S(-9), S(-9), S(9), S(9)}, {}, boxes);
         space.boundingBox(kBox);
         space.reindexStatic();
       },
       true},
      {"arbiters", [](Space<S>& space) { space.eachArbiter(space.staticBody(), [](Arbiter<S>&) {}); }},
      {"save and hash",
       [](Space<S>& space) {
         const SavedSpace<S> saved = space.save();
         const SavedSpace<S> copy = saved;
         space.hash();
       },
       true},
      {"adopt", [](Space<S>& space) { space.adopt(WorldState<S>(space.state())); }},
  };
}

template <Scalar S>
class AllocationTest : public ::testing::Test {
 protected:
  static void wire(Space<S>& space) {
    CollisionHandler<S> handler;
    handler.begin = [](Arbiter<S>&, Space<S>&, void*) { return true; };
    space.registerHandler(1, handler);
    space.registerHandler(2, handler);
  }
  static void fill(Space<S>& space, SolverKind solver) {
    wire(space);
    space.addWildcardHandler(1, 1);
    space.setSolver(solver);
    fillAtRandom(space, 3);
    hashesOf(space, 40);
  }

  /// Has each call for memory of an operation fail, one after the other. The world is then as it was or
  /// refuses everything; the operation succeeds when it is made again; and the match goes on as one in which
  /// nothing failed.
  /// @return how many failed
  static long failEachAllocation(const Operation<S>& operation, SolverKind solver) {
    Space<S> space;
    fill(space, solver);
    const SavedSpace<S> before = space.save();
    const std::uint64_t hashBefore = space.hash();
    operation.act(space);
    const std::uint64_t hashAfter = space.hash();
    const std::vector<std::uint64_t> later = hashesOf(space, 3);
    for (long failing = 0;; ++failing) {
      SCOPED_TRACE(std::string(operation.name) + ", allocation " + std::to_string(failing));
      // One that has no room for anything yet.
      Space<S> tried;
      wire(tried);
      tried.restore(before);
      if (operation.cold) tried.dropCache();
      bool failed = false;
      untilFailure = failing;
      try {
        operation.act(tried);
      } catch (const std::bad_alloc&) {
        failed = true;
      }
      const bool reached = untilFailure < 0;
      untilFailure = -1;
      if (failed) {
        expectAsItWasOrUnusable(tried, before, hashBefore);
        operation.act(tried);
      }
      EXPECT_EQ(tried.hash(), hashAfter);
      EXPECT_EQ(hashesOf(tried, 3), later);
      if (!reached || ::testing::Test::HasFailure()) return failing;
    }
  }

  template <class Call>
  static long countIn(Call&& call) {
    const long before = allocations;
    call();
    return allocations - before;
  }
};
TYPED_TEST_SUITE(AllocationTest, AllScalars);

TYPED_TEST(AllocationTest, AWarmStepTakesNoMemory) {
  using S = TypeParam;
  Space<S> space;
  CollisionHandler<S> handler;
  handler.preSolve = [](Arbiter<S>&, Space<S>&, void*) { return true; };
  space.registerHandler(1, handler);
  space.addWildcardHandler(1, 1);
  for (std::uint64_t seed = 0; seed < 4; ++seed) fillAtRandom(space, seed);
  // Steps made again need no more room than the first time.
  const SavedSpace<S> saved = space.save();
  const auto play = [&] {
    for (int i = 0; i < 300; ++i) space.step(kTick<S>);
  };
  for (int round = 0; round < 2; ++round) {
    play();
    space.restore(saved);
  }

  EXPECT_EQ(this->countIn(play), 0);
}

TYPED_TEST(AllocationTest, AWarmStepOfTheSoftStepTakesNoMemoryAloneOrWithWorkers) {
  using S = TypeParam;
  for (const ContactPrecision precision : {ContactPrecision::accurate, ContactPrecision::fast}) {
    for (const int workers : {1, 3}) {
      WorkerPool pool(workers);
      Space<S> space;
      space.setSolver(SolverKind::softStep);
      space.setPrecision(precision);
      space.setWorkers(&pool, Sharing::always);
      for (std::uint64_t seed = 0; seed < 4; ++seed) fillAtRandom(space, seed);
      const SavedSpace<S> saved = space.save();
      const auto play = [&] {
        for (int i = 0; i < 200; ++i) space.step(kTick<S>);
      };
      for (int round = 0; round < 2; ++round) {
        play();
        space.restore(saved);
      }

      EXPECT_EQ(this->countIn(play), 0) << workers << " workers";
    }
  }
}

// docs/formats.md, "From strangers". Heavy boxes in one place: nearly all pairs share bodies, so that each is
// alone in its block, and the first solver gives up.
TYPED_TEST(AllocationTest, PairsInOnePlaceTakeNoMoreMemoryThanIsDocumented) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::sequentialImpulses, SolverKind::softStep}) {
    for (const ContactPrecision precision : {ContactPrecision::accurate, ContactPrecision::fast}) {
      const std::size_t before = live;
      mostLive = before;
      Space<S> space;
      space.setSolver(solver);
      space.setPrecision(precision);
      for (int i = 0; i < 300; ++i) addBox(space, {}, S(1), S(1), S(i % 2 == 0 ? 1000000 : 1));
      space.step(kTick<S>);
      const auto pairs = space.state().pairs.size();
      for (int i = 0; i < 3; ++i) space.step(kTick<S>);

      ASSERT_EQ(pairs, 300u * 299u / 2u);
      EXPECT_LE(static_cast<double>(mostLive - before) / static_cast<double>(pairs),
                mostBytesPerPair<S>(solver, precision))
          << static_cast<int>(solver) << ' ' << static_cast<int>(precision);
    }
  }
}

TYPED_TEST(AllocationTest, ASpaceThatCannotBeMadeGivesAllMemoryBack) {
  using S = TypeParam;
  const long needed = this->countIn([] { Space<S> space; });
  ASSERT_GT(needed, 3);
  for (long failing = 0; failing < needed; ++failing) {
    const std::size_t before = live;
    untilFailure = failing;
    bool failed = false;
    try {
      Space<S> space;
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    untilFailure = -1;

    EXPECT_TRUE(failed);
    EXPECT_EQ(live, before) << "allocation " << failing;
  }
}

TYPED_TEST(AllocationTest, WhereMemoryFailsTheWorldIsAsItWasOrUnusable) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    long failed = 0;
    for (const Operation<S>& operation : changes<S>()) failed += this->failEachAllocation(operation, solver);
    for (const Operation<S>& operation : otherCalls<S>()) {
      failed += this->failEachAllocation(operation, solver);
    }
    EXPECT_GT(failed, 150);
  }
}

TYPED_TEST(AllocationTest, WhereMemoryFailsAWorldIsRestoredWholeOrNotAtAll) {
  using S = TypeParam;
  Space<S> space;
  this->fill(space, SolverKind::softStep);
  const SavedSpace<S> saved = space.save();
  const std::uint64_t hash = space.hash();
  for (const bool withCache : {true, false}) {
    int unusable = 0;
    for (long failing = 0;; ++failing) {
      Space<S> other;
      this->wire(other);
      addDisc<S>(other, {}, S(1), S(1));
      const SavedSpace<S> before = other.save();
      const std::uint64_t hashBefore = other.hash();
      bool failed = false;
      untilFailure = failing;
      try {
        if (withCache) {
          other.restore(saved);
        } else {
          other.adopt(saved.state());
        }
      } catch (const std::bad_alloc&) {
        failed = true;
      }
      untilFailure = -1;
      if (failed) {
        unusable += other.isUsable() ? 0 : 1;
        expectAsItWasOrUnusable(other, before, hashBefore);
        other.restore(saved);
      }
      ASSERT_EQ(other.hash(), hash);
      if (!failed) break;
    }
    EXPECT_GT(unusable, 0);
  }
}

TYPED_TEST(AllocationTest, ASaveThatFailsHoldsNothing) {
  using S = TypeParam;
  Space<S> space;
  this->fill(space, SolverKind::softStep);
  for (long failing = 0;; ++failing) {
    SavedSpace<S> saved;
    bool failed = false;
    untilFailure = failing;
    try {
      space.save(saved);
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    untilFailure = -1;
    if (!failed) break;
    EXPECT_EQ(saved.state().bodies.slots(), 0u);
    EXPECT_THROW(space.restore(saved), ForeignWorld);
    EXPECT_TRUE(space.isUsable());
    space.save(saved);
    space.restore(saved);
  }
}

TYPED_TEST(AllocationTest, SavingHashingAndRestoringWithinTheSameRoomTakeNoMemory) {
  using S = TypeParam;
  Space<S> space;
  fillAtRandom(space, 3);
  SavedSpace<S> saved;
  for (int i = 0; i < 300; ++i) {
    space.step(kTick<S>);
    space.save(saved);
  }
  const auto round = [&] {
    space.save(saved);
    for (int i = 0; i < 8; ++i) space.step(kTick<S>);
    space.restore(saved);
    space.hash();
  };
  for (int i = 0; i < 20; ++i) round();

  EXPECT_EQ(this->countIn(round), 0);
}

TYPED_TEST(AllocationTest, WarmQueriesTakeNoMemory) {
  using S = TypeParam;
  Space<S> space;
  fillAtRandom(space, 2);
  std::vector<PointHit<S>> points;
  std::vector<SegmentHit<S>> segments;
  std::vector<ShapeId> boxes;
  const auto ask = [&] {
    space.pointQuery({}, S(20), {}, points);
    space.segmentQuery({S(-9), S(0)}, {S(9), S(0)}, S(1), {}, segments);
    space.boxQuery({S(-9), S(-9), S(9), S(9)}, {}, boxes);
    space.eachArbiter(space.staticBody(), [](Arbiter<S>&) {});
    const QueryView<S> view = space.queries();
    const Shape<S> asked = circleShape<S>({}, S(1));
    SegmentHit<S> hits[4];
    NearHit<S> near[4];
    ShapeId ids[4];
    view.castRay({S(-9), S(0)}, {S(9), S(0)}, {}, hits);
    view.castShape(asked, {{}, {S(-9), S(0)}, S(0), {S(18), S(0)}, S(1)}, {}, hits);
    view.nearest(asked, Transform<S>(), S(9), {}, near);
    view.overlapping(asked, Transform<S>(), {}, ids);
  };
  space.step(kTick<S>);
  ask();
  EXPECT_EQ(this->countIn(ask), 0);
}

}  // namespace
}  // namespace samestep
