// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/game.h>

#include <cstdint>
#include <span>

namespace samestep {

/// Finds what would make peers part, on one machine: each step is taken back and made again, and must give
/// the same. In a game's debug build it stands in for the session:
///
///     SyncTest test(game);
///     each frame: if (!test.frame(inputs)) show(test.report());
///
/// It finds state that is not saved or not restored, and whatever else makes a step depend on more than the
/// state and the inputs. It takes no memory.
class SyncTest {
 public:
  struct Report {
    /// The first tick whose step gave another state when it was made again.
    Tick tick = 0;
    std::uint64_t first = 0;  ///< The hash after it.
    std::uint64_t again = 0;
    /// Name of what differs, by Game::difference; empty where the game cannot tell.
    char text[256] = {};
  };

  static constexpr Tick kMaxDistance = 8;
  /// The longest held or command bytes of one input.
  static constexpr std::uint32_t kMaxBytes = 128;

  /// @param distance  how many steps are taken back each frame, 1 to kMaxDistance
  /// @throws ValueOutOfRange for a game without its four functions and another distance
  explicit SyncTest(const Game& game, Tick distance = 2);
  ~SyncTest();
  SyncTest(const SyncTest&) = delete;
  SyncTest& operator=(const SyncTest&) = delete;

  /// Makes a step with these inputs, then the last ones again.
  /// @return whether they gave the same; once they did not, nothing more is done
  /// @throws ValueOutOfRange for more than kMaxPlayers and for longer bytes than kMaxBytes
  bool frame(std::span<const PlayerInput> players);
  bool good() const;
  const Report& report() const;
  Tick tick() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace samestep
