// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "cli/program.h"
#include "cli/verify/verdict_line.h"
#include "cli/verify/verify_batch.h"

namespace samestep::program {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> verdicts;
  std::vector<std::string> wanted;
  std::string output;
  std::string missing;
};

/// Files of verdicts, those in folders with their parts.
std::vector<std::string> verdictFiles(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    std::error_code error;
    if (!fs::is_directory(argument, error)) {
      files.push_back(argument);
      continue;
    }
    std::vector<std::string> inside;
    for (const auto& entry : fs::recursive_directory_iterator(argument, error)) {
      const std::string name = entry.path().filename().string();
      const bool named =
          name.ends_with(".jsonl") || (name.ends_with(".part") && name.find(".jsonl.") != std::string::npos);
      if (named && entry.is_regular_file(error)) inside.push_back(entry.path().string());
    }
    std::stable_sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

/// The files that should have verdicts: recordings, those in folders, and those that lists name by lines.
std::set<std::string> wantedFiles(const std::vector<std::string>& arguments) {
  std::set<std::string> wanted;
  for (const std::string& argument : arguments) {
    std::error_code error;
    if (argument == "-" || fs::is_directory(argument, error) || looksLikeRecording(argument)) {
      for (std::string& file : filesNamed({argument})) wanted.insert(std::move(file));
      continue;
    }
    std::ifstream stream(argument, std::ios::binary);
    if (!stream) throw Unusable(argument + ": cannot be read");
    for (std::string line; std::getline(stream, line);) {
      if (!line.empty()) wanted.insert(line);
    }
  }
  return wanted;
}

/// Verdicts of many runs: of each file under each question one.
class Merger {
 public:
  void read(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw Unusable(path + ": cannot be read");
    for (std::string line; std::getline(stream, line);) {
      const bool cut = stream.eof();
      const auto verdict = cut ? std::nullopt : readVerdictLine(line);
      if (!verdict) {
        ++torn_;
      } else {
        add(*verdict, line + "\n");
      }
    }
  }

  std::string lines() const {
    std::string all;
    for (const auto& [key, entry] : kept_) all += entry.line;
    return all;
  }
  std::vector<std::string> missing(const std::set<std::string>& wanted) const {
    std::set<std::string> settled;
    for (const auto& [key, entry] : kept_) {
      if (entry.verdict.settled) settled.insert(entry.verdict.file);
    }
    std::vector<std::string> left;
    std::set_difference(wanted.begin(), wanted.end(), settled.begin(), settled.end(),
                        std::back_inserter(left));
    return left;
  }
  /// Says what two runs disagree about.
  bool tellConflicts() const {
    for (const std::string& words : conflicts_) std::fprintf(stderr, "samestep: %s\n", words.c_str());
    return !conflicts_.empty();
  }
  std::string summary() const {
    std::map<std::string, std::uint64_t> counts;
    std::uint64_t ticks = 0, milliseconds = 0, unsettled = 0;
    for (const auto& [key, entry] : kept_) {
      ++counts[entry.verdict.verdict];
      ticks += entry.verdict.ticks;
      milliseconds += entry.verdict.milliseconds;
      if (!entry.verdict.settled) ++unsettled;
    }
    std::string text = std::to_string(kept_.size()) + " verdicts";
    const char* before = ": ";
    for (const auto& [name, count] : counts) {
      text += before + std::to_string(count) + " " + printable(name);
      before = ", ";
    }
    text += "; " + std::to_string(doubles_) + " doubles, " + std::to_string(torn_) +
            " lines that were cut, " + std::to_string(unsettled) + " for want of time or memory; " +
            std::to_string(ticks) + " ticks in " + std::to_string(milliseconds) + " ms of a core";
    if (milliseconds > 0) text += " (" + std::to_string(ticks * 1000 / milliseconds) + " ticks/s)";
    return text;
  }

 private:
  struct Entry {
    VerdictLine verdict;
    std::string line;
  };
  using Question = std::tuple<std::string, std::uint64_t, std::string>;

  void add(const VerdictLine& verdict, const std::string& line) {
    const Question question = verdict.question();
    compare(question, verdict);
    const auto [place, isNew] = kept_.try_emplace({verdict.file, question}, Entry{verdict, line});
    if (isNew) return;
    ++doubles_;
    if (!place->second.verdict.settled && verdict.settled) place->second = {verdict, line};
  }
  /// Bytes that are the same have one verdict, whatever the file is called and whoever verified it.
  void compare(const Question& question, const VerdictLine& verdict) {
    if (!verdict.settled || verdict.content == std::string(16, '0')) return;
    const auto [place, isNew] = verdicts_.try_emplace(question, verdict.verdict);
    if (isNew || place->second == verdict.verdict) return;
    conflicts_.push_back(printable(verdict.file) + ": content " + verdict.content + " is " +
                         printable(place->second) + " by one run and " + printable(verdict.verdict) +
                         " by another");
  }

  std::map<std::pair<std::string, Question>, Entry> kept_;
  std::map<Question, std::string> verdicts_;
  std::vector<std::string> conflicts_;
  std::uint64_t doubles_ = 0;
  std::uint64_t torn_ = 0;
};

int merge(const Options& options) {
  if (!options.output.empty()) checkWritable(options.output);
  if (!options.missing.empty()) checkWritable(options.missing);
  const std::set<std::string> wanted = wantedFiles(options.wanted);
  Merger merger;
  for (const std::string& file : verdictFiles(options.verdicts)) merger.read(file);
  if (options.output.empty()) {
    std::fputs(merger.lines().c_str(), stdout);
  } else {
    writeFile(options.output, merger.lines());
  }
  std::string left;
  const std::vector<std::string> missing = merger.missing(wanted);
  for (const std::string& file : missing) left += file + "\n";
  if (!options.missing.empty()) writeFile(options.missing, left);
  std::string words = merger.summary();
  if (!wanted.empty()) {
    words +=
        "; " + std::to_string(missing.size()) + " of " + std::to_string(wanted.size()) + " files are missing";
    if (options.missing.empty()) std::fputs(left.c_str(), stderr);
  }
  std::fprintf(stderr, "%s\n", words.c_str());
  return merger.tellConflicts() || !missing.empty() ? kMismatch : kGood;
}

}  // namespace

void addMerge(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "merge",
      "Put the lines of many runs of 'verify --json' together, each verdict once; list what is missing");
  auto options = std::make_shared<Options>();
  word->add_option("FILE|DIR", options->verdicts,
                   "Files of such lines, or folders of *.jsonl and their parts")
      ->required();
  word->add_option(
          "--wanted", options->wanted,
          "What should be there: folders of recordings, lists of files, recordings, or - for a list on "
          "the standard input")
      ->allow_extra_args(true);
  word->add_option("-o,--output", options->output,
                   "Where to write the lines, by file; else the standard output");
  word->add_option(
      "--missing", options->missing,
      "Where to list the wanted files without a verdict, or without one that more time or memory "
      "would not change; else the error output");
  word->callback([options, &result] { result = merge(*options); });
}

}  // namespace samestep::program
