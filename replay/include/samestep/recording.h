// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/command.h>
#include <samestep/space_codec.h>

namespace samestep {

// A recording: a world, what happened to it tick by tick, and the hash of the world after every tick. It
// needs nothing else to be replayed. docs/formats.md tells every byte.

inline constexpr std::uint32_t kRecordingVersion = 2;

/// What the first bytes of a recording say.
struct RecordingInfo {
  std::uint32_t version = 0;
  std::uint32_t revision = 0;  ///< kSimulationRevision of the build that recorded it.
  ScalarKind scalar = ScalarKind::fixed;
};

/// @throws FormatError for what is no recording, and for one of another version
RecordingInfo recordingInfo(std::span<const std::uint8_t> bytes);

/// How large a recording from outside may be.
struct RecordingLimits : WorldLimits {
  RecordingLimits() = default;
  RecordingLimits(const WorldLimits& world) : WorldLimits(world) {}

  /// Of the whole recording. Some hours of a match of a dozen players are a tenth of it.
  std::uint64_t bytes = std::uint64_t{1} << 30;
  /// Between two steps.
  std::uint32_t commandsPerTick = 1u << 16;
  /// As Space::work counts it, for all of a replay: unlike a limit of seconds, no recording meets it on one
  /// machine and not on another.
  std::uint64_t work = ~std::uint64_t{0};
};

/// What stands in a recording after the first world.
enum class RecordingItem : std::uint8_t {
  step = 0,     ///< A step was made; its hash.
  command = 1,  ///< Something that was done before the next step.
  end = 2,      ///< The number of steps, then the checksum.
};

/// Reads a recording from front to back. The bytes must outlive it.
template <Scalar S>
class RecordingReader {
 public:
  /// Checks all of it first: limits, structure, numbers, checksum, that it has a step, that no command comes
  /// after the last one, whose hash would cover it, and that nothing follows.
  /// @param interrupt  asked every few items
  /// @throws FormatError, Interrupted
  explicit RecordingReader(std::span<const std::uint8_t> bytes, const RecordingLimits& limits = {},
                           const Interrupt& interrupt = {});
  /// The command at `offset`, as offset() gave it for these bytes, which moves to the next item.
  /// @throws FormatError
  static Command<S> commandAt(std::span<const std::uint8_t> bytes, std::uint64_t& offset);

  /// Seconds.
  S timeStep() const { return timeStep_; }
  /// Steps in the recording.
  std::uint64_t ticks() const { return ticks_; }
  /// Before the first step.
  const WorldState<S>& initialWorld() const { return world_; }
  std::uint64_t initialHash() const { return initialHash_; }

  /// Reads the next item; once at the end, stays there.
  RecordingItem next();
  /// Where the next item stands.
  std::uint64_t nextOffset() const { return offset_; }
  /// Of the item read last.
  std::uint64_t offset() const { return itemOffset_; }
  const Command<S>& command() const { return command_; }
  std::uint64_t hash() const { return hash_; }

 private:
  void countItems(std::uint32_t mostCommands, const Interrupt& interrupt);
  void readEnd(class ByteReader& reader) const;

  std::span<const std::uint8_t> bytes_;
  S timeStep_{};
  WorldState<S> world_;
  std::uint64_t initialHash_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint64_t offset_ = 0;
  std::uint64_t itemOffset_ = 0;
  std::uint64_t hash_ = 0;
  Command<S> command_;
};

#define SAMESTEP_EACH_SCALAR extern template class RecordingReader<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
