// SPDX-License-Identifier: MIT
#include "cli/program.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>  // not in results: shown to people only
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <samestep/error.h>
#include <samestep/workers.h>

#include "recording/recording_format.h"

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
  findKernel(kernel.c_str(), target);
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

void addSettingsOption(CLI::App& app, std::string& settings) {
  app.add_option("--settings", settings,
                 "A file of settings, as 'samestep tune' writes it, in place of those of the scene");
}

SceneSource findScene(const std::string& scene, const std::string& settings) {
  SceneSource source = SceneSource::find(scene);
  if (!settings.empty()) source.useSettingsFile(settings);
  return source;
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

namespace {

namespace fs = std::filesystem;

/// Guesses from the first bytes of a file that is no recording what it is.
std::string seemsToBe(std::string_view first) {
  if (first.empty()) return "the file is empty";
  if (first.starts_with(std::string_view("\x89SAMS"))) return "this is a snapshot, not a recording";
  const auto printable = [](char c) { return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t'; };
  if (!std::all_of(first.begin(), first.end(), printable)) return "not a recording";
  const std::string_view::size_type start = first.find_first_not_of(" \n\r\t");
  if (start != std::string_view::npos && first[start] == '{') {
    return "this is JSON, perhaps a scene, not a recording; 'samestep record' makes one of a scene";
  }
  return "this is text, not a recording";
}

/// Path that another leads to by links, which may be of a file yet to be made.
/// @throws Unusable for links that lead in a ring
std::string behindLinks(const std::string& path) {
  constexpr int kMostLinks = 40;
  fs::path place(path);
  std::error_code error;
  for (int i = 0; i < kMostLinks; ++i) {
    if (!fs::is_symlink(fs::symlink_status(place, error))) return place.string();
    const fs::path target = fs::read_symlink(place, error);
    place = target.is_absolute() ? target : place.parent_path() / target;
  }
  throw Unusable(path + ": cannot be written: too many links");
}

/// True if the path is there and no regular file: a device, a pipe, a socket.
bool isWrittenThrough(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

bool writeAll(const std::string& path, std::span<const std::uint8_t> bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return static_cast<bool>(stream.flush());
}

}  // namespace

std::vector<std::uint8_t> readRecording(const std::string& path, std::uint64_t most) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || fs::is_directory(path)) throw Unusable(path + ": cannot be read");
  std::vector<std::uint8_t> bytes(kWorldAt);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad()) throw Unusable(path + ": cannot be read");
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  const std::size_t magic = std::min(bytes.size(), sizeof kRecordingMagic);
  if (bytes.empty() ||
      !std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(magic), kRecordingMagic)) {
    const std::string_view first(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    throw Unusable(path + ": offset 0: " + seemsToBe(first));
  }
  recordingInfo(bytes);
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  while (stream && bytes.size() <= most) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kPiece);
    stream.read(reinterpret_cast<char*>(bytes.data() + before), static_cast<std::streamsize>(kPiece));
    bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw Unusable(path + ": cannot be read");
  if (bytes.size() > most) throw Unusable(path + ": longer than " + std::to_string(most) + " bytes");
  return bytes;
}

void writeFile(const std::string& path, std::span<const std::uint8_t> bytes) {
  const std::string place = behindLinks(path);
  if (isWrittenThrough(place)) {
    if (!writeAll(place, bytes)) throw Unusable(path + ": cannot be written");
    return;
  }
  const std::string part = place + ".part";
  std::error_code error;
  const bool written = writeAll(part, bytes);
  if (written) fs::rename(part, place, error);
  if (written && !error) return;
  std::remove(part.c_str());
  throw Unusable(path + ": cannot be written" + (error ? ": " + error.message() : ""));
}

void checkWritable(const std::string& path) {
  const std::string place = behindLinks(path);
  if (isWrittenThrough(place)) {
    if (access(place.c_str(), W_OK) != 0) throw Unusable(path + ": cannot be written");
    return;
  }
  const std::string part = place + ".part";
  const bool writable = !fs::is_directory(place) && std::ofstream(part, std::ios::binary);
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

std::string printable(std::string text) {
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '.';
  }
  return text;
}

}  // namespace samestep::program
