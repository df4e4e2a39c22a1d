// SPDX-License-Identifier: MIT
#include <samestep/error.h>
#include <samestep/fingerprint.h>
#include <samestep/recorder.h>
#include <samestep/space_codec.h>
#include <samestep/space_game.h>
#include <samestep/state_diff.h>
#include <samestep/version.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string>

#include "session/is_taken.h"
#include "session/mix.h"

namespace samestep {

using lockstep::mix;

namespace {

/// Object that values of an OwnState are told as.
constexpr const char* kOwnState = "own state";
constexpr std::uint64_t kOwnValue = 0x6f776e;

/// Cuts a text to fit.
void put(const std::string& text, std::span<char> into) {
  const std::size_t length = std::min(text.size(), into.size() - 1);
  std::copy_n(text.begin(), length, into.begin());
  into[length] = 0;
}

#ifndef SAMESTEP_FIXED_ONLY
std::uint64_t bitsOf(double value) { return std::bit_cast<std::uint64_t>(value); }
#endif
std::uint64_t bitsOf(Fixed value) { return static_cast<std::uint64_t>(value.raw()); }

}  // namespace

template <Scalar S>
struct SpaceGame<S>::Impl {
  static Impl& self(void* data) { return *static_cast<Impl*>(data); }

  void save(std::uint32_t slot) {
    space.save(saved[slot]);
    if (own.save != nullptr && (slot < kSaveSlots || own.write != nullptr)) own.save(slot, own.data);
  }
  void load(std::uint32_t slot) {
    space.restore(saved[slot]);
    if (own.load != nullptr) own.load(slot, own.data);
  }
  void step(const TickInputs& inputs) {
    if (!recorder) {
      apply(space, inputs, data);
      space.step(timeStep);
      return;
    }
    if (recordsFromNext) recordedFrom = inputs.tick;
    recordsFromNext = false;
    recorder->input({inputBytes.data(), encodeInputs(inputs, inputBytes)});
    recorder->step();
  }
  Wiring<S> wiring() {
    Wiring<S> wiring;
    wiring.data = this;
    wiring.applyInput = [](Space<S>& world, std::span<const std::uint8_t> bytes, void* impl) {
      std::array<PlayerInput, kMaxPlayers> players;
      self(impl).apply(world, decodeInputs(bytes, players), self(impl).data);
    };
    return wiring;
  }
  std::uint64_t hash() const {
    return own.hash == nullptr ? space.hash() : mix(space.hash(), own.hash(own.data));
  }
  bool difference(std::uint32_t slotA, std::uint32_t slotB, std::span<char> text) const {
    const auto found = differences(saved[slotA].state(), saved[slotB].state(), 1);
    std::string line;
    if (!found.empty()) {
      const FieldDifference& first = found.front();
      line = first.object + ", " + first.field + ": " + first.a + " and " + first.b;
    } else {
      line = ownDifference(slotA, slotB);
    }
    if (line.empty()) return false;
    if (!text.empty()) put(line, text);
    return true;
  }

  /// Bytes of the OwnState that was saved; none where it does not write any.
  std::vector<std::uint8_t> ownBytes(std::uint32_t slot) const {
    if (own.write == nullptr) return {};
    std::vector<std::uint8_t> bytes(own.write(slot, {}, own.data));
    own.write(slot, bytes, own.data);
    return bytes;
  }
  std::string ownName(std::uint64_t byte) const {
    std::array<char, sizeof(GameValue::field)> name{};
    if (own.name != nullptr) own.name(byte, name, own.data);
    name.back() = 0;
    return name.front() != 0 ? std::string(name.data()) : "byte " + std::to_string(byte);
  }
  std::string ownDifference(std::uint32_t slotA, std::uint32_t slotB) const {
    const auto a = ownBytes(slotA);
    const auto b = ownBytes(slotB);
    const auto at =
        static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
    if (at == a.size() && at == b.size()) return {};
    return std::string(kOwnState) + ", " + ownName(at) + ": " + valueOf(a, at) + " and " + valueOf(b, at);
  }
  static std::string valueOf(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    return at < bytes.size() ? std::to_string(bytes[at]) : "none";
  }

  std::uint32_t valueHashesOf(std::uint32_t slot, std::span<std::uint64_t> into) const {
    const std::vector<std::uint64_t> hashes = valueHashes(saved[slot].state());
    const std::vector<std::uint8_t> bytes = ownBytes(slot);
    if (into.size() >= hashes.size() + bytes.size()) {
      auto to = std::copy(hashes.begin(), hashes.end(), into.begin());
      for (std::size_t i = 0; i < bytes.size(); ++i) *to++ = mix(mix(kOwnValue, i), bytes[i]);
    }
    return static_cast<std::uint32_t>(hashes.size() + bytes.size());
  }
  void valueOf(std::uint32_t slot, std::uint32_t index, GameValue& into) const {
    const std::size_t ofSpace = own.write == nullptr ? index + 1u : valueHashes(saved[slot].state()).size();
    if (index >= ofSpace) {
      put(kOwnState, into.object);
      put(ownName(index - ofSpace), into.field);
      put(valueOf(ownBytes(slot), index - ofSpace), into.text);
      return;
    }
    const WorldValue value = valueAt(saved[slot].state(), index);
    put(value.object, into.object);
    put(value.field, into.field);
    put(value.value, into.text);
  }

  /// The length of the world, then the world, then the OwnState.
  std::uint64_t write(std::uint32_t slot, std::span<std::uint8_t> into) const {
    const std::uint64_t world = encodeWorld(saved[slot].state(), std::span<std::uint8_t>());
    const std::uint64_t beside = own.write == nullptr ? 0 : own.write(slot, {}, own.data);
    const std::uint64_t all = 8 + world + beside;
    if (into.size() < all) return all;
    for (unsigned i = 0; i < 8; ++i) into[i] = static_cast<std::uint8_t>(world >> (8 * i));
    encodeWorld(saved[slot].state(), into.subspan(8, world));
    if (own.write != nullptr) own.write(slot, into.subspan(8 + world, beside), own.data);
    return all;
  }
  /// @throws as decodeWorld
  void read(std::span<const std::uint8_t> bytes) {
    std::uint64_t world = 0;
    for (unsigned i = 0; i < 8 && i < bytes.size(); ++i) world |= std::uint64_t{bytes[i]} << (8 * i);
    const bool fits = bytes.size() >= 8 && world <= bytes.size() - 8;
    require<Fault::MalformedBytes>(fits, "These bytes are not the state of a game.");
    const auto beside = bytes.subspan(8 + world);
    std::uint64_t offset = 0;
    WorldState<S> state = decodeWorld<S>(bytes.subspan(8, world), offset);
    require<Fault::MalformedBytes>(offset == world && (own.write != nullptr || beside.empty()),
                                   "These bytes are not the state of a game.");
    if (own.read != nullptr) {
      require<Fault::MalformedBytes>(own.read(beside, own.data),
                                     "These bytes are not what the game keeps beside its Space.");
    }
    // The recording of the world before is not of this match.
    const bool records = recorder.has_value();
    recorder.reset();
    space.adopt(std::move(state));
    if (!records) return;
    recording->resize(recordingStart);
    recorder.emplace(space, timeStep, *recording, wiring());
    recordsFromNext = true;
  }

  Space<S>& space;
  S timeStep;
  ApplyInputs apply;
  void* data;
  OwnState own;
  std::array<SavedSpace<S>, kSaveSlots + kKeepSlots> saved;
  std::optional<Recorder<S>> recorder;
  std::vector<std::uint8_t>* recording = nullptr;  ///< Bytes of which ours begin at recordingStart.
  std::size_t recordingStart = 0;
  Tick recordedFrom = 0;
  bool recordsFromNext = false;
  std::array<std::uint8_t, kMaxInputsBytes> inputBytes{};
};

template <Scalar S>
SpaceGame<S>::SpaceGame(Space<S>& space, S timeStep, ApplyInputs apply, void* data, const OwnState& own)
    : impl_(nullptr) {
  require<Fault::ValueOutOfRange>(apply != nullptr, "A SpaceGame has a function that applies inputs.");
  const bool all = own.save != nullptr && own.load != nullptr && own.hash != nullptr;
  const bool none = own.save == nullptr && own.load == nullptr && own.hash == nullptr;
  require<Fault::ValueOutOfRange>(all || none, "An OwnState has all of its functions, or none.");
  require<Fault::ValueOutOfRange>(
      (own.write == nullptr) == (own.read == nullptr) && (all || own.write == nullptr),
      "An OwnState writes and reads, or neither.");
  impl_ = new Impl{space, timeStep, apply, data, own, {}, {}};
}

template <Scalar S>
SpaceGame<S>::~SpaceGame() {
  delete impl_;
}

template <Scalar S>
Game SpaceGame<S>::functions() {
  Game game;
  game.data = impl_;
  game.save = [](std::uint32_t slot, void* data) { Impl::self(data).save(slot); };
  game.load = [](std::uint32_t slot, void* data) { Impl::self(data).load(slot); };
  game.step = [](const TickInputs& inputs, void* data) { Impl::self(data).step(inputs); };
  game.hash = [](void* data) { return Impl::self(data).hash(); };
  game.difference = [](std::uint32_t slotA, std::uint32_t slotB, std::span<char> text, void* data) {
    return Impl::self(data).difference(slotA, slotB, text);
  };
  game.valueHashes = [](std::uint32_t slot, std::span<std::uint64_t> into, void* data) {
    return Impl::self(data).valueHashesOf(slot, into);
  };
  game.value = [](std::uint32_t slot, std::uint32_t index, GameValue& into, void* data) {
    Impl::self(data).valueOf(slot, index, into);
  };
  // Without what is kept beside it, a world is not the game.
  if (impl_->own.save != nullptr && impl_->own.write == nullptr) return game;
  game.write = [](std::uint32_t slot, std::span<std::uint8_t> into, void* data) {
    return Impl::self(data).write(slot, into);
  };
  game.read = [](std::span<const std::uint8_t> bytes, void* data) {
    return lockstep::isTaken([&] { Impl::self(data).read(bytes); });
  };
  return game;
}

template <Scalar S>
void SpaceGame<S>::describe(SessionSettings& settings) const {
  settings.revision = kSimulationRevision;
  settings.fingerprint = fingerprint<S>();
  settings.content = mix(mix(settings.content, impl_->hash()), bitsOf(impl_->timeStep));
}

template <Scalar S>
bool SpaceGame<S>::snapshot(const Session& session, Tick& tick, std::vector<std::uint8_t>& bytes) const {
  std::uint32_t slot = 0;
  if (!session.certainState(tick, slot)) return false;
  bytes.resize(impl_->write(slot, {}));
  impl_->write(slot, bytes);
  return true;
}

template <Scalar S>
void SpaceGame<S>::load(std::span<const std::uint8_t> bytes) {
  impl_->read(bytes);
}

template <Scalar S>
void SpaceGame<S>::record(std::vector<std::uint8_t>& bytes) {
  impl_->recording = &bytes;
  impl_->recordingStart = bytes.size();
  impl_->recordedFrom = 0;
  impl_->recorder.emplace(impl_->space, impl_->timeStep, bytes, impl_->wiring());
}

template <Scalar S>
void SpaceGame<S>::finishRecording(Tick ticks) {
  require<Fault::ValueOutOfRange>(impl_->recorder.has_value(), "This game is not recorded.");
  require<Fault::ValueOutOfRange>(ticks >= impl_->recordedFrom,
                                  "This game is recorded from a later tick on.");
  impl_->recorder->finish(ticks - impl_->recordedFrom);
  impl_->recorder.reset();
}

template <Scalar S>
Wiring<S> SpaceGame<S>::wiring() const {
  return impl_->wiring();
}

#ifndef SAMESTEP_FIXED_ONLY
template class SpaceGame<double>;
#endif
template class SpaceGame<Fixed>;

}  // namespace samestep
