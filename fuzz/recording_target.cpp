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
#include "support/recording_sections.h"
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

/// Reads what a recording holds beside its items: worlds that can be read or are refused, in their order.
template <Scalar S>
void readBeside(const RecordingReader<S>& reader, std::size_t size) {
  std::uint64_t tick = 0;
  for (std::size_t i = 0; i < reader.keyframes().size(); ++i) {
    const Keyframe& keyframe = reader.keyframes()[i];
    expect(i == 0 ? keyframe.tick == 0 : keyframe.tick > tick, "keyframes are in order");
    expect(keyframe.offset + keyframe.bytes <= size, "a keyframe is within the bytes");
    tick = keyframe.tick;
    try {
      const WorldState<S> world = reader.world(i, kFuzzLimits);
      expect(reader.isWorld(i, world), "a world has one encoding");
    } catch (const FormatError& error) {
      expect(error.offset() <= size, "the offset of a fault is within the bytes");
    }
  }
  expect(tick <= reader.ticks(), "no keyframe is after the end");
  for (const Note& note : reader.notes()) expect(!note.key.empty(), "a key is not empty");
}

/// @return the hashes of the steps replayed
template <Scalar S>
std::vector<std::uint64_t> run(const Bytes& bytes, std::uint64_t ticks, Ending ending) {
  std::vector<std::uint64_t> hashes;
  try {
    RecordingReader<S> reader(bytes, kFuzzLimits, {}, ending);
    readBeside(reader, bytes.size());
    std::uint64_t steps = 0;
    for (;;) {
      const RecordingItem item = reader.next();
      expect(reader.offset() <= bytes.size(), "an item is within the bytes");
      if (item == RecordingItem::end) break;
      expect(reader.itemAt() < reader.nextAt() && reader.nextAt() <= reader.items().size(),
             "an item is within its section");
      if (item == RecordingItem::step) ++steps;
    }
    expect(steps == reader.ticks(), "the steps are as many as the end says");
    const Settings<S>& settings = reader.initialWorld().settings;
    if (ticks == 0 || settings.iterations > 20 || settings.substeps > 8) return hashes;
    Replay<S> replay(bytes, wiring<S>(), kFuzzLimits, {}, ending);
    while (replay.tick() < ticks && replay.step()) hashes.push_back(replay.space().hash());
    if (hashes.size() > 1) {
      replay.seek(1);
      expect(replay.space().hash() == hashes[0] || replay.reader().keyframes().size() > 1,
             "a step made again gives the same world");
    }
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
  // One of eight stays as it came.
  if (size > 0 && data[size - 1] % 8 != 0) {
    mendRevision(bytes);
    mendRecording(bytes, size > 1 && data[size - 2] % 4 != 0);
  }
  const Ending ending = (mixed(data, size) & 8) != 0 ? Ending::mayBeCut : Ending::whole;
  try {
    if (recordingInfo(bytes).scalar == ScalarKind::float64) {
      run<double>(bytes, ticks, ending);
      return 0;
    }
  } catch (const FormatError& error) {
    expect(error.offset() <= bytes.size(), "the offset of a fault is within the bytes");
    return 0;
  }
  expect(run<CheckedFixed>(bytes, ticks, ending) == run<Fixed>(bytes, ticks, ending),
         "Fixed does what CheckedFixed does");
  return 0;
}
