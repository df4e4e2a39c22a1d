// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include <samestep/decimal.h>
#include <samestep/error.h>
#include <samestep/scene.h>

#include "scenes/json.h"

namespace samestep {

/// Reason why a text is no number of S, for people; null where it is one.
const char* reasonOf(DecimalStatus status);

/// A value of a scene file and the way to it, so that whatever is wrong with it can be told with its place.
class Cursor {
 public:
  Cursor(const json::Node& node, const std::string& file, std::string path = {})
      : node_(&node), file_(&file), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& reason) const;
  /// Error that fail throws.
  SceneError error(const std::string& reason) const;
  std::uint32_t line() const { return node_->line; }

  /// Refuses what is no object, and keys other than these.
  void allow(std::initializer_list<std::string_view> keys) const;
  bool has(std::string_view key) const { return node_->find(key) != nullptr; }
  /// Value under a key of an object: refuses it where the key is missing.
  Cursor at(std::string_view key) const;
  /// Number of values of an array.
  std::uint32_t size() const;
  Cursor item(std::uint32_t index) const;

  bool boolean() const;
  const std::string& text() const;
  std::uint64_t integer(std::uint64_t low, std::uint64_t high) const;
  bool isArray() const { return node_->kind == json::Kind::array; }
  bool isObject() const { return node_->kind == json::Kind::object; }
  template <Scalar S>
  S number() const {
    expect(json::Kind::number, "a number");
    S value{};
    const char* reason = reasonOf(parseDecimal(std::string_view(node_->text), value));
    if (reason != nullptr) fail(reason);
    return value;
  }
  template <Scalar S>
  Vector<S> vector() const {
    if (!isArray() || node_->children.size() != 2) fail("an array of two numbers is wanted here");
    return {item(0).number<S>(), item(1).number<S>()};
  }

  /// Does something with the value of a key, if there is one; see guard.
  template <class Action>
  void optional(std::string_view key, Action&& action) const {
    if (!has(key)) return;
    const Cursor value = at(key);
    value.guard([&] { action(value); });
  }
  /// Does something with the engine and gives what it refuses this place.
  template <class Action>
  auto guard(Action&& action) const {
    try {
      const FailuresAreCaught caught;
      return action();
    } catch (const Error& error) {
      fail(error.what());
    }
  }

 private:
  void expect(json::Kind kind, const char* what) const;

  const json::Node* node_;
  const std::string* file_;
  std::string path_;
};

}  // namespace samestep
