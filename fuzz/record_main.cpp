// SPDX-License-Identifier: MIT
// Makes a recording of an input of the target snapshot or recording, which the program draws, compares and
// verifies like any other.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include <samestep/named_handlers.h>
#include <samestep/recorder.h>
#include <samestep/snapshot.h>

#include "mend.h"
#include "support/recording_sections.h"
#include "world_bytes.h"

namespace {

using namespace samestep;
using namespace samestep::fuzz;
using Bytes = std::vector<std::uint8_t>;

constexpr int kSteps = 60;

template <Scalar S>
Bytes recordWorld(const SnapshotInput& input) {
  Space<S> space;
  registerNamedHandlers(space);
  if (input.isWhole) {
    loadSnapshot(space, std::span<const std::uint8_t>(input.bytes), input.otherRevision, kFuzzLimits);
  } else {
    std::uint64_t end = 0;
    space.adopt(readWorld<S>(input.bytes, end));
  }
  Bytes recording;
  Recorder<S> recorder(space, ratio<S>(1, 60), recording, namedHandlerWiring<S>());
  try {
    for (int i = 0; i < kSteps; ++i) recorder.step();
  } catch (const Error& error) {
    std::fprintf(stderr, "a step is refused: %s\n", error.what());
  }
  recorder.finish();
  return recording;
}

Bytes recordingOf(const std::string& target, Bytes input) {
  if (target == "snapshot") {
    if (input.empty()) return {};
    const SnapshotInput world(input);
    return world.isDouble ? recordWorld<double>(world) : recordWorld<Fixed>(world);
  }
  mendRevision(input);
  mendRecording(input);
  return input;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string target = argc == 4 ? argv[1] : "";
  if (target != "snapshot" && target != "recording") {
    std::fputs("usage: samestep_fuzz_record snapshot|recording INPUT RECORDING\n", stderr);
    return 2;
  }
  std::ifstream file(argv[2], std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", argv[2]);
    return 1;
  }
  try {
    const Bytes made =
        recordingOf(target, {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
    std::ofstream out(argv[3], std::ios::binary);
    out.write(reinterpret_cast<const char*>(made.data()), static_cast<std::streamsize>(made.size()));
    out.close();
    if (out) return 0;
    std::fprintf(stderr, "%s: cannot be written\n", argv[3]);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s: %s\n", argv[2], error.what());
  }
  return 1;
}
