// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace samestep::json {

enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

/// A JSON value as it stands in its file: numbers are kept as text, so that each scalar reads them exactly.
struct Node {
  Kind kind = Kind::null;
  bool truth = false;
  std::uint32_t line = 0;
  std::string text;               ///< Text of a number or string.
  std::vector<std::string> keys;  ///< Keys of an object, one per child.
  std::vector<Node> children;     ///< Children of an array or object.

  /// The value of a key; null if there is none.
  const Node* find(std::string_view key) const;
};

/// Arrays and objects may be nested this deep.
inline constexpr int kMaxDepth = 32;

/// A text may hold so many values: each takes a hundred bytes, however few it has in its file.
inline constexpr std::uint32_t kMaxValues = 1u << 21;

/// @param file  what errors call the text
/// @throws SceneError for what is not JSON, repeats a key, is nested deeper than kMaxDepth or holds more than
///         kMaxValues
Node parse(std::string_view text, const std::string& file);

}  // namespace samestep::json
