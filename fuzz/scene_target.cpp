// SPDX-License-Identifier: MIT
// Scenes from text: refused with file, place and reason, or a world that can be stepped without any overflow.
#include <samestep/scene.h>

#include <cstring>
#include <string_view>
#include <vector>

#include <samestep/space_codec.h>

#include "check.h"
#include "input.h"

namespace samestep::fuzz {
namespace {

constexpr std::uint32_t kMostBodies = 64;
/// Reading is the business of this target: most scenes are stepped once, one in eight more often.
constexpr int kSteps = 1, kMoreSteps = 4;

template <Scalar S>
std::vector<std::uint64_t> run(const SceneSource& source, int steps) {
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
    expect(std::strncmp(error.what(), "fuzz.json", 9) == 0, "an error names the file");
  } catch (const Error&) {
    // What a command or a step refuses.
  }
  return hashes;
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep;
  using namespace samestep::fuzz;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // A scene may name other files; those are the reader's business, and here a way out.
  if (text.find("csv") != std::string_view::npos || text.find("\\u") != std::string_view::npos) return 0;
  const int steps = (mixed(data, size) & 7) == 0 ? kMoreSteps : kSteps;
  try {
    const SceneSource source = SceneSource::fromText(text, "fuzz.json");
    if (size % 2 == 0) {
      expect(run<CheckedFixed>(source, steps) == run<Fixed>(source, steps),
             "Fixed does what CheckedFixed does");
    } else {
      run<double>(source, steps);
    }
  } catch (const SceneError& error) {
    expect(std::strncmp(error.what(), "fuzz.json", 9) == 0, "an error names the file");
  }
  return 0;
}
