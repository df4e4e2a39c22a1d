// SPDX-License-Identifier: MIT
// Scenes from text, or by formula ("soup:100"): refused with file, place and reason, or a world that can be
// stepped without any overflow.
#include <samestep/scene.h>

#include <cstring>
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

void expectNamed(const SceneError& error, const std::string& file) {
  expect(std::strncmp(error.what(), file.c_str(), file.size()) == 0, "an error names the file");
}

template <Scalar S>
std::vector<std::uint64_t> run(const SceneSource& source, const std::string& file, int steps) {
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
    expectNamed(error, file);
  } catch (const Error&) {
    // What a command or a step refuses.
  }
  return hashes;
}

/// Whether a text may name a scene by formula, and no file.
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
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // A scene may name other files; those are the reader's business, and here a way out.
  for (const char* word : {"csv", "inputs", "\\u"}) {
    if (text.find(word) != std::string_view::npos) return 0;
  }
  const bool formula = mayBeFormula(text);
  const std::string file = formula ? std::string(text.substr(0, text.find('\0'))) : "fuzz.json";
  const std::uint64_t choice = mixed(data, size) & 7;
  const int steps = choice == 0 ? kMoreSteps : choice < 4 ? kSteps : 0;
  try {
    const SceneSource source = formula ? SceneSource::find(text) : SceneSource::fromText(text, file);
    if (formula && !isSmall(text)) return 0;
    if (size % 2 == 0) {
      expect(run<CheckedFixed>(source, file, steps) == run<Fixed>(source, file, steps),
             "Fixed does what CheckedFixed does");
    } else {
      run<double>(source, file, steps);
    }
  } catch (const SceneError& error) {
    expectNamed(error, file);
  }
  return 0;
}
