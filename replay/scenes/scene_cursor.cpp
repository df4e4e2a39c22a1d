// SPDX-License-Identifier: MIT
#include "scenes/scene_cursor.h"

#include <algorithm>
#include <charconv>

namespace samestep {

const char* reasonOf(DecimalStatus status) {
  switch (status) {
    case DecimalStatus::ok:
      return nullptr;
    case DecimalStatus::empty:
    case DecimalStatus::notANumber:
      return "not a number";
    case DecimalStatus::outOfRange:
      return "too large a number for this scalar";
    case DecimalStatus::tooLong:
      return "too many digits";
  }
  return "not a number";
}

SceneError Cursor::error(const std::string& reason) const { return {*file_, node_->line, path_, reason}; }

void Cursor::fail(const std::string& reason) const { throw error(reason); }

void Cursor::expect(json::Kind kind, const char* what) const {
  if (node_->kind != kind) fail(std::string(what) + " is wanted here");
}

void Cursor::allow(std::initializer_list<std::string_view> keys) const {
  expect(json::Kind::object, "an object");
  for (const std::string& key : node_->keys) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string known;
    for (const std::string_view k : keys) known += (known.empty() ? "" : ", ") + std::string(k);
    at(key).fail("unknown key \"" + key + "\"; known here: " + known);
  }
}

Cursor Cursor::at(std::string_view key) const {
  const json::Node* child = node_->find(key);
  if (child == nullptr) fail("\"" + std::string(key) + "\" is missing");
  return {*child, *file_, path_ + "/" + std::string(key)};
}

std::uint32_t Cursor::size() const {
  expect(json::Kind::array, "an array");
  return static_cast<std::uint32_t>(node_->children.size());
}

Cursor Cursor::item(std::uint32_t index) const {
  return {node_->children[index], *file_, path_ + "/" + std::to_string(index)};
}

bool Cursor::boolean() const {
  expect(json::Kind::boolean, "true or false");
  return node_->truth;
}

const std::string& Cursor::text() const {
  expect(json::Kind::string, "a string");
  return node_->text;
}

std::uint64_t Cursor::integer(std::uint64_t low, std::uint64_t high) const {
  expect(json::Kind::number, "a whole number");
  const std::string& text = node_->text;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high) {
    fail("a whole number from " + std::to_string(low) + " to " + std::to_string(high) + " is wanted here");
  }
  return value;
}

}  // namespace samestep
