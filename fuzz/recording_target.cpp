// SPDX-License-Identifier: MIT
// Recordings from bytes, with revision and checksum made good: refused with a reason, or read to the end,
// replayed for some steps without any overflow.
#include <samestep/named_handlers.h>
#include <samestep/recording.h>
#include <samestep/replay.h>

#include <vector>

#include "check.h"
#include "input.h"
#include "mend.h"
#include "world_bytes.h"

namespace samestep::fuzz {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Reading is the business of this target: of half of the recordings so much is replayed, of one in eight
/// more.
constexpr std::uint64_t kTicks = 3, kMoreTicks = 16;

template <Scalar S>
Wiring<S> wiring() {
  Wiring<S> result = namedHandlerWiring<S>();
  result.applyInput = [](Space<S>& space, std::span<const std::uint8_t> bytes, void*) {
    require<Fault::ValueOutOfRange>(!bytes.empty());
    space.body(space.staticBody()).setUserData(bytes[0]);
  };
  return result;
}

/// @return the hashes of the steps replayed
template <Scalar S>
std::vector<std::uint64_t> run(const Bytes& bytes, std::uint64_t ticks) {
  std::vector<std::uint64_t> hashes;
  try {
    RecordingReader<S> reader(bytes, kFuzzLimits);
    std::uint64_t steps = 0;
    for (;;) {
      const RecordingItem item = reader.next();
      expect(reader.offset() < bytes.size(), "an item is within the bytes");
      if (item == RecordingItem::end) break;
      if (item == RecordingItem::step) ++steps;
    }
    expect(steps == reader.ticks(), "the steps are as many as the end says");
    const Settings<S>& settings = reader.initialWorld().settings;
    if (ticks == 0 || settings.iterations > 20 || settings.substeps > 8) return hashes;
    Replay<S> replay(bytes, wiring<S>(), kFuzzLimits);
    while (replay.tick() < ticks && replay.step()) hashes.push_back(replay.space().hash());
  } catch (const FormatError& error) {
    expect(error.offset() <= bytes.size(), "the offset of a fault is within the bytes");
  } catch (const Error&) {
    // A body without mass, a callback that is not registered.
  }
  return hashes;
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep;
  using namespace samestep::fuzz;
  Bytes bytes(data, data + size);
  const std::uint64_t choice = mixed(data, size) & 7;
  const std::uint64_t ticks = choice == 0 ? kMoreTicks : choice < 4 ? kTicks : 0;
  // As it came in one of eight.
  if (size > 0 && data[size - 1] % 8 != 0) {
    mendRevision(bytes);
    mendChecksum(bytes);
  }
  try {
    if (recordingInfo(bytes).scalar == ScalarKind::float64) {
      run<double>(bytes, ticks);
      return 0;
    }
  } catch (const FormatError& error) {
    expect(error.offset() <= bytes.size(), "the offset of a fault is within the bytes");
    return 0;
  }
  expect(run<CheckedFixed>(bytes, ticks) == run<Fixed>(bytes, ticks), "Fixed does what CheckedFixed does");
  return 0;
}
