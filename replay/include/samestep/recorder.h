// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <samestep/recording.h>

namespace samestep {

/// Takes the bytes of a recording, piece by piece, in order.
using ByteSink = void (*)(std::span<const std::uint8_t> bytes, void* data);

/// Records a match: what is done to a Space from now on, and the hash of its world after each step.
///
/// All that changes the world between steps must go through apply(), so that it is recorded; functions
/// registered with the Space, and what they do during a step, are not recorded but must be registered again
/// for the replay. A recording that was not finished is refused as cut short.
///
///     std::vector<std::uint8_t> bytes;
///     Recorder<Fixed> recorder(space, ratio<Fixed>(1, 60), bytes);
///     recorder.apply(ApplyImpulse<Fixed>{player, {Fixed(3), Fixed(0)}});
///     recorder.step();
///     recorder.finish();
template <Scalar S>
class Recorder {
 public:
  /// Appends to `bytes`. The Space, the bytes and the wiring's data must outlive the recorder.
  /// @param timeStep  of every step, s
  /// @throws SpaceLocked; ForeignWorld where no reader would take the world, as for more than WorldLimits;
  ///         ValueOutOfRange for the time step
  Recorder(Space<S>& space, S timeStep, std::vector<std::uint8_t>& bytes, const Wiring<S>& wiring = {});
  /// Gives pieces of up to some KB to `sink`, so that a long match takes no memory.
  Recorder(Space<S>& space, S timeStep, ByteSink sink, void* data, const Wiring<S>& wiring = {});
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Applies a command and records it; one that the Space refuses is not recorded.
  /// @return as samestep::apply
  /// @throws as samestep::apply; ValueOutOfRange for a spawn with more than 256 shapes and an input of more
  ///         than 2^16 bytes; ForeignWorld where checking finds an unrecorded change
  BodyId apply(const Command<S>& command);
  /// Makes a step and records it.
  /// @return the hash of the world
  /// @throws as Space::step; ForeignWorld where checking finds an unrecorded change
  std::uint64_t step();
  /// For a game that calls Space::step by itself: records the step it has just made.
  /// @throws ForeignWorld unless exactly one step of the recording's length has been made since the last call
  std::uint64_t stepped();
  /// Whether apply() and step() look, for the price of one more hash each, if anything changed the world that
  /// was not recorded. Off at first.
  void setChecking(bool checking);
  /// Ends the recording. Nothing more can be recorded.
  void finish();

  /// Steps recorded.
  std::uint64_t ticks() const;

 private:
  struct Impl;
  Impl* impl_;
};

#define SAMESTEP_EACH_SCALAR extern template class Recorder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
