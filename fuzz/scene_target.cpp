// SPDX-License-Identifier: MIT
// Scenes from text, or by formula ("soup:100"): refused with file, place and reason, or a world that can be
// stepped without any overflow. What follows in an input behind bytes of zero are the files that the scene
// may name: "1", "2" and so on.
#include <samestep/scene.h>

#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <samestep/space_codec.h>

#include "check.h"
#include "input.h"

namespace samestep::fuzz {
namespace {

constexpr std::uint32_t kMostBodies = 64;
/// Reading is the business of this target: half of the scenes are stepped, one in eight more often.
constexpr int kSteps = 1, kMoreSteps = 4;

/// The scene and its files, as an input has them.
class Files : public SceneFiles {
 public:
  explicit Files(std::string_view input) {
    std::string_view::size_type end = input.find('\0');
    for (; end != std::string_view::npos; end = input.find('\0')) {
      parts_.push_back(input.substr(0, end));
      input.remove_prefix(end + 1);
    }
    parts_.push_back(input);
  }

  std::string_view scene() const { return parts_[0]; }
  /// Remembers the name of the last.
  std::string read(const std::string& name) override {
    asked_ = name;
    if (name.size() == 1 && name[0] >= '1' && name[0] <= '9') {
      const auto number = static_cast<std::size_t>(name[0] - '0');
      if (number < parts_.size()) return std::string(parts_[number]);
    }
    throw SceneError(name, 0, "", "is not among the files");
  }
  /// Expects that the error names the scene, or the last file that it named.
  void expectNamed(const SceneError& error, const std::string& file) const {
    const auto names = [&](const std::string& one) {
      const std::string begin = one + ":";
      return std::strncmp(error.what(), begin.c_str(), std::strlen(begin.c_str())) == 0;
    };
    expect(names(file) || (asked_ && names(*asked_)), "an error names the file");
  }

 private:
  std::vector<std::string_view> parts_;
  std::optional<std::string> asked_;
};

template <Scalar S>
std::vector<std::uint64_t> run(const SceneSource& source, const Files& files, const std::string& file,
                               int steps) {
  std::vector<std::uint64_t> hashes;
  try {
    Scene<S> scene(source);
    if (const char* flaw = flawOf(scene.space().state())) fail(flaw);
    hashes.push_back(scene.space().hash());
    const Settings<S>& settings = scene.space().settings();
    if (scene.space().bodyCount() > kMostBodies || settings.iterations > 20 || settings.substeps > 8)
      return hashes;
    for (int i = 0; i < steps; ++i) {
      scene.step();
      hashes.push_back(scene.space().hash());
    }
  } catch (const SceneError& error) {
    files.expectNamed(error, file);
  } catch (const Error&) {
    // A command or a step may be refused.
  }
  return hashes;
}

/// True if a text may name a scene by formula, and no file.
bool mayBeFormula(std::string_view text) {
  return text.find(':') != std::string_view::npos && text.find_first_of("{[\"./\\") == std::string_view::npos;
}

/// More digits make a world that takes its time and shows nothing new.
bool isSmall(std::string_view formula) { return formula.size() <= formula.find(':') + 3; }

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep;
  using namespace samestep::fuzz;
  Files files(std::string_view(reinterpret_cast<const char*>(data), size));
  const std::string_view text = files.scene();
  const bool formula = mayBeFormula(text);
  const std::string file = formula ? std::string(text) : "fuzz.json";
  const std::uint64_t choice = mixed(data, size) & 7;
  const int steps = choice == 0 ? kMoreSteps : choice < 4 ? kSteps : 0;
  try {
    const SceneSource source = formula ? SceneSource::find(text) : SceneSource::fromText(text, file, &files);
    if (formula && !isSmall(text)) return 0;
    if (size % 2 == 0) {
      expect(run<CheckedFixed>(source, files, file, steps) == run<Fixed>(source, files, file, steps),
             "Fixed does what CheckedFixed does");
    } else {
      run<double>(source, files, file, steps);
    }
  } catch (const SceneError& error) {
    files.expectNamed(error, file);
  }
  return 0;
}
