// SPDX-License-Identifier: MIT
#include "loopback/relay_process.h"

// A relay gathers packets for a time; not in results: sessions are told the time and keep their steps the
// same.
#include <chrono>

#include <algorithm>
#include <cstdio>

#include <samestep/relay.h>

namespace samestep::loopback {
namespace {

/// The word, cut to fit, as a secret; the last byte tells secrets of the same word apart.
std::array<std::uint8_t, 32> secretOf(const std::string& word, std::uint8_t last) {
  std::array<std::uint8_t, 32> secret{};
  std::copy_n(word.begin(), std::min<std::size_t>(word.size(), 31), secret.begin());
  secret[31] = last;
  return secret;
}

/// Microseconds since the first call.
std::uint64_t clock() {
  using std::chrono::steady_clock;                  // not in results: when packets are passed on
  static const auto start = steady_clock::now();    // not in results: when packets are passed on
  const auto passed = steady_clock::now() - start;  // not in results: when packets are passed on
  // not in results: when packets are passed on
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(passed).count());
}

}  // namespace

MatchKey relayMatchKey(const std::string& word) { return {secretOf(word, 254)}; }
KeyPair relayKeys(const std::string& word) { return KeyPair::fromSeed(secretOf(word, 253)); }

void runRelay(const RelayOptions& options) {
  UdpTransport udp("0.0.0.0", options.port);
  std::printf("relay at port %u\n", static_cast<unsigned>(udp.port()));
  std::fflush(stdout);
  runRelay(options, udp);
}

void runRelay(const RelayOptions& options, UdpTransport& udp) {
  SealedTransport sealed(udp.transport(), relayKeys(options.word), relayMatchKey(options.word));
  // Every peer that has the word plays.
  sealed.setAdmission([](const PublicKey&, void*) { return true; }, nullptr);
  Relay relay(sealed.transport());
  std::uint64_t told = 0;
  for (std::uint64_t now = clock(); options.seconds == 0 || now < std::uint64_t{options.seconds} * 1'000'000;
       now = clock()) {
    sealed.update(now);
    relay.update(now);
    if (options.tellEvery != 0 && now - told >= std::uint64_t{options.tellEvery} * 1'000'000) {
      told = now;
      std::printf("%u seats, %llu datagrams sent, %llu refused\n", relay.seats(),
                  static_cast<unsigned long long>(relay.sentPackets()),
                  static_cast<unsigned long long>(relay.refused()));
      std::fflush(stdout);
    }
    udp.wait(2);
  }
}

}  // namespace samestep::loopback
