// SPDX-License-Identifier: MIT
// Scenes from text: refused with file, place and reason, or a world that can be stepped without any overflow.
#include <samestep/scene.h>

#include <cstring>
#include <string_view>
#include <vector>

#include <samestep/space_codec.h>

#include "check.h"

namespace samestep::fuzz {
namespace {

constexpr std::uint32_t kMostBodies = 64;
constexpr int kSteps = 4;

template <Scalar S>
std::vector<std::uint64_t> run(const SceneSource& source) {
  std::vector<std::uint64_t> hashes;
  try {
    Scene<S> scene(source);
    if (const char* flaw = flawOf(scene.space().state())) fail(flaw);
    hashes.push_back(scene.space().hash());
    const Settings<S>& settings = scene.space().settings();
    if (scene.space().bodyCount() > kMostBodies || settings.iterations > 20 || settings.substeps > 8)
      return hashes;
    for (int i = 0; i < kSteps; ++i) {
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
  try {
    const SceneSource source = SceneSource::fromText(text, "fuzz.json");
    if (size % 2 == 0) {
      expect(run<CheckedFixed>(source) == run<Fixed>(source), "Fixed does what CheckedFixed does");
    } else {
      run<double>(source);
    }
  } catch (const SceneError& error) {
    expect(std::strncmp(error.what(), "fuzz.json", 9) == 0, "an error names the file");
  }
  return 0;
}
