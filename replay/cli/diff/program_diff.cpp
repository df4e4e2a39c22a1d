// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include <samestep/hash_tree.h>
#include <samestep/replay_diff.h>

#include "cli/diff/diff_tree.h"
#include "cli/program.h"

namespace samestep::program {
namespace {

struct Options {
  std::string a;
  std::string b;
  std::string answers;
  std::uint32_t most = 5;
  std::uint32_t context = 0;
  bool json = false;
};

unsigned long long shown(std::uint64_t number) { return number; }

/// Reads a recording; says on the error output what is wrong with its first bytes.
bool read(const std::string& file, std::vector<std::uint8_t>& bytes) {
  try {
    bytes = readRecording(file);
    return true;
  } catch (const FormatError& error) {
    tell(file, error);
    return false;
  }
}

/// True if a whole recording can be used; which of the two is at fault is told here.
template <Scalar S>
bool usable(const std::string& file, std::span<const std::uint8_t> bytes, std::uint64_t& ticks) {
  try {
    ticks = RecordingReader<S>(bytes).ticks();
    return true;
  } catch (const FormatError& error) {
    tell(file, error);
    return false;
  }
}

void reportCommands(const ReplayDifference& difference) {
  if (difference.commandTick == 0) {
    std::printf("what was done to them is the same up to here\n");
    return;
  }
  std::printf("what was done to them differs first at tick %llu:\n", shown(difference.commandTick));
  for (const std::string& words : difference.onlyA) std::printf("  only A: %s\n", words.c_str());
  for (const std::string& words : difference.onlyB) std::printf("  only B: %s\n", words.c_str());
  if (difference.onlyA.empty() && difference.onlyB.empty()) std::printf("  the same in another order\n");
}

void reportWorlds(const ReplayDifference& difference) {
  if (difference.stage == "start") {
    std::printf("the worlds differ from the start, first in\n");
  } else if (difference.stage == "commands") {
    std::printf("the worlds differ at tick %llu, before its step, first in\n", shown(difference.tick));
  } else {
    std::printf("the worlds differ at tick %llu, in the stage \"%s\", first in\n", shown(difference.tick),
                difference.stage.c_str());
  }
  for (const FieldDifference& field : difference.fields) {
    std::printf("  %s, %s\n    A: %s\n    B: %s\n", field.object.c_str(), field.field.c_str(),
                field.a.c_str(), field.b.c_str());
  }
}

std::string jsonQuoted(const std::string& text) { return nlohmann::json(printable(text)).dump(); }

std::string listOf(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ",") + jsonQuoted(word);
  return "[" + list + "]";
}

void reportJson(const ReplayDifference& difference, std::uint64_t ticksA, std::uint64_t ticksB) {
  const bool same = !difference.worldsDiffer && ticksA == ticksB;
  std::string line = std::string("{\"same\":") + (same ? "true" : "false") +
                     ",\"ticksA\":" + std::to_string(ticksA) + ",\"ticksB\":" + std::to_string(ticksB) +
                     ",\"tick\":" + std::to_string(difference.tick);
  if (difference.worldsDiffer) line += ",\"stage\":" + jsonQuoted(difference.stage);
  line += ",\"fields\":[";
  for (const FieldDifference& field : difference.fields) {
    line += std::string(line.back() == '[' ? "" : ",") + "{\"object\":" + jsonQuoted(field.object) +
            ",\"field\":" + jsonQuoted(field.field) + ",\"a\":" + jsonQuoted(field.a) +
            ",\"b\":" + jsonQuoted(field.b) + "}";
  }
  line += "]";
  if (difference.commandTick > 0) {
    line += ",\"commandTick\":" + std::to_string(difference.commandTick) +
            ",\"onlyA\":" + listOf(difference.onlyA) + ",\"onlyB\":" + listOf(difference.onlyB);
  }
  std::printf("%s}\n", line.c_str());
}

/// Tells what was done in the ticks before, and the values of the object that differs first after each of
/// them.
template <Scalar S>
void reportContext(const Options& options, const Wirings& wirings, std::span<const std::uint8_t> bytes,
                   const char* side, const ReplayDifference& difference) {
  Replay<S> replay(bytes, wiringOf<S>(wirings));
  const std::uint64_t from = difference.tick - std::min<std::uint64_t>(difference.tick, options.context);
  replay.seek(from);
  const std::string object = difference.fields.empty() ? std::string() : difference.fields.front().object;
  while (true) {
    std::printf("%s after tick %llu\n", side, shown(replay.tick()));
    for (const WorldValue& value : valuesOf(replay.space().state())) {
      if (value.object == object) {
        std::printf("    %s, %s: %s\n", value.object.c_str(), value.field.c_str(), value.value.c_str());
      }
    }
    if (replay.tick() >= difference.tick || !replay.applyCommands()) return;
    replay.eachCommand([](const Command<S>& command, std::span<const std::uint8_t>) {
      std::printf("  %s\n", describe(command).c_str());
    });
    replay.step();
  }
}

template <Scalar S>
int run(const Options& options, const Wirings& wirings, std::span<const std::uint8_t> a,
        std::span<const std::uint8_t> b) {
  std::uint64_t ticksA = 0;
  std::uint64_t ticksB = 0;
  if (!usable<S>(options.a, a, ticksA) || !usable<S>(options.b, b, ticksB)) return kUnusable;
  Progress progress("diff", 0);
  VerifyOptions how;
  how.data = &progress;
  how.progress = [](std::uint64_t done, std::uint64_t total, void* data) {
    static_cast<Progress*>(data)->at(done, total);
    return true;
  };
  const ReplayDifference difference = findDifference<S>(a, b, wiringOf<S>(wirings), options.most, how);
  progress.clear();
  if (options.json) {
    reportJson(difference, ticksA, ticksB);
    return difference.worldsDiffer || ticksA != ticksB ? kMismatch : kGood;
  }
  if (difference.worldsDiffer) {
    reportWorlds(difference);
    if (difference.stage != "start") reportCommands(difference);
    if (options.context > 0) {
      reportContext<S>(options, wirings, a, "A", difference);
      reportContext<S>(options, wirings, b, "B", difference);
    }
    return kMismatch;
  }
  std::printf("the worlds are the same for %llu ticks\n", shown(difference.tick));
  reportCommands(difference);
  if (ticksA == ticksB) return kGood;
  std::printf("but A has %llu ticks and B has %llu\n", shown(ticksA), shown(ticksB));
  return kMismatch;
}

/// Names of the nodes on the way to one, the root left out.
std::string placeOf(HashTree& tree, const TreePath& path) {
  std::string place;
  for (std::size_t level = 1; level <= path.size(); ++level) {
    const TreePath upper(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(level));
    place += (place.empty() ? "" : ", ") + printable(tree.name(upper));
  }
  return place;
}

/// By hashes alone, with the side that a command answers for.
int diffByAnswers(const Options& options, const Wirings& wirings, std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<HashTree> ours = treeOf(bytes, wirings);
  AnsweredTree theirs(options.answers);
  const auto difference = firstDifference(*ours, theirs);
  if (!difference) {
    std::printf("the two are the same, by every hash\n");
    return kGood;
  }
  const TreePath& path = difference->path;
  std::string place = placeOf(*ours, path);
  if (difference->onlyInOne && ours->name(path).empty()) place = placeOf(theirs, path);
  const std::string a = ours->value(path);
  const std::string b = printable(theirs.value(path));
  if (options.json) {
    std::printf("{\"same\":false,\"place\":%s,\"onlyInOne\":%s,\"a\":%s,\"b\":%s,\"questions\":%u}\n",
                jsonQuoted(place).c_str(), difference->onlyInOne ? "true" : "false", jsonQuoted(a).c_str(),
                jsonQuoted(b).c_str(), static_cast<unsigned>(difference->questions));
    return kMismatch;
  }
  std::printf("they differ first in %s%s, found by %u questions\n", place.c_str(),
              difference->onlyInOne ? ", which only one has" : "",
              static_cast<unsigned>(difference->questions));
  if (path.size() == 1 && !difference->onlyInOne) {
    std::printf(
        "the recorded hashes differ there, the worlds computed do not: one was made by another build\n");
  }
  if (!a.empty() || !b.empty()) std::printf("    A: %s\n    B: %s\n", a.c_str(), b.c_str());
  return kMismatch;
}

int diff(const Options& options, const Wirings& wirings) {
  std::vector<std::uint8_t> a;
  std::vector<std::uint8_t> b;
  if (options.b.empty() == options.answers.empty()) {
    throw Unusable("diff: another recording is wanted, or --answers");
  }
  if (!options.answers.empty()) return read(options.a, a) ? diffByAnswers(options, wirings, a) : kUnusable;
  if (!read(options.a, a) || !read(options.b, b)) return kUnusable;
  const ScalarKind scalar = recordingInfo(a).scalar;
  if (scalar != recordingInfo(b).scalar) {
    std::printf("one is recorded with fixed, the other with double\n");
    return kMismatch;
  }
  return withScalarOf(scalar, [&](auto number) { return run<decltype(number)>(options, wirings, a, b); });
}

}  // namespace

void addDiff(CLI::App& app, Wirings& wirings, int& result) {
  CLI::App* word = app.add_subcommand(
      "diff", "Replay two recordings and find the first tick, object and field in which their worlds differ");
  auto options = std::make_shared<Options>();
  word->add_option("A", options->a, "A recording")->required();
  word->add_option("B", options->b, "Another one");
  word->add_option(
      "--answers", options->answers,
      "In place of B a command that answers for it, such as 'ssh HOST samestep answer B': only hashes "
      "are exchanged, about as many as the logarithm of what there is");
  word->add_option("--context", options->context,
                   "Also tell what was done in so many ticks before, and the object that differs after each")
      ->check(CLI::Range(1u, 1000u));
  word->add_flag("--json", options->json, "Say it as a line of JSON");
  word->add_option("--fields", options->most, "How many differing fields to show")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  addGameOption(*word, wirings);
  word->callback([options, &wirings, &result] { result = diff(*options, wirings); });
}

void addAnswer(CLI::App& app, Wirings& wirings, int& result) {
  CLI::App* word = app.add_subcommand(
      "answer", "Answer the questions of a 'samestep diff --answers' about a recording, a line each");
  auto file = std::make_shared<std::string>();
  word->add_option("FILE", *file, "A recording")->required();
  addGameOption(*word, wirings);
  word->callback([file, &wirings, &result] {
    std::vector<std::uint8_t> bytes;
    if (!read(*file, bytes)) {
      result = kUnusable;
      return;
    }
    const std::unique_ptr<HashTree> tree = treeOf(bytes, wirings);
    answerQuestions(*tree, stdin, stdout);
  });
}

}  // namespace samestep::program
