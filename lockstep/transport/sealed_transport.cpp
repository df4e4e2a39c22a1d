// SPDX-License-Identifier: MIT
#include <samestep/sealed_transport.h>
#include <sodium.h>

#include <algorithm>
#include <optional>

#include "transport/handshake.h"
#include "transport/peer_table.h"

namespace samestep {

namespace {

using Bytes = std::span<const std::uint8_t>;

// A sealed datagram: its kind, the receiver's number for the connection, the low half of its own number.
constexpr std::uint32_t kHead = 5;
constexpr std::uint32_t kTag = crypto_aead_chacha20poly1305_ietf_ABYTES;
static_assert(kHead + kTag == SealedTransport::kSealBytes);

constexpr std::uint64_t kCallAgain = 250'000;        // us
constexpr std::uint64_t kSilenceOfPeer = 3'000'000;  // us, after which a peer is called anew.
/// No call looks at more datagrams than these: whoever floods a peer shall not stop it.
constexpr int kMostDropped = 256;

std::array<std::uint8_t, 12> nonceOf(std::uint64_t number) {
  std::array<std::uint8_t, 12> nonce{};
  for (std::uint32_t i = 0; i < 8; ++i) nonce[4 + i] = static_cast<std::uint8_t>(number >> (8 * i));
  return nonce;
}

}  // namespace

struct SealedTransport::Impl : PeerTable {
  Impl(const Transport& carrier, const KeyPair& self, const MatchKey& secret)
      : below(carrier), own(self), match(secret) {}

  Transport below;
  KeyPair own;
  MatchKey match;
  Admission admission = nullptr;
  void* admissionData = nullptr;
  std::uint64_t now = 0;
  SealCounters counters{};
  std::array<std::uint8_t, kMaxDatagram> arrived{};

  void callIfNeeded(SealedPeer& peer) {
    const bool silent = peer.current == kNoConnection || now - peer.lastHeard > kSilenceOfPeer;
    if (!peer.used || !peer.callable || !silent || now < peer.nextCall) return;
    if (!peer.call) {
      peer.calling = placeFor(peer);
      occupy(peer.calling, SealedConnection::State::calling);
      peer.call.emplace(own, peer.key, match, numberOf(peer.calling));
    }
    peer.nextCall = now + kCallAgain;
    below.send(peer.below, peer.call->hello(), below.data);
  }

  /// The peer called knows that its answer arrived by the first sealed datagram.
  void confirmAgain(SealedPeer& peer) {
    if (peer.current == kNoConnection || connections[peer.current].heard || now < peer.nextCall) return;
    peer.nextCall = now + kCallAgain;
    seal(peer, {});
  }

  void seal(SealedPeer& peer, Bytes bytes) {
    SealedConnection& connection = connections[peer.current];
    const std::uint64_t number = connection.sent++;
    std::array<std::uint8_t, kMaxDatagram> out;
    out[0] = static_cast<std::uint8_t>(SealedKind::sealed);
    out[1] = static_cast<std::uint8_t>(connection.peerNumber);
    out[2] = static_cast<std::uint8_t>(connection.peerNumber >> 8);
    out[3] = static_cast<std::uint8_t>(number);
    out[4] = static_cast<std::uint8_t>(number >> 8);
    const auto nonce = nonceOf(number);
    crypto_aead_chacha20poly1305_ietf_encrypt(out.data() + kHead, nullptr, bytes.data(), bytes.size(),
                                              out.data(), kHead, nullptr, nonce.data(),
                                              connection.keys.sending.data());
    below.send(peer.below, Bytes(out).first(kHead + bytes.size() + kTag), below.data);
  }

  void takeHello(Address from, Bytes datagram) {
    const auto caller = readHello(own, match, datagram);
    if (!caller) {
      ++counters.forged;
      return;
    }
    SealedPeer* peer = find(caller->key);
    if (peer == nullptr && admission != nullptr && admission(caller->key, admissionData))
      peer = letIn(caller->key);
    if (peer == nullptr) {
      ++counters.strangers;
      return;
    }
    if (const SealedConnection* known = madeFor(*peer, caller->fresh)) {
      below.send(from, known->answer, below.data);
      return;
    }
    answer(*peer, *caller, from);
  }

  /// The connection that a hello has led to before.
  const SealedConnection* madeFor(const SealedPeer& peer, const PublicKey& fresh) const {
    const std::uint32_t first = indexOf(peer) * kConnectionsOfPeer;
    for (std::uint32_t i = first; i < first + kConnectionsOfPeer; ++i) {
      const SealedConnection& connection = connections[i];
      const bool answered = connection.state != SealedConnection::State::none && connection.answer[0] != 0;
      if (answered && connection.callerFresh == fresh) return &connection;
    }
    return nullptr;
  }

  void answer(SealedPeer& peer, const Caller& caller, Address from) {
    const std::uint32_t index = placeFor(peer);
    SealedConnection& connection = occupy(index, SealedConnection::State::unconfirmed);
    const auto keys = writeAnswer(caller, match, numberOf(index), connection.answer);
    if (!keys) {
      occupy(index, SealedConnection::State::none);
      ++counters.forged;
      return;
    }
    connection.keys = *keys;
    connection.peerNumber = caller.number;
    connection.callerFresh = caller.fresh;
    below.send(from, connection.answer, below.data);
  }

  void takeAnswer(Address from, Bytes datagram) {
    const std::uint32_t index = datagram[1];
    const auto number = static_cast<std::uint16_t>(datagram[1] | datagram[2] << 8);
    SealedPeer& peer = peers[index / kConnectionsOfPeer];
    if (!peer.used || !peer.call || peer.calling != index || numberOf(index) != number) {
      ++counters.unknown;
      return;
    }
    const auto answered = peer.call->answered(own, datagram);
    if (!answered) {
      ++counters.forged;
      return;
    }
    connections[index].keys = answered->keys;
    connections[index].peerNumber = answered->peerNumber;
    peer.call.reset();
    peer.calling = kNoConnection;
    makeCurrent(peer, index, from);
    peer.nextCall = now + kCallAgain;
    seal(peer, {});
  }

  void makeCurrent(SealedPeer& peer, std::uint32_t index, Address from) {
    connections[index].state = SealedConnection::State::confirmed;
    peer.current = index;
    peer.below = from;
    peer.lastHeard = now;
  }

  /// @return the length of what was sealed, or nothing for a datagram that is dropped
  std::optional<std::uint32_t> open(Address& from, Bytes datagram, std::span<std::uint8_t> into) {
    const std::uint32_t index = datagram[1];
    const auto number = static_cast<std::uint16_t>(datagram[1] | datagram[2] << 8);
    SealedConnection& connection = connections[index];
    if (connection.state < SealedConnection::State::unconfirmed || numberOf(index) != number) {
      ++counters.unknown;
      return {};
    }
    const std::uint64_t whole =
        connection.window.wholeOf(static_cast<std::uint16_t>(datagram[3] | datagram[4] << 8));
    if (connection.window.seen(whole)) {
      ++counters.replayed;
      return {};
    }
    const auto nonce = nonceOf(whole);
    const Bytes sealed = datagram.subspan(kHead);
    std::array<std::uint8_t, kMaxDatagram> plain;
    if (crypto_aead_chacha20poly1305_ietf_decrypt(plain.data(), nullptr, nullptr, sealed.data(),
                                                  sealed.size(), datagram.data(), kHead, nonce.data(),
                                                  connection.keys.receiving.data()) != 0) {
      ++counters.forged;
      return {};
    }
    connection.window.mark(whole);
    hear(index, from);
    const auto length = static_cast<std::uint32_t>(sealed.size() - kTag);
    if (length > into.size()) {
      ++counters.malformed;
      return {};
    }
    std::copy_n(plain.begin(), length, into.begin());
    from = Address{index / kConnectionsOfPeer} + 1;
    return length;
  }

  /// Notes what is true once a datagram of a connection was opened: the peer is there, at that address.
  void hear(std::uint32_t index, Address from) {
    SealedPeer& peer = peers[index / kConnectionsOfPeer];
    connections[index].heard = true;
    peer.lastHeard = now;
    if (connections[index].state == SealedConnection::State::unconfirmed) {
      makeCurrent(peer, index, from);
    } else if (peer.current == index) {
      peer.below = from;
    }
  }

  std::uint32_t receive(Address& from, std::span<std::uint8_t> into) {
    for (int dropped = 0; dropped < kMostDropped; ++dropped) {
      const std::uint32_t length = below.receive(from, arrived, below.data);
      if (length == 0) break;
      const Bytes datagram = Bytes(arrived).first(std::min(length, kMaxDatagram));
      const auto kind = static_cast<SealedKind>(datagram[0]);
      if (kind == SealedKind::sealed && datagram.size() >= kSealBytes) {
        if (const auto opened = open(from, datagram, into); opened.value_or(0) > 0) return *opened;
        continue;
      }
      const bool hello = kind == SealedKind::hello && datagram.size() == kHelloBytes;
      const bool answer = kind == SealedKind::answer && datagram.size() == kAnswerBytes;
      if (!hello && !answer) {
        ++counters.malformed;
      } else if (!madeWith(match, datagram)) {
        ++counters.forged;
      } else if (hello) {
        takeHello(from, datagram);
      } else {
        takeAnswer(from, datagram);
      }
    }
    return 0;
  }
};

SealedTransport::SealedTransport(const Transport& below, const KeyPair& own, const MatchKey& match)
    : impl_(new Impl(below, own, match)) {
  if (sodium_init() < 0) randombytes_stir();
  // Numbers of an earlier run are not those of this one.
  for (SealedConnection& connection : impl_->connections) {
    connection.use = static_cast<std::uint8_t>(randombytes_uniform(256));
  }
}

SealedTransport::~SealedTransport() {
  sodium_memzero(impl_->own.secretKey.data(), impl_->own.secretKey.size());
  for (SealedConnection& connection : impl_->connections)
    sodium_memzero(&connection.keys, sizeof(ConnectionKeys));
  delete impl_;
}

Address SealedTransport::addPeer(const PublicKey& peer) {
  const SealedPeer* added = impl_->letIn(peer);
  return added == nullptr ? 0 : Address{impl_->indexOf(*added)} + 1;
}

Address SealedTransport::addPeer(const PublicKey& peer, Address below) {
  SealedPeer* added = impl_->letIn(peer);
  if (added == nullptr) return 0;
  added->callable = true;
  added->below = below;
  added->nextCall = 0;
  return Address{impl_->indexOf(*added)} + 1;
}

void SealedTransport::removePeer(Address peer) {
  if (SealedPeer* found = impl_->find(peer)) impl_->remove(*found);
}

void SealedTransport::setAdmission(Admission admission, void* data) {
  impl_->admission = admission;
  impl_->admissionData = data;
}

void SealedTransport::update(std::uint64_t now) {
  impl_->now = now;
  for (SealedPeer& peer : impl_->peers) {
    impl_->callIfNeeded(peer);
    impl_->confirmAgain(peer);
  }
}

void SealedTransport::send(Address peer, Bytes bytes) {
  SealedPeer* found = impl_->find(peer);
  if (found == nullptr || found->current == kNoConnection || bytes.size() > kMaxPayload) {
    ++impl_->counters.unsent;
    return;
  }
  impl_->seal(*found, bytes);
}

std::uint32_t SealedTransport::receive(Address& from, std::span<std::uint8_t> into) {
  return impl_->receive(from, into);
}

Transport SealedTransport::transport() {
  return {this,
          [](Address to, Bytes bytes, void* data) { static_cast<SealedTransport*>(data)->send(to, bytes); },
          [](Address& from, std::span<std::uint8_t> into, void* data) {
            return static_cast<SealedTransport*>(data)->receive(from, into);
          }};
}

bool SealedTransport::connected(Address peer) const {
  const SealedPeer* found = impl_->find(peer);
  return found != nullptr && found->current != kNoConnection;
}

PublicKey SealedTransport::keyOf(Address peer) const {
  const SealedPeer* found = impl_->find(peer);
  return found == nullptr ? PublicKey{} : found->key;
}

const SealCounters& SealedTransport::counters() const { return impl_->counters; }

}  // namespace samestep
