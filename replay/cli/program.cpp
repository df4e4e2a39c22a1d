// SPDX-License-Identifier: MIT
#include "cli/program.h"

#include <unistd.h>

#include <chrono>  // not in results: shown to people only
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <samestep/error.h>
#include <samestep/workers.h>

namespace samestep::program {
namespace {

constexpr std::int64_t kQuietMilliseconds = 2000;
constexpr std::int64_t kRefreshMilliseconds = 200;

}  // namespace

void addScalarOption(CLI::App& app, std::string& scalar) {
  std::vector<std::string> names{"fixed"};
  if (ScalarTraits<double>::kSupported) names.emplace_back("double");
  if (ScalarTraits<CheckedFixed>::kSupported) names.emplace_back("checked");
  app.add_option("--scalar", scalar, "The number type that the world is computed with")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
}

KernelTarget ComputeOptions::target() const {
  KernelTarget target = KernelTarget::best;
  findKernel(kernel, target);
  if (isAvailable(target)) return target;
  std::string reason = "this build or this processor has no kernel \"" + kernel + "\"; it has";
  for (const KernelTarget available : availableKernels()) reason += std::string(" ") + kernelName(available);
  throw Unusable(reason);
}

std::vector<std::string> kernelNames() {
  std::vector<std::string> names;
  for (const KernelTarget target : kKernelTargets) names.emplace_back(kernelName(target));
  return names;
}

void addComputeOptions(CLI::App& app, ComputeOptions& options) {
  app.add_option("--kernel", options.kernel,
                 "The processor instructions to solve contacts with; no hash differs")
      ->check(CLI::IsMember(kernelNames()))
      ->capture_default_str();
  app.add_option("--workers", options.workers,
                 "How many threads share all that can be shared; no hash differs")
      ->check(CLI::Range(1, WorkerPool::kMostWorkers))
      ->capture_default_str();
}

void addTicksOption(CLI::App& app, std::uint64_t& ticks) {
  app.add_option("--ticks", ticks, "How many steps to make; as the scene says if not given")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
}

std::int64_t milliseconds() {
  using namespace std::chrono;  // not in results: shown to people only
  // not in results: shown to people only
  return duration_cast<std::chrono::milliseconds>(steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(const char* what, std::uint64_t total)
    : what_(what),
      total_(total),
      next_(samestep::program::milliseconds() + kQuietMilliseconds),
      terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::clear() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
  shown_ = false;
}

void Progress::at(std::uint64_t done, std::uint64_t total) {
  // The clock costs more than a small step.
  if (!terminal_ || done % 16 != 0) return;
  const std::int64_t now = samestep::program::milliseconds();
  if (now < next_) return;
  next_ = now + kRefreshMilliseconds;
  shown_ = true;
  std::fprintf(stderr, "\r\033[K%s: %llu of %llu ticks", what_, static_cast<unsigned long long>(done),
               static_cast<unsigned long long>(total));
  std::fflush(stderr);
}

StatusLine::StatusLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

void StatusLine::clear() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
  shown_ = false;
}

void StatusLine::show(const std::string& text) {
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
  std::fflush(stderr);
  shown_ = terminal_;
}

std::vector<std::uint8_t> readFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path)) throw Unusable(path + ": cannot be read");
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw Unusable(path + ": cannot be read");
  return bytes;
}

void writeFile(const std::string& path, std::span<const std::uint8_t> bytes) {
  const std::string part = path + ".part";
  {
    std::ofstream stream(part, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream.flush()) {
      std::remove(part.c_str());
      throw Unusable(path + ": cannot be written");
    }
  }
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) {
    std::remove(part.c_str());
    throw Unusable(path + ": cannot be written: " + error.message());
  }
}

void checkWritable(const std::string& path) {
  const std::string part = path + ".part";
  const bool writable = !std::filesystem::is_directory(path) && std::ofstream(part, std::ios::binary);
  std::remove(part.c_str());
  if (!writable) throw Unusable(path + ": cannot be written");
}

void writeFile(const std::string& path, const std::string& text) {
  writeFile(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void tell(const std::string& file, const std::exception& error) {
  std::fflush(stdout);
  std::string place = file;
  if (const auto* format = dynamic_cast<const FormatError*>(&error)) {
    place += ": offset " + std::to_string(format->offset());
  }
  // Our own errors name the file.
  const bool named = dynamic_cast<const Unusable*>(&error) != nullptr;
  std::fprintf(stderr, "samestep: %s%s\n", named ? "" : (place + ": ").c_str(), error.what());
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace samestep::program
