// SPDX-License-Identifier: MIT
#include "study/chart_sweep.h"

#include <time.h>  // not in results: speed is what a chart shows

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include <samestep/collision.h>

#include "base/require_ieee.h"
#include "scenes/scene_document.h"
#include "study/chart_track.h"
#include "study/method.h"

namespace samestep {
namespace {

constexpr std::uint64_t kDefaultSteps = 330;
/// Settling and first touches of memory are not timed.
constexpr std::uint64_t kWarmUpSteps = 30;
constexpr int kMostRepeats = 1000;
/// Every so many steps bodies are looked at.
constexpr std::uint64_t kLookSteps = 6;
constexpr int kReferenceSubsteps = 64;
constexpr double kAgreement = 0.01;
constexpr double kRestSpeed = 0.1;

double threadSeconds() {
  timespec now{};
  // not in results: speed is what a chart shows
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::stable_sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// True if it is one of the project's own scenes: a user's may have the name of one.
bool isOurs(const SceneSource& source) {
  const SceneSource::Document& document = source.document();
  if (!document.family.empty()) return true;
  for (const std::string& folder : sceneFolders()) {
    std::error_code error;
    if (std::filesystem::equivalent(folder, document.folder, error)) return true;
  }
  return false;
}

std::string meters(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g m", value);
  return text;
}

/// The deepest overlap of two shapes that are kept apart, m.
template <Scalar S>
double deepestOverlap(Space<S>& space) {
  S deepest{};
  space.eachArbiter([&](Arbiter<S>& arbiter) {
    if (arbiter.pair().solved == 0) return;
    // The shapes are asked where they are now: the arbiter may know where they were before the step moved
    // them.
    const ContactPointSet<S> touch = shapesCollide(arbiter.shapeDataA(), arbiter.bodyDataA().transform(),
                                                   arbiter.shapeDataB(), arbiter.bodyDataB().transform());
    for (int i = 0; i < touch.count; ++i) deepest = max(deepest, -touch.points[i].distance);
  });
  return static_cast<double>(deepest);
}

/// Seconds per step of one run, or of as many as it takes to measure it.
template <Scalar S>
double secondsPerStep(const SceneSource& source, const Method& method, int count, KernelTarget kernel,
                      std::uint64_t steps, double leastSeconds) {
  const std::uint64_t warmUp = std::min(kWarmUpSteps, steps / 10);
  double seconds = 0;
  double timed = 0;
  for (int repeat = 0; repeat == 0 || (repeat < kMostRepeats && seconds < leastSeconds); ++repeat) {
    Scene<S> scene(source);
    useMethod(scene.space(), method, count);
    scene.space().setKernel(kernel);
    while (scene.tick() < warmUp) scene.step();
    const double start = threadSeconds();
    while (scene.tick() < steps) scene.step();
    seconds += threadSeconds() - start;
    timed += static_cast<double>(steps - warmUp);
  }
  return seconds / timed;
}

/// Yardstick by which the errors of one scene are measured.
class Yardstick {
 public:
  Yardstick(const SceneSource& source, std::uint64_t steps);

  void describe(Chart& chart) const;
  std::uint64_t steps() const { return steps_; }
  void measure(const Method& method, ChartPoint& point) const {
    withScalarOf(method, [&](auto scalar) { measure<decltype(scalar)>(method, point); });
  }

 private:
  enum class Kind { exact, reference, rest, overlap };

  template <Scalar S>
  void measure(const Method& method, ChartPoint& point) const;
  template <Scalar S>
  void useExact();
  template <Scalar S>
  void useReference(const Method& method);
  template <Scalar S>
  Track trackOf(Scene<S>& scene, const Method& method, int count) const;
  template <Scalar S>
  void measureAfter(Scene<S>& scene, ChartPoint& point) const;

  const SceneSource& source_;
  std::uint64_t steps_;
  Kind kind_ = Kind::overlap;
  const ExactAnswer* exact_;
  std::string reference_;
  double resolution_ = 0;
  Track expected_;
};

Yardstick::Yardstick(const SceneSource& source, std::uint64_t steps)
    : source_(source),
      steps_(steps),
      exact_(isOurs(source) ? exactAnswerOf(source.summary().name) : nullptr) {
  // The first soft step of the table: of double where this build has it.
  const Method* finest = &methods().front();
  for (const Method& method : methods()) {
    if (finest->solver != SolverKind::softStep) finest = &method;
  }
  if (steps_ == 0) {
    steps_ = exact_ != nullptr ? exact_->steps : std::min(source.summary().ticks, kDefaultSteps);
  }
  if (exact_ != nullptr && steps_ > exact_->most) {
    throw std::runtime_error("the exact answer of " + source.summary().name + " holds for " +
                             std::to_string(exact_->most) + " ticks at the most");
  }
  withScalarOf(*finest, [&](auto scalar) {
    if (exact_ != nullptr) {
      useExact<decltype(scalar)>();
    } else {
      useReference<decltype(scalar)>(*finest);
    }
  });
}

template <Scalar S>
void Yardstick::useExact() {
  const Scene<S> scene(source_);
  const StartWorld start = startOf(scene.space());
  const double dt = static_cast<double>(scene.timeStep());
  for (std::uint64_t step = kLookSteps; step <= steps_; step += kLookSteps) {
    expected_.push_back(exact_->after(start, dt * static_cast<double>(step)));
  }
  kind_ = Kind::exact;
}

template <Scalar S>
void Yardstick::useReference(const Method& method) {
  Scene<S> fine(source_);
  Scene<S> coarse(source_);
  expected_ = trackOf(fine, method, kReferenceSubsteps);
  resolution_ = distanceBetween(expected_, trackOf(coarse, method, kReferenceSubsteps / 2));
  reference_ = method.name;
  if (resolution_ <= kAgreement) {
    kind_ = Kind::reference;
    return;
  }
  const Spots before = spotsOf(fine.space());
  fine.step();
  const double speed = distanceBetween(before, spotsOf(fine.space())) / static_cast<double>(fine.timeStep());
  kind_ = speed < kRestSpeed ? Kind::rest : Kind::overlap;
}

template <Scalar S>
Track Yardstick::trackOf(Scene<S>& scene, const Method& method, int count) const {
  useMethod(scene.space(), method, count);
  Track track;
  while (scene.tick() < steps_) {
    scene.step();
    if (scene.tick() % kLookSteps == 0) track.push_back(spotsOf(scene.space()));
  }
  return track;
}

/// In the second after the last step.
template <Scalar S>
void Yardstick::measureAfter(Scene<S>& scene, ChartPoint& point) const {
  const Spots before = spotsOf(scene.space());
  const auto second = static_cast<std::uint64_t>(static_cast<int>(S(1) / scene.timeStep() + ratio<S>(1, 2)));
  double overlap = 0;
  double looks = 0;
  for (std::uint64_t step = 1; step <= second; ++step) {
    scene.step();
    if (step % kLookSteps != 0 && step != second) continue;
    overlap += deepestOverlap(scene.space());
    looks += 1;
  }
  point.overlap = overlap / looks;
  point.drift = kind_ == Kind::rest ? distanceBetween(before, spotsOf(scene.space())) : 0;
  point.error = point.overlap + point.drift;
}

template <Scalar S>
void Yardstick::measure(const Method& method, ChartPoint& point) const {
  Scene<S> scene(source_);
  const Track track = trackOf(scene, method, point.count);
  if (kind_ == Kind::exact || kind_ == Kind::reference) {
    point.error = distanceBetween(track, expected_);
  } else {
    measureAfter(scene, point);
  }
}

void Yardstick::describe(Chart& chart) const {
  const std::string steps = std::to_string(steps_);
  const std::string substeps = std::to_string(kReferenceSubsteps);
  const std::string chaos = "This scene has no exact answer, and its runs with " +
                            std::to_string(kReferenceSubsteps / 2) + " and " + substeps +
                            " substeps do not agree on one.";
  switch (kind_) {
    case Kind::exact:
      chart.kind = "exact";
      chart.measure = {"Error against the exact answer: root mean square distance of",
                       std::string(exact_->measure) + ", over " + steps + " steps."};
      break;
    case Kind::reference:
      chart.kind = "reference";
      chart.resolution = resolution_;
      chart.measure = {"Error against a converged run (" + reference_ + ", " + substeps +
                           " substeps): root mean square distance of the",
                       "bodies from it, over " + steps + " steps. With half its substeps it is " +
                           meters(resolution_) + " off."};
      break;
    case Kind::rest:
      chart.kind = "rest";
      chart.measure = {chaos, "Error in the second after step " + steps +
                                  ": the deepest overlap (mean) plus how far bodies at rest drift (root mean "
                                  "square)."};
      break;
    case Kind::overlap:
      chart.kind = "overlap";
      chart.measure = {chaos, "Error: the deepest overlap, mean over the second after step " + steps + "."};
      break;
  }
}

struct Run {
  const Method* method;
  KernelTarget kernel;
  int count;
  std::vector<double> milliseconds;
};

}  // namespace

Chart sweepScene(const SceneSource& source, const SweepOptions& options) {
  std::vector<Run> runs;
  for (const Method& method : methods()) {
    const bool soft = method.solver == SolverKind::softStep;
    for (std::size_t i = 0; i < (soft ? options.kernels.size() : 1); ++i) {
      const KernelTarget kernel = soft ? options.kernels[i] : KernelTarget::best;
      for (const int count : method.counts) runs.push_back({&method, kernel, count, {}});
    }
  }
  const int total = static_cast<int>(runs.size()) * (options.rounds + 1);
  int done = 0;
  const auto tell = [&](const std::string& what) {
    if (options.progress) options.progress(done, total, what);
  };
  const auto lineOf = [&](const Run& run) {
    const bool one = options.kernels.size() == 1 || run.method->solver != SolverKind::softStep;
    return std::string(run.method->name) + (one ? "" : std::string(" (") + kernelName(run.kernel) + ")");
  };
  const auto nameOf = [&](const Run& run) {
    return lineOf(run) + ", " + std::to_string(run.count) + " " + run.method->unit;
  };

  tell("looking for what to measure errors by");
  const Yardstick yardstick(source, options.steps);
  for (int round = 1; round <= options.rounds; ++round) {
    for (Run& run : runs) {
      tell("time, round " + std::to_string(round) + " of " + std::to_string(options.rounds) + ": " +
           nameOf(run));
      run.milliseconds.push_back(1000 * withScalarOf(*run.method, [&](auto scalar) {
                                   return secondsPerStep<decltype(scalar)>(source, *run.method, run.count,
                                                                           run.kernel, yardstick.steps(),
                                                                           options.leastSeconds);
                                 }));
      ++done;
    }
  }
  Chart chart;
  chart.scene = source.summary().name;
  yardstick.describe(chart);
  const Run* last = nullptr;
  for (const Run& run : runs) {
    tell("error: " + nameOf(run));
    if (last == nullptr || run.method != last->method || run.kernel != last->kernel) {
      chart.lines.push_back({lineOf(run), run.method->scalar, run.method->unit, {}});
    }
    last = &run;
    ChartPoint& point = chart.lines.back().points.emplace_back();
    const auto [fastest, slowest] = std::minmax_element(run.milliseconds.begin(), run.milliseconds.end());
    point.count = run.count;
    point.milliseconds = median(run.milliseconds);
    point.fastest = *fastest;
    point.slowest = *slowest;
    yardstick.measure(*run.method, point);
    ++done;
  }
  markFront(chart);
  return chart;
}

}  // namespace samestep
