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
  /// @throws FormatError; MissingCallback for a world that needs functions the wiring does not register
  explicit Replay(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring = {},
                  const WorldLimits& limits = {});

  /// Steps in the recording, and steps made so far.
  std::uint64_t ticks() const { return reader_.ticks(); }
  std::uint64_t tick() const { return tick_; }
  S timeStep() const { return reader_.timeStep(); }
  Space<S>& space() { return space_; }
  const Space<S>& space() const { return space_; }
  /// The hash that was recorded for the world as it should be now.
  std::uint64_t recordedHash() const { return recordedHash_; }

  /// Applies what was done before the next step, once; commands() then has it. False at the end.
  /// @throws FormatError for what the world refuses, and where it outgrows the limits
  bool applyCommands();
  /// applyCommands, unless that has been done, and the step. False at the end.
  /// @throws as applyCommands
  bool step();

  /// What was done last before a step.
  const std::vector<Command<S>>& commands() const { return commands_; }

 private:
  RecordingReader<S> reader_;
  Wiring<S> wiring_;
  WorldLimits limits_;
  Space<S> space_;
  std::vector<Command<S>> commands_;
  std::uint64_t tick_ = 0;
  std::uint64_t recordedHash_ = 0;
  bool applied_ = false;
  bool ended_ = false;
};

#define SAMESTEP_EACH_SCALAR extern template class Replay<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
