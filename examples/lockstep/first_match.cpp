// SPDX-License-Identifier: MIT
// Two players push a crate. Both peers run in this program, and datagrams between them are lost now and then.
#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/session.h>
#include <samestep/space_game.h>

#include <array>
#include <cstdio>
#include <deque>
#include <vector>

using namespace samestep;
using S = Fixed;

// The game: a world, and what the players do to it. Nothing else may change it.
struct Arena {
  Space<S> space;
  std::array<BodyId, 2> players;
  BodyId crate;

  Arena() {
    space.setDamping(ratio<S>(1, 2));
    for (int i = 0; i < 2; ++i) {
      players[i] = add({S(i == 0 ? -3 : 3), S(0)});
      Shape<S> disc = circleShape<S>(players[i], ratio<S>(1, 2));
      disc.setMass(S(1));
      space.add(disc);
    }
    crate = add({S(0), S(0)});
    Shape<S> box = boxShape<S>(crate, S(1), S(1));
    box.setMass(S(2));
    space.add(box);
  }
  BodyId add(const Vector<S>& position) {
    Body<S> body;
    body.setPosition(position);
    return space.add(body);
  }
};

// One byte a player: bit 0 pushes to the left, bit 1 to the right.
void applyInputs(Space<S>& space, const TickInputs& inputs, void* data) {
  const auto& arena = *static_cast<Arena*>(data);
  for (std::size_t i = 0; i < 2; ++i) {
    const PlayerInput& player = inputs.players[i];
    if (!player.present || player.held.empty()) continue;
    const int way = (player.held[0] >> 1 & 1) - (player.held[0] & 1);
    auto& body = space.body(arena.players[i]);
    body.applyForce({S(12 * way), S(0)}, body.position());
  }
}

// Datagrams in memory, in place of UDP.
struct Datagram {
  Address from;
  std::vector<std::uint8_t> bytes;
};
std::array<std::deque<Datagram>, 2> inboxes;
int sent = 0;

Transport transportOf(Address* own) {
  Transport transport;
  transport.data = own;
  transport.send = [](Address to, std::span<const std::uint8_t> bytes, void* data) {
    if (++sent % 7 == 0) return;  // lost
    inboxes[to].push_back({*static_cast<Address*>(data), {bytes.begin(), bytes.end()}});
  };
  transport.receive = [](Address& from, std::span<std::uint8_t> into, void* data) -> std::uint32_t {
    auto& box = inboxes[*static_cast<Address*>(data)];
    if (box.empty()) return 0;
    const Datagram datagram = box.front();
    box.pop_front();
    from = datagram.from;
    std::copy(datagram.bytes.begin(), datagram.bytes.end(), into.begin());
    return static_cast<std::uint32_t>(datagram.bytes.size());
  };
  return transport;
}

struct Peer {
  Arena arena;
  Address address;
  SpaceGame<S> game{arena.space, ratio<S>(1, 60), applyInputs, &arena};
  Session session;

  explicit Peer(Seat seat)
      : address(seat), session(settings(seat), game.functions(), transportOf(&address)) {}
  SessionSettings settings(Seat seat) const {
    SessionSettings settings;
    settings.players = 2;
    settings.localSeat = seat;
    settings.addresses[0] = 0;
    settings.addresses[1] = 1;
    game.describe(settings);
    return settings;
  }
};

int main() {
  Peer left(0), right(1);
  for (std::uint64_t frame = 0; frame < 600; ++frame) {
    const std::uint64_t now = frame * 16'667;
    const std::uint8_t pushes[] = {static_cast<std::uint8_t>(frame / 40 % 2 * 2),
                                   static_cast<std::uint8_t>(frame / 90 % 2)};
    left.session.frame(now, {&pushes[0], 1});
    right.session.frame(now, {&pushes[1], 1});
    for (Peer* peer : {&left, &right}) {
      for (SessionEvent event; peer->session.next(event);) {
        if (event.kind == SessionEvent::Kind::desync) std::printf("desync at tick %u\n", event.tick);
      }
    }
  }
  std::printf("left made %u ticks and is sure of %u, right %u and %u\n", left.session.tick(),
              left.session.confirmed(), right.session.tick(), right.session.confirmed());
  return left.session.tick() > 550 && right.session.tick() > 550 ? 0 : 1;
}
