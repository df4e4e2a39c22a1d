// SPDX-License-Identifier: MIT
// What scripts/platforms runs on each platform: runner [OPTION]... FILE...
// Prints a line about the platform, then lines of a name, a tick and a hash. The name is
//   fingerprint.SCALAR: at tick 0, the fingerprint;
//   game.double: at tick 0, a hash of what a game's own double code computes;
//   RECORDING: for each tick of a recording, the hash of the world after it, computed here, or with
//   --recorded that which the recording carries; RECORDING@saved: at the tick of --save-at, the hash of the
//   bytes of a snapshot; RECORDING@TICK, a file with the snapshot of that tick, as --write leaves it: the
//   same for the recording played on from there.
// Options: --recorded, --ticks N, --save-at TICK, --write (the snapshots, beside the recordings), --kernel
// NAME,
// --workers N; others are refused. Output goes through printf, as <iostream> would be most of the program.
#include <bit>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <samestep/fingerprint.h>
#include <samestep/named_handlers.h>
#include <samestep/replay.h>
#include <samestep/snapshot.h>
#include <samestep/version.h>
#include <samestep/workers.h>

#include "../consumer/client_double.h"

namespace samestep {
namespace {

[[noreturn]] void stop(const char* path, const char* reason) {
  std::printf("%s: %s\n", path, reason);
  std::exit(1);
}

std::vector<std::uint8_t> readFile(const char* path) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) stop(path, "cannot be opened");
  std::vector<std::uint8_t> bytes;
  std::uint8_t chunk[4096];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, file)) {
    bytes.insert(bytes.end(), chunk, chunk + count);
  }
  std::fclose(file);
  return bytes;
}

/// The part of a path after the last slash.
std::string_view nameOf(std::string_view path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

struct Options {
  bool recorded = false;
  bool write = false;
  std::uint64_t ticks = ~std::uint64_t{0};
  std::uint64_t saveAt = 0;
  KernelTarget kernel = KernelTarget::best;
  int workers = 1;
};

void printHash(std::string_view name, std::uint64_t tick, std::uint64_t hash) {
  std::printf("%.*s %" PRIu64 " %016" PRIx64 "\n", static_cast<int>(name.size()), name.data(), tick, hash);
}

/// FNV-1a: another one than that of the snapshot's own checksum.
std::uint64_t hashOfBytes(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

template <Scalar S>
void save(const std::string& path, const Space<S>& space, const Options& options) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(saveSnapshot(space, {})));
  saveSnapshot(space, bytes);
  printHash(std::string(nameOf(path)) + "@saved", options.saveAt, hashOfBytes(bytes));
  if (!options.write) return;
  const std::string into = path + "@" + std::to_string(options.saveAt);
  std::FILE* file = std::fopen(into.c_str(), "wb");
  if (file == nullptr || std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() ||
      std::fclose(file) != 0) {
    stop(into.c_str(), "cannot be written");
  }
}

template <Scalar S>
void play(const std::string& path, const std::vector<std::uint8_t>& bytes, const Options& options) {
  WorkerPool pool(options.workers);
  Replay<S> replay(bytes, namedHandlerWiring<S>());
  replay.space().setWorkers(&pool, Sharing::always);
  replay.space().forceKernel(options.kernel);
  while (replay.tick() < options.ticks && replay.step()) {
    printHash(nameOf(path), replay.tick(), options.recorded ? replay.recordedHash() : replay.space().hash());
    if (replay.tick() == options.saveAt) save(path, replay.space(), options);
  }
}

/// Plays a recording from the step after the one of the snapshot.
template <Scalar S>
void playOn(const std::string& path, const std::vector<std::uint8_t>& recording, const Options& options) {
  const Wiring<S> wiring = namedHandlerWiring<S>();
  Space<S> space;
  wiring.connect(space, wiring.data);
  loadSnapshot(space, readFile(path.c_str()));
  WorkerPool pool(options.workers);
  space.setWorkers(&pool, Sharing::always);
  space.forceKernel(options.kernel);
  const std::uint64_t start = space.stamp();
  RecordingReader<S> reader(recording);
  std::uint64_t tick = 0;
  for (RecordingItem item = reader.next(); item != RecordingItem::end && tick < options.ticks;
       item = reader.next()) {
    if (item == RecordingItem::step) ++tick;
    if (item == RecordingItem::command && tick >= start) applyCommand(space, reader.command(), wiring);
    if (item != RecordingItem::step || tick <= start) continue;
    space.step(reader.timeStep());
    printHash(nameOf(path), tick, space.hash());
  }
}

template <Scalar S>
void run(const std::string& path, const std::vector<std::uint8_t>& recording, const Options& options) {
  if (path.find('@') == std::string::npos) {
    play<S>(path, recording, options);
  } else {
    playOn<S>(path, recording, options);
  }
}

void runFile(const std::string& path, const Options& options) {
  const std::vector<std::uint8_t> recording = readFile(path.substr(0, path.find('@')).c_str());
  if (recordingInfo(recording).scalar == ScalarKind::fixed) {
    run<Fixed>(path, recording, options);
    return;
  }
#ifndef SAMESTEP_FIXED_ONLY
  run<double>(path, recording, options);
#else
  stop(path.c_str(), "this build has no double");
#endif
}

void printFingerprints() {
  printHash("fingerprint.fixed", 0, fingerprint<Fixed>());
#ifndef SAMESTEP_FIXED_ONLY
  printHash("fingerprint.double", 0, fingerprint<double>());
#endif
}

#ifndef SAMESTEP_FIXED_ONLY
/// Hash of what a game computes with double by itself, under the flags that the library gives it: vectors
/// turned on and on, and sums of products, from numbers that differ in every bit.
std::uint64_t hashOfGame() {
  constexpr int kCount = 64;
  std::uint64_t random = 1;
  const auto next = [&] {
    random = random * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(static_cast<std::int64_t>(random >> 12)) / 4503599627370496.0 - 0.5;
  };
  ::Pair vectors[kCount];
  double a[kCount], b[kCount], out[4];
  for (int i = 0; i < kCount; ++i) {
    vectors[i] = {next(), next()};
    a[i] = next();
    b[i] = next();
  }
  std::vector<std::uint8_t> bytes;
  const auto keep = [&](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
  };
  for (int round = 0; round < 100; ++round) {
    turnAll(vectors, kCount, turned({0.96, 0.28}, vectors[round % kCount]));
    axpy(a, b, a[round % kCount], kCount);
    alternate(out, a, b, a + 8);
    keep(sum(a, b, kCount));
    for (const double value : out) keep(value);
    for (int i = 0; i < kCount; ++i) a[i] = next();
    for (::Pair& vector : vectors) {
      keep(vector.x);
      vector = {vector.x + next(), vector.y + next()};
    }
  }
  return hashOfBytes(bytes);
}
#endif

void describePlatform() {
  const std::string_view name = compiler();
  std::printf("platform: %d %s %.*s\n", static_cast<int>(8 * sizeof(void*)),
              std::endian::native == std::endian::little ? "little" : "big", static_cast<int>(name.size()),
              name.data());
  // So that it is seen even if the program does not come to its end.
  std::fflush(stdout);
}

}  // namespace
}  // namespace samestep

int main(int argumentCount, char** arguments) {
  samestep::Options options;
  samestep::describePlatform();
  samestep::printFingerprints();
#ifndef SAMESTEP_FIXED_ONLY
  samestep::printHash("game.double", 0, samestep::hashOfGame());
#endif
  for (int i = 1; i < argumentCount; ++i) {
    const std::string_view argument = arguments[i];
    if (argument == "--recorded") {
      options.recorded = true;
    } else if (argument == "--write") {
      options.write = true;
    } else if (argument == "--save-at" && i + 1 < argumentCount) {
      options.saveAt = std::strtoull(arguments[++i], nullptr, 10);
    } else if (argument == "--ticks" && i + 1 < argumentCount) {
      options.ticks = std::strtoull(arguments[++i], nullptr, 10);
    } else if (argument == "--kernel" && i + 1 < argumentCount) {
      ++i;
      if (!samestep::findKernel(arguments[i], options.kernel)) samestep::stop(arguments[i], "no such kernel");
      if (!samestep::isAvailable(options.kernel)) samestep::stop(arguments[i], "not on this machine");
    } else if (argument == "--workers" && i + 1 < argumentCount) {
      options.workers = static_cast<int>(std::strtol(arguments[++i], nullptr, 10));
    } else if (argument.starts_with("--")) {
      samestep::stop(arguments[i], "unknown option");
    } else {
      samestep::runFile(arguments[i], options);
    }
  }
  std::puts("end");
  return 0;
}
