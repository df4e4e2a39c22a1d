// SPDX-License-Identifier: MIT
#include "cli/verify/verify_batch.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "cli/program.h"
#include "cli/verify/worker_processes.h"
#include "recording/recording_format.h"

namespace samestep::program {
namespace {

namespace fs = std::filesystem;

bool looksLikeRecording(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  char first[sizeof kRecordingMagic] = {};
  stream.read(first, sizeof first);
  return stream && std::equal(std::begin(first), std::end(first), kRecordingMagic,
                              [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

void addFolder(const std::string& folder, std::vector<std::string>& files) {
  const std::size_t before = files.size();
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && looksLikeRecording(entry.path())) {
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

/// Steps times the bytes of the first world; of an old recording or one that was cut, its size.
std::uint64_t workOf(const std::string& file) {
  constexpr std::uint64_t kTail = 29, kMostTicks = 1u << 30;
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::uint8_t> head(kWorldAt + kSectionHeadBytes);
  std::vector<std::uint8_t> tail(kTail);
  stream.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
  if (error || !stream || size < head.size() + kTail) return error ? 0 : size;
  stream.seekg(-static_cast<std::streamoff>(kTail), std::ios::end);
  stream.read(reinterpret_cast<char*>(tail.data()), static_cast<std::streamsize>(tail.size()));
  const bool ended = littleEndian(head, kVersionAt, 4) > kOldestRecordingVersion &&
                     tail[0] == static_cast<std::uint8_t>(SectionKind::end);
  if (!stream || !ended) return size;
  return std::min(littleEndian(tail, 5, 8), kMostTicks) * littleEndian(head, kWorldAt + 1, 4);
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

std::vector<std::string> shardOf(const std::vector<std::string>& files, std::uint64_t shard,
                                 std::uint64_t count) {
  struct Job {
    std::uint64_t work;
    std::string file;
  };
  std::vector<Job> jobs;
  for (const std::string& file : files) jobs.push_back({workOf(file), file});
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) {
    return a.work != b.work ? a.work > b.work : a.file < b.file;
  });
  std::vector<std::uint64_t> loads(count, 0);
  std::vector<std::string> own;
  for (const Job& job : jobs) {
    const auto least = std::min_element(loads.begin(), loads.end());
    // At least one, so that files without work are shared out, too.
    *least += std::max<std::uint64_t>(job.work, 1);
    if (static_cast<std::uint64_t>(least - loads.begin()) + 1 == shard) own.push_back(job.file);
  }
  return own;
}

void verifyAll(const std::vector<std::string>& files, const VerifyPlan& plan, int jobs,
               std::uint64_t megabytes, const std::function<void(const Said&)>& tell) {
  const bool alone = jobs == 1 && megabytes == 0;
  if (alone || !WorkerProcesses::available()) {
    for (const std::string& file : files) tell(verifyFile(file, plan));
    return;
  }
  VerifyPlan quiet = plan;
  quiet.quiet = true;
  WorkerProcesses(files, quiet, std::min<std::size_t>(static_cast<std::size_t>(jobs), files.size()),
                  megabytes)
      .run(tell);
}

}  // namespace samestep::program
