// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/recorder.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "recording/packing.h"
#include "recording/recording_format.h"

namespace samestep {

/// Writes the sections of a recording while the last of its ticks can still be taken back. What it writes
/// goes by what was recorded in the end alone, not by what was taken back.
class RecordingWriter {
 public:
  RecordingWriter(ByteSink sink, void* data);

  /// Gives the header, and the first world with its hash.
  void begin(std::span<const std::uint8_t> header, std::uint64_t hash, std::span<const std::uint8_t> world);
  /// Bytes to which the items of the next tick are appended.
  std::vector<std::uint8_t>& items() { return items_; }
  /// Before a step is made: gives what can no longer be taken back then, and makes room, so that endTick
  /// takes no memory. Where the sink throws, the same is given once more.
  void prepareTick();
  /// The items so far are those of one more tick, after which the world has this hash.
  /// @pre prepareTick() since the last one
  void endTick(std::uint64_t hash);
  /// Bytes to which the world after the last tick is appended, if a keyframe of it may be due; else null.
  std::vector<std::uint8_t>* keyframeDue();
  /// Takes the keyframe that was due, unless it has become too large for the ticks since the last one.
  void endKeyframe();
  /// Leaves out the one that was due.
  void dropKeyframe();
  /// Puts in an item that belongs to the last tick, before what was done since.
  void insertAfterTick(std::span<const std::uint8_t> item);
  void note(std::string_view key, std::string_view value);
  /// Forgets all that came after a tick.
  /// @pre oldest() <= tick <= ticks()
  void rewind(std::uint64_t tick);
  /// Says that ticks up to this one stay.
  void confirm(std::uint64_t tick);
  void setRewindTicks(std::uint32_t most);
  void setKeyframes(const KeyframeBudget& budget) { budget_ = budget; }
  void setPacking(bool packing);
  /// Gives what is left, the index and the end.
  void finish();

  std::uint64_t ticks() const { return ticks_; }
  /// The first tick that can be gone back to.
  std::uint64_t oldest() const { return oldest_; }
  /// After a tick that can be gone back to.
  std::uint64_t hashAfter(std::uint64_t tick) const { return markOf(tick).hash; }

 private:
  /// The end of a tick among the items of the recording; the one with tick 0 is that of the first world.
  struct Mark {
    std::uint64_t end = 0;
    std::uint64_t hash = 0;
  };
  /// Pace of keyframes: the size of the last world that was looked at for one, and the tick of the last one
  /// taken.
  struct Pace {
    std::uint64_t bytes = 0;
    std::uint64_t taken = 0;
  };
  /// A world that is not given yet, or was too large: then empty.
  struct Waiting {
    std::uint64_t tick = 0;
    Pace pace;
    std::vector<std::uint8_t> bytes;
  };
  struct IndexEntry {
    std::uint64_t tick;
    std::uint64_t offset;
    std::uint64_t chain;
  };

  Mark& markOf(std::uint64_t tick) { return marks_[static_cast<std::size_t>(tick % marks_.size())]; }
  const Mark& markOf(std::uint64_t tick) const {
    return marks_[static_cast<std::size_t>(tick % marks_.size())];
  }
  std::uint64_t oldestAfter(std::uint64_t ticks) const;
  void settleTo(std::uint64_t tick);
  void settle(std::uint64_t tick);
  void cutAfter(std::uint64_t tick);
  void giveFirstWaiting();
  void dropFirstWaiting();
  Pace pace() const { return waitingCount_ > 0 ? waiting_[waitingCount_ - 1].pace : pace_; }
  void giveSection(SectionKind kind, std::span<const std::uint8_t> payload);
  void putSection(std::uint8_t kind, std::uint64_t length, std::span<const std::uint8_t> more,
                  std::span<const std::uint8_t> payload);

  ByteSink sink_;
  void* data_;
  KeyframeBudget budget_;
  std::unique_ptr<Packer> packer_;
  std::uint64_t offset_ = 0;  ///< Bytes that the sink has.
  std::uint64_t chain_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint64_t oldest_ = 0;
  std::uint64_t settled_ = 0;  ///< The last tick that was looked at for the end of a section.
  std::uint64_t lastCut_ = 0;  ///< The last tick whose items are given.
  std::uint64_t itemsGiven_ = 0;
  Pace pace_;                        ///< Pace of what waits no longer.
  std::vector<std::uint8_t> items_;  ///< Items that are not given yet.
  std::vector<Mark> marks_;          ///< A ring of the ticks that can be gone back to.
  std::vector<Waiting> waiting_;  ///< The first of them are in use, in order; the others keep their memory.
  std::size_t waitingCount_ = 0;
  std::vector<std::uint8_t> notes_;
  std::vector<std::uint8_t> section_;
  std::vector<IndexEntry> index_;
};

}  // namespace samestep
