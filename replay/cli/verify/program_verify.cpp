// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>

#include <samestep/verify.h>
#include <samestep/version.h>
#include <samestep/workers.h>

#include <unistd.h>

#include "cli/program.h"
#include "cli/verify/other_verifiers.h"
#include "cli/verify/verdict_file.h"
#include "cli/verify/verdict_line.h"
#include "cli/verify/verify_batch.h"

namespace samestep::program {
namespace {

/// Words of a server that tell the match it knows, as they stand in the arguments.
struct ExpectedWords {
  std::string firstHash;
  std::string timeStep;
  std::string scalar;
  std::vector<std::string> commands;
  std::uint64_t ticks = 0;
  std::uint64_t firstTick = 0;
};

bool readHash(const std::string& text, std::uint64_t& hash) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  return text.size() == 16 && error == std::errc() && end == text.data() + text.size();
}

/// "1/60".
bool readTimeStep(const std::string& text, std::uint32_t& rate) {
  if (!text.starts_with("1/")) return false;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), rate);
  return error == std::errc() && end == text.data() + text.size() && rate > 0 && rate <= 1000000;
}

std::vector<std::string> commandWords() {
  std::vector<std::string> words{"none"};
  for (std::uint8_t kind = 0; kind < kCommandKinds; ++kind) {
    words.emplace_back(commandName(static_cast<CommandKind>(kind)));
  }
  return words;
}

Expectations expectationsOf(const CLI::App& word, const ExpectedWords& words) {
  Expectations expected;
  std::uint64_t hash = 0;
  std::uint32_t rate = 0;
  if (readHash(words.firstHash, hash)) expected.firstHash = hash;
  if (readTimeStep(words.timeStep, rate)) expected.stepsPerSecond = rate;
  if (!words.scalar.empty()) {
    expected.scalar = words.scalar == "fixed" ? ScalarKind::fixed : ScalarKind::float64;
  }
  if (word.count("--ticks") > 0) expected.ticks = words.ticks;
  if (word.count("--first-tick") > 0) expected.firstTick = words.firstTick;
  if (words.commands.empty()) return expected;
  expected.commands = 0;
  for (std::uint8_t kind = 0; kind < kCommandKinds; ++kind) {
    const std::string name = commandName(static_cast<CommandKind>(kind));
    const bool allowed =
        std::find(words.commands.begin(), words.commands.end(), name) != words.commands.end();
    if (allowed) expected.commands |= 1u << kind;
  }
  return expected;
}

/// Adds the options of expectations.
void addExpectations(CLI::App& word, ExpectedWords& words) {
  const auto hashes = [](const std::string& text) {
    std::uint64_t hash = 0;
    return readHash(text, hash) ? std::string() : "16 hexadecimal digits are wanted, not " + text;
  };
  const auto steps = [](const std::string& text) {
    std::uint32_t rate = 0;
    return readTimeStep(text, rate) ? std::string() : "1/60 or the like is wanted, not " + text;
  };
  word.add_option("--expect-first-hash", words.firstHash, "The hash that the world must have at the start")
      ->check(CLI::Validator(hashes, "HASH"));
  word.add_option("--time-step", words.timeStep, "How long each step must be, in seconds, as 1/60")
      ->check(CLI::Validator(steps, "1/N"));
  word.add_option("--scalar", words.scalar, "The number type that it must be recorded with")
      ->check(CLI::IsMember({"fixed", "double"}));
  word.add_option("--ticks", words.ticks, "How many steps it must have")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
  word.add_option("--first-tick", words.firstTick, "How many steps the world must have made at the start");
  word.add_option("--allow-commands", words.commands, "The kinds of command there may be, or none")
      ->delimiter(',')
      ->check(CLI::IsMember(commandWords()));
}

}  // namespace

namespace {

/// Files to verify, and who verifies them.
struct Batch {
  std::vector<std::string> arguments;
  Crew crew;
  std::string shard;
  std::string output;
  std::uint32_t files = 100;  ///< Number of files, of a hundred.
  std::uint64_t seed = 0;
  std::string with;
  bool telling = false;
};

/// "3/8": shard and count.
bool readShard(const std::string& text, std::uint64_t& shard, std::uint64_t& count) {
  constexpr std::uint64_t kMostShards = 1000000;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard);
  if (error != std::errc() || slash == end || *slash != '/') return false;
  const auto [last, wrong] = std::from_chars(slash + 1, end, count);
  return wrong == std::errc() && last == end && shard >= 1 && shard <= count && count <= kMostShards;
}

/// Counts verdicts, and says what they were of several files.
class Summary {
 public:
  explicit Summary(const std::vector<Job>& jobs) : files_(jobs.size()) {
    for (const Job& job : jobs) work_ += job.work;
  }

  void add(const Job& job, const Said& said) {
    ++counts_[static_cast<std::size_t>(said.verdict)];
    ticks_ += said.ticks;
    code_ = std::max(code_, exitCodeOf(said.verdict));
    done_ += job.work;
    ++told_;
  }
  /// A verdict that an earlier run came to.
  void addFound(const Job& job, Verdict verdict) {
    ++counts_[static_cast<std::size_t>(verdict)];
    code_ = std::max(code_, exitCodeOf(verdict));
    work_ -= job.work;
    ++told_;
    ++found_;
  }
  int code() const { return code_; }
  /// The time left is that of the work left, as the work done took.
  std::string progress() const {
    const std::uint64_t took = since();
    const double perWork = static_cast<double>(took) / static_cast<double>(std::max<std::uint64_t>(done_, 1));
    const auto left = static_cast<std::uint64_t>(perWork * static_cast<double>(work_ - done_) / 1000);
    return "verify: " + std::to_string(told_) + " of " + std::to_string(files_) + " files, " +
           std::to_string((told_ - found_) * 1000 / took) + " a second, " +
           std::to_string(ticks_ * 1000 / took) + " ticks a second, " + std::to_string(left) + " s left";
  }
  std::string text() const {
    const std::uint64_t took = since();
    std::string line = std::to_string(told_) + (told_ == 1 ? " file" : " files");
    const char* before = ": ";
    for (std::size_t i = 0; i < std::size(counts_); ++i) {
      if (counts_[i] == 0) continue;
      line += before + std::to_string(counts_[i]) + " " + verdictName(static_cast<Verdict>(i));
      before = ", ";
    }
    if (found_ > 0) line += "; " + std::to_string(found_) + " verdicts were there";
    return line + "; " + std::to_string(ticks_) + " ticks in " + std::to_string(took) + " ms (" +
           std::to_string(ticks_ * 1000 / took) + " ticks/s)\n";
  }

 private:
  std::uint64_t since() const {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(milliseconds() - start_, 1));
  }

  std::size_t files_;
  std::int64_t start_ = milliseconds();
  std::size_t told_ = 0;
  std::size_t found_ = 0;
  std::uint64_t counts_[kVerdicts] = {};
  std::uint64_t ticks_ = 0;
  std::uint64_t work_ = 0;
  std::uint64_t done_ = 0;
  int code_ = kGood;
};

/// Shows how far a batch is: on a terminal as it goes, else where it is asked for, a line now and then.
class BatchProgress {
 public:
  explicit BatchProgress(bool shown, bool asked)
      : terminal_(isatty(STDERR_FILENO) == 1), shown_(asked || (shown && terminal_)) {}

  void clear() { status_.clear(); }
  void show(const Summary& summary) {
    if (!shown_ || milliseconds() < next_) return;
    next_ = milliseconds() + (terminal_ ? 100 : 10000);
    status_.show(summary.progress());
  }

 private:
  bool terminal_;
  bool shown_;
  std::int64_t next_ = 0;
  StatusLine status_;
};

std::vector<Job> jobsFor(const Batch& batch) {
  std::vector<std::string> files = filesNamed(batch.arguments);
  if (files.empty()) throw Unusable("there are no files to verify");
  if (batch.files < 100) files = sampleOf(files, batch.files, batch.seed);
  const std::vector<Job> jobs = jobsOf(files);
  std::uint64_t shard = 1;
  std::uint64_t count = 1;
  if (!readShard(batch.shard, shard, count)) return jobs;
  return shardsOf(jobs, count)[static_cast<std::size_t>(shard - 1)];
}

/// Takes out the jobs whose verdicts an earlier run left in the file of verdicts, which holds those alone
/// from then on.
std::vector<Job> withoutFound(const std::vector<Job>& jobs, const VerifyPlan& plan,
                              const OtherVerifiers& others, VerdictFile& verdicts, Summary& summary) {
  if (verdicts.isEmpty()) return jobs;
  std::vector<Job> left;
  const std::uint64_t asked = askedOf(plan.options);
  for (const Job& job : jobs) {
    const std::uint32_t other = others.revisionFor(job.file);
    const std::uint64_t content = contentOf(job.file, plan.options.limits.bytes);
    const std::string line =
        verdicts.found(job.file, content, asked, other == 0 ? kSimulationRevision : other);
    if (line.empty()) {
      left.push_back(job);
      continue;
    }
    verdicts.add(line);
    summary.addFound(job, verdictNamed(readVerdictLine(line)->verdict));
  }
  return left;
}

/// Has each job verified, by the program of its revision where there is one.
void verifyEach(const std::vector<Job>& jobs, const Batch& batch, const VerifyPlan& plan,
                const OtherVerifiers& others, const std::function<void(const Job&, const Said&)>& tell) {
  std::map<std::uint32_t, std::vector<Job>> byRevision;
  for (const Job& job : jobs) byRevision[others.revisionFor(job.file)].push_back(job);
  for (const auto& [revision, some] : byRevision) {
    std::vector<std::string> files;
    for (const Job& job : some) files.push_back(job.file);
    const auto tellPlace = [&, &some = some](std::size_t place, const Said& said) {
      tell(some[place], said);
    };
    if (revision == 0) {
      verifyAll(files, plan, batch.crew, tellPlace);
    } else {
      others.verify(revision, files, plan, tellPlace);
    }
  }
}

int runBatch(const Batch& batch, const VerifyPlan& plan, const OtherVerifiers& others) {
  std::vector<Job> jobs = jobsFor(batch);
  Summary summary(jobs);
  const bool several = jobs.size() != 1 || !batch.shard.empty() || batch.files < 100;
  std::unique_ptr<VerdictFile> verdicts;
  if (!batch.output.empty()) {
    verdicts = std::make_unique<VerdictFile>(batch.output);
    jobs = withoutFound(jobs, plan, others, *verdicts, summary);
  }
  BatchProgress progress(jobs.size() > 1, batch.telling);
  verifyEach(jobs, batch, plan, others, [&](const Job& job, const Said& said) {
    progress.clear();
    if (verdicts) {
      verdicts->add(said.out);
    } else {
      std::fputs(said.out.c_str(), stdout);
      // A batch that is killed keeps the verdicts it has come to, each in a line that is whole.
      std::fflush(stdout);
    }
    std::fputs(said.error.c_str(), stderr);
    summary.add(job, said);
    progress.show(summary);
  });
  progress.clear();
  if (verdicts) verdicts->finish();
  if (several) std::fputs(summary.text().c_str(), plan.json ? stderr : stdout);
  return summary.code();
}

/// Words of the command line that another revision's program is given, too: all options but those about the
/// files themselves, about how it is told, and about what only this program is given.
std::vector<std::string> optionsForOthers(const CLI::App& word) {
  constexpr std::string_view kOwn[] = {"--shard", "--output", "--progress", "--sample-files",
                                       "--json",  "--with",   "--game",     "--help"};
  std::vector<std::string> words;
  for (const CLI::Option* option : word.get_options()) {
    const std::string name = option->get_lnames().empty() ? "" : "--" + option->get_lnames().front();
    const bool own = std::find(std::begin(kOwn), std::end(kOwn), name) != std::end(kOwn);
    if (name.empty() || own || option->count() == 0) continue;
    words.push_back(name);
    if (option->get_expected_max() == 0) continue;
    words.push_back(CLI::detail::join(option->results(), ","));
  }
  return words;
}

void addBatch(CLI::App& word, Batch& batch, VerifyPlan& plan) {
  word.add_option(
          "FILE|DIR|-", batch.arguments,
          "Recordings, as 'samestep record' or a game wrote them, folders of them, or - for a list of "
          "files on the standard input")
      ->required();
  word.add_option("--jobs", batch.crew.jobs,
                  "How many processes verify files, one each at a time, without network or writing; if it is "
                  "not given, the program does so by itself")
      ->check(CLI::Range(1, 1024));
  const auto shards = [](const std::string& text) {
    std::uint64_t shard = 0;
    std::uint64_t count = 0;
    return readShard(text, shard, count) ? std::string() : "1/8 or the like is wanted, not " + text;
  };
  word.add_option(
          "--shard", batch.shard,
          "I/N: only the I-th of N parts of the files, which are of about the same work and the same on "
          "every machine that has the files")
      ->check(CLI::Validator(shards, "I/N"));
  word.add_option("--max-memory,--limit-memory", batch.crew.megabytes,
                  "Megabytes of memory that a file may take, by a process")
      ->check(CLI::Range(std::uint64_t{16}, std::uint64_t{1} << 24));
  word.add_flag("--json", plan.json, "Say what is to be said in JSON, a line for each file");
  word.add_option("-o,--output", batch.output,
                  "Write the lines of --json to this file, which is whole or not there; a run that was ended "
                  "goes on where it was")
      ->needs("--json");
  word.add_flag("--progress", batch.telling, "Say how far it is where there is no terminal, too");
  word.add_option("--sample", plan.options.sample,
                  "Replay only so many of 100 stretches between keyframes of each recording, one at least")
      ->check(CLI::Range(1u, 100u));
  word.add_option("--sample-files", batch.files, "Verify only so many of 100 files")
      ->check(CLI::Range(1u, 100u));
  word.add_option("--seed", batch.seed, "What samples are drawn by; keep it from those who send recordings");
  word.add_option("--with", batch.with,
                  "A folder of programs samestep-REVISION, which judge the recordings of other revisions")
      ->check(CLI::ExistingDirectory);
  word.add_flag("--to-the-end", plan.options.toTheEnd, "Go on after a mismatch, to see whether it heals");
}

void addLimits(CLI::App& word, RecordingLimits& limits, std::int64_t& seconds) {
  word.add_option("--max-bodies,--limit-bodies", limits.bodies,
                  "Refuse recordings of worlds with more bodies")
      ->capture_default_str();
  word.add_option("--max-shapes,--limit-shapes", limits.shapes, "Refuse those with more shapes")
      ->capture_default_str();
  word.add_option("--max-pairs,--limit-pairs", limits.pairs, "Refuse those with more shapes near each other")
      ->check(CLI::Range(std::uint32_t{0}, kMostPairs))
      ->capture_default_str();
  word.add_option("--max-handlers,--limit-handlers", limits.handlers,
                  "Refuse those with more collision handlers bound")
      ->capture_default_str();
  word.add_option("--max-joints,--limit-joints", limits.joints, "Refuse those with more joints")
      ->capture_default_str();
  word.add_option("--max-iterations,--limit-iterations", limits.iterations,
                  "Refuse those whose steps solve contacts more often, by sequential impulses")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  word.add_option("--max-substeps,--limit-substeps", limits.substeps,
                  "Refuse those whose steps have more substeps")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  word.add_option("--max-commands,--limit-commands", limits.commandsPerTick,
                  "Refuse those with more commands before a step")
      ->capture_default_str();
  word.add_option("--max-bytes,--limit-bytes", limits.bytes,
                  "Refuse files that are larger; no more of them is read")
      ->capture_default_str();
  word.add_option("--max-work,--limit-work", limits.work,
                  "Refuse those that take more work, in units of about 10 ns: the same on every machine")
      ->check(CLI::Range(std::uint64_t{1}, ~std::uint64_t{0}));
  word.add_option("--max-seconds,--limit-seconds", seconds, "Give up after so many seconds for a recording")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 30));
}

}  // namespace

void addVerify(CLI::App& app, Wirings& wirings, int& result) {
  CLI::App* word = app.add_subcommand(
      "verify", "Replay recordings and check that every tick comes out as it was recorded");
  auto batch = std::make_shared<Batch>();
  auto plan = std::make_shared<VerifyPlan>();
  plan->wirings = &wirings;
  addBatch(*word, *batch, *plan);
  auto compute = std::make_shared<ComputeOptions>();
  addComputeOptions(*word, *compute);
  auto expected = std::make_shared<ExpectedWords>();
  addExpectations(*word, *expected);
  // These are for recordings from strangers.
  addLimits(*word, plan->options.limits, plan->seconds);
  addGameOption(*word, wirings);
  word->callback([batch, plan, compute, expected, word, &result] {
    plan->options.kernel = compute->target();
    plan->options.expected = expectationsOf(*word, *expected);
    WorkerPool pool(compute->workers);
    plan->options.workers = &pool;
    Crew& crew = batch->crew;
    crew.apart = word->count("--jobs") > 0 || !batch->output.empty();
    crew.inOrder = batch->output.empty();
    if ((crew.apart || crew.megabytes > 0) && compute->workers > 1) {
      throw Unusable("--workers share out a step, processes (--jobs, --max-memory, -o) files: one at a time");
    }
    plan->options.sampleSeed = batch->seed;
    result = runBatch(*batch, *plan, OtherVerifiers(batch->with, optionsForOthers(*word)));
  });
}

}  // namespace samestep::program
