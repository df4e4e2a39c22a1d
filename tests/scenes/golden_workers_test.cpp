// SPDX-License-Identifier: MIT
// Every golden scene comes out the same with any number of workers and with every kernel.
#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/scene.h>

namespace samestep {
namespace {

/// In most scenes enough for something to have fallen upon something; fewer ticks for more bodies.
constexpr std::uint64_t kTicks = 120;
constexpr std::uint64_t kBodyTicks = 10000;

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const SceneSummary& scene : listScenes()) {
    if (scene.name.find(':') == std::string::npos) names.push_back(scene.name);
  }
  return names;
}

/// Solver that a scene is played with in place of its own.
struct Way {
  const char* name;
  bool soft;
  ContactPrecision precision;
};
constexpr Way kWays[] = {{"own", false, ContactPrecision::accurate},
                         {"soft", true, ContactPrecision::accurate},
                         {"fast", true, ContactPrecision::fast}};

template <Scalar S>
std::vector<std::uint64_t> play(const std::string& name, const Way& way, TaskRunner* workers,
                                KernelTarget kernel) {
  Scene<S> scene(SceneSource::find(name));
  if (way.soft) {
    scene.space().setSolver(SolverKind::softStep);
    scene.space().setPrecision(way.precision);
  }
  scene.space().forceKernel(kernel);
  scene.space().setWorkers(workers, Sharing::always);
  std::vector<std::uint64_t> hashes;
  const std::uint64_t ticks = std::clamp<std::uint64_t>(kBodyTicks / scene.space().bodyCount(), 2, kTicks);
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    scene.step();
    hashes.push_back(scene.space().hash());
  }
  return hashes;
}

template <Scalar S>
void compare(const std::string& name) {
  std::vector<std::unique_ptr<WorkerPool>> pools;
  for (int workers = 1; workers <= 8; ++workers) pools.push_back(std::make_unique<WorkerPool>(workers));
  for (const Way& way : kWays) {
    if (way.precision == ContactPrecision::fast && !std::is_same_v<S, Fixed>) continue;
    const auto alone = play<S>(name, way, nullptr, KernelTarget::best);
    for (const auto& pool : pools) {
      EXPECT_EQ(alone, play<S>(name, way, pool.get(), KernelTarget::best))
          << way.name << ", " << pool->workers() << " workers";
    }
    for (const KernelTarget kernel : availableKernels()) {
      EXPECT_EQ(alone, play<S>(name, way, nullptr, kernel)) << way.name << ", " << kernelName(kernel);
    }
  }
}

std::string testName(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  // Only letters and digits are allowed here.
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class GoldenWorkersTest : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenWorkersTest, WorkersAndKernelsChangeNoHash) {
  compare<Fixed>(GetParam());
#ifndef SAMESTEP_FIXED_ONLY
  compare<double>(GetParam());
#endif
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenWorkersTest, ::testing::ValuesIn(sceneNames()), testName);

}  // namespace
}  // namespace samestep
