// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

#include <samestep/workers.h>

#include "parallel/idle.h"

namespace samestep {

/// The workers of a Space at work. One of them leads: it runs code in order, and what it calls each() for is
/// shared out among all. Ranges go to the same worker whenever the count is the same, so that data stay in
/// its cache, but a worker that has nothing left takes from the others: nobody waits for one that sleeps, or
/// that its runner never starts. Who does what changes no result: each range writes only its own records.
class Crew {
 public:
  static constexpr std::uint32_t kMostWorkers = WorkerPool::kMostWorkers;

  Crew() = default;
  ~Crew() { delete[] sections_; }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Null: alone.
  void set(TaskRunner* runner, Sharing sharing) {
    const int workers = runner == nullptr ? 1 : runner->workers();
    const std::uint32_t size = workers < 2                   ? 1
                               : workers < int{kMostWorkers} ? static_cast<std::uint32_t>(workers)
                                                             : kMostWorkers;
    Section* sections = size > 1 ? new Section[size] : nullptr;
    delete[] sections_;
    sections_ = sections;
    runner_ = runner;
    size_ = size;
    always_ = sharing == Sharing::always;
  }
  /// True if there is anybody to share with, and enough to do: at least `least` of something.
  bool helpsWith(std::uint64_t count, std::uint64_t least) const {
    return size_ > 1 && (always_ || count >= least);
  }

  /// Calls lead() on one of the workers, the others waiting for what it shares out. It may not throw, so it
  /// takes no memory.
  /// @param together  false: by the caller alone; true only where helpsWith says so
  template <class Lead>
  void during(bool together, Lead&& lead) {
    if (!together) {
      lead();
      return;
    }
    lead_ = [](void* data) noexcept { (*static_cast<Lead*>(data))(); };
    leadData_ = const_cast<void*>(static_cast<const void*>(&lead));
    led_.store(0, std::memory_order_relaxed);
    ended_.store(0, std::memory_order_relaxed);
    runner_->run(
        static_cast<int>(size_), [](int index, void* data) { static_cast<Crew*>(data)->join(index); }, this);
    leading_ = kNobody;
  }

  /// Calls part(begin, end) for ranges that make up [0, count), each of at least `grain` but the last, and
  /// returns when all have returned. For lead() alone to call; outside of during() it makes one call.
  template <class Part>
  void each(std::uint32_t count, std::uint32_t grain, Part&& part) {
    const std::uint32_t most = size_ * kRangesPerWorker;
    const std::uint32_t wanted = always_ ? count : count / grain;
    const std::uint32_t ranges = wanted < most ? wanted : most;
    if (leading_ == kNobody || ranges < 2) {
      if (count > 0) part(std::uint32_t{0}, count);
      return;
    }
    part_ = [](void* data, std::uint32_t begin, std::uint32_t end) {
      (*static_cast<std::remove_reference_t<Part>*>(data))(begin, end);
    };
    partData_ = const_cast<void*>(static_cast<const void*>(&part));
    count_ = count;
    ranges_ = ranges;
    unfinished_.store(ranges, std::memory_order_relaxed);
    ++round_;
    for (std::uint32_t i = 0; i < size_; ++i) {
      sections_[i].left.store(untaken(round_, start(i + 1) - start(i)), std::memory_order_release);
    }
    announced_.store(round_, std::memory_order_release);
    takeRanges(leading_);
    Idle idle;
    while (unfinished_.load(std::memory_order_acquire) != 0) idle.wait();
  }

 private:
  static constexpr std::uint32_t kRangesPerWorker = 4;
  static constexpr std::uint32_t kNobody = 0xffffffffu;

  /// The ranges that one worker starts with, of which others may take: how many are taken, how many there
  /// are, and of which round, in 8, 8 and 16 bits. Whoever takes one has seen all that belongs to its round,
  /// which does not end before that range does. Rounds do not come again within one during(): a step makes
  /// some 33000 of them at the most.
  struct alignas(64) Section {
    std::atomic<std::uint32_t> left{0};
  };
  static constexpr std::uint32_t kOneTaken = 1 << 8;
  static std::uint32_t untaken(std::uint32_t round, std::uint32_t ranges) { return round << 16 | ranges; }
  static std::uint32_t taken(std::uint32_t left) { return left >> 8 & 0xff; }
  static std::uint32_t ranges(std::uint32_t left) { return left & 0xff; }
  /// The first range of a worker's section.
  std::uint32_t start(std::uint32_t worker) const { return ranges_ * worker / size_; }

  void join(int index) {
    const std::uint32_t own = static_cast<std::uint32_t>(index);
    if (led_.exchange(1, std::memory_order_acq_rel) == 0) {
      leading_ = own;
      lead_(leadData_);
      ended_.store(1, std::memory_order_release);
    } else {
      std::uint32_t seen = 0;
      Idle idle;
      while (ended_.load(std::memory_order_acquire) == 0) {
        const std::uint32_t round = announced_.load(std::memory_order_acquire);
        if (round == seen) {
          idle.wait();
          continue;
        }
        seen = round;
        takeRanges(own);
        idle = Idle();
      }
    }
  }

  void takeRanges(std::uint32_t own) {
    for (std::uint32_t i = 0; i < size_; ++i) {
      const std::uint32_t worker = own + i < size_ ? own + i : own + i - size_;
      std::atomic<std::uint32_t>& section = sections_[worker].left;
      std::uint32_t left = section.load(std::memory_order_acquire);
      while (taken(left) != ranges(left)) {
        if (!section.compare_exchange_weak(left, left + kOneTaken, std::memory_order_acq_rel,
                                           std::memory_order_acquire)) {
          continue;
        }
        const std::uint64_t range = start(worker) + taken(left);
        part_(partData_, static_cast<std::uint32_t>(range * count_ / ranges_),
              static_cast<std::uint32_t>((range + 1) * count_ / ranges_));
        unfinished_.fetch_sub(1, std::memory_order_release);
        left = section.load(std::memory_order_acquire);
      }
    }
  }

  TaskRunner* runner_ = nullptr;
  std::uint32_t size_ = 1;
  bool always_ = false;
  Section* sections_ = nullptr;

  void (*lead_)(void*) noexcept = nullptr;
  void* leadData_ = nullptr;
  std::uint32_t leading_ = kNobody;
  std::uint32_t round_ = 0;
  // The following belong to the round.
  void (*part_)(void*, std::uint32_t, std::uint32_t) = nullptr;
  void* partData_ = nullptr;
  std::uint32_t count_ = 0;
  std::uint32_t ranges_ = 0;

  // These tell whether there is a leader and whether it is done. Some processors have no instructions for
  // single bytes.
  alignas(64) std::atomic<std::uint32_t> led_{0};
  std::atomic<std::uint32_t> ended_{0};
  alignas(64) std::atomic<std::uint32_t> announced_{0};
  alignas(64) std::atomic<std::uint32_t> unfinished_{0};
};

}  // namespace samestep
