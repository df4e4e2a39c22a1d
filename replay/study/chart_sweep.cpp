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
constexpr int kLeastHalvings = -1;
constexpr int kMostHalvings = 3;

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

/// Setting of a run: steps of the scene's own length times 2^-halvings.
struct Setting {
  const Method* method;
  KernelTarget kernel;
  int halvings;
  int count;
};

/// A run of a scene by a setting, told in steps of the scene's own length.
template <Scalar S>
class Run {
 public:
  Run(const SceneSource& source, const Setting& setting) : scene_(source), halvings_(setting.halvings) {
    useMethod(scene_.space(), *setting.method, setting.count);
    scene_.space().setKernel(setting.kernel);
    dt_ = scene_.timeStep();
    if (halvings_ < 0) dt_ = dt_ + dt_;
    for (int i = 0; i < halvings_; ++i) dt_ = dt_ * ratio<S>(1, 2);
  }

  Space<S>& space() { return scene_.space(); }
  double timeStep() const { return static_cast<double>(scene_.timeStep()); }
  /// Makes steps until so many of the scene's own length would have been made; those of twice the length make
  /// one too few of an odd number.
  void until(std::uint64_t tick) {
    const std::uint64_t steps = halvings_ < 0 ? tick >> 1 : tick << halvings_;
    const FailuresAreCaught caught;
    while (scene_.tick() < steps) {
      if (halvings_ == 0) {
        scene_.step();
      } else {
        scene_.space().step(dt_);
      }
    }
  }

 private:
  Scene<S> scene_;
  S dt_{};
  int halvings_;
};

/// A number from -1024 to 1023 that depends on nothing but these.
int nudge(std::uint64_t start, std::uint64_t body, std::uint64_t axis) {
  std::uint64_t x = (start << 40) ^ (body << 1) ^ axis;
  for (int i = 0; i < 2; ++i) {
    x ^= x >> 31;
    x *= 0x9e3779b97f4a7c15u;
  }
  return static_cast<int>(x >> 53) - 1024;
}

/// Makes the bodies that move freely a little faster or slower; the start of number 0 is the scene's own.
template <Scalar S>
void nudgeBodies(Space<S>& space, int start) {
  if (start == 0) return;
  std::vector<BodyId> bodies;
  space.eachBody([&](const Body<S>& body) {
    if (body.isDynamic()) bodies.push_back(body.id());
  });
  const auto number = static_cast<std::uint64_t>(start);
  for (const BodyId id : bodies) {
    Body<S>& body = space.body(id);
    // The change is up to 2^-10 m/s along each axis.
    const Vector<S> more{ratio<S>(nudge(number, id.index, 0), 1 << 20),
                         ratio<S>(nudge(number, id.index, 1), 1 << 20)};
    body.setVelocity(body.velocity() + more);
  }
}

/// Seconds of work per simulated second of one run, or of as many as it takes to measure it.
template <Scalar S>
double secondsPerSecond(const SceneSource& source, const Setting& setting, std::uint64_t steps,
                        double leastSeconds) {
  const std::uint64_t warmUp = std::min(kWarmUpSteps, steps / 10) & ~std::uint64_t{1};
  double seconds = 0;
  double simulated = 0;
  for (int repeat = 0; repeat == 0 || (repeat < kMostRepeats && seconds < leastSeconds); ++repeat) {
    Run<S> run(source, setting);
    run.until(warmUp);
    const double start = threadSeconds();
    run.until(steps);
    seconds += threadSeconds() - start;
    simulated += run.timeStep() * static_cast<double>(steps - warmUp);
  }
  return seconds / simulated;
}

/// Yardstick by which the errors of one scene are measured.
class Yardstick {
 public:
  Yardstick(const SceneSource& source, std::uint64_t steps);

  /// @param starts  from how many the errors of a scene without an answer are
  void describe(int starts, Chart& chart) const;
  std::uint64_t steps() const { return steps_; }
  /// @throws Error, SceneError for a step that cannot be made
  void measure(const Setting& setting, int starts, ChartPoint& point) const {
    withScalarOf(*setting.method,
                 [&](auto scalar) { measureStarts<decltype(scalar)>(setting, starts, point); });
  }

 private:
  enum class Kind { exact, reference, rest, overlap };
  /// True if errors are distances from an answer.
  bool comparesWays() const { return kind_ == Kind::exact || kind_ == Kind::reference; }

  template <Scalar S>
  void measureStarts(const Setting& setting, int starts, ChartPoint& point) const;
  template <Scalar S>
  void measureOne(const Setting& setting, int start, ChartPoint& point) const;
  template <Scalar S>
  void useExact();
  template <Scalar S>
  void useReference(const Method& method);
  template <Scalar S>
  Track trackOf(Run<S>& run) const;
  template <Scalar S>
  void measureAfter(Run<S>& run, ChartPoint& point) const;

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
  Run<S> fine(source_, {&method, KernelTarget::best, 0, kReferenceSubsteps});
  Run<S> coarse(source_, {&method, KernelTarget::best, 0, kReferenceSubsteps / 2});
  expected_ = trackOf(fine);
  resolution_ = distanceBetween(expected_, trackOf(coarse));
  reference_ = method.name;
  if (resolution_ <= kAgreement) {
    kind_ = Kind::reference;
    return;
  }
  const Spots before = spotsOf(fine.space());
  fine.until(steps_ + 1);
  const double speed = distanceBetween(before, spotsOf(fine.space())) / fine.timeStep();
  kind_ = speed < kRestSpeed ? Kind::rest : Kind::overlap;
}

template <Scalar S>
Track Yardstick::trackOf(Run<S>& run) const {
  Track track;
  for (std::uint64_t tick = kLookSteps; tick <= steps_; tick += kLookSteps) {
    run.until(tick);
    track.push_back(spotsOf(run.space()));
  }
  run.until(steps_);
  return track;
}

/// Measures in the second after the last step.
template <Scalar S>
void Yardstick::measureAfter(Run<S>& run, ChartPoint& point) const {
  const Spots before = spotsOf(run.space());
  const auto second = static_cast<std::uint64_t>(1 / run.timeStep() + 0.5);
  double overlap = 0;
  double looks = 0;
  for (std::uint64_t step = kLookSteps; step < second + kLookSteps; step += kLookSteps) {
    run.until(steps_ + std::min(step, second));
    overlap += deepestOverlap(run.space());
    looks += 1;
  }
  point.overlap = overlap / looks;
  point.drift = kind_ == Kind::rest ? distanceBetween(before, spotsOf(run.space())) : 0;
  point.error = point.overlap + point.drift;
}

template <Scalar S>
void Yardstick::measureOne(const Setting& setting, int start, ChartPoint& point) const {
  Run<S> run(source_, setting);
  nudgeBodies(run.space(), start);
  const Track track = trackOf(run);
  if (comparesWays()) {
    point.error = distanceBetween(track, expected_);
  } else {
    measureAfter(run, point);
  }
}

template <Scalar S>
void Yardstick::measureStarts(const Setting& setting, int starts, ChartPoint& point) const {
  std::vector<ChartPoint> measured(static_cast<std::size_t>(comparesWays() ? 1 : starts), point);
  for (std::size_t i = 0; i < measured.size(); ++i) measureOne<S>(setting, static_cast<int>(i), measured[i]);
  const auto of = [&](double ChartPoint::*figure) {
    std::vector<double> values;
    for (const ChartPoint& one : measured) values.push_back(one.*figure);
    return values;
  };
  point.overlap = median(of(&ChartPoint::overlap));
  point.drift = median(of(&ChartPoint::drift));
  std::vector<double> errors = of(&ChartPoint::error);
  point.error = median(errors);
  std::stable_sort(errors.begin(), errors.end());
  point.lowQuartile = errors[(errors.size() - 1) / 4];
  point.highQuartile = errors[errors.size() - 1 - (errors.size() - 1) / 4];
}

void Yardstick::describe(int starts, Chart& chart) const {
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
  if (starts > 1 && !comparesWays()) {
    chart.measure[1] += " Median, quartiles of " + std::to_string(starts) + " starts.";
  }
}

/// A setting and how long it took in each round, ms per simulated second.
struct Timed {
  Setting setting;
  std::vector<double> milliseconds;
  std::string failure;
};

/// Sweeps one scene.
class Sweep {
 public:
  Sweep(const SceneSource& source, const SweepOptions& options);
  Chart run();

 private:
  void tell(const std::string& what) const {
    if (options_.progress) options_.progress(done_, total_, what);
  }
  std::string lineOf(const Setting& setting) const;
  std::string nameOf(const Setting& setting) const;
  double rateOf(const Setting& setting) const {
    return setting.halvings < 0 ? rate_ / 2 : rate_ * static_cast<double>(1 << setting.halvings);
  }
  void time(const Yardstick& yardstick, Timed& timed);
  ChartLine newLine(const Setting& setting) const;
  ChartPoint measure(const Yardstick& yardstick, const Timed& timed) const;

  const SceneSource& source_;
  const SweepOptions& options_;
  double rate_;  ///< Steps per second of the scene itself.
  std::vector<Timed> all_;
  int done_ = 0;
  int total_;
};

Sweep::Sweep(const SceneSource& source, const SweepOptions& options) : source_(source), options_(options) {
  const Scene<Fixed> scene(source);
  rate_ = static_cast<double>(static_cast<int>(1 / static_cast<double>(scene.timeStep()) + 0.5));
  for (const int halvings : options.halvings) {
    if (halvings < kLeastHalvings || halvings > kMostHalvings) {
      throw std::runtime_error("steps of " + std::to_string(halvings) + " halvings are not among -1 to 3");
    }
    if (halvings != 0 && scene.hasEvents()) {
      throw std::runtime_error("the events of " + source.summary().name +
                               " come at numbered steps, so that it has one step size");
    }
  }
  for (const Method& method : methods()) {
    const bool soft = method.solver == SolverKind::softStep;
    for (const int halvings : options.halvings) {
      for (std::size_t i = 0; i < (soft ? options.kernels.size() : 1); ++i) {
        const KernelTarget kernel = soft ? options.kernels[i] : KernelTarget::best;
        for (const int count : method.counts) all_.push_back({{&method, kernel, halvings, count}, {}, {}});
      }
    }
  }
  total_ = static_cast<int>(all_.size()) * (options.rounds + 1);
}

std::string Sweep::lineOf(const Setting& setting) const {
  const bool one = options_.kernels.size() == 1 || setting.method->solver != SolverKind::softStep;
  std::string name = setting.method->name;
  if (!one) name += std::string(" (") + kernelName(setting.kernel) + ")";
  if (setting.halvings != 0)
    name += " at 1/" + std::to_string(static_cast<int>(rateOf(setting) + 0.5)) + " s";
  return name;
}

std::string Sweep::nameOf(const Setting& setting) const {
  return lineOf(setting) + ", " + std::to_string(setting.count) + " " + setting.method->unit;
}

void Sweep::time(const Yardstick& yardstick, Timed& timed) {
  if (!timed.failure.empty()) return;
  try {
    timed.milliseconds.push_back(1000 * withScalarOf(*timed.setting.method, [&](auto scalar) {
                                   return secondsPerSecond<decltype(scalar)>(
                                       source_, timed.setting, yardstick.steps(), options_.leastSeconds);
                                 }));
  } catch (const std::exception& error) {
    timed.failure = error.what();
    timed.milliseconds.push_back(0);
  }
}

ChartLine Sweep::newLine(const Setting& setting) const {
  ChartLine line{lineOf(setting), setting.method->scalar, setting.method->unit, {}};
  line.solver = setting.method->solver;
  line.precision = setting.method->precision;
  line.stepsPerSecond = rateOf(setting);
  return line;
}

ChartPoint Sweep::measure(const Yardstick& yardstick, const Timed& timed) const {
  ChartPoint point;
  point.count = timed.setting.count;
  point.failure = timed.failure;
  const auto [fastest, slowest] = std::minmax_element(timed.milliseconds.begin(), timed.milliseconds.end());
  point.milliseconds = median(timed.milliseconds);
  point.fastest = *fastest;
  point.slowest = *slowest;
  if (!point.failure.empty()) return point;
  try {
    yardstick.measure(timed.setting, options_.starts, point);
  } catch (const std::exception& error) {
    point.failure = error.what();
  }
  return point;
}

Chart Sweep::run() {
  tell("looking for what to measure errors by");
  const Yardstick yardstick(source_, options_.steps);
  for (int round = 1; round <= options_.rounds; ++round) {
    for (Timed& timed : all_) {
      tell("time, round " + std::to_string(round) + " of " + std::to_string(options_.rounds) + ": " +
           nameOf(timed.setting));
      time(yardstick, timed);
      ++done_;
    }
  }
  Chart chart;
  chart.scene = source_.summary().name;
  chart.stepsPerSecond = rate_;
  yardstick.describe(options_.starts, chart);
  const Setting* last = nullptr;
  for (const Timed& timed : all_) {
    const Setting& now = timed.setting;
    tell("error: " + nameOf(now));
    if (last == nullptr || lineOf(now) != lineOf(*last)) chart.lines.push_back(newLine(now));
    last = &now;
    chart.lines.back().points.push_back(measure(yardstick, timed));
    ++done_;
  }
  markFront(chart);
  return chart;
}

}  // namespace

Chart sweepScene(const SceneSource& source, const SweepOptions& options) {
  return Sweep(source, options).run();
}

}  // namespace samestep
