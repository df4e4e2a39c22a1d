// SPDX-License-Identifier: MIT
// Samestep beside its peers: time, quality and memory of the scenes of docs/performance.md.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "peer_memory.h"
#include "peer_quality.h"
#include "peer_worlds.h"

namespace samestep::bench {
namespace {

const std::string kReference = "chipmunk";

struct Plan {
  std::vector<std::string> scenes{"pyramid100", "pyramid40", "pyramids25", "circles",
                                  "tumbler",    "soup",      "sparse",     "sparse-falling"};
  std::vector<std::string> engines{kReference,
                                   "box2d24",
                                   "samestep-double-impulses10",
                                   "samestep-double-soft4",
                                   "samestep-fixed-impulses10",
                                   "samestep-fixed-soft4",
                                   "samestep-fixed-fast4"};
  int rounds = 5;
  int warmUp = 30;
  int timed = 300;
  bool memory = true;
  bool wall = false;
  std::string folder = SAMESTEP_PEER_SCENES;
  std::string csv, details;
};

/// Findings about one engine in one scene.
struct Cell {
  std::vector<double> ms;      ///< Times per step, by round.
  std::vector<double> ratios;  ///< Ratios to the reference in the same round.
  Quality quality;
  std::optional<long long> bytes;
};

using Results = std::map<std::string, std::map<std::string, Cell>>;

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

void measure(const Plan& plan, const std::string& engine, const PeerScene& scene, Cell& cell) {
  const std::unique_ptr<World> world = makeWorld(engine, scene);
  for (int i = 0; i < plan.warmUp; ++i) world->step();
  // The thread's own time has no part of what other threads do.
  const clockid_t clock = plan.wall ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID;
  const double start = seconds(clock);
  for (int i = 0; i < plan.timed; ++i) world->step();
  cell.ms.push_back(1000 * (seconds(clock) - start) / plan.timed);
  if (cell.ms.size() == 1) cell.quality = qualityOf(scene, world->motions());
}

void measureMemory(const Plan& plan, const std::vector<PeerScene>& scenes, Results& results) {
  for (const PeerScene& scene : scenes) {
    for (const std::string& engine : plan.engines) {
      std::fprintf(stderr, "memory %s %s\n", scene.name.c_str(), engine.c_str());
      results[scene.name][engine].bytes = peakGrowth(engine, scene, plan.warmUp + plan.timed);
    }
  }
}

void measureRound(const Plan& plan, int round, const std::vector<PeerScene>& scenes, Results& results) {
  for (const PeerScene& scene : scenes) {
    std::map<std::string, Cell>& cells = results[scene.name];
    for (const std::string& engine : plan.engines) {
      measure(plan, engine, scene, cells[engine]);
      std::fprintf(stderr, "round %d of %d %s %s: %.3f ms per step\n", round + 1, plan.rounds,
                   scene.name.c_str(), engine.c_str(), cells[engine].ms.back());
    }
    if (!cells.contains(kReference)) continue;
    for (const std::string& engine : plan.engines) {
      cells[engine].ratios.push_back(cells[engine].ms.back() / cells[kReference].ms.back());
    }
  }
}

/// A number, or nothing where the figure does not apply.
std::string figure(bool applies, const char* format, double value) {
  if (!applies) return "";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

template <class Print>
void eachCell(const Plan& plan, Results& results, Print&& print) {
  for (const std::string& scene : plan.scenes) {
    for (const std::string& engine : plan.engines) print(scene, engine, results[scene][engine]);
  }
}

void writeCsv(const Plan& plan, Results& results, std::FILE* out) {
  std::fprintf(out,
               "scene,engine,ms_per_step,ratio_to_chipmunk,apex_drop_m,max_penetration_m,kinetic_energy_J,"
               "pile_y_m,bytes\n");
  eachCell(plan, results, [&](const std::string& scene, const std::string& engine, const Cell& cell) {
    const bool piled = scene == "circles" || scene == "soup";
    std::fprintf(out, "%s,%s,%.4f,%s,%s,%.5f,%.4g,%s,%s\n", scene.c_str(), engine.c_str(), median(cell.ms),
                 figure(!cell.ratios.empty(), "%.3f", cell.ratios.empty() ? 0 : median(cell.ratios)).c_str(),
                 figure(scene.starts_with("pyramid"), "%.4f", cell.quality.apexDrop).c_str(),
                 cell.quality.maxPenetration, cell.quality.kineticEnergy,
                 figure(piled, "%.3f", cell.quality.pileY).c_str(),
                 cell.bytes ? std::to_string(*cell.bytes).c_str() : "");
  });
}

void writeDetails(const Plan& plan, Results& results, std::FILE* out) {
  std::fprintf(out,
               "scene,engine,rounds,lowest_ms,highest_ms,lowest_ratio,highest_ratio,through_walls,turned\n");
  eachCell(plan, results, [&](const std::string& scene, const std::string& engine, const Cell& cell) {
    const auto [low, high] = std::minmax_element(cell.ms.begin(), cell.ms.end());
    const bool has = !cell.ratios.empty();
    const auto [least, most] = std::minmax_element(cell.ratios.begin(), cell.ratios.end());
    std::fprintf(out, "%s,%s,%zu,%.4f,%.4f,%s,%s,%d,%d\n", scene.c_str(), engine.c_str(), cell.ms.size(),
                 *low, *high, figure(has, "%.3f", has ? *least : 0).c_str(),
                 figure(has, "%.3f", has ? *most : 0).c_str(), cell.quality.throughWalls,
                 cell.quality.turned);
  });
}

bool writeTo(const std::string& path, const Plan& plan, Results& results,
             void (*write)(const Plan&, Results&, std::FILE*)) {
  if (path.empty()) return true;
  std::FILE* out = path == "-" ? stdout : std::fopen(path.c_str(), "w");
  if (out == nullptr) {
    std::fprintf(stderr, "cannot write %s\n", path.c_str());
    return false;
  }
  write(plan, results, out);
  return out == stdout || std::fclose(out) == 0;
}

int run(const Plan& plan) {
  std::vector<PeerScene> scenes;
  for (const std::string& name : plan.scenes) scenes.push_back(readScene(plan.folder, name));
  const PeerScene empty{.name = "", .gravityX = "0", .gravityY = "0", .shapes = {}};
  for (const std::string& engine : plan.engines) {
    if (makeWorld(engine, empty) == nullptr) {
      std::fprintf(stderr, "no engine '%s' (see --help)\n", engine.c_str());
      return 2;
    }
  }
  Results results;
  // First, while this process has freed little that a world could be given again.
  if (plan.memory) measureMemory(plan, scenes, results);
  for (int round = 0; round < plan.rounds; ++round) {
    measureRound(plan, round, scenes, results);
    // Each time, so that a run that is cut short leaves what it found; the standard output takes one table.
    const bool last = round + 1 == plan.rounds;
    const bool written = (plan.csv == "-" && !last) || writeTo(plan.csv, plan, results, writeCsv);
    if (!written || !writeTo(plan.details, plan, results, writeDetails)) return 1;
  }
  return 0;
}

}  // namespace
}  // namespace samestep::bench

int main(int argc, char** argv) {
  samestep::bench::Plan plan;
  plan.csv = "-";
  CLI::App app("Runs the same scenes in Samestep, Chipmunk and Box2D, in rounds that take turns.");
  app.add_option("--scenes", plan.scenes, "names in the folder of scenes, sparse-falling, or pyramidN")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--engines", plan.engines,
                 "chipmunk, chipmunkITERATIONS, box2d24, samestep-double-softSUBSTEPS,\n"
                 "samestep-double-impulsesITERATIONS, and the same with fixed; with xN for N workers;\n"
                 "with -KERNEL for contacts solved by that kernel: portable, sse42, avx2 ...")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--rounds", plan.rounds, "medians are over these")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--warm-up", plan.warmUp, "steps before the timed ones")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  app.add_option("--timed", plan.timed, "timed steps; quality is that after the last")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_flag("--memory,!--no-memory", plan.memory,
               "also run each world in a process of its own for its peak");
  app.add_flag("--wall", plan.wall, "time by the wall clock, as several workers need, not the thread's own");
  app.add_option("--folder", plan.folder, "where the scenes are")->capture_default_str();
  app.add_option("--csv", plan.csv, "file for the figures, - for the standard output")->capture_default_str();
  app.add_option("--details", plan.details, "file for ranges over the rounds and bodies gone astray");
  CLI11_PARSE(app, argc, argv);
  return samestep::bench::run(plan);
}
