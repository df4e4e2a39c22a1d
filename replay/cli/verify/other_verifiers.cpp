// SPDX-License-Identifier: MIT
#include "cli/verify/other_verifiers.h"

#include <samestep/version.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>

#include "cli/program.h"
#include "cli/verify/verdict_line.h"
#include "recording/recording_format.h"

#if (defined(__unix__) && !defined(__EMSCRIPTEN__) && !defined(__wasi__)) || defined(__APPLE__)
#define SAMESTEP_PROCESSES
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#endif

namespace samestep::program {

std::string OtherVerifiers::programFor(std::uint32_t revision) const {
  return folder_ + "/samestep-" + std::to_string(revision);
}

#ifdef SAMESTEP_PROCESSES
namespace {

struct Closing {
  std::FILE* stream;
  ~Closing() {
    if (stream != nullptr) std::fclose(stream);
  }
};

/// A list of files that a program can have as its standard input.
std::FILE* listOf(const std::vector<std::string>& files) {
  std::FILE* list = std::tmpfile();
  if (list == nullptr) throw Unusable("no file for a list can be made");
  for (const std::string& file : files) std::fprintf(list, "%s\n", file.c_str());
  std::fflush(list);
  std::rewind(list);
  return list;
}

/// Starts a program with this standard input; what it writes to its standard output can be read.
std::FILE* start(const std::vector<std::string>& words, std::FILE* input, pid_t& process) {
  int ends[2];
  if (::pipe(ends) != 0) throw Unusable("no more pipes");
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  std::fflush(stdout);
  process = ::fork();
  if (process < 0) throw Unusable("no more processes");
  if (process == 0) {
    ::dup2(::fileno(input), STDIN_FILENO);
    ::dup2(ends[1], STDOUT_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  return ::fdopen(ends[0], "rb");
}

bool readLine(std::FILE* stream, std::string& line) {
  line.clear();
  for (int c = std::fgetc(stream); c != EOF; c = std::fgetc(stream)) {
    if (c == '\n') return true;
    line += static_cast<char>(c);
  }
  return false;
}

Said saidBy(const VerdictLine& verdict, const std::string& line, bool json) {
  Said said;
  said.verdict = verdictNamed(verdict.verdict);
  said.ticks = verdict.ticks;
  said.out = json ? line + "\n"
                  : verdict.file + ": " + printable(verdict.verdict) + ", by the program of revision " +
                        std::to_string(verdict.verifier) +
                        (verdict.reason.empty() ? "" : ": " + printable(verdict.reason)) + "\n";
  return said;
}

}  // namespace

std::uint32_t OtherVerifiers::revisionFor(const std::string& file) const {
  if (folder_.empty()) return 0;
  std::array<char, kWorldAt> first{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(first.data(), static_cast<std::streamsize>(first.size()))) return 0;
  std::uint32_t revision = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    revision |= std::uint32_t{static_cast<std::uint8_t>(first[kRevisionAt + i])} << (8 * i);
  }
  const bool isRecording =
      std::equal(std::begin(kRecordingMagic), std::end(kRecordingMagic), first.begin(),
                 [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); });
  const bool other = isRecording && revision != kSimulationRevision && revision != 0;
  return other && ::access(programFor(revision).c_str(), X_OK) == 0 ? revision : 0;
}

void OtherVerifiers::verify(std::uint32_t revision, const std::vector<std::string>& files,
                            const VerifyPlan& plan,
                            const std::function<void(std::size_t, const Said&)>& tell) const {
  const std::string program = programFor(revision);
  std::vector<std::string> words{program, "verify", "-", "--json"};
  words.insert(words.end(), options_.begin(), options_.end());
  const Closing list{listOf(files)};
  pid_t process = 0;
  const Closing answers{start(words, list.stream, process)};
  std::map<std::string, std::vector<std::size_t>> waiting;
  for (std::size_t i = files.size(); i-- > 0;) waiting[files[i]].push_back(i);
  for (std::string line; readLine(answers.stream, line);) {
    const auto verdict = readVerdictLine(line);
    const auto asked = verdict ? waiting.find(verdict->file) : waiting.end();
    if (asked == waiting.end() || asked->second.empty()) continue;
    tell(asked->second.back(), saidBy(*verdict, line, plan.json));
    asked->second.pop_back();
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  for (const auto& [file, places] : waiting) {
    for (const std::size_t place : places) {
      tell(place, saidUnusable(file, file + ": " + program + " says nothing of it", false, plan));
    }
  }
}

#else

std::uint32_t OtherVerifiers::revisionFor(const std::string&) const { return 0; }
void OtherVerifiers::verify(std::uint32_t, const std::vector<std::string>&, const VerifyPlan&,
                            const std::function<void(std::size_t, const Said&)>&) const {}

#endif

}  // namespace samestep::program
