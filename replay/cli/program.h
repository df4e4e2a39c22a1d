// SPDX-License-Identifier: MIT
// What the parts of the program share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <samestep/judge.h>
#include <samestep/kernel.h>
#include <samestep/recording.h>
#include <samestep/scalar.h>
#include <samestep/scene.h>

namespace samestep::program {

/// Exit codes of the program.
enum Exit : int {
  kGood = 0,
  kMismatch = 1,
  kUnusable = 2,
};

/// Something the caller must mend: bad arguments, files that cannot be read or written.
class Unusable : public std::exception {
 public:
  explicit Unusable(std::string reason) : reason_(std::move(reason)) {}
  const char* what() const noexcept override { return reason_.c_str(); }

 private:
  std::string reason_;
};

/// Each adds one word of the command line; running it leaves the exit code in `result`.
void addScenes(CLI::App& app, int& result);
void addHash(CLI::App& app, int& result);
void addRecord(CLI::App& app, int& result);
void addVerify(CLI::App& app, Wirings& wirings, int& result);
void addShards(CLI::App& app, int& result);
void addMerge(CLI::App& app, int& result);
void addInfo(CLI::App& app, int& result);
void addDiff(CLI::App& app, Wirings& wirings, int& result);
/// Answers for a recording that is on this machine, to a diff on another one.
void addAnswer(CLI::App& app, Wirings& wirings, int& result);
void addDraw(CLI::App& app, Wirings& wirings, int& result);
void addFilm(CLI::App& app, Wirings& wirings, int& result);
void addChart(CLI::App& app, int& result);
void addEnvelope(CLI::App& app, int& result);
void addTune(CLI::App& app, int& result);
void addNetsim(CLI::App& app, int& result);
/// Nothing where the build is without samestep::transport.
void addMatch(CLI::App& app, int& result);
/// Nothing where the build is without cpp-httplib.
void addView(CLI::App& app, int& result);
void addRelay(CLI::App& app, int& result);

/// Adds --game, which puts the wirings of a game's library in place of these.
/// @throws Unusable, when it is read, for what is no such library
void addGameOption(CLI::App& app, Wirings& wirings);

/// Adds --scalar with the scalars of this build.
void addScalarOption(CLI::App& app, std::string& scalar);

/// Adds --settings.
void addSettingsOption(CLI::App& app, std::string& settings);
/// A scene, with the settings of a file in place of its own unless the file's name is empty.
/// @throws SceneError
SceneSource findScene(const std::string& scene, const std::string& settings);

/// Adds --ticks; 0 stands for not given.
void addTicksOption(CLI::App& app, std::uint64_t& ticks);

/// Choice of who computes: no result depends on it.
struct ComputeOptions {
  std::string kernel = "best";
  int workers = 1;
  /// @throws Unusable where the build or the processor lacks it
  KernelTarget target() const;
};

/// Names of all kernels, those that this machine lacks, too.
std::vector<std::string> kernelNames();

/// Adds --kernel and --workers.
void addComputeOptions(CLI::App& app, ComputeOptions& options);

/// Calls visit(S()) for the scalar of that name.
/// @throws Unusable where this build lacks it
template <class Visit>
int withScalar(const std::string& name, Visit&& visit) {
  if (name == "fixed") return visit(Fixed());
  if constexpr (ScalarTraits<CheckedFixed>::kSupported) {
    if (name == "checked") return visit(CheckedFixed());
  }
  if constexpr (ScalarTraits<double>::kSupported) {
    if (name == "double") return visit(double());
  }
  throw Unusable("this build has no scalar \"" + name + "\"");
}

/// Calls `visit` for the scalar of a recording.
template <class Visit>
int withScalarOf(ScalarKind kind, Visit&& visit) {
  if (kind == ScalarKind::fixed) return visit(Fixed());
  if constexpr (ScalarTraits<double>::kSupported) return visit(double());
  throw Unusable("this build has no scalar \"double\"");
}

/// Shows on a terminal how far long work is: "record: 1200 of 6000 ticks".
class Progress {
 public:
  Progress(const char* what, std::uint64_t total);
  ~Progress() { clear(); }
  void at(std::uint64_t done) { at(done, total_); }
  void at(std::uint64_t done, std::uint64_t total);
  /// Takes it off the terminal.
  void clear();

 private:
  const char* what_;
  std::uint64_t total_;
  std::int64_t next_;
  bool terminal_;
  bool shown_ = false;
};

/// Says on the error output what long work is at: on a terminal in a line that it keeps rewriting, else in a
/// line each.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  void show(const std::string& text);
  /// Takes it off the terminal.
  void clear();

 private:
  bool terminal_;
  bool shown_ = false;
};

/// Milliseconds since some point in the past.
std::int64_t milliseconds();

/// A recording, whose first bytes are looked at before the rest is read.
/// @param most  bytes; no more of a longer file are read
/// @throws Unusable for what is none, saying what it seems to be, and for a longer one; FormatError
std::vector<std::uint8_t> readRecording(const std::string& path,
                                        std::uint64_t most = RecordingLimits().bytes);
/// A regular file is written beside and moved into place, so that it is whole or not there; a link stays one,
/// and what it leads to is written. A device or pipe is written through.
/// @throws Unusable
void writeFile(const std::string& path, std::span<const std::uint8_t> bytes);
void writeFile(const std::string& path, const std::string& text);
/// Before long work: whether writeFile will find the folder and may write there.
/// @throws Unusable
void checkWritable(const std::string& path);

/// Says on the error output what is wrong with a file and, of malformed bytes, where.
void tell(const std::string& file, const std::exception& error);

/// 16 hexadecimal digits.
std::string hex(std::uint64_t value);
/// A stranger's bytes on a line: what a terminal would take for orders is shown as dots.
std::string printable(std::string text);

}  // namespace samestep::program
