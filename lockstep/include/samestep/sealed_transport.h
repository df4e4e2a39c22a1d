// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <samestep/transport.h>

namespace samestep {

/// A peer's lasting name: the public half of an X25519 key pair.
struct PublicKey {
  std::array<std::uint8_t, 32> bytes{};
  friend bool operator==(const PublicKey&, const PublicKey&) = default;
};

/// Keys of a peer: they say who it is. The lobby hands public keys round; the secret one never leaves its
/// peer.
struct KeyPair {
  PublicKey publicKey{};
  std::array<std::uint8_t, 32> secretKey{};

  /// A new pair from the system's random numbers.
  static KeyPair generate();
  /// The pair that belongs to 32 secret bytes, for keys that are kept.
  static KeyPair fromSeed(const std::array<std::uint8_t, 32>& seed);
};

/// A secret of everybody in a match, handed out by the lobby. A datagram that was not made with it is dropped
/// after one short hash, unanswered.
struct MatchKey {
  std::array<std::uint8_t, 32> bytes{};
};

/// Number of datagrams dropped since the start, by reason. Drops are silent on the wire.
struct SealCounters {
  std::uint64_t malformed = 0;  ///< A length or kind that no peer sends.
  std::uint64_t forged = 0;     ///< Datagrams not made with the match's or peer's keys.
  std::uint64_t strangers = 0;  ///< Datagrams made with the match's key by a peer that was not let in.
  std::uint64_t replayed = 0;   ///< Received before, or too old to tell.
  std::uint64_t unknown = 0;    ///< Datagrams for a connection that does not exist (any more).
  std::uint64_t unsent = 0;     ///< Not sent, as there is no connection to that peer yet.
};

/// Datagrams in which only the two peers of a connection can read, write or repeat anything, over any other
/// Transport. Every datagram is encrypted and authenticated (ChaCha20-Poly1305), numbered by 64 bits of which
/// 16 are sent, and taken once. Keys are agreed on by X25519: from the lasting keys, which say who is there,
/// and from new ones, so that a key that leaks later does not open what was recorded before. It adds
/// kSealBytes to a datagram.
///
/// A peer is named by the Address that addPeer answers, and may change its own address at any time. No
/// answer is longer than the datagram it answers, and a stranger gets none.
class SealedTransport {
 public:
  static constexpr std::uint32_t kSealBytes = 21;
  /// The longest datagram that can be sent.
  static constexpr std::uint32_t kMaxPayload = kMaxDatagram - kSealBytes;
  static_assert(kMaxPayload >= kMaxPacket, "a session's packets fit");
  static constexpr std::uint32_t kMaxPeers = 64;
  /// Function that tells whether a peer that is not known, but has the match's key, is let in.
  using Admission = bool (*)(const PublicKey& peer, void* data);

  /// @param below  what carries the sealed datagrams; it must outlive this
  SealedTransport(const Transport& below, const KeyPair& own, const MatchKey& match);
  ~SealedTransport();
  SealedTransport(const SealedTransport&) = delete;
  SealedTransport& operator=(const SealedTransport&) = delete;

  /// Lets a peer in that is expected to call.
  /// @return its name here, from 1 on; 0 where there is no room for it
  Address addPeer(const PublicKey& peer);
  /// Lets a peer in and calls it at an address of the transport below, until it answers.
  Address addPeer(const PublicKey& peer, Address below);
  /// Ends the connection; what the peer sends from now on is dropped.
  void removePeer(Address peer);
  /// Asks a function about peers that are not known; null, as in the beginning, lets none in.
  void setAdmission(Admission admission, void* data);

  /// Calls peers that have not answered. Call it before receiving, some 60 times a second.
  /// @param now  microseconds of a clock that never goes back
  void update(std::uint64_t now);

  /// Seals and sends at most kMaxPayload bytes; dropped and counted where no connection exists yet.
  void send(Address peer, std::span<const std::uint8_t> bytes);
  /// The next datagram of a peer. @return its length, or 0 if there is none
  std::uint32_t receive(Address& from, std::span<std::uint8_t> into);
  /// Transport that this is; it must not outlive this.
  Transport transport();

  /// True if keys have been agreed on with the peer.
  bool connected(Address peer) const;
  /// Public key of a peer; all zeros for a name that is not in use.
  PublicKey keyOf(Address peer) const;
  const SealCounters& counters() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace samestep
