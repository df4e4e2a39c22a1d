// SPDX-License-Identifier: MIT
#include "transport/handshake.h"

#include <sodium.h>

#include <algorithm>
#include <initializer_list>

namespace samestep {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint8_t kVersion = 1;
constexpr std::uint32_t kTag = crypto_aead_chacha20poly1305_ietf_ABYTES;
constexpr std::uint32_t kMac = 16;
// These are the places at which the parts of a hello begin.
constexpr std::uint32_t kFresh = 2;
constexpr std::uint32_t kLasting = kFresh + 32;
constexpr std::uint32_t kNumber = kLasting + 32 + kTag;
constexpr std::uint32_t kHelloMac = kHelloBytes - kMac;
// And those of an answer.
constexpr std::uint32_t kAnswerFresh = 3;
constexpr std::uint32_t kAnswerNumber = kAnswerFresh + 32;
constexpr std::uint32_t kAnswerMac = kAnswerNumber + 2 + kTag;
static_assert(kAnswerMac + kMac == kAnswerBytes);
static_assert(kNumber + 2 + kTag <= kHelloMac && kAnswerBytes <= kHelloBytes);

Bytes text(const char* words) {
  const char* end = words;
  while (*end != 0) ++end;
  return {reinterpret_cast<const std::uint8_t*>(words), static_cast<std::size_t>(end - words)};
}

/// BLAKE2b of parts whose lengths are fixed by what they are.
Key hashOf(std::initializer_list<Bytes> parts) {
  crypto_generichash_state state;
  crypto_generichash_init(&state, nullptr, 0, 32);
  for (const Bytes part : parts) crypto_generichash_update(&state, part.data(), part.size());
  Key out;
  crypto_generichash_final(&state, out.data(), out.size());
  return out;
}

std::array<std::uint8_t, kMac> macOf(const MatchKey& match, Bytes bytes) {
  const Key key = hashOf({text("samestep seal 1 mac"), match.bytes});
  std::array<std::uint8_t, kMac> out;
  crypto_generichash(out.data(), out.size(), bytes.data(), bytes.size(), key.data(), key.size());
  return out;
}

/// X25519; nothing for a public key that gives no secret.
std::optional<Key> shared(const Key& secret, const PublicKey& other) {
  Key out;
  if (crypto_scalarmult(out.data(), secret.data(), other.bytes.data()) != 0) return {};
  return out;
}

// Each key seals one message alone, so its number is 0.
constexpr std::array<std::uint8_t, 12> kOnce{};

void sealOnce(const Key& key, Bytes plain, Bytes beside, std::uint8_t* into) {
  crypto_aead_chacha20poly1305_ietf_encrypt(into, nullptr, plain.data(), plain.size(), beside.data(),
                                            beside.size(), nullptr, kOnce.data(), key.data());
}

bool openOnce(const Key& key, Bytes sealed, Bytes beside, std::uint8_t* into) {
  return crypto_aead_chacha20poly1305_ietf_decrypt(into, nullptr, nullptr, sealed.data(), sealed.size(),
                                                   beside.data(), beside.size(), kOnce.data(),
                                                   key.data()) == 0;
}

std::array<std::uint8_t, 2> bytesOf(std::uint16_t number) {
  return {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8)};
}

std::uint16_t numberOf(Bytes bytes) { return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8); }

Key firstChain(const MatchKey& match, const Key& secret, const PublicKey& fresh, const PublicKey& called) {
  return hashOf({text("samestep seal 1 call"), match.bytes, secret, fresh.bytes, called.bytes});
}

Key lastChain(const Key& chain, const Key& freshSecret, const Key& lastingSecret, const PublicKey& fresh) {
  return hashOf({chain, freshSecret, lastingSecret, fresh.bytes});
}

PublicKey publicKeyAt(Bytes bytes, std::size_t offset) {
  PublicKey key;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), 32, key.bytes.begin());
  return key;
}

}  // namespace

KeyPair KeyPair::generate() {
  KeyPair pair;
  crypto_box_keypair(pair.publicKey.bytes.data(), pair.secretKey.data());
  return pair;
}

KeyPair KeyPair::fromSeed(const std::array<std::uint8_t, 32>& seed) {
  KeyPair pair;
  crypto_box_seed_keypair(pair.publicKey.bytes.data(), pair.secretKey.data(), seed.data());
  return pair;
}

bool madeWith(const MatchKey& match, Bytes datagram) {
  if (datagram.size() <= kMac) return false;
  const auto mac = macOf(match, datagram.first(datagram.size() - kMac));
  return sodium_memcmp(mac.data(), datagram.last(kMac).data(), kMac) == 0;
}

Call::Call(const KeyPair& own, const PublicKey& peer, const MatchKey& match, std::uint16_t number)
    : fresh_(KeyPair::generate()) {
  const Bytes hello = hello_;
  hello_[0] = static_cast<std::uint8_t>(SealedKind::hello);
  hello_[1] = kVersion;
  std::copy(fresh_.publicKey.bytes.begin(), fresh_.publicKey.bytes.end(), hello_.begin() + kFresh);
  // A peer whose key gives no secret can never answer, so zeros in its place do no harm.
  const Key first = firstChain(match, shared(fresh_.secretKey, peer).value_or(Key{}), fresh_.publicKey, peer);
  sealOnce(first, own.publicKey.bytes, hello.first(kLasting), hello_.data() + kLasting);
  chain_ = hashOf({first, shared(own.secretKey, peer).value_or(Key{})});
  sealOnce(chain_, bytesOf(number), hello.first(kNumber), hello_.data() + kNumber);
  const auto mac = macOf(match, hello.first(kHelloMac));
  std::copy(mac.begin(), mac.end(), hello_.begin() + kHelloMac);
}

Call::~Call() {
  sodium_memzero(fresh_.secretKey.data(), fresh_.secretKey.size());
  sodium_memzero(chain_.data(), chain_.size());
}

std::optional<Call::Answered> Call::answered(const KeyPair& own, Bytes answer) const {
  if (answer.size() != kAnswerBytes) return {};
  const PublicKey theirs = publicKeyAt(answer, kAnswerFresh);
  const auto freshSecret = shared(fresh_.secretKey, theirs);
  const auto lastingSecret = shared(own.secretKey, theirs);
  if (!freshSecret || !lastingSecret) return {};
  const Key chain = lastChain(chain_, *freshSecret, *lastingSecret, theirs);
  std::array<std::uint8_t, 2> number;
  if (!openOnce(chain, answer.subspan(kAnswerNumber, 2 + kTag), answer.first(kAnswerNumber), number.data()))
    return {};
  return Answered{{hashOf({chain, text("from caller")}), hashOf({chain, text("to caller")})},
                  numberOf(number)};
}

std::optional<Caller> readHello(const KeyPair& own, const MatchKey& match, Bytes hello) {
  if (hello.size() != kHelloBytes || hello[1] != kVersion) return {};
  Caller caller;
  caller.fresh = publicKeyAt(hello, kFresh);
  const auto secret = shared(own.secretKey, caller.fresh);
  if (!secret) return {};
  const Key first = firstChain(match, *secret, caller.fresh, own.publicKey);
  const Bytes lasting = hello.subspan(kLasting, 32 + kTag);
  if (!openOnce(first, lasting, hello.first(kLasting), caller.key.bytes.data())) return {};
  const auto lastingSecret = shared(own.secretKey, caller.key);
  if (!lastingSecret) return {};
  caller.chain = hashOf({first, *lastingSecret});
  std::array<std::uint8_t, 2> number;
  if (!openOnce(caller.chain, hello.subspan(kNumber, 2 + kTag), hello.first(kNumber), number.data()))
    return {};
  caller.number = numberOf(number);
  return caller;
}

std::optional<ConnectionKeys> writeAnswer(const Caller& caller, const MatchKey& match, std::uint16_t number,
                                          std::span<std::uint8_t, kAnswerBytes> answer) {
  KeyPair fresh = KeyPair::generate();
  const auto freshSecret = shared(fresh.secretKey, caller.fresh);
  const auto lastingSecret = shared(fresh.secretKey, caller.key);
  sodium_memzero(fresh.secretKey.data(), fresh.secretKey.size());
  if (!freshSecret || !lastingSecret) return {};
  const Key chain = lastChain(caller.chain, *freshSecret, *lastingSecret, fresh.publicKey);
  const Bytes written = answer;
  answer[0] = static_cast<std::uint8_t>(SealedKind::answer);
  const auto callers = bytesOf(caller.number);
  std::copy(callers.begin(), callers.end(), answer.begin() + 1);
  std::copy(fresh.publicKey.bytes.begin(), fresh.publicKey.bytes.end(), answer.begin() + kAnswerFresh);
  sealOnce(chain, bytesOf(number), written.first(kAnswerNumber), answer.data() + kAnswerNumber);
  const auto mac = macOf(match, written.first(kAnswerMac));
  std::copy(mac.begin(), mac.end(), answer.begin() + kAnswerMac);
  return ConnectionKeys{hashOf({chain, text("to caller")}), hashOf({chain, text("from caller")})};
}

}  // namespace samestep
