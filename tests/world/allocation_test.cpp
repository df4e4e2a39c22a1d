// SPDX-License-Identifier: MIT
// A step of a world that has warmed up takes no memory.
#include <samestep/space.h>
#include <samestep/workers.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace {
std::atomic<long> allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace samestep {
namespace {

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
