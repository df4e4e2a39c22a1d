// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <samestep/error.h>

namespace samestep {

/// A growing sequence whose erase moves the last element into the gap: O(1) to erase once found, and the
/// order after it depends on nothing but the calls made. MIS section 14.
template <class T>
class Array {
 public:
  /// Empty, with room for `capacity` elements; 0 means kDefaultCapacity. MIS: arrayNew
  explicit Array(std::size_t capacity = 0) { items_.reserve(capacity == 0 ? kDefaultCapacity : capacity); }

  static constexpr std::size_t kDefaultCapacity = 4;

  std::size_t size() const { return items_.size(); }
  bool empty() const { return items_.empty(); }

  /// @throws IndexOutOfBounds
  T& operator[](std::size_t index) {
    require<Fault::IndexOutOfBounds>(index < items_.size(), "Array: item ", index,
                                     " is asked for, there are ", items_.size());
    return items_[index];
  }
  /// @throws IndexOutOfBounds
  const T& operator[](std::size_t index) const {
    require<Fault::IndexOutOfBounds>(index < items_.size(), "Array: item ", index,
                                     " is asked for, there are ", items_.size());
    return items_[index];
  }

  /// Appends; the room doubles when it is used up. MIS: arrayPush
  void push(T item) {
    if (items_.size() == items_.capacity()) items_.reserve(2 * items_.capacity());
    items_.push_back(std::move(item));
  }

  /// Takes the last element away and returns it.
  /// @throws IndexOutOfBounds if there is none
  /// MIS: arrayPop
  T pop() {
    require<Fault::IndexOutOfBounds>(!items_.empty());
    T last = std::move(items_.back());
    items_.pop_back();
    return last;
  }

  /// Erases the first element equal to `item`, moving the last one into its place; does nothing if there is
  /// none. O(size). Whether one was erased. MIS: arrayDeleteObj
  bool deleteObj(const T& item) {
    for (std::size_t i = 0; i < items_.size(); ++i) {
      if (!(items_[i] == item)) continue;
      if (i + 1 != items_.size()) items_[i] = std::move(items_.back());
      items_.pop_back();
      return true;
    }
    return false;
  }

  /// O(size). MIS: arrayContains
  bool contains(const T& item) const {
    for (const T& each : items_) {
      if (each == item) return true;
    }
    return false;
  }

  /// Calls release(T&) on each element from the first to the last, then empties the array; its room stays.
  /// MIS: arrayFreeEach
  template <class Release>
  void clear(Release&& release) {
    for (T& each : items_) release(each);
    items_.clear();
  }
  void clear() { items_.clear(); }

  T* begin() { return items_.data(); }
  T* end() { return items_.data() + items_.size(); }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + items_.size(); }

  friend bool operator==(const Array&, const Array&) = default;

 private:
  std::vector<T> items_;
};

}  // namespace samestep
