// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <samestep/id.h>
#include <samestep/scalar.h>
#include <samestep/state.h>
#include <samestep/vector.h>

namespace samestep {

/// Visits the fields of a record down to its plain numbers: counts them and their bytes, and changes the one
/// with a given place.
class LeafVisitor {
 public:
  static constexpr int kNone = -1;

  explicit LeafVisitor(int target = kNone) : target_(target) {}

  template <class T>
  void operator()(const char* name, T& field) {
    const std::string outer = path_;
    path_ += (path_.empty() ? "" : ".") + std::string(name);
    descend(field);
    path_ = outer;
  }

  int count() const { return count_; }
  std::size_t bytes() const { return bytes_; }
  /// Name of the one that was changed.
  const std::string& changed() const { return changed_; }

 private:
  template <class T>
  void descend(T& field) {
    if constexpr (requires(LeafVisitor & v) { T::fields(field, v); }) {
      T::fields(field, *this);
    } else if constexpr (std::is_array_v<T>) {
      for (auto& element : field) descend(element);
    } else if constexpr (requires { field.x, field.y; }) {
      descend(field.x);
      descend(field.y);
    } else if constexpr (requires { field.index, field.generation; }) {
      descend(field.index);
      descend(field.generation);
    } else {
      leaf(field);
    }
  }

  template <class T>
  void leaf(T& value) {
    bytes_ += sizeof(T);
    if (count_++ != target_) return;
    changed_ = path_;
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(static_cast<std::underlying_type_t<T>>(value) ^ 1);
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(value ^ 1);
    } else if constexpr (requires { value = value + T(1); }) {
      value = value + T(1);
    } else {
      value = value + T(Fixed(1));
    }
  }

  int target_;
  int count_ = 0;
  std::size_t bytes_ = 0;
  std::string path_;
  std::string changed_;
};

/// The plain numbers of a record.
template <class T>
LeafVisitor leavesOf(T record) {
  LeafVisitor visitor;
  T::fields(record, visitor);
  return visitor;
}

/// Changes the number at a place; says which it was.
template <class T>
std::string changeLeaf(T& record, int place) {
  LeafVisitor visitor(place);
  T::fields(record, visitor);
  return visitor.changed();
}

/// Changes the field or section with a given place in the list of a world's sections.
struct SectionChange {
  int target;
  int place = 0;
  std::string changed{};

  template <class T>
  void operator()(const char* name, T& field) {
    if (place++ != target) return;
    changed = name;
    LeafVisitor change(0);
    change(name, field);
  }
  template <class T, class IdType>
  void operator()(const Section& section, SlotMap<T, IdType>& records) {
    if (place++ != target) return;
    changed = section.object;
    changeLeaf(records.valueAt(records.slots() - 1), 0);
  }
  template <class T>
  void operator()(const Section& section, std::vector<T>& records) {
    if (place++ != target) return;
    changed = section.object;
    if (records.empty()) {
      records.emplace_back();
    } else {
      records.pop_back();
    }
  }
};

/// Changes the field or section at a place of a world that has records in each; says which, or nothing past
/// the last place.
template <class World>
std::string changeSection(World& world, int place) {
  SectionChange change{place};
  World::sections(change, world);
  return change.changed;
}

}  // namespace samestep
