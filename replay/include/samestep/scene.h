// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <samestep/command.h>
#include <samestep/space.h>

namespace samestep {

/// A scene that cannot be used, and where: "arena.json:12: /bodies/3/mass: Body's mass is negative."
class SceneError : public std::exception {
 public:
  /// @param line  from 1; 0 where no line is to blame
  /// @param path  of the value within the document, as "/bodies/3/mass"
  SceneError(const std::string& file, std::uint32_t line, const std::string& path, const std::string& reason);

  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// The parts of a scene that all number types share; see docs/formats.md.
struct SceneSummary {
  std::string name;
  std::string about;
  std::uint64_t ticks = 600;  ///< Number of ticks it is worth watching.
};

/// Source of the files that a scene names.
class SceneFiles {
 public:
  virtual ~SceneFiles() = default;
  /// The whole text of a file.
  /// @param path  the folder of the scene and the name that stands in it
  /// @throws SceneError where there is none
  virtual std::string read(const std::string& path) = 0;
};

/// A scene's file, read but not yet turned into numbers.
class SceneSource {
 public:
  /// Reads a scene by its path (it ends in .json), by its name, or one of a family: "pyramid:40", "soup:500".
  /// @throws SceneError
  static SceneSource find(std::string_view nameOrPath);
  /// A scene from memory: out of an archive, or sent by somebody whose scenes may name no file here.
  /// @param file  what errors call it
  /// @param files  those that it names, read whenever a Scene is made of it, and which must outlive it; null
  ///               for the disk, where they are looked for in the working folder
  /// @throws SceneError
  static SceneSource fromText(std::string_view text, const std::string& file, SceneFiles* files = nullptr);

  SceneSource(SceneSource&& other) noexcept : document_(std::exchange(other.document_, nullptr)) {}
  SceneSource& operator=(SceneSource&& other) noexcept {
    std::swap(document_, other.document_);
    return *this;
  }
  ~SceneSource();

  SceneSummary summary() const;

  /// Puts settings in the place of the scene's own, as `samestep tune` writes them. They are read when a
  /// Scene is made of it, which throws SceneError for what is wrong with them.
  /// @param file  what errors call them
  /// @throws SceneError for what is no JSON
  void useSettings(std::string_view text, const std::string& file);
  /// Puts the settings of a file in the place of the scene's own.
  /// @throws SceneError for one that cannot be read, too
  void useSettingsFile(const std::string& path);

  struct Document;
  const Document& document() const { return *document_; }

 private:
  explicit SceneSource(Document* document) : document_(document) {}
  Document* document_;
};

/// The scenes that can be found by name, sorted by name, the families with an example number last.
/// @throws SceneError where a file in the folder of scenes is none
std::vector<SceneSummary> listScenes();
/// Folders in which scenes are looked for by name, in this order: the environment's SAMESTEP_SCENES, where
/// the program was installed, where it was built.
std::vector<std::string> sceneFolders();

/// A scene under way: its world, and the commands that its events turn into.
template <Scalar S>
class Scene {
 public:
  /// @throws SceneError
  explicit Scene(const SceneSource& source);

  Space<S>& space() { return space_; }
  const Space<S>& space() const { return space_; }
  /// Seconds.
  S timeStep() const { return timeStep_; }
  /// True if anything is to happen at a numbered step.
  bool hasEvents() const { return !events_.empty(); }
  /// Steps made so far.
  std::uint64_t tick() const { return space_.stamp(); }

  /// The next command due before the coming step, or null. It is to be applied before the next call. Events
  /// for bodies and joints that are gone are left out.
  const Command<S>* nextCommand();
  /// Applies the commands that are due, then makes a step.
  /// @throws SceneError for a command that cannot be done, with its place; for a step that cannot be made,
  /// with
  ///         the place of a body that no step can move, else with its number
  void step();
  /// Error of a command or step by other means, as step would throw it: for who applies commands and makes
  /// steps alone.
  SceneError refused(const Error& error) const;

 private:
  /// A command whose body is still a name.
  struct Event {
    Event(std::uint64_t tickIn, std::uint32_t nameIn, std::uint32_t lineIn, Command<S>&& commandIn)
        : tick(tickIn), name(nameIn), line(lineIn), command(std::move(commandIn)) {}
    std::uint64_t tick;
    std::uint32_t name;
    std::uint32_t line;    // Line in the scene's file, or in that of its inputs.
    bool isInput = false;  // True if it stands there.
    Command<S> command;
  };
  template <Scalar T>
  friend class SceneBuilder;

  Space<S> space_;
  S timeStep_{};
  std::vector<Event> events_;
  std::vector<BodyId> names_;
  std::uint64_t next_ = 0;
  bool commandsDone_ = true;  // True if all that are due before the coming step were given out.
  std::string file_;
  std::string inputsFile_;
  std::optional<SceneError> unsteppable_;  // The first body that is so as it stands in the scene.
};

/// Sets what stands in a document of settings, as `samestep tune` writes it: "settings" as in a scene, and
/// "stepsPerSecond" if it is there.
/// @param file  what errors call it
/// @return steps per second; 0 where the document has none
/// @throws SceneError; the Space is then as it was
template <Scalar S>
std::uint32_t useSettings(Space<S>& space, std::string_view text, const std::string& file);

#define SAMESTEP_EACH_SCALAR      \
  extern template class Scene<S>; \
  extern template std::uint32_t useSettings<S>(Space<S>&, std::string_view, const std::string&);
#include <samestep/each_scalar.h>

}  // namespace samestep
