// SPDX-License-Identifier: MIT
#include <samestep/player.h>

#include <algorithm>

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
Player<S>::Player(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring, const PlayerOptions& options)
    : options_(options), replay_(bytes, wiring, options.limits, options.interrupt, options.ending) {
  compare();
}

/// Notes whether the world is the one recorded, and what that proves.
template <Scalar S>
void Player<S>::compare() {
  bool same = replay_.space().hash() == replay_.recordedHash();
  const std::span<const Keyframe> keyframes = reader().keyframes();
  const auto at = std::lower_bound(keyframes.begin(), keyframes.end(), tick(),
                                   [](const Keyframe& a, std::uint64_t wanted) { return a.tick < wanted; });
  if (same && at != keyframes.end() && at->tick == tick()) {
    same = reader().isWorld(static_cast<std::size_t>(at - keyframes.begin()), space().state());
  }
  const bool before = !wrong_ || tick() < *wrong_;
  if (!same && before) wrong_ = tick();
  if (same && chained_ && before && tick() > proven_) proven_ = tick();
}

template <Scalar S>
bool Player<S>::step() {
  if (!replay_.step()) return false;
  compare();
  return true;
}

template <Scalar S>
bool Player<S>::seek(std::uint64_t target) {
  require<Fault::ValueOutOfRange>(target <= ticks(), "The recording ends before that step.");
  std::uint64_t nearest = 0;
  for (const Keyframe& keyframe : reader().keyframes()) {
    if (keyframe.tick <= target) nearest = keyframe.tick;
  }
  if (target < tick() || nearest > tick()) {
    replay_.seek(nearest);
    chained_ = nearest <= proven_;
    compare();
  }
  while (tick() < target) {
    if (!step()) return false;
    if (options_.progress != nullptr && !options_.progress(tick(), target, options_.data)) return false;
  }
  return true;
}

template <Scalar S>
Trust Player<S>::trust() const {
  if (wrong_ && tick() >= *wrong_) return Trust::refuted;
  return chained_ ? Trust::proven : Trust::claimed;
}

template <Scalar S>
std::vector<ClaimAt> claimsOf(RecordingReader<S> reader, std::size_t most) {
  std::vector<ClaimAt> all;
  reader.seek(0);
  std::uint64_t tick = 0;
  for (RecordingItem item = reader.next(); item != RecordingItem::end && all.size() < most;
       item = reader.next()) {
    if (item == RecordingItem::step) ++tick;
    if (item != RecordingItem::claim) continue;
    const Claim& claim = reader.claim();
    all.push_back({tick, std::string(claim.key), {claim.value.begin(), claim.value.end()}});
  }
  return all;
}

#define SAMESTEP_EACH_SCALAR \
  template class Player<S>;  \
  template std::vector<ClaimAt> claimsOf<S>(RecordingReader<S>, std::size_t);
#include <samestep/each_scalar.h>

}  // namespace samestep
