// SPDX-License-Identifier: MIT
// Every scene gives the hashes that were written down for it, on every machine.
#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/scene.h>

namespace samestep {
namespace {

constexpr int kTicks = 600;
constexpr std::uint32_t kLargest = 1000;

std::string goldenFile(const std::string& name) { return std::string(SAMESTEP_GOLDEN) + "/" + name; }

/// Scenes with too many moving bodies to have golden files.
std::vector<std::string> largeScenes() {
  std::ifstream stream(goldenFile("large.txt"));
  std::vector<std::string> names;
  for (std::string name; std::getline(stream, name);) names.push_back(name);
  return names;
}

bool isLarge(const std::string& name) {
  const std::vector<std::string> large = largeScenes();
  return std::find(large.begin(), large.end(), name) != large.end();
}

/// Names of the scenes in the folder: families have a colon in their names.
std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const SceneSummary& scene : listScenes()) {
    if (scene.name.find(':') == std::string::npos) names.push_back(scene.name);
  }
  return names;
}

struct Golden {
  std::string scene;
  std::string scalar;
};
std::ostream& operator<<(std::ostream& stream, const Golden& golden) {
  return stream << golden.scene << " in " << golden.scalar;
}

std::vector<Golden> allGolden() {
  std::vector<Golden> all;
  for (const std::string& name : sceneNames()) {
    if (isLarge(name)) continue;
    all.push_back({name, "fixed"});
#ifndef SAMESTEP_FIXED_ONLY
    all.push_back({name, "double"});
#endif
  }
  return all;
}

template <Scalar S>
void compare(const std::string& name, std::istream& golden) {
  Scene<S> scene(SceneSource::find(name));
  for (std::uint64_t tick = 1; tick <= kTicks; ++tick) {
    scene.step();
    std::uint64_t expectedTick = 0;
    std::string expected;
    golden >> expectedTick >> expected;
    ASSERT_EQ(expectedTick, tick);
    std::ostringstream hash;
    hash << std::hex;
    hash.width(16);
    hash.fill('0');
    hash << scene.space().hash();
    ASSERT_EQ(hash.str(), expected) << "tick " << tick;
  }
}

class GoldenTest : public ::testing::TestWithParam<Golden> {};

TEST_P(GoldenTest, EveryTickHasTheHashWrittenDown) {
  const Golden golden = GetParam();
  const std::string file = goldenFile(golden.scene + "." + golden.scalar + ".txt");
  std::ifstream stream(file);
  ASSERT_TRUE(stream) << file << " is missing; scripts/golden writes it";
#ifndef SAMESTEP_FIXED_ONLY
  if (golden.scalar == "double") return compare<double>(golden.scene, stream);
#endif
  compare<Fixed>(golden.scene, stream);
}

std::string testName(const ::testing::TestParamInfo<Golden>& info) {
  std::string name = info.param.scene + "_" + info.param.scalar;
  // Only letters and digits are allowed here.
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Scenes, GoldenTest, ::testing::ValuesIn(allGolden()), testName);

TEST(GoldenFilesTest, ExactlyTheLargeScenesHaveNone) {
  for (const std::string& name : sceneNames()) {
    const Scene<Fixed> scene(SceneSource::find(name));
    std::uint32_t moving = 0;
    scene.space().eachBody([&](const Body<Fixed>& body) { moving += body.isDynamic() ? 1 : 0; });
    EXPECT_EQ(moving > kLargest, isLarge(name)) << name;
  }
}

}  // namespace
}  // namespace samestep
