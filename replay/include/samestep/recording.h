// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <samestep/command.h>
#include <samestep/space_codec.h>

namespace samestep {

// A recording: a world, what happened to it tick by tick, and the hash of the world after every tick. It
// needs nothing else to be replayed. docs/formats.md tells every byte.

/// Version that a Recorder writes.
inline constexpr std::uint32_t kRecordingVersion = 4;
/// Oldest version that readers still take.
inline constexpr std::uint32_t kOldestRecordingVersion = 2;

/// Limits of a claim and of a note: bytes of a key, and of a value.
inline constexpr std::uint32_t kMaxKeyBytes = 255;
inline constexpr std::uint32_t kMaxClaimBytes = 4096;
inline constexpr std::uint32_t kMaxNoteBytes = 1u << 16;

/// Header of a recording: what its first bytes say.
struct RecordingInfo {
  std::uint32_t version = 0;
  std::uint32_t revision = 0;  ///< kSimulationRevision of the build that recorded it.
  ScalarKind scalar = ScalarKind::fixed;
};

/// @throws FormatError for what is no recording, and for one of another version
RecordingInfo recordingInfo(std::span<const std::uint8_t> bytes);

/// Limits of a recording from outside.
struct RecordingLimits : WorldLimits {
  RecordingLimits() = default;
  RecordingLimits(const WorldLimits& world) : WorldLimits(world) {}

  /// Bytes of the whole recording, and of what is packed in it when it is unpacked. Some hours of a match of
  /// a dozen players are a tenth of it.
  std::uint64_t bytes = std::uint64_t{1} << 30;
  /// Limit of commands between two steps.
  std::uint32_t commandsPerTick = 1u << 16;
  /// Work as Space::work counts it, for all of a replay: unlike a limit of seconds, no recording meets it on
  /// one machine and not on another.
  std::uint64_t work = ~std::uint64_t{0};
};

/// True if this build has zstd: it can then pack recordings, and read packed ones.
bool packingAvailable();

/// Kind of an item in a recording after the first world.
enum class RecordingItem : std::uint8_t {
  step = 0,     ///< A step was made; its hash.
  command = 1,  ///< Something that was done before the next step.
  end = 2,      ///< Nothing follows.
  claim = 3,    ///< The game says something about the world as it is after the last step.
};

/// Claim: what a recording says about a world without proving it, a score, a winner, a lap time. Only the
/// game knows what a key means; see Wiring::checkClaim.
struct Claim {
  std::string_view key;
  std::span<const std::uint8_t> value;
};

/// Something beside the match, which nothing is made of: names of players, of the level, of the build.
struct Note {
  std::string_view key;
  std::string_view value;
};

/// A world within a recording.
struct Keyframe {
  std::uint64_t tick = 0;    ///< After which it stands.
  std::uint64_t hash = 0;    ///< Hash of that world, as recorded.
  std::uint64_t offset = 0;  ///< Offset of its section.
  std::uint64_t bytes = 0;   ///< Bytes of its section.
  std::uint64_t chain = 0;   ///< The chain before it.
};

/// Treatment of a recording that ends too early, as one of a game that crashed.
enum class Ending : std::uint8_t {
  whole,     ///< It is refused.
  mayBeCut,  ///< It is taken up to its last whole tick.
};

/// Reads a recording from front to back. The bytes must outlive it.
template <Scalar S>
class RecordingReader {
 public:
  /// Checks all of it first: limits, structure, numbers, the chain of hashes, that keyframes and index are
  /// where and what they should be, that it has a step, that no command comes after the last one, whose hash
  /// would cover it, and that nothing follows. Worlds of keyframes after the first are read when asked for.
  /// @param interrupt  asked every few items
  /// @throws FormatError, Interrupted
  explicit RecordingReader(std::span<const std::uint8_t> bytes, const RecordingLimits& limits = {},
                           const Interrupt& interrupt = {}, Ending ending = Ending::whole);
  /// The command at `offset` of items(), which moves to the next item.
  /// @throws FormatError
  static Command<S> commandAt(std::span<const std::uint8_t> items, std::uint64_t& offset);

  std::uint32_t version() const { return version_; }
  /// Seconds.
  S timeStep() const { return timeStep_; }
  /// Steps in the recording.
  std::uint64_t ticks() const { return ticks_; }
  /// True if nothing of it is missing; always so where it had to be whole.
  bool isWhole() const { return whole_; }
  /// World before the first step.
  const WorldState<S>& initialWorld() const { return world_; }
  std::uint64_t initialHash() const { return initialHash_; }
  /// Keyframes in their order, the first world first.
  std::span<const Keyframe> keyframes() const { return keyframes_; }
  /// Number of claims.
  std::uint64_t claims() const { return claims_; }
  /// All of them, in their order.
  std::vector<Note> notes() const;

  /// The world of a keyframe, which has the hash that is recorded for it. That it follows from what happened
  /// before is for a replay to show.
  /// @throws FormatError
  WorldState<S> world(std::size_t keyframe, const WorldLimits& limits = {}) const;
  /// True if a keyframe is this world, to the last byte.
  bool isWorld(std::size_t keyframe, const WorldState<S>& world) const;
  /// Goes to the items after a keyframe.
  void seek(std::size_t keyframe);

  /// Reads the next item; once at the end, stays there.
  RecordingItem next();
  /// Kind of the next item, where that is a claim; else another item than a claim.
  bool claimFollows();
  /// Offset of the item read last, in the recording; for one in a packed section, that of the section.
  std::uint64_t offset() const { return itemOffset_; }
  const Command<S>& command() const { return command_; }
  std::uint64_t hash() const { return hash_; }
  /// Lasts until the next item is read.
  const Claim& claim() const { return claim_; }

  /// The bytes that the item read last stands in, and the places there of the item read last and of the next
  /// one. They last until an item after the next step is read.
  std::span<const std::uint8_t> items() const;
  std::uint64_t itemAt() const { return itemAt_; }
  std::uint64_t nextAt() const { return position_; }

 private:
  struct Scan;
  void scanOldFormat(Scan& scan);
  void scanSections(Scan& scan, bool mayBeCut);
  bool scanSection(const struct RecordingSection& section, std::uint64_t chainBefore, Scan& scan);
  void scanKeyframe(const struct RecordingSection& section, std::uint64_t chainBefore);
  void scanTicks(const struct RecordingSection& section, Scan& scan);
  void scanIndex(const struct RecordingSection& section) const;
  void scanEnd(const struct RecordingSection& section, std::uint64_t indexAt) const;
  void load(const struct RecordingSection& section);
  bool loadNext();
  RecordingItem readItem();
  void readOldEnd(class ByteReader& reader) const;

  std::span<const std::uint8_t> bytes_;
  /// Format of the worlds in it, see decodeWorld.
  std::uint32_t worldFormat() const { return version_ < 4 ? 1 : kWorldFormat; }

  std::uint32_t version_ = 0;
  S timeStep_{};
  WorldState<S> world_;
  std::uint64_t initialHash_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint64_t claims_ = 0;
  bool whole_ = true;
  std::vector<Keyframe> keyframes_;
  std::vector<std::uint64_t> notes_;  ///< Offsets of their sections.
  std::uint64_t firstSection_ = 0;
  std::uint64_t usableEnd_ = 0;  ///< End of the sections with items, in the recording.

  // The section whose items are read: the bytes up to its end, or what it unpacks to.
  bool packed_ = false;
  std::vector<std::uint8_t> unpacked_;
  std::uint64_t sectionAt_ = 0;
  std::uint64_t sectionEnd_ = 0;  ///< End of its items.
  std::uint64_t nextSection_ = 0;
  std::uint64_t position_ = 0;
  std::uint64_t itemAt_ = 0;

  std::uint64_t itemOffset_ = 0;
  std::uint64_t hash_ = 0;
  Command<S> command_;
  Claim claim_;
};

#define SAMESTEP_EACH_SCALAR extern template class RecordingReader<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
