// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/remark.h>

namespace samestep {

/// Interface of who does the parts of a step that several threads can do: a job system of the caller's, or a
/// WorkerPool. Its threads must have the default floating-point environment, as the stepping one must.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;
  /// Number of tasks it runs at once, at least 1. Asked once, by Space::setWorkers.
  virtual int workers() const = 0;
  /// Calls task(index, data) once for each index in [0, tasks), on any threads and in any order, and returns
  /// when all have returned. A task throws nothing and calls no run(). Tasks may wait for each other's work,
  /// but never for one that has not begun: running them one after the other is allowed.
  virtual void run(int tasks, void (*task)(int index, void* data), void* data) = 0;
};

/// Parts of a step that a Space shares out among workers.
enum class Sharing : std::uint8_t {
  whenWorth = 0,  ///< Shares what takes longer than waking somebody for it.
  always = 1,     ///< Everything that can be, in the smallest parts: for tests.
};

/// Threads that wait for tasks, briefly awake and then asleep. The thread that calls run() is one of the
/// workers. Several Spaces may share a pool, also from several threads; their runs then take turns.
class WorkerPool : public TaskRunner {
 public:
  /// More workers than any machine that this is for.
  static constexpr int kMostWorkers = 64;

  /// Held within [1, kMostWorkers]. More workers than processors work, but bring nothing; where the system
  /// gives fewer threads, or has none, there are fewer workers. Both are remarked on.
  /// @param remarks  if not null, is told; only during the call
  explicit WorkerPool(int workers, Remarks* remarks = nullptr);
  /// Waits for the threads to end.
  ~WorkerPool() override;
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const override;
  void run(int tasks, void (*task)(int index, void* data), void* data) override;

  /// Number of workers this machine runs at once, at least 1.
  static int processors();

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace samestep
