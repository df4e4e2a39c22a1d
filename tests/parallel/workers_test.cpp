// SPDX-License-Identifier: MIT
// Pools of workers, and what a crew makes of any runner.
#include <samestep/workers.h>

#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "parallel/crew.h"

namespace samestep {
namespace {

/// Runs tasks one after the other, the last first.
class Backwards : public TaskRunner {
 public:
  int workers() const override { return 4; }
  void run(int tasks, void (*task)(int, void*), void* data) override {
    for (int i = tasks - 1; i >= 0; --i) task(i, data);
  }
};

/// A fresh thread for every task.
class ThreadEach : public TaskRunner {
 public:
  explicit ThreadEach(int workers) : workers_(workers) {}
  int workers() const override { return workers_; }
  void run(int tasks, void (*task)(int, void*), void* data) override {
    std::vector<std::thread> threads;
    for (int i = 0; i < tasks; ++i) threads.emplace_back(task, i, data);
    for (std::thread& thread : threads) thread.join();
  }

 private:
  int workers_;
};

template <class Task>
void runEach(TaskRunner& runner, int tasks, Task task) {
  runner.run(
      tasks, [](int index, void* data) { (*static_cast<Task*>(data))(index); }, &task);
}

TEST(WorkerPoolTest, RunsEveryTaskOnceForAnyNumberOfWorkersAndTasks) {
  for (int workers = 1; workers <= 8; ++workers) {
    WorkerPool pool(workers);
    ASSERT_EQ(pool.workers(), workers);
    for (const int tasks : {0, 1, 2, 7, 100}) {
      std::vector<int> runs(static_cast<std::size_t>(tasks));
      runEach(pool, tasks, [&](int index) { ++runs[static_cast<std::size_t>(index)]; });
      EXPECT_EQ(runs, std::vector<int>(static_cast<std::size_t>(tasks), 1)) << workers;
    }
  }
}

TEST(WorkerPoolTest, RunsFromSeveralThreadsTakeTurns) {
  WorkerPool pool(3);
  // Not atomic: only one run may be under way at a time.
  int inside = 0, done = 0;
  bool together = false;
  const auto use = [&](int who) {
    for (int i = 0; i < 200; ++i) {
      runEach(pool, 1, [&](int) {
        together = together || inside != 0;
        inside = who;
        std::this_thread::yield();
        ++done;
        inside = 0;
      });
    }
  };
  std::thread one(use, 1), two(use, 2);
  one.join();
  two.join();
  EXPECT_EQ(done, 400);
  EXPECT_FALSE(together);
}

TEST(WorkerPoolTest, HoldsItsSizeAndTellsWhy) {
  const auto told = [](int workers, Remark remark) {
    Remarks remarks;
    const WorkerPool pool(workers, &remarks);
    return std::pair(pool.workers(), remarks.count(remark));
  };
  EXPECT_EQ(told(0, Remark::FewerWorkers), std::pair(1, std::uint64_t{0}));
  EXPECT_EQ(told(-3, Remark::FewerWorkers), std::pair(1, std::uint64_t{0}));
  EXPECT_EQ(told(WorkerPool::kMostWorkers + 1, Remark::FewerWorkers),
            std::pair(WorkerPool::kMostWorkers, std::uint64_t{1}));
  const int more = WorkerPool::processors() + 1;
  EXPECT_EQ(told(more, Remark::MoreWorkersThanProcessors), std::pair(more, std::uint64_t{1}));
}

template <class Runner>
std::vector<std::uint32_t> countVisits(Runner& runner, std::uint32_t items, int rounds) {
  Crew crew;
  crew.set(&runner, Sharing::always);
  std::vector<std::uint32_t> visits(items);
  crew.during(true, [&] {
    for (int i = 0; i < rounds; ++i) {
      crew.each(items, 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k) ++visits[k];
      });
    }
  });
  return visits;
}

TEST(CrewTest, VisitsEveryItemOnceInEveryRound) {
  constexpr int kRounds = 2000;
  for (const std::uint32_t items : {1u, 2u, 5u, 8u, 1000u}) {
    const std::vector<std::uint32_t> all(items, kRounds);
    for (int workers = 2; workers <= 8; workers += 3) {
      WorkerPool pool(workers);
      EXPECT_EQ(countVisits(pool, items, kRounds), all) << items << " by " << workers;
    }
    Backwards backwards;
    EXPECT_EQ(countVisits(backwards, items, kRounds), all);
    ThreadEach threads(3);
    EXPECT_EQ(countVisits(threads, items, kRounds), all);
  }
}

TEST(CrewTest, ARoundSeesAllOfTheRoundBefore) {
  WorkerPool pool(4);
  Crew crew;
  crew.set(&pool, Sharing::always);
  std::vector<std::uint32_t> now(64, 1), next(64);
  std::uint32_t expected = 1;
  crew.during(true, [&] {
    for (int round = 0; round < 500; ++round) {
      crew.each(64, 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) next[i] = 3 * now[(i + 17) % 64] + 1;
      });
      std::swap(now, next);
      expected = 3 * expected + 1;
    }
  });
  EXPECT_EQ(now, std::vector<std::uint32_t>(64, expected));
}

TEST(CrewTest, WithoutARunnerItIsOneCall) {
  Crew crew;
  EXPECT_FALSE(crew.helpsWith(1000000, 1));
  std::string calls;
  crew.during(false, [&] {
    crew.each(100, 10, [&](std::uint32_t begin, std::uint32_t end) {
      calls += std::to_string(begin) + "-" + std::to_string(end) + " ";
    });
    crew.each(0, 10, [&](std::uint32_t, std::uint32_t) { calls += "none"; });
  });
  EXPECT_EQ(calls, "0-100 ");
}

}  // namespace
}  // namespace samestep
