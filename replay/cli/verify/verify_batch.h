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

/// Files of one shard out of `count`, by the work they seem to be: steps times the size of the first world,
/// as their first and last bytes tell it, greatest first, each to the shard that has least.
/// @param shard  1 to `count`
std::vector<std::string> shardOf(const std::vector<std::string>& files, std::uint64_t shard,
                                 std::uint64_t count);

/// Verifies files with `jobs` processes, so that none can hurt another: one that ends is told of, and another
/// takes its place. Calls `tell` for each file in the order of the list.
/// @param megabytes  of memory that each process may have; 0 for any
void verifyAll(const std::vector<std::string>& files, const VerifyPlan& plan, int jobs,
               std::uint64_t megabytes, const std::function<void(const Said&)>& tell);

}  // namespace samestep::program
