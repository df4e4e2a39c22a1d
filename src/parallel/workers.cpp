// SPDX-License-Identifier: MIT
#include <samestep/workers.h>

#include "parallel/idle.h"

#ifdef SAMESTEP_THREADS
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>
#endif

namespace samestep {

#ifdef SAMESTEP_THREADS

struct WorkerPool::Impl {
  /// Number of times a thread looks for tasks before it sleeps: some tenths of a millisecond, as a step has
  /// several parts.
  static constexpr std::uint32_t kAwakeRounds = 600;

  std::mutex running;  ///< One run at a time.
  std::mutex mutex;    ///< Guards all below but what is atomic.
  std::condition_variable tasksWait, allDone;
  void (*task)(int, void*) = nullptr;
  void* data = nullptr;
  int begun = 0;  ///< Tasks that someone has begun.
  std::vector<std::uint8_t> taken;
  bool sleeping = false;  ///< True while run() waits on allDone.
  bool ending = false;
  std::atomic<std::uint32_t> runs{0};
  std::atomic<int> unfinished{0};
  std::vector<std::thread> threads;

  /// Runs what nobody has begun, the task of its own number first: the same data stay with the same thread.
  void work(int own) {
    std::unique_lock<std::mutex> lock(mutex);
    while (begun < static_cast<int>(taken.size())) {
      std::size_t next = static_cast<std::size_t>(own);
      if (next >= taken.size() || taken[next] != 0) {
        next = static_cast<std::size_t>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
      }
      taken[next] = 1;
      ++begun;
      lock.unlock();
      task(static_cast<int>(next), data);
      lock.lock();
      if (unfinished.fetch_sub(1) == 1 && sleeping) allDone.notify_one();
    }
  }

  void serve(int own) {
    std::uint32_t seen = 0;
    for (;;) {
      Idle idle;
      while (runs.load() == seen && idle.rounds() < kAwakeRounds) idle.wait();
      {
        std::unique_lock<std::mutex> lock(mutex);
        tasksWait.wait(lock, [&] { return runs.load() != seen || ending; });
        if (ending) return;
        seen = runs.load();
      }
      work(own);
    }
  }

  void run(int tasks, void (*what)(int, void*), void* with) {
    const std::lock_guard<std::mutex> alone(running);
    {
      const std::lock_guard<std::mutex> lock(mutex);
      task = what;
      data = with;
      begun = 0;
      taken.assign(static_cast<std::size_t>(tasks), 0);
      unfinished.store(tasks);
      runs.fetch_add(1);
    }
    tasksWait.notify_all();
    work(0);
    Idle idle;
    while (unfinished.load() != 0 && idle.rounds() < kAwakeRounds) idle.wait();
    std::unique_lock<std::mutex> lock(mutex);
    sleeping = true;
    allDone.wait(lock, [&] { return unfinished.load() == 0; });
    sleeping = false;
  }

  /// @return false where the system gives no more threads
  bool addThread() {
    const int own = static_cast<int>(threads.size()) + 1;
#if defined(__cpp_exceptions)
    try {
      threads.emplace_back([this, own] { serve(own); });
    } catch (const std::system_error&) {
      return false;
    }
#else
    threads.emplace_back([this, own] { serve(own); });
#endif
    return true;
  }
};

WorkerPool::WorkerPool(int workers, Remarks* remarks) : impl_(new Impl) {
  const int wanted = std::clamp(workers, 1, kMostWorkers);
  impl_->threads.reserve(static_cast<std::size_t>(wanted - 1));
  while (this->workers() < wanted && impl_->addThread()) {
  }
  if (remarks == nullptr) return;
  if (this->workers() < workers) {
    remarks->raise(Remark::FewerWorkers, "There are fewer workers than were asked for. No result differs.");
  } else if (workers > processors()) {
    remarks->raise(Remark::MoreWorkersThanProcessors,
                   "More workers than this machine runs at once. No result differs.");
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->ending = true;
    impl_->runs.fetch_add(1);
  }
  impl_->tasksWait.notify_all();
  for (std::thread& thread : impl_->threads) thread.join();
  delete impl_;
}

int WorkerPool::workers() const { return static_cast<int>(impl_->threads.size()) + 1; }

void WorkerPool::run(int tasks, void (*task)(int index, void* data), void* data) {
  if (tasks > 0) impl_->run(tasks, task, data);
}

int WorkerPool::processors() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

#else

struct WorkerPool::Impl {};

WorkerPool::WorkerPool(int workers, Remarks* remarks) : impl_(nullptr) {
  if (remarks != nullptr && workers > 1) {
    remarks->raise(Remark::FewerWorkers, "There are fewer workers than were asked for. No result differs.");
  }
}
WorkerPool::~WorkerPool() = default;
int WorkerPool::workers() const { return 1; }
void WorkerPool::run(int tasks, void (*task)(int index, void* data), void* data) {
  for (int i = 0; i < tasks; ++i) task(i, data);
}
int WorkerPool::processors() { return 1; }

#endif

}  // namespace samestep
