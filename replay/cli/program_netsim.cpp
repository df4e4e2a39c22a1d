// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/program.h"
#include "netsim/match.h"

namespace samestep::program {
namespace {

constexpr std::int64_t kShowEvery = 5000;

using netsim::MatchOptions;
using netsim::MatchReport;

struct Options {
  std::string seeds = "1-100";
  std::string peers = "2-16";
  std::uint32_t ticks = 3600;
  std::vector<std::string> faults{"all"};
  std::string game = "arena";
  std::string planted = "none";
  bool shrinks = true;
  std::uint32_t delay = MatchOptions::kBySeed;
  std::uint32_t loss = MatchOptions::kBySeed;
  bool relay = false;
};

struct Range {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// "7" or "1-100".
Range rangeOf(const std::string& text, const char* option, std::uint64_t least, std::uint64_t most) {
  Range range;
  const char* next = text.c_str();
  const auto number = [&] {
    std::uint64_t value = 0;
    const char* start = next;
    while (*next >= '0' && *next <= '9' && value < std::uint64_t{1} << 48) {
      value = value * 10 + static_cast<std::uint64_t>(*next++ - '0');
    }
    if (next == start) next = "not a number";
    return value;
  };
  range.first = range.last = number();
  if (*next == '-') {
    ++next;
    range.last = number();
  }
  if (*next != 0 || range.first < least || range.last > most || range.first > range.last) {
    throw Unusable(std::string(option) + ": '" + text + "' is no range within " + std::to_string(least) +
                   "-" + std::to_string(most));
  }
  return range;
}

netsim::Planted plantedNamed(const std::string& name) {
  if (name == "flip") return netsim::Planted::flip;
  if (name == "deaf") return netsim::Planted::deaf;
  if (name == "forgets") return netsim::Planted::forgets;
  if (name == "lies") return netsim::Planted::lies;
  if (name == "unsealed") return netsim::Planted::unsealed;
  return netsim::Planted::none;
}

std::string commandOf(const MatchOptions& options, const Options& asked) {
  std::string text = "samestep netsim --seeds " + std::to_string(options.seed) + " --peers " +
                     std::to_string(options.peers) + " --ticks " + std::to_string(options.ticks) +
                     " --fault " + netsim::faultNames(options.faults);
  if (asked.game != "arena") text += " --game " + asked.game;
  if (asked.delay != MatchOptions::kBySeed) text += " --delay " + std::to_string(asked.delay);
  if (asked.loss != MatchOptions::kBySeed) text += " --loss " + std::to_string(asked.loss);
  if (asked.relay) text += " --relay";
  if (asked.planted != "none") text += " --plant " + asked.planted;
  return text;
}

void tellFailure(const MatchOptions& options, const MatchReport& report, const Options& asked) {
  std::printf("seed %llu: FAILED\n", static_cast<unsigned long long>(options.seed));
  for (const std::string& violation : report.violations) std::printf("  %s\n", violation.c_str());
  if (report.desynced != 0) {
    std::printf("  the detector spoke up for tick %u, on peers with bits %x\n", report.desyncTick,
                report.desynced);
  }
  for (const std::string& finding : report.findings) std::printf("  %s\n", finding.c_str());
  std::printf("  again: %s\n", commandOf(options, asked).c_str());
  if (asked.shrinks) {
    std::printf("  smaller: %s\n", commandOf(netsim::shrink(options), asked).c_str());
  }
}

/// Sum of what the seeds covered.
struct Sum {
  std::uint64_t matches = 0;
  std::uint64_t failed = 0;
  std::uint64_t peerMilliseconds = 0;
  MatchReport all;

  void add(const MatchReport& report) {
    ++matches;
    failed += report.violations.empty() ? 0 : 1;
    all.steps += report.steps;
    all.rollbacks += report.rollbacks;
    all.deepest = std::max(all.deepest, report.deepest);
    all.waited += report.waited;
    all.datagrams += report.datagrams;
    all.lost += report.lost;
    all.dropped += report.dropped;
    all.left += report.left;
    all.joined += report.joined;
    all.rejoined += report.rejoined;
    all.refused += report.refused;
    all.moved += report.moved;
    all.up += report.up;
    all.down += report.down;
    all.upDatagrams += report.upDatagrams;
    all.downDatagrams += report.downDatagrams;
    all.forged += report.forged;
    all.spoilt += report.spoilt;
    all.milliseconds += report.milliseconds;
    all.payload += report.payload;
    peerMilliseconds += report.milliseconds * report.peers;
    all.trace = all.trace * 31 + report.trace;
  }
  void print() const {
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::printf("%llu matches, %llu failed; %llu s of play\n", number(matches), number(failed),
                number(all.milliseconds / 1000));
    std::printf("steps: %llu, %llu rollbacks (deepest %u), %llu frames waited\n", number(all.steps),
                number(all.rollbacks), all.deepest, number(all.waited));
    std::printf("players: %u dropped, %u left, %u came to a match under way (%u of them back), %u moved\n",
                all.dropped, all.left, all.joined, all.rejoined, all.moved);
    std::printf("datagrams: %llu, %llu lost, %llu changed on the way, %llu dropped for their seal\n",
                number(all.datagrams), number(all.lost), number(all.spoilt), number(all.forged));
    // IP and UDP take 28 bytes of each, and a seal 21.
    const auto each = [&](std::uint64_t payload, std::uint64_t datagrams) {
      return number((payload + (28 + 21) * datagrams) * 1000 / std::max<std::uint64_t>(peerMilliseconds, 1));
    };
    if (all.up == 0) {
      std::printf("traffic: %llu bytes a second sent by each peer, with seals, IP and UDP\n",
                  each(all.payload, all.datagrams));
    } else {
      std::printf(
          "traffic: %llu bytes a second sent to the relay by each peer, %llu sent to each, with seals, IP "
          "and "
          "UDP\n",
          each(all.up, all.upDatagrams), each(all.down, all.downDatagrams));
    }
    std::printf("liars: %u states were sent to newcomers that are not the match's, and not believed\n",
                all.refused);
    std::printf("trace %s\n", hex(all.trace).c_str());
  }
};

int run(const Options& asked) {
  const Range seeds = rangeOf(asked.seeds, "--seeds", 0, std::uint64_t{1} << 40);
  const Range peers = rangeOf(asked.peers, "--peers", 2, kMaxPlayers);
  std::uint32_t faults = 0;
  for (const std::string& name : asked.faults) {
    const std::uint32_t fault = netsim::faultNamed(name);
    if (fault == 0 && name != "none") throw Unusable("--fault: there is no fault '" + name + "'");
    faults |= fault;
  }
  Sum sum;
  StatusLine status;
  std::int64_t showAt = milliseconds() + kShowEvery;
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    MatchOptions options;
    options.seed = seed;
    options.peers = static_cast<std::uint32_t>(peers.first + seed % (peers.last - peers.first + 1));
    options.ticks = asked.ticks;
    options.faults = faults;
    options.delay = asked.delay;
    options.loss = asked.loss;
    options.relay = asked.relay;
    options.planted = plantedNamed(asked.planted);
    options.makeGame = asked.game == "arena" ? netsim::makeArenaGame : netsim::makeIntegerGame;
    const MatchReport report = netsim::runMatch(options);
    sum.add(report);
    if (!report.violations.empty()) tellFailure(options, report, asked);
    if (milliseconds() < showAt) continue;
    showAt = milliseconds() + kShowEvery;
    status.show("netsim: " + std::to_string(sum.matches) + " of " +
                std::to_string(seeds.last - seeds.first + 1) + " matches, " + std::to_string(sum.failed) +
                " failed");
  }
  status.clear();
  sum.print();
  return sum.failed == 0 ? kGood : kMismatch;
}

}  // namespace

void addNetsim(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "netsim", "Play whole matches over a simulated network and check that all peers stay the same");
  auto options = std::make_shared<Options>();
  word->add_option("--seeds", options->seeds, "One match for each seed, from one to another")
      ->capture_default_str();
  word->add_option("--peers", options->peers, "How many peers play, by seed")->capture_default_str();
  word->add_option("--ticks", options->ticks, "How long a match is")
      ->check(CLI::Range(60u, 1u << 20))
      ->capture_default_str();
  word->add_option(
          "--fault", options->faults,
          "What may go wrong: loss, partition, stall, crash, leave, change, drift, hostile, asymmetric, "
          "join, rejoin, lie, corrupt, move, all or none")
      ->delimiter(',')
      ->capture_default_str();
  word->add_option("--delay", options->delay, "One way, ms, in place of what the seed has")
      ->check(CLI::Range(0u, 1000u));
  word->add_option("--loss", options->loss, "Of a hundred datagrams, in place of what the seed has")
      ->check(CLI::Range(0u, 90u));
  word->add_flag("--relay", options->relay, "All packets go through a relay");
  word->add_option("--game", options->game, "What is played: physics, or a game whose state is one integer")
      ->check(CLI::IsMember({"arena", "integer"}))
      ->capture_default_str();
  word->add_option("--plant", options->planted, "Break one peer on purpose; the run must then fail")
      ->check(CLI::IsMember({"none", "flip", "deaf", "forgets", "lies", "unsealed"}))
      ->capture_default_str();
  word->add_flag("!--no-shrink", options->shrinks, "Do not look for a smaller match that fails as well");
  word->callback([options, &result] { result = run(*options); });
}

}  // namespace samestep::program
