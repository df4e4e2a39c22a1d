// SPDX-License-Identifier: MIT
// A step of a world that has warmed up takes no memory.
#include <samestep/space.h>
#include <samestep/workers.h>

#include <malloc.h>

#include <atomic>
#include <concepts>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace {
std::atomic<long> allocations = 0;
std::atomic<std::size_t> live = 0;
std::atomic<std::size_t> mostLive = 0;

/// How many more calls take memory before one fails; none fails below 0.
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

/// What a Space takes at the worst for each pair, with all that belongs to its shapes, bytes.
template <Scalar S>
double mostBytesPerPair(SolverKind solver, ContactPrecision precision) {
  if (solver == SolverKind::sequentialImpulses) return 1300;
  if (std::floating_point<S>) return 2800;
  return precision == ContactPrecision::fast ? 3300 : 2400;
}

template <Scalar S>
class AllocationTest : public ::testing::Test {
 protected:
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
  // The same steps again need no more room than the first time.
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
  };
  space.step(kTick<S>);
  ask();
  EXPECT_EQ(this->countIn(ask), 0);
}

}  // namespace
}  // namespace samestep
