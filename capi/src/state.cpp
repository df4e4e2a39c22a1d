// SPDX-License-Identifier: MIT
// Hashes, slots, snapshots, differences.
#include <cstring>
#include <string>

#include <samestep/snapshot.h>
#include <samestep/state_diff.h>

#include "base/require_ieee.h"
#include "limits_of.h"

/// A place to save worlds in.
struct samestep_slot {
  explicit samestep_slot(samestep::ScalarKind kind) : scalar(kind) {}
  virtual ~samestep_slot() = default;
  const samestep::ScalarKind scalar;
};

namespace samestep::c {
namespace {

template <Scalar S>
struct SlotOf : samestep_slot {
  SlotOf() : samestep_slot(ScalarTraits<S>::kKind) {}
  SavedSpace<S> saved;
};

template <Scalar S, class Slot>
auto& slotOf(Slot* slot) {
  requireOr(at(slot).scalar == ScalarTraits<S>::kKind, SAMESTEP_WRONG_SCALAR);
  if constexpr (std::is_const_v<Slot>) {
    return static_cast<const SlotOf<S>&>(*slot).saved;
  } else {
    return static_cast<SlotOf<S>&>(*slot).saved;
  }
}

/// Runs action(its saved world) on a slot of either scalar.
template <class Action>
samestep_status callSlot(const samestep_slot* slot, Action&& action) noexcept {
  return callFree([&] {
    const auto scalar = static_cast<std::int32_t>(at(slot).scalar);
    forScalar(scalar, [&](auto number) { action(slotOf<decltype(number)>(slot)); });
  });
}

template <Scalar S>
std::string differenceOf(const WorldState<S>& a, const WorldState<S>& b, std::uint32_t most) {
  std::string text;
  for (const FieldDifference& one : differences(a, b, most)) {
    text += one.object + ": " + one.field + ": " + one.a + ", " + one.b + "\n";
  }
  return text;
}

std::span<const std::uint8_t> bytesOf(const std::uint8_t* bytes, std::size_t size) {
  if (size != 0) at(bytes);
  return {bytes, size};
}

}  // namespace

RecordingLimits toLimits(const samestep_limits* from) {
  if (from == nullptr) return {};
  current(from);
  require<Fault::ValueOutOfRange>(from->pairs <= kMostPairs, "Pairs are at most 2^28.");
  RecordingLimits limits;
  limits.bodies = from->bodies;
  limits.shapes = from->shapes;
  limits.pairs = limits.restingPairs = from->pairs;
  limits.handlers = from->handlers;
  limits.iterations = from->iterations;
  limits.substeps = from->substeps;
  limits.commandsPerTick = from->commands_per_tick;
  limits.bytes = from->bytes;
  limits.work = from->work;
  return limits;
}

}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_world_get_hash(const samestep_world* world, uint64_t* hash) {
  return call(world, [&](auto& of) { at(hash) = of.space.hash(); });
}

samestep_status samestep_body_get_hash(const samestep_world* world, samestep_body_id body, uint64_t* hash) {
  return call(world, [&](auto& of) {
    at(hash);
    *hash = of.space.hash(fromC<samestep::BodyId>(body));
  });
}

samestep_status samestep_shape_get_hash(const samestep_world* world, samestep_shape_id shape,
                                        uint64_t* hash) {
  return call(world, [&](auto& of) {
    at(hash);
    *hash = of.space.hash(fromC<samestep::ShapeId>(shape));
  });
}

samestep_status samestep_slot_create(int32_t scalar, samestep_slot** slot) {
  return callFree([&] {
    at(slot);
    forScalar(scalar, [&](auto number) { *slot = new SlotOf<decltype(number)>(); });
  });
}

void samestep_slot_destroy(samestep_slot* slot) { delete slot; }

samestep_status samestep_world_save(samestep_world* world, samestep_slot* slot) {
  return call(world, [&]<class World>(World& of) { of.space.save(slotOf<typename World::Number>(slot)); });
}

samestep_status samestep_world_restore(samestep_world* world, const samestep_slot* slot) {
  return call(world, [&]<class World>(World& of) { of.space.restore(slotOf<typename World::Number>(slot)); });
}

samestep_status samestep_slot_get_tick(const samestep_slot* slot, uint64_t* tick) {
  return callSlot(slot, [&](const auto& saved) { at(tick) = saved.stamp(); });
}

samestep_status samestep_slot_get_bytes(const samestep_slot* slot, uint64_t* bytes) {
  return callSlot(slot, [&](const auto& saved) { at(bytes) = saved.bytes(); });
}

void samestep_limits_init(samestep_limits* limits) {
  if (limits == nullptr) return;
  const samestep::RecordingLimits defaults;
  *limits = {};
  limits->version = SAMESTEP_C_VERSION;
  limits->bodies = defaults.bodies;
  limits->shapes = defaults.shapes;
  limits->pairs = defaults.pairs;
  limits->handlers = defaults.handlers;
  limits->iterations = defaults.iterations;
  limits->substeps = defaults.substeps;
  limits->commands_per_tick = defaults.commandsPerTick;
  limits->bytes = defaults.bytes;
  limits->work = defaults.work;
}

samestep_status samestep_world_write_snapshot(const samestep_world* world, uint8_t* bytes, size_t capacity,
                                              size_t* size) {
  return call(world, [&](auto& of) {
    at(size);
    giveSize(samestep::saveSnapshot(of.space, {}), bytes, capacity, size);
    if (bytes != nullptr) samestep::saveSnapshot(of.space, {bytes, capacity});
  });
}

samestep_status samestep_world_read_snapshot(samestep_world* world, const uint8_t* bytes, size_t size,
                                             int32_t any_revision, const samestep_limits* limits) {
  return call(world, [&](auto& of) {
    const auto others =
        any_revision != 0 ? samestep::OtherRevision::takeStateOnly : samestep::OtherRevision::refuse;
    samestep::loadSnapshot(of.space, bytesOf(bytes, size), others, toLimits(limits));
  });
}

samestep_status samestep_snapshot_get_info(const uint8_t* bytes, size_t size, samestep_snapshot_info* info) {
  return callFree([&] {
    at(info);
    const samestep::SnapshotInfo found = samestep::snapshotInfo(bytesOf(bytes, size));
    *info = {found.version, found.revision, static_cast<int32_t>(found.scalar), 0, found.size};
  });
}

samestep_status samestep_world_write_difference(const samestep_world* a, const samestep_world* b,
                                                uint32_t most, char* text, size_t capacity, size_t* size) {
  return call(a, [&]<class World>(World& of) {
    using S = typename World::Number;
    at(size);
    requireOr(at(b).scalar == of.scalar, SAMESTEP_WRONG_SCALAR);
    const std::string difference = differenceOf(of.space.state(), as<S>(*b).space.state(), most);
    giveSize(difference.size() + 1, text, capacity, size);
    if (text != nullptr) std::memcpy(text, difference.c_str(), difference.size() + 1);
  });
}

}  // extern "C"
