// SPDX-License-Identifier: MIT
// A game's own callbacks, inputs and claims in the program: by a main of its own, and by a plug-in.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samestep/recorder.h>

#include <samestep/circle_shape.h>
#include <samestep/segment_shape.h>

#include "game/game.h"
#include "support/world.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string said;
};

/// A ball that bounces by the game's own handler on a floor, and jumps.
std::vector<std::uint8_t> match(std::uint8_t height) {
  Space<Fixed> space;
  const Wiring<Fixed> wiring = game::wirings().fixed;
  wiring.connect(space, nullptr);
  space.setGravity({Fixed(0), Fixed(-10)});
  space.addWildcardHandler(7, game::kBounce);
  Body<Fixed> body(Fixed(1), Fixed(1));
  body.setPosition({Fixed(0), Fixed(3)});
  const BodyId ball = space.add(body);
  space.add(circleShape<Fixed>(ball, Fixed(1)));
  Shape<Fixed> floor =
      segmentShape<Fixed>(space.staticBody(), {Fixed(-9), Fixed(0)}, {Fixed(9), Fixed(0)}, Fixed(0));
  floor.setCollisionType(7);
  space.add(floor);
  std::vector<std::uint8_t> bytes;
  Recorder<Fixed> recorder(space, ratio<Fixed>(1, 60), bytes, wiring);
  for (int tick = 1; tick <= 90; ++tick) {
    const std::uint8_t jump[] = {9};
    if (tick == 60) recorder.input(jump);
    recorder.step();
  }
  const std::uint8_t claimed[] = {height};
  recorder.claim("height", claimed);
  recorder.finish();
  return bytes;
}

class GameTest : public ::testing::Test {
 protected:
  GameTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "samestep-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~GameTest() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return folder_ + "/" + name; }
  void write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    std::ofstream(file(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  Outcome run(const std::string& program, const std::string& arguments) const {
    const std::string command = "'" + program + "' " + arguments + " >'" + file("said") + "' 2>&1";
    const int status = std::system(command.c_str());
    std::ifstream stream(file("said"), std::ios::binary);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()}};
  }

 private:
  std::string folder_;
};

TEST_F(GameTest, WithoutTheGameAnErrorNamesTheCallback) {
  write("a.rec", match(1));
  const Outcome outcome = run(SAMESTEP_PROGRAM, "verify '" + file("a.rec") + "'");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.said, HasSubstr("its handlers need one registered under 1000"));
}

TEST_F(GameTest, AMainOfItsOwnAndAPlugInVerifyTheSame) {
  write("good.rec", match(1));
  write("liar.rec", match(99));
  const std::string plugin = "--game '" SAMESTEP_GAME_PLUGIN "' ";
  const auto both = [&](const std::string& arguments, const char* word) {
    const Outcome own = run(SAMESTEP_GAME, std::string(word) + " " + arguments);
    const Outcome loaded = run(SAMESTEP_PROGRAM, std::string(word) + " " + plugin + arguments);
    EXPECT_EQ(own.code, loaded.code) << own.said << loaded.said;
    return loaded;
  };
  const Outcome good = both("'" + file("good.rec") + "'", "verify");
  EXPECT_EQ(good.code, 0) << good.said;
  EXPECT_THAT(good.said, HasSubstr("1 claim holds"));
  const Outcome liar = both("--json '" + file("liar.rec") + "'", "verify");
  EXPECT_EQ(liar.code, 1) << liar.said;
  EXPECT_THAT(liar.said, HasSubstr("\"verdict\":\"false claim\""));
  EXPECT_EQ(both("--jobs 2 '" + file("good.rec") + "' '" + file("good.rec") + "'", "verify").code, 0);
  EXPECT_EQ(both("'" + file("good.rec") + "' '" + file("liar.rec") + "'", "diff").code, 0);
  EXPECT_EQ(both("'" + file("good.rec") + "' --tick 30 -o '" + file("a.svg") + "'", "draw").code, 0);
  EXPECT_EQ(both("'" + file("good.rec") + "' -o '" + file("b.svg") + "'", "film").code, 0);
}

TEST_F(GameTest, APlugInThatIsNoneIsRefused) {
  write("a.rec", match(1));
  const auto said = [&](const std::string& library) {
    const Outcome outcome = run(SAMESTEP_PROGRAM, "verify --game '" + library + "' '" + file("a.rec") + "'");
    EXPECT_EQ(outcome.code, 2);
    return outcome.said;
  };
  EXPECT_THAT(said(file("nothing.so")), HasSubstr("nothing.so: cannot be loaded"));
  EXPECT_THAT(said(file("a.rec")), HasSubstr("a.rec: cannot be loaded"));
  EXPECT_THAT(said("a.rec"), HasSubstr("a.rec: cannot be loaded"));
}

TEST_F(GameTest, AnInputThatTheGameRefusesIsTold) {
  // A world without the player.
  Space<Fixed> space;
  std::vector<std::uint8_t> bytes;
  Wiring<Fixed> wiring = game::wirings().fixed;
  wiring.connect(space, nullptr);
  wiring.applyInput = [](Space<Fixed>&, std::span<const std::uint8_t>, void*) {};
  Recorder<Fixed> recorder(space, ratio<Fixed>(1, 60), bytes, wiring);
  recorder.step();
  const std::uint8_t jump[] = {0x2a, 0x07};
  recorder.input(jump);
  recorder.step();
  recorder.finish();
  write("a.rec", bytes);
  const Outcome outcome = run(SAMESTEP_GAME, "verify '" + file("a.rec") + "'");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.said, HasSubstr("before tick 2 the game refuses its input ("));
  EXPECT_THAT(outcome.said, HasSubstr("input: 2 bytes: 2a 07"));
}

}  // namespace
}  // namespace samestep
