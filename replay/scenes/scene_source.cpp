// SPDX-License-Identifier: MIT
// Finding and reading scenes, before they become numbers.
#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <samestep/scene.h>

#include "scenes/scene_cursor.h"
#include "scenes/scene_document.h"

namespace samestep {
namespace {

namespace fs = std::filesystem;

struct Family {
  const char* name;
  const char* example;
  const char* about;
  std::uint32_t largest;
};
constexpr Family kFamilies[] = {
    {"pyramid", "pyramid:10", "N rows of unit boxes, one more in each lower row (any N from 1 to 200)", 200},
    {"soup", "soup:100", "N convex polygons of 3 to 8 corners in a container (any N from 1 to 20000)", 20000},
};

std::string executableFolder() {
  std::error_code error;
  const fs::path path = fs::read_symlink("/proc/self/exe", error);
  return error ? std::string() : path.parent_path().string();
}

/// The whole of a text file.
std::string readFromDisk(const std::string& path) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error) throw SceneError(path, 0, "", "cannot be read: " + error.message());
  if (bytes > kMaxSceneFileBytes) throw SceneError(path, 0, "", "larger than 64 MiB");
  std::ifstream stream(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw SceneError(path, 0, "", "cannot be read");
  return text;
}

void readFile(const std::string& path, SceneSource::Document& document) {
  const fs::path place(path);
  document.name = place.stem().string();
  document.file = path;
  document.folder = place.has_parent_path() ? place.parent_path().string() + "/" : "";
  document.root = json::parse(readFromDisk(path), path);
}

/// "pyramid:40"; false where it is no family.
bool readFamily(std::string_view name, SceneSource::Document& document) {
  const std::string_view::size_type colon = name.find(':');
  if (colon == std::string_view::npos) return false;
  for (const Family& family : kFamilies) {
    if (name.substr(0, colon) != family.name) continue;
    const std::string_view digits = name.substr(colon + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), document.size);
    const bool whole = error == std::errc() && end == digits.data() + digits.size();
    if (!whole || document.size < 1 || document.size > family.largest) {
      throw SceneError(std::string(name), 0, "",
                       "after the colon comes a number from 1 to " + std::to_string(family.largest));
    }
    document.name = name;
    document.file = name;
    document.family = family.name;
    return true;
  }
  return false;
}

SceneSummary summaryOf(const SceneSource::Document& document) {
  SceneSummary summary;
  summary.name = document.name;
  if (!document.family.empty()) {
    summary.about = document.name;
    return summary;
  }
  const Cursor root(document.root, document.file);
  if (root.has("about")) summary.about = root.at("about").text();
  if (root.has("ticks")) summary.ticks = root.at("ticks").integer(1, 1u << 20);
  return summary;
}

}  // namespace

SceneError::SceneError(const std::string& file, std::uint32_t line, const std::string& path,
                       const std::string& reason)
    : text_(file + ":" + (line > 0 ? std::to_string(line) + ":" : "") +
            (path.empty() ? "" : " " + path + ":") + " " + reason) {}

std::vector<std::string> sceneFolders() {
  std::vector<std::string> folders;
  if (const char* chosen = std::getenv("SAMESTEP_SCENES"); chosen != nullptr && *chosen != 0) {
    folders.emplace_back(chosen);
  }
  const std::string program = executableFolder();
  if (!program.empty()) folders.push_back(program + "/" + SAMESTEP_SCENES_FROM_PROGRAM);
  folders.emplace_back(SAMESTEP_SCENES_SOURCE);
  return folders;
}

std::vector<SceneSummary> listScenes() {
  std::vector<SceneSummary> scenes;
  for (const std::string& folder : sceneFolders()) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() != ".json") continue;
      SceneSummary summary = SceneSource::find(entry.path().string()).summary();
      const auto same = [&](const SceneSummary& other) { return other.name == summary.name; };
      // A scene of an earlier folder hides one of the same name.
      if (std::none_of(scenes.begin(), scenes.end(), same)) scenes.push_back(std::move(summary));
    }
  }
  const auto byName = [](const SceneSummary& a, const SceneSummary& b) { return a.name < b.name; };
  std::sort(scenes.begin(), scenes.end(), byName);  // total order: names differ
  for (const Family& family : kFamilies) scenes.push_back({family.example, family.about, 600});
  return scenes;
}

SceneSource SceneSource::find(std::string_view nameOrPath) {
  const std::string name(nameOrPath);
  SceneSource source(new Document);
  if (readFamily(name, *source.document_)) return source;
  if (name.find('/') != std::string::npos || name.ends_with(".json")) {
    readFile(name, *source.document_);
    return source;
  }
  for (const std::string& folder : sceneFolders()) {
    const std::string path = folder + "/" + name + ".json";
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    readFile(path, *source.document_);
    return source;
  }
  throw SceneError(name, 0, "", "no scene of this name; 'samestep scenes' lists them");
}

SceneSource SceneSource::fromText(std::string_view text, const std::string& file, SceneFiles* files) {
  SceneSource source(new Document);
  source.document_->name = file;
  source.document_->file = file;
  source.document_->files = files;
  source.document_->root = json::parse(text, file);
  return source;
}

void SceneSource::useSettings(std::string_view text, const std::string& file) {
  document_->tuned = json::parse(text, file);
  document_->tunedFile = file;
}

void SceneSource::useSettingsFile(const std::string& path) { useSettings(readFromDisk(path), path); }

SceneSource::~SceneSource() { delete document_; }

std::string SceneSource::Document::read(const std::string& path) const {
  return files != nullptr ? files->read(path) : readFromDisk(path);
}

SceneSummary SceneSource::summary() const { return summaryOf(*document_); }

}  // namespace samestep
