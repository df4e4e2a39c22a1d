// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/session.h>

#include <cstdint>
#include <span>
#include <vector>

namespace samestep {

/// Lets others watch a match from one of its peers: whoever asks is sent a certain state and, from there on,
/// the inputs of all players. It adds nothing to the match: the players do not wait for who watches.
///
///     SpectatorHost host(session, transport, snapshot, &game);
///     each frame: session.frame(now, held);  host.update(now);
class SpectatorHost {
 public:
  /// Writes a certain state that is not long past, as saveSnapshot does.
  /// @return false where there is none yet
  using Snapshot = bool (*)(Tick& tick, std::vector<std::uint8_t>& bytes, void* data);
  static constexpr std::uint32_t kMostSpectators = 16;

  /// @param transport  another one than the session's; it should let in only those who may watch
  /// @throws ValueOutOfRange for a function that is null
  SpectatorHost(const Session& session, const Transport& transport, Snapshot snapshot, void* data);
  ~SpectatorHost();
  SpectatorHost(const SpectatorHost&) = delete;
  SpectatorHost& operator=(const SpectatorHost&) = delete;

  /// Takes in what the session is certain of and answers who watches.
  void update(std::uint64_t now);
  /// Spectators that have asked for something in the last five seconds.
  std::uint32_t watching() const;
  /// Datagrams that were no questions, or came from more than kMostSpectators.
  std::uint64_t refused() const;

 private:
  struct Impl;
  Impl* impl_;
};

/// Watches a match: joins at any time, and again after it was gone.
class Spectator {
 public:
  enum class State : std::uint8_t {
    joining,   ///< A state is on its way.
    watching,  ///< Steps are made as inputs come.
    failed,    ///< The state that came could not be loaded.
  };
  /// Brings in a state that a Snapshot wrote. What it throws as an Error ends the watching.
  using Load = void (*)(Tick tick, std::span<const std::uint8_t> bytes, void* data);
  /// The longest state, bytes.
  static constexpr std::uint32_t kMaxState = 1u << 24;

  /// @param game   of which only `step` is used
  /// @param host   where the SpectatorHost is
  /// @param delay  ticks that are known and not yet shown, against a jerky network
  /// @throws ValueOutOfRange for a function that is null, and for a delay of more than 600
  Spectator(const Game& game, Load load, void* data, const Transport& transport, Address host,
            Tick delay = 6);
  ~Spectator();
  Spectator(const Spectator&) = delete;
  Spectator& operator=(const Spectator&) = delete;

  /// Takes in what has come and makes the step that is due; several where it is far behind.
  /// @return steps made
  std::uint32_t frame(std::uint64_t now);
  State state() const;
  /// The step that is made next, and the first one whose inputs are not known.
  Tick tick() const;
  Tick known() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace samestep
