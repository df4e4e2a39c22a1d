// SPDX-License-Identifier: MIT
#include "cli/verify/verify_batch.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <utility>

#include "cli/program.h"
#include "cli/verify/worker_processes.h"
#include "recording/recording_format.h"
#include "state/state_hash.h"

namespace samestep::program {
namespace {

namespace fs = std::filesystem;

void addFolder(const std::string& folder, std::vector<std::string>& files) {
  const std::size_t before = files.size();
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && looksLikeRecording(entry.path().string())) {
      files.push_back(entry.path().string());
    }
  }
  if (files.size() == before) throw Unusable(folder + ": no recordings in this folder");
}

std::uint64_t littleEndian(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size && at + i < bytes.size(); ++i) {
    value |= std::uint64_t{bytes[at + i]} << (8 * i);
  }
  return value;
}

/// Bytes of a step without commands.
constexpr std::uint64_t kStepBytes = 9;

/// The size of a recording's first world, as its first bytes tell it.
std::uint64_t worldBytes(const std::vector<std::uint8_t>& head) {
  const bool packed = (head[kWorldAt] & kPackedBit) != 0;
  return littleEndian(head, kWorldAt + (packed ? kSectionHeadBytes : 1), 4);
}

std::uint64_t workOf(const std::string& file) {
  constexpr std::uint64_t kTail = kSectionHeadBytes + 16 + kChainBytes;
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::uint8_t> head(kWorldAt + kSectionHeadBytes + kUnpackedLengthBytes);
  std::vector<std::uint8_t> tail(kTail);
  stream.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
  if (error || !stream || size < head.size() + kTail) return error ? 0 : size;
  stream.seekg(-static_cast<std::streamoff>(kTail), std::ios::end);
  stream.read(reinterpret_cast<char*>(tail.data()), static_cast<std::streamsize>(tail.size()));
  const bool ended = littleEndian(head, kVersionAt, 4) > kOldestRecordingVersion &&
                     tail[0] == static_cast<std::uint8_t>(SectionKind::end);
  if (!stream || !ended) return size;
  const std::uint64_t plain = std::min(size, std::uint64_t{1} << 24) * kMaxUnpackedPerByte;
  const std::uint64_t work = std::min(littleEndian(tail, kSectionHeadBytes, 8), plain / kStepBytes) *
                             std::min({worldBytes(head), plain, std::uint64_t{kMaxUnpackedBytes}});
  // Millions of them can be added up.
  return std::min(work, std::uint64_t{1} << 42);
}

}  // namespace

std::vector<std::string> filesNamed(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    std::error_code error;
    if (argument == "-") {
      for (std::string line; std::getline(std::cin, line);) {
        if (!line.empty()) files.push_back(line);
      }
    } else if (fs::is_directory(argument, error)) {
      const std::size_t before = files.size();
      addFolder(argument, files);
      std::stable_sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
    } else {
      files.push_back(argument);
    }
  }
  return files;
}

bool looksLikeRecording(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  char first[sizeof kRecordingMagic] = {};
  stream.read(first, sizeof first);
  return stream && std::equal(std::begin(first), std::end(first), kRecordingMagic,
                              [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

std::vector<Job> jobsOf(const std::vector<std::string>& files) {
  std::vector<Job> jobs;
  for (const std::string& file : files) jobs.push_back({file, std::max<std::uint64_t>(workOf(file), 1)});
  return jobs;
}

std::vector<std::string> sampleOf(const std::vector<std::string>& files, std::uint32_t percent,
                                  std::uint64_t seed) {
  std::vector<std::string> drawn;
  for (const std::string& file : files) {
    if (XXH3_64bits_withSeed(file.data(), file.size(), seed) % 100 < percent) drawn.push_back(file);
  }
  return drawn;
}

std::vector<std::vector<Job>> shardsOf(std::vector<Job> jobs, std::uint64_t count) {
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) {
    return a.work != b.work ? a.work > b.work : a.file < b.file;
  });
  // The least load on top, and of equal ones the first shard.
  using Load = std::pair<std::uint64_t, std::uint64_t>;
  std::set<Load> loads;
  for (std::uint64_t shard = 0; shard < count; ++shard) loads.insert({0, shard});
  std::vector<std::vector<Job>> shards(static_cast<std::size_t>(count));
  for (Job& job : jobs) {
    const Load least = *loads.begin();
    loads.erase(loads.begin());
    loads.insert({least.first + job.work, least.second});
    shards[static_cast<std::size_t>(least.second)].push_back(std::move(job));
  }
  return shards;
}

void verifyAll(const std::vector<std::string>& files, const VerifyPlan& plan, const Crew& crew,
               const std::function<void(std::size_t, const Said&)>& tell) {
  const bool alone = crew.jobs == 1 && crew.megabytes == 0 && !crew.apart;
  if (alone || !WorkerProcesses::available()) {
    for (std::size_t i = 0; i < files.size(); ++i) tell(i, verifyFile(files[i], plan));
    return;
  }
  VerifyPlan quiet = plan;
  quiet.quiet = true;
  WorkerProcesses(files, quiet, std::min<std::size_t>(static_cast<std::size_t>(crew.jobs), files.size()),
                  crew.megabytes)
      .run(tell, crew.inOrder);
}

}  // namespace samestep::program
