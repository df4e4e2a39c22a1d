// SPDX-License-Identifier: MIT
// Worlds from bytes: refused with a reason, or one that a Space can have, that is written back to the same
// bytes, and that can be stepped without any overflow.
#include <samestep/space.h>

#include <algorithm>

#include <samestep/named_handlers.h>

#include "check.h"
#include "world_bytes.h"

namespace samestep::fuzz {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// @return the hashes of the first steps; empty where the bytes are refused
template <Scalar S>
std::vector<std::uint64_t> run(Bytes bytes) {
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
    // What takes a second to solve is no finding.
    if (space.settings().iterations > 20 || space.settings().substeps > 8) return hashes;
    for (int i = 0; i < 2; ++i) {
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

}  // namespace
}  // namespace samestep::fuzz

/// The first byte chooses the number type.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep;
  using namespace samestep::fuzz;
  if (size == 0) return 0;
  const Bytes bytes(data + 1, size - 1);
  if ((data[0] & 1) != 0) {
    run<double>(bytes);
    return 0;
  }
  expect(run<CheckedFixed>(bytes) == run<Fixed>(bytes), "Fixed does what CheckedFixed does");
  return 0;
}
