// SPDX-License-Identifier: MIT
#include "arena.h"

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

namespace arena {

using namespace samestep;

template <Scalar S>
Arena<S>::Arena(std::uint32_t players, std::uint32_t crates) : size_(crates > 32 ? 16 : 10) {
  // The arena is seen from above: nothing falls, and everything slows down.
  space_.setDamping(ratio<S>(1, 5));
  const S far(size_);
  const Vector<S> corners[] = {{-far, -far}, {far, -far}, {far, far}, {-far, far}};
  for (int i = 0; i < 4; ++i) {
    space_.add(segmentShape<S>(space_.staticBody(), corners[i], corners[(i + 1) % 4], ratio<S>(1, 2)));
  }
  for (Seat seat = 0; seat < players; ++seat) {
    // Anywhere: the same inputs are applied to the Space of a replay.
    players_[seat] = place(space_, {S(seat % 4 * 4 - 6), S(seat / 4 * 4 - 6)}).anywhere();
    Shape<S> disc = circleShape<S>(players_[seat], ratio<S>(1, 2));
    disc.setMass(S(1));
    disc.setElasticity(ratio<S>(1, 2));
    disc.setFriction(ratio<S>(1, 2));
    space_.add(disc);
  }
  const int row = crates > 32 ? 12 : 7;
  for (int i = 0; i < static_cast<int>(crates); ++i) {
    dropCrate(space_, {S(i % row * 2 - row + 1), S(i / row * 2 - row + 2)});
  }
}

template <Scalar S>
BodyId Arena<S>::place(Space<S>& space, const Vector<S>& position) const {
  Body<S> body;
  body.setPosition(position);
  return space.add(body);
}

template <Scalar S>
void Arena<S>::dropCrate(Space<S>& space, const Vector<S>& position) const {
  Shape<S> crate = boxShape<S>(place(space, position), ratio<S>(4, 5), ratio<S>(4, 5));
  crate.setMass(ratio<S>(1, 2));
  crate.setFriction(ratio<S>(1, 2));
  space.add(crate);
}

template <Scalar S>
void Arena<S>::applyInputs(Space<S>& space, const TickInputs& inputs, void* data) {
  const auto& arena = *static_cast<const Arena*>(data);
  for (Seat seat = 0; seat < inputs.players.size(); ++seat) {
    if (inputs.players[seat].present) arena.apply(space, seat, inputs.players[seat]);
  }
}

template <Scalar S>
void Arena<S>::apply(Space<S>& space, Seat seat, const PlayerInput& input) const {
  if (!space.contains(players_[seat])) return;
  Body<S>& body = space.body(players_[seat]);
  const std::uint8_t held = input.held.empty() ? std::uint8_t{0} : input.held[0];
  const int x = ((held & kRight) != 0 ? 1 : 0) - ((held & kLeft) != 0 ? 1 : 0);
  const int y = ((held & kUp) != 0 ? 1 : 0) - ((held & kDown) != 0 ? 1 : 0);
  const int push = (held & kDash) != 0 ? 40 : 20;
  if (x != 0 || y != 0) body.applyForce({S(x * push), S(y * push)}, body.position());
  const bool drops = !input.commands.empty() && input.commands[0] == kDropCrate;
  if (!drops || space.bodyCount() >= kMostCrates) return;
  // On the side of the middle, where there is room.
  const Vector<S> at = body.position();
  dropCrate(space, {at.x - S(at.x > S(0) ? 2 : -2), at.y - S(at.y > S(0) ? 2 : -2)});
}

template <Scalar S>
void applyRecorded(Space<S>& space, std::span<const std::uint8_t> bytes, void*) {
  // Players have the same ids however many there are.
  static const Arena<S> all(kMaxPlayers, 0);
  std::array<PlayerInput, kMaxPlayers> players;
  Arena<S>::applyInputs(space, decodeInputs(bytes, players), const_cast<Arena<S>*>(&all));
}

#define SAMESTEP_EACH_SCALAR \
  template class Arena<S>;   \
  template void applyRecorded<S>(Space<S>&, std::span<const std::uint8_t>, void*);
#include <samestep/each_scalar.h>

std::uint8_t botButtons(std::uint64_t seed, Seat seat, Tick tick) {
  std::uint64_t value = seed + seat * std::uint64_t{0x9e3779b97f4a7c15} + tick / 20;
  value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9u;
  value = (value ^ value >> 27) * 0x94d049bb133111ebu;
  return static_cast<std::uint8_t>((value ^ value >> 31) & 31);
}

}  // namespace arena
