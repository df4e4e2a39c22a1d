// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>

#include "cli/program.h"
#include "cli/verify/verify_batch.h"

namespace samestep::program {
namespace {

struct Options {
  std::vector<std::string> arguments;
  std::uint64_t shards = 0;
  std::string folder;
  std::uint32_t files = 100;
  std::uint64_t seed = 0;
};

std::uint64_t workOf(const std::vector<Job>& shard) {
  std::uint64_t work = 0;
  for (const Job& job : shard) work += job.work;
  return work;
}

/// Its files by lines, the greatest first.
std::string listOf(const std::vector<Job>& shard) {
  std::string list;
  for (const Job& job : shard) {
    if (job.file.find('\n') != std::string::npos) {
      throw Unusable(printable(job.file) + ": a name with an end of line fits in no list");
    }
    list += job.file + "\n";
  }
  return list;
}

int shards(const Options& options) {
  std::vector<std::string> files = filesNamed(options.arguments);
  if (options.files < 100) files = sampleOf(files, options.files, options.seed);
  if (files.empty()) throw Unusable("there are no files to share out");
  const std::vector<std::vector<Job>> all = shardsOf(jobsOf(files), options.shards);
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  std::uint64_t whole = 0;
  std::uint64_t most = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    writeFile(options.folder + "/" + std::to_string(i + 1) + ".list", listOf(all[i]));
    whole += workOf(all[i]);
    most = std::max(most, workOf(all[i]));
  }
  std::printf("%llu files in %llu shards, of which the greatest has %.1f %% of the work\n",
              static_cast<unsigned long long>(files.size()), static_cast<unsigned long long>(all.size()),
              100.0 * static_cast<double>(most) / static_cast<double>(whole));
  return kGood;
}

}  // namespace

void addShards(CLI::App& app, int& result) {
  CLI::App* word = app.add_subcommand(
      "shards", "Share recordings out: a list of files for each shard, of about the same work");
  auto options = std::make_shared<Options>();
  word->add_option("N", options->shards, "How many shards")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1000000}))
      ->required();
  word->add_option("FILE|DIR|-", options->arguments,
                   "Recordings, folders of them, or - for a list of files on the standard input")
      ->required();
  word->add_option("-o,--output", options->folder, "The folder to write 1.list, 2.list, ... to")->required();
  word->add_option("--sample-files", options->files, "Take only so many of 100 files")
      ->check(CLI::Range(1u, 100u));
  word->add_option("--seed", options->seed, "What the sample is drawn by");
  word->callback([options, &result] { result = shards(*options); });
}

}  // namespace samestep::program
