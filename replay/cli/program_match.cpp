// SPDX-License-Identifier: MIT
#include "cli/program.h"

#ifdef SAMESTEP_TRANSPORT

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "loopback/match.h"

namespace samestep::program {
namespace {

using loopback::MatchOptions;
using loopback::PeerReport;
using loopback::PeerResult;

struct Options {
  MatchOptions match;
  std::uint32_t delay = 50;
  std::uint32_t jitter = 10;
  std::uint32_t loss = 5;
  std::uint32_t window = 8;
  std::uint32_t inputDelay = 2;
  std::string folder;
  std::string flip;
};

/// "SEAT@TICK".
void readFlip(const std::string& text, MatchOptions& match) {
  const char* end = text.data() + text.size();
  std::uint32_t seat = 0;
  const auto [at, noSeat] = std::from_chars(text.data(), end, seat);
  const bool divided = noSeat == std::errc() && at != end && *at == '@';
  const auto [last, noTick] = divided ? std::from_chars(at + 1, end, match.flipTick)
                                      : std::from_chars_result{at, std::errc::invalid_argument};
  if (noTick != std::errc() || last != end || seat >= match.players || match.flipTick >= match.ticks) {
    throw Unusable("--flip: '" + text + "' is no SEAT@TICK of the match");
  }
  match.flipSeat = static_cast<Seat>(seat);
}

void print(std::size_t seat, const PeerResult& peer) {
  const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  const PeerReport& report = peer.report;
  if (!peer.ended) {
    std::printf("peer %zu: its process did not end well\n", seat);
    return;
  }
  std::printf("peer %zu: %u ticks, %llu steps, %llu rollbacks (deepest %u), %llu frames waited, ", seat,
              report.certain, number(report.steps), number(report.rollbacks), report.deepest,
              number(report.waited));
  std::printf("%llu of %llu datagrams lost, %llu bytes a second sent\n", number(report.lost),
              number(report.datagrams),
              number(report.bytes * 1'000'000 / std::max<std::uint64_t>(report.microseconds, 1)));
  std::fputs(peer.words.c_str(), stdout);
}

void write(const std::string& folder, const std::vector<PeerResult>& peers) {
  for (std::size_t seat = 0; seat < peers.size(); ++seat) {
    if (peers[seat].recording.empty()) continue;
    writeFile((std::filesystem::path(folder) / ("peer" + std::to_string(seat) + ".rec")).string(),
              peers[seat].recording);
  }
}

int run(Options& asked) {
  MatchOptions& match = asked.match;
  match.link.delay = asked.delay * 1000u;
  match.link.jitter = asked.jitter * 1000u;
  match.link.loss = asked.loss * 10;
  match.window = static_cast<std::uint8_t>(asked.window);
  match.inputDelay = static_cast<std::uint8_t>(asked.inputDelay);
  if (!asked.flip.empty()) readFlip(asked.flip, match);
  if (!asked.folder.empty()) {
    std::filesystem::create_directories(asked.folder);
    checkWritable(asked.folder + "/peer0.rec");
  }
  std::printf("%u peers play %u ticks over UDP: sealed, %u ms and up to %u more on the way, %u %% lost\n",
              match.players, match.ticks, asked.delay, asked.jitter, asked.loss);
  std::fflush(stdout);
  const std::vector<PeerResult> peers = loopback::playMatch(match);
  bool good = true;
  for (std::size_t seat = 0; seat < peers.size(); ++seat) {
    print(seat, peers[seat]);
    good &= peers[seat].ended && !peers[seat].report.desynced;
  }
  if (!asked.folder.empty()) write(asked.folder, peers);
  const std::string wrong = loopback::compareRecordings(match, peers);
  std::fputs(wrong.c_str(), stdout);
  if (wrong.empty()) {
    std::printf("%zu recordings, each verified, all the same to the last byte (%zu bytes)\n", peers.size(),
                peers[0].recording.size());
  }
  return good && wrong.empty() ? kGood : kMismatch;
}

}  // namespace

void addMatch(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "match", "Play a match of bots between processes, over UDP that is made as bad as asked for");
  auto options = std::make_shared<Options>();
  MatchOptions& match = options->match;
  word->add_option("--players", match.players, "Processes that play")
      ->check(CLI::Range(2u, unsigned{kMaxPlayers}))
      ->capture_default_str();
  word->add_option("--ticks", match.ticks, "How long the match is")
      ->check(CLI::Range(60u, 1u << 20))
      ->capture_default_str();
  word->add_option("--crates", match.crates, "How many crates lie about")
      ->check(CLI::Range(0u, 100u))
      ->capture_default_str();
  word->add_option("--delay", options->delay, "One way, ms")
      ->check(CLI::Range(0u, 1000u))
      ->capture_default_str();
  word->add_option("--jitter", options->jitter, "Added to the delay, evenly spread up to this, ms")
      ->check(CLI::Range(0u, 1000u))
      ->capture_default_str();
  word->add_option("--loss", options->loss, "Of a hundred datagrams")
      ->check(CLI::Range(0u, 90u))
      ->capture_default_str();
  word->add_option("--window", options->window, "Ticks that may be predicted; 0: pure lockstep")
      ->check(CLI::Range(0u, unsigned{kMaxWindow}))
      ->capture_default_str();
  word->add_option("--input-delay", options->inputDelay, "Ticks between an input and its step")
      ->check(CLI::Range(0u, unsigned{kMaxInputDelay}))
      ->capture_default_str();
  word->add_option("--speed", match.speed, "How many times faster than usual all clocks run")
      ->check(CLI::Range(1u, 16u))
      ->capture_default_str();
  word->add_option("--seed", match.seed, "Of the bots and of what is lost")->capture_default_str();
  word->add_flag("--relay", match.relay, "All packets go through a relay, one process more");
  word->add_option("-o,--output", options->folder, "A folder for what each peer has recorded");
  // This is there to see a desync: one bit of SEAT is changed at TICK.
  word->add_option("--flip", options->flip)->group("");
  word->callback([options, &result] { result = run(*options); });
}

}  // namespace samestep::program

#else

namespace samestep::program {

void addMatch(CLI::App&, int&) {}

}  // namespace samestep::program

#endif
