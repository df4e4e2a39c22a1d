// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/recording.h>

namespace samestep {

/// A recording under way again: a Space of its own in which the same things happen.
template <Scalar S>
class Replay {
 public:
  /// Checks the whole recording first. The bytes must outlive it.
  /// @param interrupt  asked while the recording is checked, before each command and within commands and
  ///                   steps, see Space::setInterrupt; after it has ended one the replay is over
  /// @throws FormatError; MissingCallback for a world that needs functions the wiring does not register;
  ///         Interrupted
  explicit Replay(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring = {},
                  const RecordingLimits& limits = {}, const Interrupt& interrupt = {},
                  Ending ending = Ending::whole);

  /// Steps in the recording, and steps made so far.
  std::uint64_t ticks() const { return reader_.ticks(); }
  std::uint64_t tick() const { return tick_; }
  S timeStep() const { return reader_.timeStep(); }
  Space<S>& space() { return space_; }
  const Space<S>& space() const { return space_; }
  /// The hash that was recorded for the world as it should be now.
  std::uint64_t recordedHash() const { return recordedHash_; }

  /// Applies what was done before the next step, once; eachCommand() then tells it. False at the end.
  /// @throws FormatError for what the world refuses, and where it outgrows the limits; Interrupted
  bool applyCommands();
  /// applyCommands, unless that has been done, and the step. False at the end.
  /// @throws as applyCommands
  bool step();

  /// Reads the next claim about the world as it is now; null where there is none left. Those that are not
  /// asked for are passed over by the next step.
  const Claim* nextClaim();
  /// Goes to the world after a step, forth or back, by way of the last keyframe before it.
  /// @throws ValueOutOfRange beyond the end; FormatError as applyCommands, and for a keyframe that is none
  void seek(std::uint64_t tick);
  const RecordingReader<S>& reader() const { return reader_; }

  /// Sets the function that is asked about each command before it is applied; false ends the replay there.
  /// Null for none.
  void setCommandFilter(bool (*filter)(const Command<S>& command, std::uint64_t offset, void* data),
                        void* data) {
    filter_ = filter;
    filterData_ = data;
  }

  /// Bytes of what was done last before a step, as it stands in the recording. Commands are not kept: a few
  /// bytes each may tell of any number. They last until the claims or commands after that step are looked at.
  std::span<const std::uint8_t> commandBytes() const {
    return reader_.items().subspan(static_cast<std::size_t>(commandsBegin_),
                                   static_cast<std::size_t>(commandsEnd_ - commandsBegin_));
  }
  /// Calls visit(command, its bytes) for each of them.
  template <class Visit>
  void eachCommand(Visit&& visit) const {
    for (std::uint64_t offset = commandsBegin_; offset < commandsEnd_;) {
      const std::uint64_t from = offset;
      const auto items = reader_.items();
      const Command<S> command = RecordingReader<S>::commandAt(items, offset);
      visit(command, items.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(offset - from)));
    }
  }

 private:
  template <class Action>
  void act(Action&& action);
  void applyNow();

  Interrupt interrupt_;
  RecordingReader<S> reader_;
  Wiring<S> wiring_;
  RecordingLimits limits_;
  Space<S> space_;
  bool (*filter_)(const Command<S>&, std::uint64_t, void*) = nullptr;
  void* filterData_ = nullptr;
  std::uint64_t commandsBegin_ = 0;
  std::uint64_t commandsEnd_ = 0;
  std::uint64_t tick_ = 0;
  std::uint64_t recordedHash_ = 0;
  bool applied_ = false;
  bool ended_ = false;
};

#define SAMESTEP_EACH_SCALAR extern template class Replay<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
