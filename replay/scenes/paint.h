// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iterator>
#include <string>

#include <samestep/body.h>

namespace samestep {

/// Colours of a shape in pictures.
struct Paint {
  const char* fill;
  const char* line;
};
inline constexpr Paint kStatic{"#b9bec6", "#8d949f"};
inline constexpr Paint kKinematic{"#5fb3a8", "#2f7d73"};
inline constexpr Paint kSensor{"#f0c6da", "#c2568a"};
inline constexpr Paint kDynamic[] = {{"#f2c879", "#b98a2f"}, {"#9cc5e8", "#4f86b5"}, {"#e6a1a0", "#b3605f"},
                                     {"#b5d6a0", "#6f9c53"}, {"#cdb3e0", "#8a68a6"}, {"#f0b48a", "#b97643"},
                                     {"#a9d9d2", "#58998f"}, {"#d8cfa0", "#968a4c"}};

inline Paint paintOf(BodyType type, std::uint32_t index) {
  if (type == BodyType::staticBody) return kStatic;
  if (type == BodyType::kinematicBody) return kKinematic;
  return kDynamic[index % std::size(kDynamic)];
}

/// Text as it may stand between the tags of an SVG.
inline std::string escapedText(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "&lt;";
    } else if (c == '&') {
      safe += "&amp;";
    } else if (static_cast<unsigned char>(c) >= ' ') {
      safe += c;
    }
  }
  return safe;
}

}  // namespace samestep
