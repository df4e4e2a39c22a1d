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

#include "session/mix.h"

namespace samestep {

using lockstep::mix;

namespace {

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
    if (own.save != nullptr && slot < kSaveSlots) own.save(slot, own.data);
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
    if (found.empty()) return false;
    const FieldDifference& first = found.front();
    const std::string line = first.object + ", " + first.field + ": " + first.a + " and " + first.b;
    if (text.empty()) return true;
    put(line, text);
    return true;
  }

  std::uint32_t valueHashesOf(std::uint32_t slot, std::span<std::uint64_t> into) const {
    const std::vector<std::uint64_t> hashes = valueHashes(saved[slot].state());
    if (into.size() >= hashes.size()) std::copy(hashes.begin(), hashes.end(), into.begin());
    return static_cast<std::uint32_t>(hashes.size());
  }
  void valueOf(std::uint32_t slot, std::uint32_t index, GameValue& into) const {
    const WorldValue value = valueAt(saved[slot].state(), index);
    put(value.object, into.object);
    put(value.field, into.field);
    put(value.value, into.text);
  }

  Space<S>& space;
  S timeStep;
  ApplyInputs apply;
  void* data;
  OwnState own;
  std::array<SavedSpace<S>, kSaveSlots + kKeepSlots> saved;
  std::optional<Recorder<S>> recorder;
  std::array<std::uint8_t, kMaxInputsBytes> inputBytes{};
};

template <Scalar S>
SpaceGame<S>::SpaceGame(Space<S>& space, S timeStep, ApplyInputs apply, void* data, const OwnState& own)
    : impl_(nullptr) {
  require<Fault::ValueOutOfRange>(apply != nullptr, "A SpaceGame has a function that applies inputs.");
  const bool all = own.save != nullptr && own.load != nullptr && own.hash != nullptr;
  const bool none = own.save == nullptr && own.load == nullptr && own.hash == nullptr;
  require<Fault::ValueOutOfRange>(all || none, "An OwnState has all of its functions, or none.");
  impl_ = new Impl{space, timeStep, apply, data, own, {}, {}, {}};
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
  bytes.clear();
  encodeWorld(impl_->saved[slot].state(), bytes);
  return true;
}

template <Scalar S>
void SpaceGame<S>::load(std::span<const std::uint8_t> bytes) {
  std::uint64_t offset = 0;
  impl_->space.adopt(decodeWorld<S>(bytes, offset));
}

template <Scalar S>
void SpaceGame<S>::record(std::vector<std::uint8_t>& bytes) {
  impl_->recorder.emplace(impl_->space, impl_->timeStep, bytes, impl_->wiring());
}

template <Scalar S>
void SpaceGame<S>::finishRecording(Tick ticks) {
  require<Fault::ValueOutOfRange>(impl_->recorder.has_value(), "This game is not recorded.");
  impl_->recorder->finish(ticks);
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
