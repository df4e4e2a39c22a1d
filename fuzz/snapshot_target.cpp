// SPDX-License-Identifier: MIT
// Worlds from bytes, bare or as a snapshot, whose size and checksum are made good: refused with a reason, or
// one that a Space can have, that is written back to the same bytes, and that can be stepped without any
// overflow.
#include <samestep/snapshot.h>

#include <algorithm>

#include <samestep/named_handlers.h>

#include "check.h"
#include "input.h"
#include "world_bytes.h"

namespace samestep::fuzz {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// @param steps  at most 2: of a sixtieth, and of a second
/// @return the hashes of the first steps; empty where the bytes are refused
template <Scalar S>
std::vector<std::uint64_t> run(Bytes bytes, int steps) {
  std::vector<std::uint64_t> hashes;
  std::uint64_t end = 0;
  try {
    const WorldState<S> world = readWorld<S>(bytes, end);
    if (const char* flaw = flawOf(world, kFuzzLimits)) fail(flaw);
    const std::vector<std::uint8_t> again = writeWorld(world);
    expect(again.size() == end && std::equal(again.begin(), again.end(), bytes.begin()),
           "a world is written back to the bytes it was read from");
    Space<S> space;
    registerNamedHandlers(space);
    space.adopt(world);
    hashes.push_back(space.hash());
    // A world that takes a second to solve is no finding.
    if (steps == 0 || space.settings().iterations > 20 || space.settings().substeps > 8) return hashes;
    for (int i = 0; i < steps; ++i) {
      space.step(i == 0 ? ratio<S>(1, 60) : S(1));
      hashes.push_back(space.hash());
    }
    expect(flawOf(space.state()) == nullptr, "after a step the world is still one a Space can have");
  } catch (const FormatError& error) {
    expect(error.offset() <= bytes.size(), "the offset of a fault is within the bytes");
  } catch (const Error&) {
    // A body without mass, a callback that is not registered.
  }
  return hashes;
}

template <Scalar S>
void loadWhole(Bytes bytes, OtherRevision otherRevision) {
  Space<S> space;
  registerNamedHandlers(space);
  const std::uint64_t before = space.hash();
  try {
    loadSnapshot(space, bytes, otherRevision, kFuzzLimits);
  } catch (const Error& error) {
    const auto* format = dynamic_cast<const FormatError*>(&error);
    expect(format == nullptr || format->offset() <= bytes.size(),
           "the offset of a fault is within the bytes");
    expect(space.hash() == before, "bytes that are refused change nothing");
    return;
  }
  expect(flawOf(space.state(), kFuzzLimits) == nullptr, "what is loaded is a world that a Space can have");
  if (snapshotInfo(bytes).version < kSnapshotVersion) return;
  std::vector<std::uint8_t> again(bytes.size());
  expect(saveSnapshot(space, std::span<std::uint8_t>(again)) == bytes.size(),
         "a snapshot is saved again in as many bytes");
  Space<S> copy;
  registerNamedHandlers(copy);
  loadSnapshot(copy, Bytes(again), OtherRevision::refuse, kFuzzLimits);
  expect(copy.hash() == space.hash(), "a snapshot saved again is the same world");
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep;
  using namespace samestep::fuzz;
  if (size == 0) return 0;
  const SnapshotInput input({data, size});
  if (input.isWhole) {
    input.isDouble ? loadWhole<double>(input.bytes, input.otherRevision)
                   : loadWhole<Fixed>(input.bytes, input.otherRevision);
    return 0;
  }
  // Reading is the business of this target: half of the worlds are stepped.
  const std::uint64_t choice = mixed(data, size) & 7;
  const int steps = choice < 2 ? 2 : choice < 4 ? 1 : 0;
  if (input.isDouble) {
    run<double>(input.bytes, steps);
    return 0;
  }
  expect(run<CheckedFixed>(input.bytes, steps) == run<Fixed>(input.bytes, steps),
         "Fixed does what CheckedFixed does");
  return 0;
}
