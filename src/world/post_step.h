// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <samestep/body.h>

namespace samestep {

/// The callbacks that wait for the end of a step or query, in the order they were added.
template <Scalar S>
class PostStepQueue {
 public:
  using Function = void (*)(Space<S>& space, std::uint64_t key, void* data);

  bool running() const { return running_; }
  /// How many there are, those that ran in the go under way included: a place for dropFrom.
  std::size_t size() const { return waiting_.size(); }
  /// Forgets those added since the queue had a size: what they were to do belongs to what has not happened.
  void dropFrom(std::size_t size) {
    if (waiting_.size() > size)
      waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(size), waiting_.end());
  }
  /// Forgets all that wait: what they were to do belongs to a world that is gone.
  void drop() { dropFrom(done_); }
  /// @return false if the key is waiting already
  bool add(Function function, std::uint64_t key, void* data) {
    for (const Callback& waiting : waiting_) {
      if (waiting.function != nullptr && waiting.key == key) return false;
    }
    waiting_.push_back({function, key, data});
    return true;
  }
  /// Calls them. A callback may add callbacks: they run in the same go. After one that throws the later ones
  /// wait for the next time.
  void run(Space<S>& space) {
    const Running running(*this);
    while (done_ < waiting_.size()) {
      const Callback callback = waiting_[done_];
      waiting_[done_++].function = nullptr;
      callback.function(space, callback.key, callback.data);
    }
  }

 private:
  struct Callback {
    Function function;
    std::uint64_t key;
    void* data;
  };
  class Running {
   public:
    explicit Running(PostStepQueue& queue) : queue_(queue) {
      queue_.done_ = 0;
      queue_.running_ = true;
    }
    ~Running() {
      auto& waiting = queue_.waiting_;
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(queue_.done_));
      queue_.done_ = 0;
      queue_.running_ = false;
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    PostStepQueue& queue_;
  };

  std::vector<Callback> waiting_;
  std::size_t done_ = 0;
  bool running_ = false;
};

}  // namespace samestep
