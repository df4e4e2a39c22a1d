// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include <samestep/scene.h>

namespace samestep {

/// The texts of the files of a scene, by name.
using Texts = std::map<std::string, std::string>;

class FilesInMemory : public SceneFiles {
 public:
  explicit FilesInMemory(const Texts& texts) : texts_(texts) {}
  std::string read(const std::string& path) override {
    const auto found = texts_.find(path);
    if (found == texts_.end()) throw SceneError(path, 0, "", "is not in memory");
    return found->second;
  }

 private:
  const Texts& texts_;
};

/// A scene called test.json that names these files and finds no others.
template <Scalar S>
Scene<S> sceneFrom(const std::string& text, const Texts& texts = {}) {
  FilesInMemory files(texts);
  return Scene<S>(SceneSource::fromText(text, "test.json", &files));
}

/// Complaint with which a scene is refused; empty where it is not.
template <Scalar S>
std::string complaint(const std::string& text, const Texts& texts = {}) {
  try {
    sceneFrom<S>(text, texts);
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

}  // namespace samestep
