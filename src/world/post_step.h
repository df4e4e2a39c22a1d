// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
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
  /// Number of callbacks, those that ran in the go under way included: a place for dropFrom.
  std::size_t size() const { return waiting_.size(); }
  /// Forgets those added since the queue had a size: what they were to do belongs to what has not happened.
  void dropFrom(std::size_t size) {
    if (waiting_.size() <= size) return;
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(size), waiting_.end());
    fillPlaces();
  }
  /// Forgets all that wait: what they were to do belongs to a world that is gone.
  void drop() { dropFrom(done_); }
  /// @return false if the key is waiting already
  bool add(Function function, std::uint64_t key, void* data) {
    if (2 * (waiting_.size() + 1) > places_.size()) growPlaces();
    std::uint32_t& place = placeOf(key);
    if (place != kNone && waiting_[place].function != nullptr) return false;
    waiting_.push_back({function, key, data});
    place = static_cast<std::uint32_t>(waiting_.size() - 1);
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
      if (queue_.done_ > 0) queue_.fillPlaces();
      queue_.done_ = 0;
      queue_.running_ = false;
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    PostStepQueue& queue_;
  };

  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Place of a key in the table, or where it would be: it has a power of two of places, at least half of
  /// them free.
  std::uint32_t& placeOf(std::uint64_t key) {
    const std::size_t last = places_.size() - 1;
    std::size_t at = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 32) & last;
    while (places_[at] != kNone && waiting_[places_[at]].key != key) at = (at + 1) & last;
    return places_[at];
  }
  void growPlaces() {
    places_.resize(places_.empty() ? 16 : 2 * places_.size());
    fillPlaces();
  }
  void fillPlaces() {
    std::fill(places_.begin(), places_.end(), kNone);
    for (std::uint32_t i = 0; i < waiting_.size(); ++i) placeOf(waiting_[i].key) = i;
  }

  std::vector<Callback> waiting_;
  /// Place of the last callback that was added under a key.
  std::vector<std::uint32_t> places_;
  std::size_t done_ = 0;
  bool running_ = false;
};

}  // namespace samestep
