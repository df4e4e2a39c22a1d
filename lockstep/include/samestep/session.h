// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/game.h>
#include <samestep/transport.h>

#include <cstdint>
#include <span>
#include <string>

namespace samestep {

/// Steps of the present that are saved, to be gone back to.
enum class Saving : std::uint8_t {
  everyStep,  ///< Each one that is not certain yet: a rollback repeats no more than it must.
  sparse,     ///< The last certain one only: for games whose saves cost more than their steps.
};

/// Guess of the input of a player that was not heard yet.
enum class Prediction : std::uint8_t {
  repeatLast,  ///< The player is taken to hold what it held last.
  nothing,
};

struct SessionSettings {
  /// Tells this match from others that the same peers play.
  std::uint32_t match = 0;
  /// Seats taken at the start, 2 to 16, and which of them is ours.
  std::uint8_t players = 2;
  Seat localSeat = 0;
  /// Address of each seat in the transport. 0 for a seat from `players` on: whoever the transport lets in.
  Address addresses[kMaxPlayers] = {};
  /// The most seats, `players` to 16, the same for all peers; 0: as many as `players`. The others may be
  /// taken while the match is under way, and so may those of players that are gone.
  std::uint8_t maxPlayers = 0;
  /// Takes the local seat in a match that is under way, in place of starting one.
  bool joins = false;
  /// Number of steps that may be made ahead of the last certain one, 0 to kMaxWindow. 0: pure lockstep, which
  /// neither predicts nor saves.
  std::uint8_t window = 8;
  /// Ticks between an input and the step that uses it, 0 to kMaxInputDelay.
  std::uint8_t inputDelay = 2;
  /// Steps that are shown before they are made, 0 to kMaxRunAhead.
  std::uint8_t runAhead = 0;
  Saving saving = Saving::everyStep;
  Prediction prediction = Prediction::repeatLast;
  /// 1 to 64, the same for all peers.
  std::uint8_t maxHeldBytes = 8;
  /// 0 to 128, the same for all peers.
  std::uint8_t maxCommandBytes = 32;
  /// Hashes are compared after each so many steps; 0: never. The same for all peers.
  std::uint16_t hashInterval = 60;
  // All peers compare these before they start; see SpaceGame::describe.
  std::uint32_t revision = 0;
  std::uint64_t fingerprint = 0;
  std::uint64_t content = 0;
  // Microseconds.
  std::uint32_t resendAfter = 50'000;
  std::uint32_t interruptedAfter = 500'000;
  /// A peer that is silent for so long, or whose next input is so late, is dropped by the others.
  std::uint32_t dropAfter = 3'000'000;
  /// A pause may last for so long; then its peer is dropped like one that makes no inputs.
  std::uint32_t pausedAtMost = 300'000'000;
  /// Time to wait, when two leave at about the same time, to hear from the other.
  std::uint32_t goneAfter = 1'000'000;
  /// A match that cannot go on, for most of its players are gone, ends after so long.
  std::uint32_t endAfter = 15'000'000;
};

inline constexpr std::uint8_t kMaxInputDelay = 16;
inline constexpr std::uint8_t kMaxRunAhead = 4;

enum class SessionState : std::uint8_t {
  connecting,  ///< Some peers were not heard yet.
  running,
  ended,    ///< The session is over for good; endReason() says why.
  joining,  ///< The state of a match under way is on its way here.
};

enum class EndReason : std::uint8_t {
  none,
  left,         ///< The seat went by leave().
  refused,      ///< A peer has another build, game or settings.
  dropped,      ///< The others went on without us.
  minority,     ///< Most players are gone, and might play on together.
  diverged,     ///< The others agreed on fewer inputs of a player than this peer has used for certain.
  notAdmitted,  ///< No state came that most of the players vouch for.
};
const char* endReasonName(EndReason reason);

/// Something that the game may want to show.
struct SessionEvent {
  enum class Kind : std::uint8_t {
    started,
    refused,      ///< `seat` has another value of what `detail` says, a Mismatch.
    interrupted,  ///< `seat` is silent.
    resumed,      ///< `seat` is heard again.
    paused,       ///< `seat` said that it pauses.
    unpaused,
    left,     ///< `seat` has its last input at the tick before `tick`.
    dropped,  ///< The seat went, agreed by the others.
    desync,   ///< The states after `tick` steps differ: `local` here, `remote` at `seat`.
    located,  ///< The difference has been found: Session::desync().
    ended,
    joined,  ///< `seat` plays from `tick` on.
    lied,    ///< The state that `seat` sent is no state, or not the one that most players have.
  };
  Kind kind = Kind::started;
  Seat seat = kNoSeat;
  std::uint8_t detail = 0;
  Tick tick = 0;
  std::uint64_t local = 0;
  std::uint64_t remote = 0;
};

/// Difference of the states of two peers.
struct DesyncReport {
  /// The first state that is known to differ, after so many steps: hashes are compared at intervals.
  Tick first = 0;
  /// The state that was looked at, and the other peer.
  Tick tick = 0;
  Seat seat = kNoSeat;
  /// The first value that differs, as it is here and there. Where only one has the object, the names differ
  /// as well.
  GameValue ours;
  GameValue theirs;
  /// Bit by seat: whose state after `first` steps is not that of most. 0 where no state is that of more than
  /// half of the peers, as between two.
  std::uint16_t minority = 0;
};

/// Report in a line: "body 7, center.x after 330 ticks: 1 (0x100000000) here, 2 (0x200000000) at peer 1; peer
/// 1 differs from most".
std::string desyncText(const DesyncReport& report);

/// In what two peers differ that want to play together.
enum class Mismatch : std::uint8_t {
  none,
  protocol,
  players,
  settings,
  revision,
  fingerprint,
  content,
  seat,  ///< It is taken, or is another player's, or there are no players that could join this match.
};

/// Result of a frame.
enum class Frame : std::uint8_t {
  advanced,  ///< A step was made.
  waiting,   ///< The inputs of others are waited for: show the last one again.
  paused,
  idle,  ///< The session does not run.
};

struct SessionStats {
  std::uint64_t steps = 0;  ///< Steps made, repeated ones included.
  std::uint64_t rollbacks = 0;
  std::uint64_t saves = 0;
  std::uint32_t deepest = 0;    ///< Rollback, in steps.
  std::uint64_t waited = 0;     ///< Frames without a step.
  std::uint64_t sentBytes = 0;  ///< Payload of datagrams.
  std::uint64_t sentPackets = 0;
  std::uint64_t badPackets = 0;  ///< Dropped: malformed, of another match, of nobody known.
  std::uint64_t lostEvents = 0;  ///< Number not fetched in time.
};

/// A networked match of 2 to 16 players without a host: each peer runs the whole game, and only inputs
/// travel.
///
///     Session session(settings, game, transport);
///     each frame: session.frame(now, held);  while (session.next(event)) show(event);
///
/// It reads no clock: `now` is in microseconds since any moment, and never goes back. After construction it
/// takes no memory, but to look for the cause of a desync and to send a newcomer the state. All peers apply
/// the same inputs in the same ticks and so, the game being deterministic, go through the same states.
///
/// The functions of the game and of the transport must not call what changes the session: frame, poll,
/// command, leave, pause and what begins with set throw SpaceLocked there.
class Session {
 public:
  /// @throws ValueOutOfRange for settings outside their ranges or a game without a function
  Session(const SessionSettings& settings, const Game& game, const Transport& transport);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Takes in what has arrived, takes back what was predicted wrongly, and makes a step if it may.
  /// @param held  what the local player holds, at most maxHeldBytes; for the tick inputDelay() ahead
  /// @throws ValueOutOfRange for more bytes
  Frame frame(std::uint64_t now, std::span<const std::uint8_t> held);
  /// Only talks to the others: for between two frames, and for while none are made.
  void poll(std::uint64_t now);
  /// Queues a command of the local player for the next input that has room.
  /// @return false where too many wait: try again later
  /// @throws ValueOutOfRange for one longer than maxCommandBytes
  bool command(std::span<const std::uint8_t> bytes);

  /// Leaves the match with the next input; poll until the state is ended.
  void leave();
  /// Pauses: no inputs are made meanwhile, and all others wait.
  void pause(bool paused);
  /// @throws ValueOutOfRange; from the next frame on. All may change at any time, and differ between peers.
  void setInputDelay(std::uint8_t ticks);
  void setWindow(std::uint8_t ticks);
  void setRunAhead(std::uint8_t ticks);
  void setSaving(Saving saving);
  /// Sets who may take a seat that is free, for instance a player that comes back by another address; ~0
  /// for whoever the transport lets in. A seat that is taken keeps its address.
  /// @throws ValueOutOfRange for a seat that is not there
  void setAddress(Seat seat, Address address);
  std::uint8_t inputDelay() const;
  std::uint8_t window() const;

  SessionState state() const;
  EndReason endReason() const;
  /// Steps made, and steps whose inputs are all known; the latter may be ahead.
  Tick tick() const;
  Tick confirmed() const;
  /// The inputs of a certain step that is not longer ago than 200 ticks. They last until the next call.
  /// @return false for any other step
  bool inputs(Tick tick, std::span<PlayerInput, kMaxPlayers> players, TickInputs& into) const;
  /// The number under which the game keeps a state that is certain, of the last seconds; for games that tell
  /// their values. @return false while there is none
  bool certainState(Tick& tick, std::uint32_t& slot) const;
  /// Bit by seat: who plays now.
  std::uint16_t present() const;
  /// Length that a frame should have, in thousandths of the usual: over 1000 for who is ahead of the others.
  /// Stays within 950 to 1050.
  std::uint32_t frameLength() const;
  /// Takes the oldest event. 64 are kept.
  bool next(SessionEvent& event);
  /// Report of a desync so far: null where there was none; its values are empty before the event `located`,
  /// and for a game without Game::value.
  const DesyncReport* desync() const;
  const SessionStats& stats() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace samestep
