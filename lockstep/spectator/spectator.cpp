// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/spectator.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "session/byte_io.h"
#include "session/is_taken.h"

namespace samestep {

using lockstep::isTaken;
using lockstep::PacketReader;
using lockstep::PacketWriter;

namespace {

/// The first byte of a packet.
enum class Kind : std::uint8_t {
  have = 0x61,    ///< A spectator says what it has: a state, how many blocks of it, inputs up to where.
  block = 0x62,   ///< A piece of a state.
  inputs = 0x63,  ///< Inputs of some ticks.
};
constexpr Tick kNone = 0xffffffffu;
constexpr std::uint32_t kBlock = 1024;
/// Number of ticks the host remembers.
constexpr Tick kLog = 1024;
/// A state older than this is not sent to who comes.
constexpr Tick kFresh = 300;
constexpr std::uint32_t kBlocksAtOnce = 6;
constexpr std::uint32_t kMostCatchUp = 8;
constexpr int kMostReceived = 256;
constexpr std::uint64_t kGone = 5'000'000;
constexpr std::uint64_t kAnswerEvery = 10'000;
/// Number of known inputs of a spectator that were not shown yet, at most.
constexpr Tick kAhead = 1024;

void require(bool condition, const char* text) { samestep::require<Fault::ValueOutOfRange>(condition, text); }

}  // namespace

struct SpectatorHost::Impl {
  struct Watcher {
    Address address = 0;
    std::uint64_t lastHeard = 0;
    std::uint64_t lastAnswered = 0;
    bool used = false;
  };

  void keepInputs();
  bool takeState();
  void receive(Address from, std::span<const std::uint8_t> bytes);
  Watcher* watcherAt(Address from);
  void sendBlocks(Address to, std::uint32_t from) const;
  void sendInputs(Address to, Tick from) const;

  const Session& session;
  Transport transport;
  Snapshot snapshot;
  void* data;
  std::uint64_t now = 0;
  std::uint64_t refused = 0;
  std::array<Watcher, kMostSpectators> watchers{};
  Tick stateTick = kNone;
  std::vector<std::uint8_t> state;
  Tick first = 0;  ///< First tick of the log.
  Tick logged = 0;
  std::vector<std::vector<std::uint8_t>> entries;
};

/// Remembers the inputs of the steps that are certain by now.
void SpectatorHost::Impl::keepInputs() {
  std::array<PlayerInput, kMaxPlayers> players;
  std::array<std::uint8_t, kMaxInputsBytes> bytes;
  const Tick to = std::min(session.confirmed(), session.tick());
  for (TickInputs inputs; logged < to && session.inputs(logged, players, inputs); ++logged) {
    const std::size_t size = encodeInputs(inputs, bytes);
    entries[logged % kLog].assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    if (logged - first >= kLog) first = logged - kLog + 1;
  }
}

/// Tells whether there is a state from which the log goes on.
bool SpectatorHost::Impl::takeState() {
  const bool fresh = stateTick != kNone && stateTick >= first && logged - stateTick < kFresh;
  if (fresh) return true;
  Tick tick = 0;
  if (!snapshot(tick, state, data) || tick < first || tick > logged) return false;
  stateTick = tick;
  return state.size() <= Spectator::kMaxState;
}

SpectatorHost::Impl::Watcher* SpectatorHost::Impl::watcherAt(Address from) {
  Watcher* free = nullptr;
  for (Watcher& watcher : watchers) {
    if (watcher.used && watcher.address == from) return &watcher;
    if (!watcher.used || now - watcher.lastHeard > kGone) free = &watcher;
  }
  if (free != nullptr) *free = {from, now, 0, true};
  return free;
}

void SpectatorHost::Impl::receive(Address from, std::span<const std::uint8_t> bytes) {
  PacketReader reader(bytes);
  const std::uint8_t kind = reader.u8();
  const Tick has = reader.u32();
  const std::uint32_t blocks = reader.u32();
  const Tick next = reader.u32();
  Watcher* watcher =
      reader.done() && kind == static_cast<std::uint8_t>(Kind::have) ? watcherAt(from) : nullptr;
  if (watcher == nullptr) {
    ++refused;
    return;
  }
  watcher->lastHeard = now;
  if (watcher->lastAnswered != 0 && now - watcher->lastAnswered < kAnswerEvery) return;
  watcher->lastAnswered = now;
  // A spectator that has no state, one that is not sent any more, or is behind the log, begins anew.
  const bool whole = next != kNone;
  if (whole && next >= first) return sendInputs(from, next);
  const bool same = has == stateTick && stateTick != kNone && stateTick >= first;
  if (same || takeState()) sendBlocks(from, same ? blocks : 0);
}

void SpectatorHost::Impl::sendBlocks(Address to, std::uint32_t from) const {
  for (std::uint32_t block = from; block < from + kBlocksAtOnce; ++block) {
    const std::size_t begin = std::size_t{block} * kBlock;
    if (begin >= state.size()) return;
    const std::size_t size = std::min<std::size_t>(kBlock, state.size() - begin);
    std::uint8_t bytes[kMaxPacket];
    PacketWriter writer(bytes);
    writer.u8(static_cast<std::uint8_t>(Kind::block));
    writer.u32(stateTick);
    writer.u32(static_cast<std::uint32_t>(state.size()));
    writer.u32(block);
    writer.bytes(std::span(state).subspan(begin, size));
    transport.send(to, writer.written(), transport.data);
  }
}

void SpectatorHost::Impl::sendInputs(Address to, Tick from) const {
  std::uint8_t bytes[kMaxPacket];
  PacketWriter writer(bytes);
  writer.u8(static_cast<std::uint8_t>(Kind::inputs));
  writer.u32(from);
  for (Tick tick = from; tick < logged; ++tick) {
    const auto& entry = entries[tick % kLog];
    PacketWriter trial = writer;
    trial.u16(static_cast<std::uint16_t>(entry.size()));
    trial.bytes(entry);
    if (!trial.good()) break;
    writer = trial;
  }
  transport.send(to, writer.written(), transport.data);
}

SpectatorHost::SpectatorHost(const Session& session, const Transport& transport, Snapshot snapshot,
                             void* data)
    : impl_(nullptr) {
  require(transport.send != nullptr && transport.receive != nullptr, "A transport lacks a function.");
  require(snapshot != nullptr, "A SpectatorHost has a function that writes a state.");
  impl_ = new Impl{session, transport, snapshot, data, 0, 0, {}, kNone, {}, 0, 0, {}};
  impl_->entries.resize(kLog);
  impl_->first = impl_->logged = std::min(session.confirmed(), session.tick());
}
SpectatorHost::~SpectatorHost() { delete impl_; }

void SpectatorHost::update(std::uint64_t now) {
  impl_->now = std::max(impl_->now, now);
  impl_->keepInputs();
  std::uint8_t bytes[kMaxDatagram];
  Address from = 0;
  for (int i = 0; i < kMostReceived; ++i) {
    const std::uint32_t size =
        impl_->transport.receive(from, std::span<std::uint8_t>(bytes), impl_->transport.data);
    if (size == 0) break;
    impl_->receive(from, {bytes, size});
  }
}

std::uint32_t SpectatorHost::watching() const {
  return static_cast<std::uint32_t>(std::count_if(
      impl_->watchers.begin(), impl_->watchers.end(),
      [&](const Impl::Watcher& watcher) { return watcher.used && impl_->now - watcher.lastHeard <= kGone; }));
}
std::uint64_t SpectatorHost::refused() const { return impl_->refused; }

struct Spectator::Impl {
  void receive(std::span<const std::uint8_t> bytes);
  void takeBlock(PacketReader& reader);
  void takeInputs(PacketReader& reader);
  void begin();
  void ask() const;
  void step();

  Game game;
  Load load;
  void* data;
  Transport transport;
  Address host;
  Tick delay;
  State state = State::joining;
  std::uint64_t askedAt = 0;
  std::uint64_t lastHeard = 0;
  Tick stateTick = kNone;
  std::uint32_t blocks = 0;  ///< Blocks that have come, in their order.
  std::vector<std::uint8_t> bytes;
  Tick tick = 0;
  Tick known = 0;
  std::vector<std::vector<std::uint8_t>> entries;
};

void Spectator::Impl::ask() const {
  std::uint8_t room[16];
  PacketWriter writer(room);
  writer.u8(static_cast<std::uint8_t>(Kind::have));
  writer.u32(stateTick);
  writer.u32(blocks);
  writer.u32(state == State::watching ? known : kNone);
  transport.send(host, writer.written(), transport.data);
}

void Spectator::Impl::receive(std::span<const std::uint8_t> datagram) {
  PacketReader reader(datagram);
  const auto kind = static_cast<Kind>(reader.u8());
  if (kind == Kind::block) takeBlock(reader);
  if (kind == Kind::inputs && state == State::watching) takeInputs(reader);
}

void Spectator::Impl::takeBlock(PacketReader& reader) {
  const Tick of = reader.u32();
  const std::uint32_t size = reader.u32();
  const std::uint32_t block = reader.u32();
  const std::uint32_t length = reader.left();
  const std::span<const std::uint8_t> piece = reader.bytes(length);
  // One is late by more than the host remembers, or it has begun anew.
  const bool fits = reader.good() && size > 0 && size <= kMaxState && std::uint64_t{block} * kBlock < size &&
                    length == std::min(kBlock, size - block * kBlock);
  if (!fits || (state == State::watching && of <= known)) return;
  if (of != stateTick || bytes.size() != size) {
    if (block != 0) return;
    state = State::joining;
    stateTick = of;
    blocks = 0;
    bytes.assign(size, 0);
  }
  if (state != State::joining || block != blocks) return;
  std::copy(piece.begin(), piece.end(),
            bytes.begin() + static_cast<std::ptrdiff_t>(block * std::uint64_t{kBlock}));
  ++blocks;
  if (std::uint64_t{blocks} * kBlock >= size) begin();
}

/// All of the state is there.
void Spectator::Impl::begin() {
  if (!isTaken([&] { load(stateTick, bytes, data); })) {
    state = State::failed;
    return;
  }
  state = State::watching;
  tick = known = stateTick;
}

void Spectator::Impl::takeInputs(PacketReader& reader) {
  Tick at = reader.u32();
  std::array<PlayerInput, kMaxPlayers> players;
  while (reader.good() && reader.left() > 0) {
    const std::span<const std::uint8_t> entry = reader.bytes(reader.u16());
    if (!reader.good() || entry.size() > kMaxInputsBytes) return;
    const bool next = at++ == known && known - tick < kAhead;
    if (!next) continue;
    bool follows = false;
    const bool taken = isTaken([&] { follows = decodeInputs(entry, players).tick == known; });
    if (!taken || !follows) return;
    entries[known++ % kAhead].assign(entry.begin(), entry.end());
  }
}

void Spectator::Impl::step() {
  std::array<PlayerInput, kMaxPlayers> players;
  game.step(decodeInputs(entries[tick % kAhead], players), game.data);
  ++tick;
}

Spectator::Spectator(const Game& game, Load load, void* data, const Transport& transport, Address host,
                     Tick delay)
    : impl_(nullptr) {
  require(game.step != nullptr && load != nullptr, "A spectator's game lacks a function.");
  require(transport.send != nullptr && transport.receive != nullptr, "A transport lacks a function.");
  require(delay <= 600, "The delay of a spectator is longer than 600 ticks.");
  impl_ = new Impl;
  impl_->game = game;
  impl_->load = load;
  impl_->data = data;
  impl_->transport = transport;
  impl_->host = host;
  impl_->delay = delay;
  impl_->entries.resize(kAhead);
}
Spectator::~Spectator() { delete impl_; }

std::uint32_t Spectator::frame(std::uint64_t now) {
  Impl& self = *impl_;
  std::uint8_t bytes[kMaxDatagram];
  Address from = 0;
  for (int i = 0; i < kMostReceived && self.state != State::failed; ++i) {
    const std::uint32_t size =
        self.transport.receive(from, std::span<std::uint8_t>(bytes), self.transport.data);
    if (size == 0) break;
    if (from == self.host) self.receive({bytes, size});
  }
  if (self.state == State::failed) return 0;
  if (self.askedAt == 0 || now - self.askedAt >= kAnswerEvery) {
    self.askedAt = now;
    self.ask();
  }
  if (self.state != State::watching) return 0;
  const Tick waits = self.known - self.tick;
  const Tick due = waits > self.delay ? std::min(waits - self.delay, kMostCatchUp) : 0;
  // One step a frame, more where there is much to catch up with.
  const Tick steps = due > 2 ? due : std::min<Tick>(due, 1);
  for (Tick i = 0; i < steps; ++i) self.step();
  return steps;
}

Spectator::State Spectator::state() const { return impl_->state; }
Tick Spectator::tick() const { return impl_->tick; }
Tick Spectator::known() const { return impl_->known; }

}  // namespace samestep
