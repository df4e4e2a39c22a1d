// SPDX-License-Identifier: MIT
#include <samestep/replay_diff.h>

#include <algorithm>
#include <iterator>

#include "base/require_ieee.h"

namespace samestep {
namespace {

/// So many commands of a tick are told; of a recording made to harm there are millions.
constexpr std::size_t kMostCommandsTold = 1000;

using CommandBytes = std::span<const std::uint8_t>;

bool bytesLess(CommandBytes a, CommandBytes b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}
bool sameBytes(CommandBytes a, CommandBytes b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); }

/// The bytes of each command, sorted.
template <Scalar S>
std::vector<CommandBytes> sortedCommands(const Replay<S>& replay) {
  std::vector<CommandBytes> all;
  replay.eachCommand([&](const Command<S>&, CommandBytes bytes) { all.push_back(bytes); });
  std::sort(all.begin(), all.end(), bytesLess);  // total order: equal commands are alike
  return all;
}

/// In words, those of one side that the other lacks, in their order.
template <Scalar S>
std::vector<std::string> onlyIn(const Replay<S>& replay, const std::vector<CommandBytes>& own,
                                const std::vector<CommandBytes>& others) {
  std::vector<CommandBytes> missing;
  std::set_difference(own.begin(), own.end(), others.begin(), others.end(), std::back_inserter(missing),
                      bytesLess);
  std::vector<std::string> words;
  replay.eachCommand([&](const Command<S>& command, CommandBytes bytes) {
    const auto found = std::lower_bound(missing.begin(), missing.end(), bytes, bytesLess);
    if (found == missing.end() || !sameBytes(*found, bytes)) return;
    missing.erase(found);
    if (words.size() < kMostCommandsTold) words.push_back(describe(command));
  });
  return words;
}

template <Scalar S>
void noteCommands(const Replay<S>& a, const Replay<S>& b, ReplayDifference& difference) {
  if (difference.commandTick != 0 || sameBytes(a.commandBytes(), b.commandBytes())) return;
  difference.commandTick = a.tick() + 1;
  const std::vector<CommandBytes> ofA = sortedCommands(a);
  const std::vector<CommandBytes> ofB = sortedCommands(b);
  difference.onlyA = onlyIn(a, ofA, ofB);
  difference.onlyB = onlyIn(b, ofB, ofA);
}

/// The worlds at the end of each stage of one step.
template <Scalar S>
struct Stages {
  std::vector<Stage> stages;
  std::vector<WorldState<S>> worlds;

  static void observe(const Space<S>& space, Stage stage, void* data) {
    auto& self = *static_cast<Stages*>(data);
    self.stages.push_back(stage);
    self.worlds.push_back(space.state());
  }
};

/// Does the step again in which the worlds part, and looks at every stage of it.
template <Scalar S>
void localise(Replay<S>& a, Replay<S>& b, std::uint32_t most, ReplayDifference& difference) {
  while (a.tick() + 1 < difference.tick) {
    a.step();
    b.step();
  }
  a.applyCommands();
  b.applyCommands();
  difference.stage = "commands";
  difference.fields = differences(a.space().state(), b.space().state(), most);
  if (!difference.fields.empty()) return;

  Stages<S> stagesA, stagesB;
  a.space().setStageObserver(Stages<S>::observe, &stagesA);
  b.space().setStageObserver(Stages<S>::observe, &stagesB);
  a.step();
  b.step();
  for (std::uint32_t i = 0; i < stagesA.worlds.size() && difference.fields.empty(); ++i) {
    difference.stage = stageName(stagesA.stages[i]);
    difference.fields = differences(stagesA.worlds[i], stagesB.worlds[i], most);
  }
}

}  // namespace

template <Scalar S>
ReplayDifference findDifference(std::span<const std::uint8_t> bytesA, std::span<const std::uint8_t> bytesB,
                                const Wiring<S>& wiring, std::uint32_t mostFields,
                                const VerifyOptions& options) {
  ReplayDifference difference;
  Replay<S> a(bytesA, wiring, options.limits);
  Replay<S> b(bytesB, wiring, options.limits);
  if (a.space().hash() != b.space().hash()) {
    difference.worldsDiffer = true;
    difference.stage = "start";
    difference.fields = differences(a.space().state(), b.space().state(), mostFields);
    return difference;
  }
  const std::uint64_t common = min(a.ticks(), b.ticks());
  while (a.tick() < common) {
    a.applyCommands();
    b.applyCommands();
    noteCommands(a, b, difference);
    a.step();
    b.step();
    difference.tick = a.tick();
    if (options.progress != nullptr && !options.progress(a.tick(), common, options.data)) break;
    if (a.space().hash() == b.space().hash()) continue;
    difference.worldsDiffer = true;
    Replay<S> againA(bytesA, wiring, options.limits);
    Replay<S> againB(bytesB, wiring, options.limits);
    localise(againA, againB, mostFields, difference);
    break;
  }
  return difference;
}

#define SAMESTEP_EACH_SCALAR                                                                                \
  template ReplayDifference findDifference<S>(std::span<const std::uint8_t>, std::span<const std::uint8_t>, \
                                              const Wiring<S>&, std::uint32_t, const VerifyOptions&);
#include <samestep/each_scalar.h>

}  // namespace samestep
