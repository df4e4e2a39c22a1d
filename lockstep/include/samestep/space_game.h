// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/command.h>
#include <samestep/game.h>
#include <samestep/session.h>
#include <samestep/space.h>

#include <cstdint>
#include <span>
#include <vector>

namespace samestep {

/// State that a game keeps beside its Space: scores, timers, random numbers. `data` is handed to each
/// function.
struct OwnState {
  void* data = nullptr;
  /// Under a number below kSaveSlots; below kSaveSlots + kKeepSlots if there is `write`.
  void (*save)(std::uint32_t slot, void* data) = nullptr;
  void (*load)(std::uint32_t slot, void* data) = nullptr;
  std::uint64_t (*hash)(void* data) = nullptr;

  /// The rest may be null. What was saved as bytes, the same on every machine: for players that join, for
  /// spectators, and to find what differs after a desync.
  /// @return how many there are; with room for all of them, they are written
  std::uint64_t (*write)(std::uint32_t slot, std::span<std::uint8_t> into, void* data) = nullptr;
  /// Brings in such bytes, which come from outside. @return false for bytes that it does not write
  bool (*read)(std::span<const std::uint8_t> bytes, void* data) = nullptr;
  /// Names the field that a byte of these belongs to, for messages.
  void (*name)(std::uint64_t byte, std::span<char> into, void* data) = nullptr;
};

/// A Space as a game of a Session or SyncTest. The Space, and what `data` points to, must outlive it.
///
///     SpaceGame<Fixed> game(space, ratio<Fixed>(1, 60), applyInputs);
///     game.describe(settings);
///     Session session(settings, game.functions(), transport);
template <Scalar S>
class SpaceGame {
 public:
  /// Does to the Space what the players do, before each step. It must go by the Space, the OwnState and the
  /// inputs alone.
  using ApplyInputs = void (*)(Space<S>& space, const TickInputs& inputs, void* data);

  /// @param timeStep  of every step, s
  /// @param own       with its first three functions, or none
  /// @throws ValueOutOfRange for a null `apply` and for a part of an OwnState
  SpaceGame(Space<S>& space, S timeStep, ApplyInputs apply, void* data = nullptr, const OwnState& own = {});
  ~SpaceGame();
  SpaceGame(const SpaceGame&) = delete;
  SpaceGame& operator=(const SpaceGame&) = delete;

  /// The functions of this object, which must outlive who calls them.
  Game functions();
  /// Puts in what peers compare before they start: the revision, the fingerprint of this machine, and the
  /// hash of the Space as it is now with the time step. A settings' content is mixed in: that of the game's
  /// own data.
  void describe(SessionSettings& settings) const;

  /// The newest certain state that a session of this game keeps, as bytes for load: what a SpectatorHost
  /// sends. An OwnState is in them if it has a function that writes it.
  /// @return false while there is none
  bool snapshot(const Session& session, Tick& tick, std::vector<std::uint8_t>& bytes) const;
  /// Brings in such a state, whatever its bytes are.
  /// @throws as loadSnapshot
  void load(std::span<const std::uint8_t> bytes);

  /// Records the match from its present world on, appending to `bytes`, which must outlive this: a replay
  /// shows it as it was played in the end, without what was guessed. See Recorder; an OwnState is not in it.
  /// Of a match that was joined it begins with the state that came.
  void record(std::vector<std::uint8_t>& bytes);
  /// Ends the recording after so many steps of the match, for instance as many as Session::confirmed() says;
  /// it then verifies with wiring().
  /// @throws ValueOutOfRange where it is not recorded, or has no such step any more
  void finishRecording(Tick ticks);
  /// Wiring that a Replay of the recording needs: it applies the inputs by this game's function and data,
  /// which must outlive it.
  Wiring<S> wiring() const;

 private:
  struct Impl;
  Impl* impl_;
};

#ifndef SAMESTEP_FIXED_ONLY
extern template class SpaceGame<double>;
#endif
extern template class SpaceGame<Fixed>;

}  // namespace samestep
