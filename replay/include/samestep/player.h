// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <samestep/replay.h>

namespace samestep {

/// Trust in the world that a Player shows.
enum class Trust : std::uint8_t {
  proven,   ///< It came out of the first world step by step, and each hash was that of the recording.
  claimed,  ///< It came from a keyframe beyond what was proven: the recording says so.
  refuted,  ///< The recording says otherwise than what came out, here or before.
};

/// A claim of a recording, with the step after which it should hold.
struct ClaimAt {
  std::uint64_t tick = 0;
  std::string key;
  std::vector<std::uint8_t> value;
};

/// Options of a Player: what it may need, and whom it asks.
struct PlayerOptions {
  RecordingLimits limits{};
  /// A recording that was cut is played as far as it goes.
  Ending ending = Ending::mayBeCut;
  /// Function that is asked after each step, which a seek makes many of; false stops it there. Null for none.
  bool (*progress)(std::uint64_t tick, std::uint64_t target, void* data) = nullptr;
  void* data = nullptr;
  /// Function that is asked far more often, while the bytes are checked and within steps: see Replay.
  Interrupt interrupt{};
};

/// Plays a recording for somebody to look at: forth and back, with the world as it is between steps. Any
/// number of players may share the bytes of a recording, each with a world of its own and in a thread of its
/// own.
///
///     Player<Fixed> player(bytes, wiring);
///     player.seek(36000);
///     while (player.step()) draw(player.space());
template <Scalar S>
class Player {
 public:
  /// Checks the bytes, which must outlive it, but no step.
  /// @throws FormatError; MissingCallback for a world that needs functions the wiring does not register
  explicit Player(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring = {},
                  const PlayerOptions& options = {});

  /// Steps in the recording, and the one after which the world stands.
  std::uint64_t ticks() const { return replay_.ticks(); }
  std::uint64_t tick() const { return replay_.tick(); }
  S timeStep() const { return replay_.timeStep(); }
  const Space<S>& space() const { return replay_.space(); }
  const RecordingReader<S>& reader() const { return replay_.reader(); }

  /// Makes the next step. False at the end.
  /// @throws FormatError for what the world refuses, and where it outgrows the limits
  bool step();
  /// Goes to the world after a step, by way of the last keyframe before it where that is nearer than the
  /// world as it is. A keyframe beyond what is proven makes the world claimed; playing from the start proves
  /// it.
  /// @return whether it got there; options.progress may have stopped it between
  /// @throws ValueOutOfRange beyond the end; FormatError as step, and for a keyframe that is none
  bool seek(std::uint64_t tick);

  Trust trust() const;
  /// So many steps from the start are proven.
  std::uint64_t provenTicks() const { return proven_; }
  /// The first step found whose world is not the one recorded.
  std::optional<std::uint64_t> wrongTick() const { return wrong_; }

 private:
  void compare();

  PlayerOptions options_;
  Replay<S> replay_;
  std::uint64_t proven_ = 0;
  bool chained_ = true;  ///< True if the world came from the proven ones.
  std::optional<std::uint64_t> wrong_;
};

/// The claims of a recording in their order, at most `most`; none of them is checked.
template <Scalar S>
std::vector<ClaimAt> claimsOf(RecordingReader<S> reader, std::size_t most = 1000);

#define SAMESTEP_EACH_SCALAR extern template class Player<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
