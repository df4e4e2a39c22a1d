// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <samestep/scene.h>

#include "scenes/json.h"

namespace samestep {

/// Document that SceneSource holds: a parsed file, or the name and number of a family.
struct SceneSource::Document {
  std::string name;
  std::string file;             ///< Name of the file in errors.
  std::string folder;           ///< Folder of the files that it names; with a slash at the end, or empty.
  SceneFiles* files = nullptr;  ///< Null for those on disk.
  json::Node root;
  std::optional<json::Node> tuned;  ///< Settings in place of the scene's own.
  std::string tunedFile;
  std::string family;  ///< Empty for a file.
  std::uint32_t size = 0;

  /// The text of a file that the scene names.
  /// @throws SceneError
  std::string read(const std::string& path) const;
};

/// A scene may have so many bodies, shapes, joints and events, and each of its files so many bytes.
inline constexpr std::uint32_t kMaxSceneBodies = 65536;
inline constexpr std::uint32_t kMaxSceneShapes = 65536;
inline constexpr std::uint32_t kMaxSceneJoints = 65536;
inline constexpr std::uint32_t kMaxSceneEvents = 1u << 20;
inline constexpr std::uint64_t kMaxSceneFileBytes = std::uint64_t{64} << 20;

/// "too many shapes: at most 65536"
inline std::string tooMany(const char* what, std::uint32_t most) {
  return "too many " + std::string(what) + ": at most " + std::to_string(most);
}

/// Calls visit(line number, line) for each line that is neither empty nor begins with '#'.
template <class Visit>
void eachLine(std::string_view text, Visit&& visit) {
  for (std::uint32_t number = 1; !text.empty(); ++number) {
    const std::string_view::size_type end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (!line.empty() && line.front() != '#') visit(number, line);
  }
}

}  // namespace samestep
