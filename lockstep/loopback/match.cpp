// SPDX-License-Identifier: MIT
#include "loopback/match.h"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <samestep/replay_diff.h>
#include <samestep/verify.h>

#include "loopback/player.h"
#include "loopback/relay_process.h"

namespace samestep::loopback {

namespace {

/// A process that plays, and the pipe that it tells its result by.
struct Child {
  pid_t process = -1;
  int pipe = -1;
  std::vector<std::uint8_t> told;
};

[[noreturn]] void refuse(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

Table setTable(const MatchOptions& options) {
  Table table;
  for (std::uint32_t seat = 0; seat < options.players; ++seat) {
    table.sockets.push_back(std::make_unique<UdpTransport>("127.0.0.1"));
    table.keys.push_back(KeyPair::generate());
  }
  table.match.bytes = KeyPair::generate().secretKey;
  if (options.relay) {
    table.relay = std::make_unique<UdpTransport>("127.0.0.1");
    const auto secret = KeyPair::generate().secretKey;
    table.relayWord.assign(secret.begin(), secret.end());
  }
  return table;
}

void tell(int pipe, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(pipe, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

/// Tells what a process of the same program found: the report as it is in memory, the words, the recording.
void tellResult(int pipe, const PeerResult& result) {
  std::array<std::uint8_t, sizeof(PeerReport) + 4> head{};
  const auto words = static_cast<std::uint32_t>(result.words.size());
  std::memcpy(head.data(), &result.report, sizeof(PeerReport));
  std::memcpy(head.data() + sizeof(PeerReport), &words, sizeof words);
  tell(pipe, head);
  tell(pipe, {reinterpret_cast<const std::uint8_t*>(result.words.data()), result.words.size()});
  tell(pipe, result.recording);
}

PeerResult resultOf(std::span<const std::uint8_t> told) {
  PeerResult result;
  std::uint32_t words = 0;
  if (told.size() < sizeof(PeerReport) + 4) return result;
  std::memcpy(&result.report, told.data(), sizeof(PeerReport));
  std::memcpy(&words, told.data() + sizeof(PeerReport), sizeof words);
  const auto rest = told.subspan(sizeof(PeerReport) + 4);
  if (words > rest.size()) return result;
  result.words.assign(rest.begin(), rest.begin() + words);
  result.recording.assign(rest.begin() + words, rest.end());
  result.ended = true;
  return result;
}

/// Starts a process that plays a seat.
Child start(const MatchOptions& options, Table& table, Seat seat) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) refuse("no pipe");
  const pid_t process = fork();
  if (process < 0) refuse("no process");
  if (process > 0) {
    close(ends[1]);
    return {process, ends[0], {}};
  }
  close(ends[0]);
  int code = 1;
  try {
    tellResult(ends[1], Player(options, table, seat).play());
    code = 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "peer %u: %s\n", static_cast<unsigned>(seat), error.what());
  }
  _exit(code);
}

/// Starts the relay. @return its process
pid_t startRelay(Table& table) {
  const pid_t process = fork();
  if (process < 0) refuse("no process");
  if (process > 0) return process;
  try {
    RelayOptions options;
    options.word = table.relayWord;
    options.tellEvery = 0;
    runRelay(options, *table.relay);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "relay: %s\n", error.what());
  }
  _exit(1);
}

/// Reads what the children tell until all have ended or so many milliseconds have passed.
void listen(std::vector<Child>& children, int most) {
  std::vector<pollfd> waiting;
  for (const Child& child : children) waiting.push_back({child.pipe, POLLIN, 0});
  auto open = static_cast<std::uint32_t>(children.size());
  std::array<std::uint8_t, 65536> bytes;
  while (open > 0 && poll(waiting.data(), waiting.size(), most) > 0) {
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (waiting[i].fd < 0 || waiting[i].revents == 0) continue;
      const ssize_t got = read(children[i].pipe, bytes.data(), bytes.size());
      if (got > 0) {
        children[i].told.insert(children[i].told.end(), bytes.begin(), bytes.begin() + got);
      } else if (got == 0 || errno != EINTR) {
        waiting[i].fd = -1;
        --open;
      }
    }
  }
}

}  // namespace

std::vector<PeerResult> playMatch(const MatchOptions& options) {
  Table table = setTable(options);
  const pid_t relay = options.relay ? startRelay(table) : -1;
  std::vector<Child> children;
  for (Seat seat = 0; seat < options.players; ++seat) children.push_back(start(options, table, seat));
  // Peers end by themselves; whoever hangs is ended.
  const auto limit = std::uint64_t{options.ticks} * 50 / options.speed + 70'000;
  listen(children, static_cast<int>(std::min<std::uint64_t>(limit, 1u << 30)));
  std::vector<PeerResult> results;
  for (const Child& child : children) {
    close(child.pipe);
    int status = 0;
    if (waitpid(child.process, &status, WNOHANG) == 0) {
      usleep(100'000);
      if (waitpid(child.process, &status, WNOHANG) == 0) {
        kill(child.process, SIGKILL);
        waitpid(child.process, &status, 0);
      }
    }
    results.push_back(resultOf(child.told));
    results.back().ended &= WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  if (relay > 0) {
    kill(relay, SIGKILL);
    int status = 0;
    waitpid(relay, &status, 0);
  }
  return results;
}

std::string compareRecordings(const MatchOptions& options, const std::vector<PeerResult>& peers) {
  FlippedArena arena(options);
  const SpaceGame<Fixed> game(arena.arena.space(), ratio<Fixed>(1, 60), FlippedArena::apply, &arena);
  VerifyOptions expected;
  expected.expected.firstHash = arena.arena.space().hash();
  expected.expected.ticks = options.ticks;
  std::string wrong;
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const std::string name = "peer " + std::to_string(i);
    if (!peers[i].ended || peers[i].recording.empty()) {
      wrong += name + " has no recording of " + std::to_string(options.ticks) + " ticks\n";
      continue;
    }
    const VerifyResult result = verify<Fixed>(peers[i].recording, game.wiring(), expected);
    if (result.unexpected != nullptr) {
      wrong += name + ": " + result.unexpected + " is not as expected\n";
    } else if (!result.matches) {
      wrong += name + ": its world after tick " + std::to_string(result.firstWrongTick) +
               " is not what its inputs lead to\n";
    } else if (peers[i].recording != peers[0].recording) {
      const ReplayDifference found =
          findDifference<Fixed>(peers[0].recording, peers[i].recording, game.wiring(), 1);
      wrong += name + " and peer 0 part at tick " + std::to_string(found.tick) + "\n";
    }
  }
  return wrong;
}

}  // namespace samestep::loopback
