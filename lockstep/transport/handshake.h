// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <samestep/sealed_transport.h>

namespace samestep {

using Key = std::array<std::uint8_t, 32>;

/// Kind of a datagram, its first byte.
enum class SealedKind : std::uint8_t { hello = 0x51, answer = 0x52, sealed = 0x53 };

/// The keys that two peers agreed on, one for each direction.
struct ConnectionKeys {
  Key sending{};
  Key receiving{};
};

/// A call: everything but the keys can be read by the peer called alone. Padded, so that an answer is
/// shorter.
///
/// | bytes | what |
/// |---|---|
/// | 1 | SealedKind::hello |
/// | 1 | version |
/// | 32 | the caller's new public key |
/// | 48 | the caller's lasting public key, sealed |
/// | 18 | the caller's number for the connection, u16, sealed |
/// | 12 | zeros |
/// | 16 | hash of all that with the match's key |
inline constexpr std::uint32_t kHelloBytes = 128;

/// | bytes | what |
/// |---|---|
/// | 1 | SealedKind::answer |
/// | 2 | the caller's number for the connection, u16 |
/// | 32 | the new public key of the peer called |
/// | 18 | its number for the connection, u16, sealed |
/// | 16 | hash of all that with the match's key |
inline constexpr std::uint32_t kAnswerBytes = 69;

/// True if a hello or answer was made with the match's key; costs one hash.
bool madeWith(const MatchKey& match, std::span<const std::uint8_t> datagram);

/// The caller's side of a key agreement.
class Call {
 public:
  Call(const KeyPair& own, const PublicKey& peer, const MatchKey& match, std::uint16_t number);
  ~Call();
  /// Bytes of the hello: the same each time it is sent.
  std::span<const std::uint8_t> hello() const { return hello_; }
  struct Answered {
    ConnectionKeys keys;
    std::uint16_t peerNumber;
  };
  /// @return nothing unless the datagram is the answer of the peer called
  std::optional<Answered> answered(const KeyPair& own, std::span<const std::uint8_t> answer) const;

 private:
  KeyPair fresh_;
  Key chain_{};
  std::array<std::uint8_t, kHelloBytes> hello_{};
};

/// A hello as the peer called reads it.
struct Caller {
  PublicKey key{};
  PublicKey fresh{};
  std::uint16_t number = 0;
  Key chain{};
};
/// @return nothing unless the datagram is a hello for this peer
std::optional<Caller> readHello(const KeyPair& own, const MatchKey& match,
                                std::span<const std::uint8_t> hello);

/// Writes the answer to a hello. @return the keys, those of the peer called
std::optional<ConnectionKeys> writeAnswer(const Caller& caller, const MatchKey& match, std::uint16_t number,
                                          std::span<std::uint8_t, kAnswerBytes> answer);

}  // namespace samestep
