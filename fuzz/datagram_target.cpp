// SPDX-License-Identifier: MIT
// What comes in datagrams and recordings of sessions: inputs of a tick, inputs of a packet, sealed bytes.
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <sodium.h>

#include <samestep/error.h>
#include <samestep/game.h>
#include <samestep/sealed_transport.h>

#include "check.h"
#include "relay/bundle.h"
#include "session/input_stream.h"
#include "transport/handshake.h"

namespace samestep::fuzz {
namespace {

using Span = std::span<const std::uint8_t>;

/// Reads the inputs of a tick: written back, they are the same bytes.
void inputsOfATick(Span bytes) {
  std::array<PlayerInput, kMaxPlayers> players;
  try {
    const TickInputs inputs = decodeInputs(bytes, players);
    std::array<std::uint8_t, kMaxInputsBytes> again;
    const std::size_t size = encodeInputs(inputs, again);
    expect(size == bytes.size() && std::equal(bytes.begin(), bytes.end(), again.begin()),
           "inputs are written back as they were");
  } catch (const MalformedBytes&) {
  }
}

void inputsOfAPacket(Span bytes) {
  lockstep::InputStream stream(8, 16);
  const std::uint8_t held[] = {1, 2};
  for (int i = 0; i < 10; ++i) stream.append({held, {}, lockstep::Control::none});
  const Tick base = bytes.empty() ? 0 : bytes[0] % 16u;
  const Tick limit = 100;
  Tick wrong = 0xffffffffu;
  lockstep::PacketReader reader(bytes.empty() ? bytes : bytes.subspan(1));
  lockstep::decodeEntries(reader, stream, base, limit, wrong);
  expect(stream.end() <= limit, "no input is taken beyond the limit");
  for (Tick tick = 0; tick < stream.end(); ++tick) {
    const lockstep::InputEntry entry = stream.at(tick);
    expect(entry.held.size() <= 8 && entry.commands.size() <= 16, "no input is longer than it may be");
  }
}

/// Reads the packets of a bundle: put together again, they are the same packets.
void packetsOfABundle(Span bytes) {
  std::vector<std::pair<Seat, std::vector<std::uint8_t>>> packets;
  std::array<std::uint8_t, kMaxPacket> packet;
  lockstep::BundleReader reader(bytes);
  lockstep::BundleQueue queue;
  Seat seat = 0;
  while (const std::uint32_t size = reader.next(seat, packet)) {
    expect(size <= kMaxPacket && seat < kMaxPlayers, "no packet is longer than it may be");
    // A later packet of inputs would take the place of one before.
    packet[0] = static_cast<std::uint8_t>(packet[0] | 4);
    if (!queue.add(seat, std::span(packet).first(size))) break;
    packets.emplace_back(seat, std::vector(packet.begin(), packet.begin() + size));
  }
  std::size_t at = 0;
  std::array<std::uint8_t, kMaxDatagram> bundle;
  while (const std::uint32_t size = queue.take(bundle)) {
    const std::span<const std::uint8_t> whole(bundle);
    lockstep::BundleReader again(whole.first(size));
    while (const std::uint32_t length = again.next(seat, packet)) {
      const bool same = at < packets.size() && packets[at].first == seat &&
                        packets[at].second.size() == length &&
                        std::equal(packets[at].second.begin(), packets[at].second.end(), packet.begin());
      expect(same, "packets come out of a bundle as they went in");
      ++at;
    }
  }
  expect(at == packets.size(), "all packets come out of their bundles");
}

/// Wire of a transport: what it sends and is given.
struct Wire {
  std::vector<std::uint8_t> arrives;
  std::size_t longest = 0;
  Transport transport() {
    return {this,
            [](Address, Span bytes, void* data) {
              auto& most = static_cast<Wire*>(data)->longest;
              most = std::max(most, bytes.size());
            },
            [](Address& from, std::span<std::uint8_t> into, void* data) -> std::uint32_t {
              auto& bytes = static_cast<Wire*>(data)->arrives;
              const auto size = static_cast<std::uint32_t>(std::min(bytes.size(), into.size()));
              std::copy_n(bytes.begin(), size, into.begin());
              bytes.clear();
              from = 5;
              return size;
            }};
  }
};

/// A datagram whose hash with the match's key is right.
std::vector<std::uint8_t> mended(Span bytes, const MatchKey& match) {
  std::vector<std::uint8_t> datagram(bytes.begin(), bytes.end());
  if (datagram.size() <= 16) return datagram;
  crypto_generichash_state state;
  std::array<std::uint8_t, 32> key;
  constexpr char kWords[] = "samestep seal 1 mac";
  crypto_generichash_init(&state, nullptr, 0, key.size());
  crypto_generichash_update(&state, reinterpret_cast<const std::uint8_t*>(kWords), sizeof kWords - 1);
  crypto_generichash_update(&state, match.bytes.data(), match.bytes.size());
  crypto_generichash_final(&state, key.data(), key.size());
  crypto_generichash(datagram.data() + datagram.size() - 16, 16, datagram.data(), datagram.size() - 16,
                     key.data(), key.size());
  return datagram;
}

void sealed(Span bytes) {
  static const MatchKey match{{9}};
  static Wire wire;
  static const KeyPair own = KeyPair::fromSeed({1});
  static const PublicKey other = KeyPair::fromSeed({2}).publicKey;
  static SealedTransport transport(wire.transport(), own, match);
  static const Address peer = transport.addPeer(other);
  const bool good = !bytes.empty() && (bytes[0] & 3) != 0;
  wire.arrives =
      good ? mended(bytes.subspan(1), match) : std::vector<std::uint8_t>(bytes.begin(), bytes.end());
  // Short ones are filled up to what a hello or an answer has.
  if (good && (bytes[0] & 4) != 0) {
    std::vector<std::uint8_t> whole(bytes.begin() + 1, bytes.end());
    whole.resize((bytes[0] & 8) != 0 ? kHelloBytes : kAnswerBytes);
    whole[0] = static_cast<std::uint8_t>((bytes[0] & 8) != 0 ? SealedKind::hello : SealedKind::answer);
    wire.arrives = mended(whole, match);
  }
  const std::size_t size = wire.arrives.size();
  wire.longest = 0;
  std::array<std::uint8_t, kMaxDatagram> into;
  Address from = 0;
  expect(transport.receive(from, into) == 0, "nothing that was made up is opened");
  expect(wire.longest <= size, "no answer is longer than its question");
  expect(!transport.connected(peer), "nobody is taken for the peer");
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep::fuzz;
  if (size == 0) return 0;
  const Span bytes(data + 1, size - 1);
  guarded([&] {
    if (data[0] > 250) return packetsOfABundle(bytes);
    switch (data[0] % 3) {
      case 0:
        return inputsOfATick(bytes);
      case 1:
        return inputsOfAPacket(bytes);
      default:
        return sealed(bytes);
    }
  });
  return 0;
}
