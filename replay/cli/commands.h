// SPDX-License-Identifier: MIT
// The commands of the program: what each is asked for, and the function that does it. They know nothing of
// the command line, whose library takes seconds to compile.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <samestep/limits.h>
#include <samestep/space_codec.h>

#include "cli/program.h"

namespace samestep::program {

struct HashOptions {
  std::string scene;
  std::string scalar = "fixed";
  std::uint64_t ticks = 0;
  std::uint64_t every = 1;
  bool highWater = false;
  ComputeOptions compute;
};

struct RecordOptions {
  std::string scene;
  std::string file;
  std::string scalar = "fixed";
  std::uint64_t ticks = 0;
};

struct VerifyFilesOptions {
  std::vector<std::string> files;
  ComputeOptions compute;
  WorldLimits limits;
  std::int64_t seconds = 0;
};

struct DiffOptions {
  std::string a;
  std::string b;
  std::uint32_t most = 5;
};

struct DrawOptions {
  std::string source;
  std::string file;
  std::string scalar = "fixed";
  std::uint64_t tick = 0;
};

struct ChartOptions {
  std::string scene;
  std::string picture;
  std::string csv;
  std::uint64_t steps = 0;
  int rounds = 3;
  std::vector<std::string> kernels;
};

struct EnvelopeOptions {
  std::string ladder;
  std::string csv;
};

/// The commands by their words. Each returns what the program exits with.
int listScenesByName();
int hashScene(const HashOptions& options);
int recordScene(const RecordOptions& options);
int verifyFiles(const VerifyFilesOptions& options);
int diffRecordings(const DiffOptions& options);
int drawTick(const DrawOptions& options);
int chartSolvers(const ChartOptions& options);
int climbLadders(const EnvelopeOptions& options);

/// The ladders that climbLadders knows.
std::vector<std::string> ladderNames();

}  // namespace samestep::program
