// SPDX-License-Identifier: MIT
// Sessions in one process whose datagrams arrive at once, and a game that adds up its inputs.
#pragma once

#include <samestep/session.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace samestep {

/// Takes no memory once it is made.
class AddingGame {
 public:
  Game functions() {
    Game game;
    game.data = this;
    game.save = [](std::uint32_t slot, void* data) { self(data).saved_[slot] = self(data).sum; };
    game.load = [](std::uint32_t slot, void* data) { self(data).sum = self(data).saved_[slot]; };
    game.step = [](const TickInputs& inputs, void* data) { self(data).step(inputs); };
    game.hash = [](void* data) { return self(data).sum; };
    game.write = [](std::uint32_t slot, std::span<std::uint8_t> into, void* data) {
      return self(data).write(slot, into);
    };
    game.read = [](std::span<const std::uint8_t> bytes, void* data) { return self(data).read(bytes); };
    return game;
  }

  std::uint64_t sum = 0;
  std::uint64_t present = 0;
  /// It writes another state than the one that was saved.
  bool lies = false;
  /// After each step, as it was made last.
  std::array<std::uint64_t, 4096> sums{};

 private:
  static AddingGame& self(void* data) { return *static_cast<AddingGame*>(data); }
  std::uint64_t write(std::uint32_t slot, std::span<std::uint8_t> into) const {
    const std::uint64_t told = saved_[slot] + (lies ? 1 : 0);
    if (into.size() >= kBytes) std::memcpy(into.data(), &told, sizeof told);
    return kBytes;
  }
  bool read(std::span<const std::uint8_t> bytes) {
    if (bytes.size() != kBytes) return false;
    std::memcpy(&sum, bytes.data(), sizeof sum);
    return true;
  }
  void step(const TickInputs& inputs) {
    present = 0;
    for (const PlayerInput& player : inputs.players) {
      present += player.present ? 1 : 0;
      for (const std::uint8_t byte : player.held) sum = sum * 3 + byte;
      for (const std::uint8_t byte : player.commands) sum = sum * 5 + byte;
    }
    sums[(inputs.tick + 1) % sums.size()] = sum;
  }

  /// More than one block.
  static constexpr std::uint64_t kBytes = 5000;
  std::array<std::uint64_t, 64> saved_{};
};

/// Boxes of a fixed size, one for each seat.
class Post {
 public:
  Transport of(Seat seat) {
    ends_[seat] = {this, seat};
    Transport transport;
    transport.data = &ends_[seat];
    transport.send = [](Address to, std::span<const std::uint8_t> bytes, void* data) {
      auto* end = static_cast<End*>(data);
      end->post->put(end->seat, to, bytes);
    };
    transport.receive = [](Address& from, std::span<std::uint8_t> into, void* data) {
      auto* end = static_cast<End*>(data);
      return end->post->take(end->seat, from, into);
    };
    return transport;
  }
  void put(Address from, Address to, std::span<const std::uint8_t> bytes) {
    Box& box = boxes_[to];
    longest = std::max(longest, bytes.size());
    if (cut || box.put - box.taken == kBox) return;
    Mail& mail = box.mail[box.put++ % kBox];
    mail.from = from;
    mail.size = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(mail.bytes.data(), bytes.data(), bytes.size());
  }

  /// Loses everything.
  bool cut = false;
  std::size_t longest = 0;

 private:
  static constexpr std::uint32_t kBox = 64;
  struct Mail {
    Address from = 0;
    std::uint32_t size = 0;
    std::array<std::uint8_t, kMaxDatagram> bytes;
  };
  struct End {
    Post* post = nullptr;
    Seat seat = 0;
  };
  struct Box {
    std::array<Mail, kBox> mail;
    std::uint32_t put = 0;
    std::uint32_t taken = 0;
  };
  std::uint32_t take(Seat seat, Address& from, std::span<std::uint8_t> into) {
    Box& box = boxes_[seat];
    if (box.taken == box.put) return 0;
    const Mail& mail = box.mail[box.taken++ % kBox];
    std::memcpy(into.data(), mail.bytes.data(), mail.size);
    from = mail.from;
    return mail.size;
  }

  std::array<End, kMaxPlayers> ends_{};
  std::array<Box, kMaxPlayers> boxes_{};
};

/// Some sessions that play with each other.
class Table {
 public:
  explicit Table(Seat players, SessionSettings settings = {})
      : Table(std::vector<SessionSettings>(players, settings)) {}
  explicit Table(std::vector<SessionSettings> settings) : games(settings.size()) {
    for (Seat seat = 0; seat < settings.size(); ++seat) {
      settings[seat].players = static_cast<std::uint8_t>(settings.size());
      settings[seat].localSeat = seat;
      for (Seat other = 0; other < settings.size(); ++other) settings[seat].addresses[other] = other;
      sessions.push_back(std::make_unique<Session>(settings[seat], games[seat].functions(), post->of(seat)));
    }
  }

  /// A frame of each, in which seat i holds held + i.
  void frame(std::uint8_t held = 0) {
    now += 16'667;
    for (Seat seat = 0; seat < sessions.size(); ++seat) {
      if (sessions[seat] == nullptr) continue;
      const std::uint8_t byte = static_cast<std::uint8_t>(held + seat);
      frames[seat] = sessions[seat]->frame(now, {&byte, 1});
    }
  }
  void play(int count) {
    for (int i = 0; i < count; ++i) frame(static_cast<std::uint8_t>(i / 7));
  }
  /// Newest tick that all are certain of and have made.
  Tick common() const {
    Tick tick = 0xffffffffu;
    for (const auto& session : sessions) {
      if (session != nullptr) tick = std::min({tick, session->tick(), session->confirmed()});
    }
    return tick;
  }
  /// True if all had the same state at that tick.
  bool agree() const {
    for (Seat seat = 0; seat < sessions.size(); ++seat) {
      const std::size_t at = common() % games[0].sums.size();
      if (sessions[seat] != nullptr && games[seat].sums[at] != games[0].sums[at]) return false;
    }
    return true;
  }
  /// True if a seat has told an event of this kind that was not fetched yet.
  bool told(Seat seat, SessionEvent::Kind kind, SessionEvent& event) {
    while (sessions[seat]->next(event)) {
      if (event.kind == kind) return true;
    }
    return false;
  }
  bool told(Seat seat, SessionEvent::Kind kind) {
    SessionEvent event;
    return told(seat, kind, event);
  }

  std::unique_ptr<Post> post = std::make_unique<Post>();
  std::vector<AddingGame> games;
  /// Null: is gone.
  std::vector<std::unique_ptr<Session>> sessions;
  std::array<Frame, kMaxPlayers> frames{};
  std::uint64_t now = 1'000'000;
};

}  // namespace samestep
