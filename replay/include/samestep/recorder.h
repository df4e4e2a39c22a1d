// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <samestep/recording.h>

namespace samestep {

/// Four seconds and nine minutes at 60 Hz.
inline constexpr std::uint32_t kDefaultRewindTicks = 240;
inline constexpr std::uint32_t kMostRewindTicks = 1u << 15;

/// When the world is put into a recording, so that a player can begin there and any stretch can be checked by
/// itself: after so many ticks, but no sooner than its size allows.
struct KeyframeBudget {
  /// Ten seconds at 60 Hz; 0 for no keyframes.
  std::uint32_t ticks = 600;
  /// So many bytes a tick may keyframes take, those of the first world aside.
  std::uint32_t bytesPerTick = 20;
};

/// Takes the bytes of a recording, piece by piece, in order.
using ByteSink = void (*)(std::span<const std::uint8_t> bytes, void* data);

/// Records a match: what is done to a Space from now on, and the hash of its world after each step.
///
/// All that changes the world between steps must go through apply(), so that it is recorded; functions
/// registered with the Space, and what they do during a step, are not recorded but must be registered again
/// for the replay. None of them may use the recorder: what it would write belongs into a step or command that
/// is being written, so within its own step() and apply() it refuses all with SpaceLocked, and commands
/// wherever the Space is locked. A recording that was not finished is taken by readers that
/// ask for it (Ending::mayBeCut), and refused by others.
///
/// Rollback: where the Space has been restored to the world after a recorded step, or to the one the
/// recording began with, the recording goes back there by itself and goes on from there, so what it tells is
/// the match as it was played in the end. Such a world is saved between a step and the next command. Nothing
/// is allocated once a match has had its busiest stretch.
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
  /// Gives sections of some KB, and keyframes, to `sink`, so that a long match takes no memory. What it has
  /// at any time is a recording that can be played up to its last whole tick (Ending::mayBeCut).
  Recorder(Space<S>& space, S timeStep, ByteSink sink, void* data, const Wiring<S>& wiring = {});
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Applies a command and records it; one that the Space refuses is not recorded.
  /// @return as applyCommand
  /// @throws as applyCommand; ForeignWorld where the Space was given a world that is none of the
  /// recording's,
  ///         or one from before the steps that can be taken back; ValueOutOfRange for a spawn with more than
  ///         256 shapes and an input of more than 2^16 bytes; ForeignWorld where checking finds an unrecorded
  ///         change
  BodyId apply(const Command<S>& command);
  /// apply() of a UserInput whose bytes stay with the caller.
  void input(std::span<const std::uint8_t> bytes);
  /// Makes a step and records it.
  /// @return the hash of the world
  /// @throws as Space::step; ForeignWorld where checking finds an unrecorded change
  std::uint64_t step();
  /// Records the step that a game has just made by calling Space::step itself.
  /// @throws ForeignWorld unless exactly one step of the recording's length has been made since the last call
  std::uint64_t stepped();
  /// Says that the first `ticks` steps are final, as once the inputs of all players are there: their bytes
  /// need wait no longer, and no world before them can be restored any more.
  /// @throws ValueOutOfRange for more steps than are recorded
  void confirm(std::uint64_t ticks);
  /// Sets how many of the last steps can be taken back; at first kDefaultRewindTicks. Bytes of older ones are
  /// given to the sink. Fewer than before forgets; more holds from now on.
  /// @throws ValueOutOfRange for more than kMostRewindTicks
  void setRewindTicks(std::uint32_t ticks);
  /// Sets the budget from now on; see KeyframeBudget for what holds at first.
  void setKeyframes(const KeyframeBudget& budget);
  /// Sets whether what is given to the sink from now on is packed by zstd. Off at first: hashes cannot be
  /// packed, so it is worth while where commands or keyframes are large.
  /// @throws ValueOutOfRange where this build lacks zstd (packingAvailable)
  void setPacking(bool packing);
  /// Puts down what the game says of the world as it is after the last step: a score, a winner, a lap time.
  /// Whoever verifies the recording asks Wiring::checkClaim. Under rollback it is taken back with its step.
  /// @param key    1 to 255 bytes
  /// @param value  at most 4096 bytes
  /// @throws ValueOutOfRange; ForeignWorld as apply
  void claim(std::string_view key, std::span<const std::uint8_t> value);
  void claim(std::string_view key, std::string_view value);
  /// Puts down something beside the match: names of players, of the level. It is never taken back.
  /// @param value  at most 2^16 bytes
  /// @throws ValueOutOfRange
  void note(std::string_view key, std::string_view value);
  /// Sets whether apply() and step() look, for the price of one more hash each, if anything changed the world
  /// that was not recorded. Off at first.
  void setChecking(bool checking);
  /// Ends the recording after its last step: what was done since is left out. Nothing more can be recorded.
  /// A recording without a step is refused by readers.
  /// @throws ForeignWorld where a world was brought in that is none of the recording's
  void finish();
  /// Finishes after the step with this number: what was guessed beyond it is left out, whatever world the
  /// Space has.
  /// @throws ValueOutOfRange for a step that is not recorded or can no longer be gone back to
  void finish(std::uint64_t ticks);

  /// Steps recorded.
  std::uint64_t ticks() const;

 private:
  struct Impl;
  Impl* impl_;
};

#define SAMESTEP_EACH_SCALAR extern template class Recorder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
