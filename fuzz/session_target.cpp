// SPDX-License-Identifier: MIT
// Whole sessions: bytes become frames, time, what players do, and packets that are lost, repeated, changed or
// made up. The seal is off.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include <samestep/session.h>

#include "check.h"

namespace samestep::fuzz {
namespace {

constexpr std::uint32_t kBox = 32;
constexpr std::uint32_t kSums = 1024;

struct Mail {
  Address from = 0;
  std::uint32_t size = 0;
  std::array<std::uint8_t, kMaxPacket> bytes{};
};

/// A game that adds up its inputs and knows at which tick it is.
struct AddingGame {
  Game functions() {
    Game game;
    game.data = this;
    game.save = [](std::uint32_t slot, void* data) { self(data).save(slot); };
    game.load = [](std::uint32_t slot, void* data) { self(data).load(slot); };
    game.step = [](const TickInputs& inputs, void* data) { self(data).step(inputs); };
    game.hash = [](void* data) { return self(data).sum; };
    game.write = [](std::uint32_t slot, std::span<std::uint8_t> into, void* data) {
      expect(slot >= kSaveSlots && slot < kSlots, "a state is written that was kept");
      if (into.size() >= 8) std::memcpy(into.data(), &self(data).saved[slot].sum, 8);
      return std::uint64_t{8};
    };
    return game;
  }
  static AddingGame& self(void* data) { return *static_cast<AddingGame*>(data); }
  void save(std::uint32_t slot) {
    expect(slot < kSlots, "a state is saved in a slot that is there");
    saved[slot] = {at, sum};
  }
  void load(std::uint32_t slot) {
    expect(slot < kSaveSlots, "a state is loaded from a slot that is there");
    at = saved[slot].at;
    sum = saved[slot].sum;
  }
  void step(const TickInputs& inputs) {
    expect(inputs.tick == at, "a step is made from the state of its tick");
    for (const PlayerInput& player : inputs.players) {
      sum = sum * 3 + (player.present ? 1 : 0);
      for (const std::uint8_t byte : player.held) sum = sum * 5 + byte;
      for (const std::uint8_t byte : player.commands) sum = sum * 7 + byte;
    }
    sums[++at % kSums] = sum;
  }

  struct State {
    Tick at = 0;
    std::uint64_t sum = 0;
  };
  Tick at = 0;
  std::uint64_t sum = 0;
  static constexpr std::uint32_t kSlots = kSaveSlots + kKeepSlots;
  std::array<State, kSlots> saved{};
  std::array<std::uint64_t, kSums> sums{};
};

/// Some sessions, and the packets on their way.
class Table {
 public:
  explicit Table(std::uint8_t choice) : players_(static_cast<Seat>(2 + choice % 3)) {
    SessionSettings settings;
    settings.players = players_;
    // A newcomer may take the seat after those of the start.
    settings.maxPlayers = static_cast<std::uint8_t>(players_ + 1);
    settings.window = choice >> 2 & 7;
    settings.inputDelay = choice >> 5 & 3;
    settings.saving = (choice & 128) != 0 ? Saving::sparse : Saving::everyStep;
    settings.maxHeldBytes = 4;
    settings.maxCommandBytes = 4;
    settings.hashInterval = 5;
    for (Seat seat = 0; seat < players_; ++seat) settings.addresses[seat] = seat;
    for (Seat seat = 0; seat < players_; ++seat) {
      settings.localSeat = seat;
      ends_[seat] = {this, seat};
      sessions_.push_back(
          std::make_unique<Session>(settings, games_[seat].functions(), transport(ends_[seat])));
    }
  }

  Seat players() const { return players_; }
  Session& session(Seat seat) { return *sessions_[seat]; }
  std::vector<Mail>& box(Seat seat) { return boxes_[seat]; }
  void frame(Seat seat, std::uint8_t held) {
    sessions_[seat]->frame(now, {&held, 1});
    const Session& session = *sessions_[seat];
    if (session.state() == SessionState::running) {
      const Tick certain = std::min(session.confirmed(), session.tick());
      expect(session.tick() - certain <= kMaxWindow + 1u, "no step is made beyond the window");
    }
    for (SessionEvent event; sessions_[seat]->next(event);) {
      desynced |= event.kind == SessionEvent::Kind::desync;
      someoneGone |= event.kind == SessionEvent::Kind::dropped || event.kind == SessionEvent::Kind::ended;
    }
  }
  /// All who play agree on what they are sure of.
  void compare() {
    Tick common = 0xffffffffu;
    for (const auto& session : sessions_) common = std::min({common, session->tick(), session->confirmed()});
    if (common == 0) return;
    for (Seat seat = 1; seat < players_; ++seat) {
      if (sessions_[seat]->tick() - common >= kSums || sessions_[0]->tick() - common >= kSums) return;
      expect(games_[seat].sums[common % kSums] == games_[0].sums[common % kSums],
             "what is certain is the same everywhere");
    }
  }

  std::uint64_t now = 1'000'000;
  bool desynced = false;
  bool someoneGone = false;

 private:
  struct End {
    Table* table = nullptr;
    Seat seat = 0;
  };
  static Transport transport(End& end) {
    return {&end,
            [](Address to, std::span<const std::uint8_t> bytes, void* data) {
              const End& from = *static_cast<End*>(data);
              expect(bytes.size() <= kMaxPacket, "a packet leaves room for a seal");
              auto& box = from.table->boxes_[to];
              if (box.size() >= kBox) return;
              Mail mail;
              mail.from = from.seat;
              mail.size = static_cast<std::uint32_t>(bytes.size());
              std::memcpy(mail.bytes.data(), bytes.data(), bytes.size());
              box.push_back(mail);
            },
            [](Address& from, std::span<std::uint8_t> into, void* data) -> std::uint32_t {
              const End& to = *static_cast<End*>(data);
              auto& box = to.table->boxes_[to.seat];
              if (box.empty()) return 0;
              const Mail mail = box.front();
              box.erase(box.begin());
              from = mail.from;
              std::memcpy(into.data(), mail.bytes.data(), mail.size);
              return mail.size;
            }};
  }

  Seat players_;
  std::array<End, kMaxPlayers> ends_{};
  std::array<AddingGame, 4> games_{};
  std::array<std::vector<Mail>, 5> boxes_{};
  std::vector<std::unique_ptr<Session>> sessions_;
};

/// Takes bytes one after another; zeros at the end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}
  bool atEnd() const { return bytes_.empty(); }
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }
  std::span<const std::uint8_t> take(std::size_t count) {
    const auto taken = bytes_.first(std::min(count, bytes_.size()));
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

class Run {
 public:
  Run(const std::uint8_t* data, std::size_t size) : bytes_(data, size), table_(bytes_.next()) {}

  void go() {
    for (int operations = 0; !bytes_.atEnd() && operations < 400; ++operations) operation();
    for (int i = 0; i < 8; ++i) round(0);
    if (!forged_) {
      expect(!table_.desynced, "no desync is told where all are the same");
      if (!table_.someoneGone) table_.compare();
    }
  }

 private:
  void operation() {
    const std::uint8_t what = bytes_.next();
    const Seat seat = static_cast<Seat>((what >> 4) % table_.players());
    switch (what & 15) {
      case 0:
        return lose(seat);
      case 1:
        return repeat(seat);
      case 2:
        return change(seat);
      case 3:
        return makeUp(seat);
      case 4:
        table_.now += std::uint64_t{bytes_.next()} * 40'000;
        return;
      case 5:
        return adjust(seat);
      case 6:
        return table_.frame(seat, bytes_.next());
      default:
        return round(what);
    }
  }
  void round(std::uint8_t held) {
    table_.now += 16'667;
    for (Seat seat = 0; seat < table_.players(); ++seat)
      table_.frame(seat, static_cast<std::uint8_t>(held + seat));
  }
  void lose(Seat seat) {
    auto& box = table_.box(seat);
    if (!box.empty()) box.erase(box.begin() + bytes_.next() % static_cast<std::ptrdiff_t>(box.size()));
  }
  void repeat(Seat seat) {
    auto& box = table_.box(seat);
    if (!box.empty() && box.size() < kBox) box.push_back(Mail(box[bytes_.next() % box.size()]));
  }
  void change(Seat seat) {
    auto& box = table_.box(seat);
    if (box.empty()) return;
    Mail& mail = box[bytes_.next() % box.size()];
    const std::uint8_t at = bytes_.next();
    const std::uint8_t by = bytes_.next();
    if (at >= mail.size) {
      mail.size = std::max<std::uint32_t>(mail.size / 2, 1);
    } else {
      mail.bytes[at] = static_cast<std::uint8_t>(mail.bytes[at] ^ by);
    }
    forged_ = true;
  }
  /// A packet of a seat, whose first bytes are as they must be.
  void makeUp(Seat to) {
    const std::uint8_t kind = bytes_.next();
    Mail mail;
    mail.from = (kind >> 4) % (table_.players() + 1u);
    const auto rest = bytes_.take(bytes_.next() % 64);
    mail.size = static_cast<std::uint32_t>(3 + rest.size());
    mail.bytes[0] = static_cast<std::uint8_t>((kind & 15) | mail.from << 4);
    std::copy(rest.begin(), rest.end(), mail.bytes.begin() + 3);
    if (table_.box(to).size() < kBox) table_.box(to).push_back(mail);
    forged_ = true;
  }
  void adjust(Seat seat) {
    Session& session = table_.session(seat);
    const std::uint8_t value = bytes_.next();
    switch (value & 7) {
      case 0:
        return session.setInputDelay(value >> 4);
      case 1:
        return session.setWindow(value >> 4);
      case 2:
        return session.setRunAhead(value >> 6);
      case 3:
        return session.setSaving((value & 16) != 0 ? Saving::sparse : Saving::everyStep);
      case 4:
        return session.pause((value & 16) != 0);
      case 5:
        if (value > 240) session.leave();
        return;
      default:
        session.command({&value, 1});
    }
  }

  Bytes bytes_;
  Table table_;
  bool forged_ = false;
};

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep::fuzz;
  guarded([&] { Run(data, size).go(); });
  return 0;
}
