// SPDX-License-Identifier: MIT
// What happens at which tick, from a scene and from a file of inputs.
#include <samestep/scene.h>

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/scenes.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

template <class S>
class SceneEventsTest : public ::testing::Test {};
TYPED_TEST_SUITE(SceneEventsTest, AllScalars);

const std::string kBody = R"("bodies": [{"name": "b", "mass": 1, "moment": 1}])";
const std::string kHeader = "tick,body,do,x,y\n";

template <Scalar S>
Scene<S> withInputs(const std::string& lines) {
  return sceneFrom<S>("{\"samestep\": 1, " + kBody + ", \"inputs\": \"keys\"}", {{"keys", lines}});
}

/// The world after some steps of a scene.
template <Scalar S>
std::uint64_t hashOf(Scene<S>&& scene, int steps) {
  for (int i = 0; i < steps; ++i) scene.step();
  return scene.space().hash();
}

TYPED_TEST(SceneEventsTest, ALineOfInputsIsTheEventOfItsCommand) {
  const struct {
    const char* line;
    const char* event;
  } same[] = {
      {"2,b,impulse,1,-2.5", R"("do": "impulse", "value": [1, -2.5])"},
      {"2,b,force,1e2,3", R"("do": "force", "value": [100, 3])"},
      {"2,b,velocity,4,0.1", R"("do": "velocity", "value": [4, 0.1])"},
      {"2,b,position,-3,7", R"("do": "position", "value": [-3, 7])"},
      {"2,b,angularVelocity,0.3,", R"("do": "angularVelocity", "value": 0.3)"},
      {"2,b,angle,1.5,", R"("do": "angle", "value": 1.5)"},
      {"2,b,remove,,", R"("do": "remove")"},
  };
  const std::uint64_t untouched = hashOf(withInputs<TypeParam>(kHeader), 3);

  for (const auto& [line, event] : same) {
    SCOPED_TRACE(line);
    const std::uint64_t byLine = hashOf(withInputs<TypeParam>(kHeader + line + "\n"), 3);
    const std::string scene =
        "{\"samestep\": 1, " + kBody + R"(, "events": [{"tick": 2, "body": "b", )" + event + "}]}";
    EXPECT_EQ(byLine, hashOf(sceneFrom<TypeParam>(scene), 3));
    EXPECT_NE(byLine, untouched);
  }
}

TYPED_TEST(SceneEventsTest, InputsAreTakenByTickThenByLine) {
  const std::string lines =
      "# what was pressed\r\n\r\n" + kHeader + "3,b,velocity,1,0\r\n2,b,velocity,5,0\n\n3,b,impulse,1,0";
  Scene<TypeParam> scene = withInputs<TypeParam>(lines);

  const auto speed = [&] {
    TypeParam x{};
    scene.space().eachBody([&](const Body<TypeParam>& body) { x += body.velocity().x; });
    return x;
  };
  scene.step();
  EXPECT_EQ(speed(), TypeParam(0));
  scene.step();
  EXPECT_EQ(speed(), TypeParam(5));
  scene.step();
  EXPECT_EQ(speed(), TypeParam(2));
}

TYPED_TEST(SceneEventsTest, MalformedInputsAreRefusedWithLineAndReason) {
  const auto said = [](const std::string& lines) {
    return complaint<TypeParam>("{\"samestep\": 1, " + kBody + ", \"inputs\": \"keys\"}", {{"keys", lines}});
  };
  const auto saidOf = [&](const std::string& line) { return said(kHeader + "1,b,angle,1,\n" + line + "\n"); };

  EXPECT_THAT(said(""), StartsWith("keys:1: the first line must be: tick,body,do,x,y"));
  EXPECT_THAT(said("\n\ntick,body\n"), StartsWith("keys:3: the first line must be: "));
  EXPECT_THAT(saidOf("1,b,angle,1"), StartsWith("keys:3: five fields are wanted"));
  EXPECT_THAT(saidOf("1,b,angle,1,,"), StartsWith("keys:3: five fields are wanted"));
  for (const char* tick : {"", "0", "-1", "1.5", "x", "1099511627777", "99999999999999999999"}) {
    EXPECT_THAT(saidOf(std::string(tick) + ",b,angle,1,"),
                StartsWith("keys:3: the tick must be a whole number from 1 to 1099511627776"))
        << tick;
  }
  EXPECT_THAT(saidOf("1,c,angle,1,"), StartsWith("keys:3: no body is named \"c\""));
  EXPECT_THAT(saidOf("1,b,explode,1,"), StartsWith("keys:3: no command \"explode\" for inputs"));
  EXPECT_THAT(saidOf("1,b,spawn,,"), StartsWith("keys:3: no command \"spawn\" for inputs"));
  EXPECT_THAT(saidOf("1,b,input,,"), StartsWith("keys:3: no command \"input\" for inputs"));
  EXPECT_THAT(saidOf("1,b,impulse,left,0"), StartsWith("keys:3: x, \"left\": not a number"));
  EXPECT_THAT(saidOf("1,b,impulse,1,1e400"), StartsWith("keys:3: y, \"1e400\": too large a number"));
  EXPECT_THAT(saidOf("1,b,impulse,1,"), StartsWith("keys:3: y, \"\": not a number"));
  EXPECT_THAT(saidOf("1,b,angle,,"), StartsWith("keys:3: x, \"\": not a number"));
  EXPECT_THAT(saidOf("1,b,angle,1,2"), StartsWith("keys:3: y means nothing to angle, and must be empty"));
  EXPECT_THAT(saidOf("1,b,remove,0,"), StartsWith("keys:3: x means nothing to remove, and must be empty"));
}

TYPED_TEST(SceneEventsTest, AnEventHasTheKeysOfItsCommand) {
  const auto said = [](const std::string& event) {
    return complaint<TypeParam>("{\"samestep\": 1, " + kBody + ", \"events\": [{\"tick\": 1, " + event +
                                "}]}");
  };
  const std::string body = R"(, "body": "b")";

  EXPECT_EQ(said(R"("do": "impulse", "value": [1, 2], "arm": [1, 0])" + body), "");
  EXPECT_THAT(said(R"("do": "velocity", "value": [1, 2], "arm": [1, 0])" + body),
              HasSubstr("/events/0/arm: unknown key \"arm\"; known here: tick, do, body, value"));
  EXPECT_THAT(said(R"("do": "remove", "value": 1)" + body),
              HasSubstr("/events/0/value: unknown key \"value\""));
  EXPECT_THAT(said(R"("do": "spawn", "body": {}, "value": 1)"), HasSubstr("/events/0/value: unknown key"));
  EXPECT_THAT(said(R"("do": "spawn", "body": {"grid": {}})"), HasSubstr("a spawn brings in one body"));
  EXPECT_THAT(said(R"("do": "force")" + body), HasSubstr("\"value\" is missing"));
  EXPECT_THAT(said(R"("do": "force", "value": 1)" + body), HasSubstr("an array of two numbers"));
  EXPECT_THAT(said(R"("do": "angle", "value": [1, 2])" + body), HasSubstr("/value: a number"));
}

}  // namespace
}  // namespace samestep
