// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include <samestep/decimal.h>
#include <samestep/player.h>
#include <samestep/version.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

constexpr std::size_t kMostClaims = 1000;

unsigned long long shown(std::uint64_t number) { return number; }

std::string printableBytes(std::span<const std::uint8_t> bytes) {
  return printable(std::string(bytes.begin(), bytes.end()));
}

/// Bytes of the recording by what they are for.
struct Sizes {
  std::uint64_t commands = 0;
  std::uint64_t commandBytes = 0;
  std::uint64_t stepBytes = 0;
};

template <Scalar S>
Sizes sizesOf(RecordingReader<S>& reader) {
  Sizes sizes;
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    const std::uint64_t bytes = reader.nextAt() - reader.itemAt();
    if (item == RecordingItem::step) sizes.stepBytes += bytes;
    if (item != RecordingItem::command) continue;
    ++sizes.commands;
    sizes.commandBytes += bytes;
  }
  return sizes;
}

template <Scalar S>
void tellWorld(const RecordingReader<S>& reader) {
  const WorldState<S>& world = reader.initialWorld();
  std::printf("starts after %llu ticks, with hash %s and room for %llu bodies and %llu shapes\n",
              shown(world.stamp), hex(reader.initialHash()).c_str(), shown(world.bodies.slots()),
              shown(world.shapes.slots()));
}

void tellKeyframes(std::span<const Keyframe> keyframes, bool all) {
  std::uint64_t bytes = 0;
  for (const Keyframe& keyframe : keyframes) bytes += keyframe.bytes;
  std::printf("keyframes: %llu, %llu bytes", shown(keyframes.size()), shown(bytes));
  if (keyframes.size() > 1) std::printf(", the last at tick %llu", shown(keyframes.back().tick));
  std::printf("\n");
  for (const Keyframe& keyframe : keyframes) {
    if (!all) break;
    std::printf("  tick %llu, hash %s, offset %llu, %llu bytes\n", shown(keyframe.tick),
                hex(keyframe.hash).c_str(), shown(keyframe.offset), shown(keyframe.bytes));
  }
}

template <Scalar S>
int tellAll(const std::string& file, std::span<const std::uint8_t> bytes, bool keyframes) {
  RecordingReader<S> reader(bytes, {}, {}, Ending::mayBeCut);
  const std::uint64_t ticks = reader.ticks();
  std::printf("%llu ticks of %s s%s\n", shown(ticks), formatDecimal(reader.timeStep()).c_str(),
              reader.isWhole() ? "" : ", and then it is cut");
  tellWorld(reader);
  const Sizes sizes = sizesOf(reader);
  std::printf("%llu bytes: %llu of ticks, %llu of %llu commands\n", shown(bytes.size()),
              shown(sizes.stepBytes), shown(sizes.commandBytes), shown(sizes.commands));
  tellKeyframes(reader.keyframes(), keyframes);
  for (const Note& note : reader.notes()) {
    std::printf("note %s: %s\n", printable(std::string(note.key)).c_str(),
                printable(std::string(note.value)).c_str());
  }
  for (const ClaimAt& claim : claimsOf(reader, kMostClaims)) {
    std::printf("claim after tick %llu: %s is %s\n", shown(claim.tick), printable(claim.key).c_str(),
                printableBytes(claim.value).c_str());
  }
  if (reader.claims() > kMostClaims) std::printf("%s: and more claims\n", file.c_str());
  return kGood;
}

int info(const std::string& file, bool keyframes) {
  try {
    const std::vector<std::uint8_t> bytes = readRecording(file);
    const RecordingInfo info = recordingInfo(bytes);
    std::printf("%s: recording, format version %u, simulation revision %u%s, %s\n", file.c_str(),
                static_cast<unsigned>(info.version), static_cast<unsigned>(info.revision),
                info.revision == kSimulationRevision ? "" : " (not this build's)",
                info.scalar == ScalarKind::fixed ? "fixed" : "double");
    return withScalarOf(info.scalar,
                        [&](auto scalar) { return tellAll<decltype(scalar)>(file, bytes, keyframes); });
  } catch (const FormatError& error) {
    tell(file, error);
    return kUnusable;
  }
}

}  // namespace

void addInfo(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand("info", "Tell what is in a recording, without replaying it");
  auto file = std::make_shared<std::string>();
  auto keyframes = std::make_shared<bool>(false);
  word->add_option("FILE", *file, "A recording")->required();
  word->add_flag("--keyframes", *keyframes, "List each keyframe");
  word->callback([file, keyframes, &result] { result = info(*file, *keyframes); });
}

}  // namespace samestep::program
