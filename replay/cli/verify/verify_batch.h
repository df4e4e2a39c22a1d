// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/verify/verify_file.h"

namespace samestep::program {

/// The recordings that the arguments name: files as they are, what is in folders and looks like a recording,
/// the lines of the standard input for "-". In an order that every machine gives them.
/// @throws Unusable for a folder without any
std::vector<std::string> filesNamed(const std::vector<std::string>& arguments);
/// True if a file begins as recordings do.
bool looksLikeRecording(const std::string& file);

/// A file and the work it seems to be.
struct Job {
  std::string file;
  std::uint64_t work = 0;
};

/// Looks at the first and last bytes of files: steps times the size of the first world, at most what so many
/// bytes can hold, since they may be a stranger's; of an old recording or one that was cut, its size. 1 at
/// least.
std::vector<Job> jobsOf(const std::vector<std::string>& files);

/// So many of a hundred, drawn by the seed and the path, in their order.
std::vector<std::string> sampleOf(const std::vector<std::string>& files, std::uint32_t percent,
                                  std::uint64_t seed);

/// Shares jobs out, greatest first, each to the shard that has least: the same on every machine.
std::vector<std::vector<Job>> shardsOf(std::vector<Job> jobs, std::uint64_t count);

/// Processes that verify.
struct Crew {
  int jobs = 1;
  std::uint64_t megabytes = 0;  ///< Memory that each process may have; 0 for any.
  /// True if there are processes for it even where one job has all the memory it wants.
  bool apart = false;
  bool inOrder = true;
};

/// Verifies files, by processes where the crew is some, so that none can hurt another: one that ends is told
/// of, and another takes its place. Calls `tell` with the place of each file in the list.
void verifyAll(const std::vector<std::string>& files, const VerifyPlan& plan, const Crew& crew,
               const std::function<void(std::size_t, const Said&)>& tell);

}  // namespace samestep::program
