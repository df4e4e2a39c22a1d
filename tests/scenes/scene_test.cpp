// SPDX-License-Identifier: MIT
#include <samestep/scene.h>

#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samestep/decimal.h>
#include <samestep/draw.h>
#include "support/scalars.h"
#include "support/scenes.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;

template <class S>
class SceneTest : public ::testing::Test {};
TYPED_TEST_SUITE(SceneTest, AllScalars);

template <Scalar S>
S decimal(const char* text) {
  S value{};
  EXPECT_EQ(parseDecimal(std::string_view(text), value), DecimalStatus::ok);
  return value;
}

/// The only body beside the static one.
template <Scalar S>
const Body<S>& onlyBody(const Scene<S>& scene) {
  BodyId id;
  scene.space().eachBody([&](const Body<S>& body) {
    if (body.id() != scene.space().staticBody()) id = body.id();
  });
  return scene.space().body(id);
}

TYPED_TEST(SceneTest, NumbersAreReadExactlyFromTheirText) {
  const Scene<TypeParam> scene(SceneSource::fromText(
      R"({"samestep": 1, "bodies": [{"mass": 2, "moment": 1,
          "position": [0.1, -1234.00000000023283064365386962890625], "velocity": [1e2, -3],
          "angularVelocity": 0.30000000000000000001}]})",
      "test.json"));

  const Body<TypeParam>& body = onlyBody(scene);
  EXPECT_EQ(body.position().x, decimal<TypeParam>("0.1"));
  EXPECT_EQ(body.position().y, decimal<TypeParam>("-1234.00000000023283064365386962890625"));
  EXPECT_EQ(body.velocity(), Vector<TypeParam>(TypeParam(100), TypeParam(-3)));
  EXPECT_EQ(body.angularVelocity(), decimal<TypeParam>("0.30000000000000000001"));
}

TYPED_TEST(SceneTest, SettingsTimeStepAndHandlersAreTaken) {
  const Scene<TypeParam> scene(SceneSource::fromText(
      R"({"samestep": 1, "stepsPerSecond": 64,
          "settings": {"gravity": [1, -2], "iterations": 7, "damping": 0.5,
                       "collisionSlop": 0.25, "collisionBias": 0.125, "collisionPersistence": 9,
                       "worldExtent": 100},
          "handlers": [{"types": [1, 2], "do": "ignore"}, {"type": 3, "do": "count"},
                       {"all": true, "do": "slippery"}]})",
      "test.json"));

  EXPECT_EQ(scene.timeStep(), TypeParam(1) / TypeParam(64));
  const Settings<TypeParam>& settings = scene.space().settings();
  EXPECT_EQ(settings.gravity, Vector<TypeParam>(TypeParam(1), TypeParam(-2)));
  EXPECT_EQ(settings.iterations, 7);
  EXPECT_EQ(settings.damping, ratio<TypeParam>(1, 2));
  EXPECT_EQ(settings.collisionSlop, ratio<TypeParam>(1, 4));
  EXPECT_EQ(settings.collisionBias, ratio<TypeParam>(1, 8));
  EXPECT_EQ(settings.collisionPersistence, 9u);
  EXPECT_EQ(settings.worldExtent, TypeParam(100));
  EXPECT_EQ(scene.space().state().handlers.size(), 3u);
}

TYPED_TEST(SceneTest, JointsAreReadWithTheirFieldsAndAdjustedByEvents) {
  using S = TypeParam;
  Scene<S> scene(SceneSource::fromText(
      R"({"samestep": 1, "bodies": [
            {"name": "plank", "mass": 1, "moment": 1, "position": [1, 0],
             "grid": {"columns": 3, "across": [1, 0]}},
            {"name": "door", "mass": 2, "moment": 1, "position": [5, 5], "angle": 0.25}],
          "joints": [
            {"kind": "revolute", "a": "plank", "b": "plank", "links": 2,
             "anchorA": [0.5, 0], "anchorB": [-0.5, 0]},
            {"kind": "distance", "a": "static", "b": "plank", "copies": 3, "rest": 2, "hertz": 3,
             "damping": 0.5},
            {"name": "hinge", "kind": "revolute", "a": "static", "b": "door", "at": [4, 5], "lower": -1,
             "upper": 2,
             "motorSpeed": 3, "motorMax": 4, "breakForce": 500, "collide": true, "userData": 7}],
          "events": [
            {"tick": 2, "do": "adjust", "joint": "hinge", "motorSpeed": -3},
            {"tick": 3, "do": "unjoin", "joint": "hinge"},
            {"tick": 4, "do": "adjust", "joint": "hinge", "motorSpeed": 1}]})",
      "test.json"));
  Space<S>& space = scene.space();
  ASSERT_EQ(space.jointCount(), 6u);
  const Joint<S>& link = space.joint({1, 1});
  EXPECT_EQ(link.bodyA.index, 2u);
  EXPECT_EQ(link.bodyB.index, 3u);
  EXPECT_EQ(link.anchorB.x, ratio<S>(-1, 2));
  const Joint<S>& spring = space.joint({4, 1});
  EXPECT_EQ(spring.bodyA, space.staticBody());
  EXPECT_EQ(spring.bodyB.index, 3u);
  EXPECT_EQ(spring.spring, 1);
  EXPECT_EQ(spring.rest, S(2));
  const JointId id{5, 1};
  const Joint<S>& hinge = space.joint(id);
  EXPECT_EQ(hinge.anchorA, Vector<S>(S(4), S(5)));
  EXPECT_NEAR(double(hinge.anchorB.x), -0.968912, 1e-6);
  EXPECT_EQ(hinge.angle, ratio<S>(1, 4));
  EXPECT_EQ(hinge.upper, S(2));
  EXPECT_EQ(hinge.limited + hinge.motor + hinge.collideConnected, 3);
  EXPECT_EQ(hinge.userData, 7u);
  scene.step();
  scene.step();
  EXPECT_EQ(space.joint(id).motorSpeed, S(-3));
  EXPECT_EQ(space.joint(id).motorMax, S(4));
  scene.step();
  EXPECT_FALSE(space.contains(id));
  scene.step();
  EXPECT_EQ(scene.tick(), 4u);
}

TEST(SceneJointTest, WhatIsWrongWithAJointIsToldWithItsPlace) {
  const auto said = [](const std::string& joints) {
    try {
      Scene<Fixed>(
          SceneSource::fromText(R"({"samestep": 1, "bodies": [{"name": "box", "mass": 1, "moment": 1}],
                                             "joints": [)" +
                                    joints + "]}",
                                "test.json"));
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(said(R"({"kind": "glue", "a": "static", "b": "box"})"),
              HasSubstr("no kind of joint of this name"));
  EXPECT_THAT(said(R"({"kind": "weld", "a": "static", "b": "bix"})"), HasSubstr("no body is named \"bix\""));
  EXPECT_THAT(said(R"({"kind": "weld", "a": "box", "b": "box"})"), HasSubstr("both ends are on body"));
  EXPECT_THAT(said(R"({"kind": "weld", "a": "static", "b": "box", "hertz": 2000})"),
              HasSubstr("hertz are out of"));
  EXPECT_THAT(said(R"({"kind": "weld", "a": "static", "b": "box", "links": 1, "copies": 1})"),
              HasSubstr("not both"));
  EXPECT_THAT(said(R"({"kind": "weld", "a": "static", "b": "box", "hurtz": 2})"), HasSubstr("hurtz"));
}

TYPED_TEST(SceneTest, TheSoftStepHasSettingsOfItsOwn) {
  const Scene<TypeParam> scene(SceneSource::fromText(
      R"({"samestep": 1, "settings": {"solver": "soft step", "substeps": 6, "contactHertz": 20,
          "contactDamping": 5, "contactPushSpeed": 2, "contactMargin": 0.5, "bounceThreshold": 0.25}})",
      "test.json"));

  const Settings<TypeParam>& settings = scene.space().settings();
  EXPECT_EQ(settings.solver, SolverKind::softStep);
  EXPECT_EQ(settings.substeps, 6);
  EXPECT_EQ(settings.contactHertz, TypeParam(20));
  EXPECT_EQ(settings.contactDamping, TypeParam(5));
  EXPECT_EQ(settings.contactPushSpeed, TypeParam(2));
  EXPECT_EQ(settings.contactMargin, ratio<TypeParam>(1, 2));
  EXPECT_EQ(settings.bounceThreshold, ratio<TypeParam>(1, 4));
}

// The soft step, having become the default, was for a while what a scene got that asked for the other.
TYPED_TEST(SceneTest, SolverAndPrecisionAreThoseTheSceneNames) {
  const auto settingsOf = [](const std::string& settings) {
    return sceneFrom<TypeParam>(R"({"samestep": 1, "settings": )" + settings + "}").space().settings();
  };
  EXPECT_EQ(settingsOf("{}").solver, SolverKind::softStep);
  EXPECT_EQ(settingsOf(R"({"solver": "soft step"})").solver, SolverKind::softStep);
  EXPECT_EQ(settingsOf(R"({"solver": "sequential impulses"})").solver, SolverKind::sequentialImpulses);
  EXPECT_EQ(settingsOf(R"({"precision": "accurate"})").precision, ContactPrecision::accurate);
  EXPECT_EQ(settingsOf(R"({"precision": "fast"})").precision, ContactPrecision::fast);
}

/// A key of an object, with what stands beside it and, instead of it, in a scene without it.
struct KeyCase {
  const char* key;
  const char* value;
  const char* beside = "";
  const char* instead = "";
};

/// Expects that each key that an object of a scene may have, but one that is for events alone, changes the
/// world: none is read and forgotten.
template <Scalar S>
void eachKeyIsHeard(const std::string& before, const std::string& after, const std::vector<KeyCase>& cases,
                    std::string_view forEvents = {}) {
  const auto hashOf = [&](const std::string& inside) {
    return sceneFrom<S>(before + inside + after).space().hash();
  };
  for (const auto& [key, value, beside, instead] : cases) {
    const std::string with = "\"" + std::string(key) + "\": " + value + beside;
    EXPECT_NE(hashOf(with), hashOf(*instead != 0 ? instead : *beside != 0 ? beside + 1 : "")) << with;
  }
  // The refusal of a key that there is not says which ones there are.
  std::string known = complaint<S>(before + "\"?\": 0" + after);
  known.erase(0, known.find("known here: ") + std::strlen("known here: "));
  std::istringstream keys(known);
  std::size_t found = 0;
  for (std::string key; std::getline(keys >> std::ws, key, ','); ++found) {
    const auto same = [&](const KeyCase& one) { return one.key == key; };
    EXPECT_TRUE(key == forEvents || std::any_of(cases.begin(), cases.end(), same)) << key;
  }
  EXPECT_GE(found, cases.size());
}

TYPED_TEST(SceneTest, EachSettingIsHeard) {
  eachKeyIsHeard<TypeParam>(R"({"samestep": 1, "settings": {)", "}}",
                            {{"solver", "\"sequential impulses\""},
                             {"precision", "\"fast\""},
                             {"continuous", "true"},
                             {"gravity", "[0, 1]"},
                             {"iterations", "7"},
                             {"substeps", "3"},
                             {"damping", "0.5"},
                             {"collisionSlop", "0.25"},
                             {"collisionBias", "0.125"},
                             {"collisionPersistence", "9"},
                             {"contactHertz", "20"},
                             {"contactDamping", "3"},
                             {"contactPushSpeed", "1.5"},
                             {"contactMargin", "0.25"},
                             {"bounceThreshold", "2"},
                             {"worldExtent", "100"},
                             {"sleepTimeThreshold", "0.5"},
                             {"idleSpeedThreshold", "0.25"}});
}

TYPED_TEST(SceneTest, EachKeyOfABodyIsHeard) {
  eachKeyIsHeard<TypeParam>(R"({"samestep": 1, "bodies": [{)", "}]}",
                            {{"type", "\"kinematic\""},
                             {"mass", "2"},
                             {"moment", "3"},
                             {"rotates", "false"},
                             {"maySleep", "false"},
                             {"bullet", "true"},
                             {"position", "[1, 2]"},
                             {"angle", "1"},
                             {"velocity", "[1, 0]"},
                             {"angularVelocity", "1"},
                             {"userData", "18446744073709551615"},
                             {"gravityScale", "-0.5"},
                             {"linearDamping", "2"},
                             {"angularDamping", "3"},
                             {"speedLimit", "4"},
                             {"spinLimit", "5"},
                             {"shapes", R"([{"circle": 1}])"},
                             {"grid", R"({"columns": 2})"}},
                            "name");
}

TYPED_TEST(SceneTest, EachKeyOfAShapeIsHeard) {
  constexpr const char* kCircle = R"(, "circle": 1)";
  eachKeyIsHeard<TypeParam>(R"({"samestep": 1, "bodies": [{"shapes": [{)", "}]}]}",
                            {{"circle", "2", "", R"("circle": 1)"},
                             {"box", "[1, 2]", "", R"("circle": 1)"},
                             {"polygon", "[[0, 0], [1, 0], [0, 1]]", "", R"("circle": 1)"},
                             {"hull", "[[0, 0], [1, 0], [0, 1]]", "", R"("circle": 1)"},
                             {"segment", "[[0, 0], [1, 0]]", "", R"("circle": 1)"},
                             {"offset", "[1, 0]", kCircle},
                             {"neighbors", "[[-1, 0], [2, 1]]", R"(, "segment": [[0, 0], [1, 0]])"},
                             {"radius", "0.5", R"(, "box": [1, 1])"},
                             {"density", "2", kCircle},
                             {"mass", "2", kCircle},
                             {"friction", "0.5", kCircle},
                             {"elasticity", "0.5", kCircle},
                             {"surfaceVelocity", "[1, 0]", kCircle},
                             {"collisionType", "7", kCircle},
                             {"group", "3", kCircle},
                             {"category", "2", kCircle},
                             {"mask", "5", kCircle},
                             {"sensor", "true", kCircle},
                             {"material", "3", kCircle},
                             {"rollingResistance", "0.125", kCircle},
                             {"userData", "9", kCircle}});
}

TYPED_TEST(SceneTest, KeysThatMeanNothingWhereTheyStandAreRefused) {
  const auto said = [](const char* shape) {
    return complaint<TypeParam>(std::string(R"({"samestep": 1, "bodies": [{"shapes": [{)") + shape + "}]}]}");
  };
  EXPECT_THAT(said(R"("circle": 1, "radius": 1)"), HasSubstr("/radius: means nothing to a circle"));
  EXPECT_THAT(said(R"("box": [1, 1], "offset": [1, 0])"), HasSubstr("/offset: means nothing to a box"));
  EXPECT_THAT(said(R"("box": [1, 1], "neighbors": [[1, 0], [2, 0]])"),
              HasSubstr("/neighbors: means nothing to a box"));
  EXPECT_THAT(said(R"("circle": 1, "density": 1, "mass": 1)"),
              HasSubstr("/mass: a shape has a mass or a density"));
  EXPECT_THAT(complaint<TypeParam>(R"({"samestep": 1, "bodies": [{"rotates": false, "moment": 1}]})"),
              HasSubstr("/moment: what does not rotate has no moment"));
}

TYPED_TEST(SceneTest, AGridMakesCopiesWithNumberedNames) {
  Scene<TypeParam> scene(SceneSource::fromText(
      R"({"samestep": 1, "bodies": [{"name": "b", "mass": 1, "moment": 1, "position": [1, 2],
          "grid": {"columns": 3, "rows": 2, "across": [10, 0], "up": [0, 5]}}],
          "events": [{"tick": 1, "do": "velocity", "body": "b.4", "value": [60, 0]}]})",
      "test.json"));
  EXPECT_EQ(scene.space().bodyCount(), 7u);

  scene.step();
  scene.step();

  std::vector<TypeParam> places;
  scene.space().eachBody([&](const Body<TypeParam>& body) { places.push_back(body.position().x); });
  EXPECT_GT(places[5], TypeParam(11));
}

TYPED_TEST(SceneTest, EventsHappenBeforeTheStepOfTheirTickInOrder) {
  Scene<TypeParam> scene(SceneSource::fromText(
      R"({"samestep": 1, "bodies": [{"name": "b", "mass": 1, "moment": 1}],
          "events": [{"tick": 3, "do": "velocity", "body": "b", "value": [1, 0]},
                     {"tick": 2, "do": "velocity", "body": "b", "value": [5, 0]},
                     {"tick": 3, "do": "impulse", "body": "b", "value": [1, 0]},
                     {"tick": 4, "do": "remove", "body": "b"},
                     {"tick": 5, "do": "impulse", "body": "b", "value": [1, 0]}]})",
      "test.json"));

  scene.step();
  EXPECT_EQ(onlyBody(scene).velocity().x, TypeParam(0));
  scene.step();
  EXPECT_EQ(onlyBody(scene).velocity().x, TypeParam(5));
  scene.step();
  EXPECT_EQ(onlyBody(scene).velocity().x, TypeParam(2));
  scene.step();
  EXPECT_EQ(scene.space().bodyCount(), 1u);
  // The event for a body that is gone is left out.
  scene.step();
}

TYPED_TEST(SceneTest, ASpawnedBodyCanBeNamedByEvents) {
  Scene<TypeParam> scene(SceneSource::fromText(
      R"({"samestep": 1, "events": [
          {"tick": 2, "do": "spawn", "body": {"name": "s", "shapes": [{"circle": 1, "mass": 2}]}},
          {"tick": 2, "do": "velocity", "body": "s", "value": [3, 0]},
          {"tick": 9, "do": "remove", "body": "s"}]})",
      "test.json"));

  scene.step();
  scene.step();

  EXPECT_EQ(scene.space().bodyCount(), 2u);
  EXPECT_EQ(onlyBody(scene).velocity().x, TypeParam(3));
  while (scene.tick() < 9) scene.step();
  EXPECT_EQ(scene.space().bodyCount(), 1u);
}

TYPED_TEST(SceneTest, AnErrorNamesFileLinePathAndReason) {
  const std::string text =
      "{\n  \"samestep\": 1,\n  \"bodies\": [\n    {\"mass\": 1},\n    {\"mass\": 1,\n     \"moment\": -4}\n "
      " ]\n}\n";

  const std::string said = complaint<TypeParam>(text);

  EXPECT_THAT(said, HasSubstr("test.json:6: /bodies/1/moment: "));
  EXPECT_THAT(said, HasSubstr("Body::setMoment: moment is -4 kg m^2"));
}

TYPED_TEST(SceneTest, ALineIsCountedRightWhereANumberEndsIt) {
  EXPECT_THAT(complaint<TypeParam>("{\"samestep\":\n1\n,\"ticks\":\n-1\n}"),
              HasSubstr("test.json:4: /ticks"));
}

TYPED_TEST(SceneTest, MalformedScenesAreRefusedWithTheirReason) {
  const auto said = [](const char* inside) {
    return complaint<TypeParam>(std::string("{\"samestep\": 1, ") + inside + "}");
  };
  EXPECT_THAT(complaint<TypeParam>(""), HasSubstr("not JSON"));
  EXPECT_THAT(complaint<TypeParam>("{\"samestep\": 1"), HasSubstr("not JSON"));
  EXPECT_THAT(complaint<TypeParam>("{}"), HasSubstr("\"samestep\" is missing"));
  EXPECT_THAT(complaint<TypeParam>("{\"samestep\": 2}"), HasSubstr("/samestep: a whole number from 1 to 1"));
  EXPECT_THAT(complaint<TypeParam>("[1]"), HasSubstr("an object is wanted here"));
  EXPECT_THAT(said("\"bodys\": []"), HasSubstr("/bodys: unknown key \"bodys\""));
  EXPECT_THAT(said("\"ticks\": 5, \"ticks\": 6"), HasSubstr("stands twice"));
  EXPECT_THAT(said("\"ticks\": 0"), HasSubstr("a whole number from 1"));
  EXPECT_THAT(said("\"ticks\": 1.5"), HasSubstr("a whole number from 1"));
  EXPECT_THAT(said("\"ticks\": 99999999999999999999"), HasSubstr("a whole number from 1"));
  EXPECT_THAT(said("\"settings\": {\"gravity\": [1]}"),
              HasSubstr("/settings/gravity: an array of two numbers"));
  EXPECT_THAT(said("\"settings\": {\"gravity\": [1, \"2\"]}"), HasSubstr("/settings/gravity/1: a number"));
  EXPECT_THAT(said("\"settings\": {\"gravity\": [1, 1e400]}"), HasSubstr("too large a number: 1e400"));
  EXPECT_THAT(said("\"settings\": {\"iterations\": 0}"), HasSubstr("/settings/iterations: "));
  EXPECT_THAT(said("\"handlers\": [{\"types\": [1, 2], \"do\": \"dance\"}]"),
              HasSubstr("no handler of this name"));
  EXPECT_THAT(said("\"bodies\": [{\"type\": \"soft\"}]"), HasSubstr("/bodies/0/type: "));
  EXPECT_THAT(said("\"bodies\": [{\"position\": [1e7, 0]}]"), HasSubstr("/bodies/0/position: "));
  EXPECT_THAT(said("\"bodies\": [{\"shapes\": [{\"friction\": 1}]}]"), HasSubstr("/bodies/0/shapes/0: "));
  EXPECT_THAT(said("\"bodies\": [{\"shapes\": [{\"circle\": -1}]}]"),
              HasSubstr("a circle: radius is -1 m, allowed are 0 and above"));
  EXPECT_THAT(said("\"bodies\": [{\"shapes\": [{\"circle\": 1, \"box\": [1, 1]}]}]"),
              HasSubstr("one thing only"));
  EXPECT_THAT(said("\"bodies\": [{\"shapes\": [{\"polygon\": [[0,0],[1,1],[2,2]]}]}]"),
              HasSubstr("/polygon: "));
  EXPECT_THAT(said("\"bodies\": [{\"name\": \"a\"}, {\"name\": \"a\"}]"),
              HasSubstr("there is a body named \"a\""));
  EXPECT_THAT(said("\"bodies\": [{\"grid\": {\"columns\": 10000, \"rows\": 10000}}]"),
              HasSubstr("too many bodies"));
  // A few bytes that ask for millions.
  std::string shapes;
  for (int i = 0; i < 100; ++i) shapes += std::string(i == 0 ? "" : ",") + "{\"circle\": 1}";
  const std::string grid =
      "\"bodies\": [{\"shapes\": [" + shapes + "], \"grid\": {\"columns\": 250, \"rows\": 250}}]";
  EXPECT_THAT(said(grid.c_str()), HasSubstr("/bodies/0/grid: too many shapes: at most 65536"));
  EXPECT_THAT(said("\"bodies\": [{\"grid\": {\"columns\": 9, \"across\": [1e6, 0]}}]"),
              HasSubstr("leads out of"));
  EXPECT_THAT(said("\"events\": [{\"tick\": 1, \"do\": \"remove\", \"body\": \"x\"}]"),
              HasSubstr("no body of this name"));
  EXPECT_THAT(said("\"events\": [{\"tick\": 1, \"do\": \"explode\", \"body\": \"x\"}]"),
              HasSubstr("no command"));
}

TYPED_TEST(SceneTest, AMassBesideAShapeWithMassIsRefused) {
  const auto said = [](const char* body) {
    return complaint<TypeParam>(std::string("{\"samestep\": 1, \"bodies\": [\n") + body + "]}");
  };
  EXPECT_THAT(said(R"({"mass": 5, "shapes": [{"circle": 1}, {"circle": 1, "mass": 2}]})"),
              HasSubstr("test.json:2: /bodies/0/mass: means nothing to a body of which a shape has a mass"));
  EXPECT_THAT(said(R"({"moment": 5, "shapes": [{"circle": 1, "density": 2}]})"),
              HasSubstr("test.json:2: /bodies/0/moment: means nothing"));
  EXPECT_EQ(said(R"({"mass": 5, "moment": 5, "shapes": [{"circle": 1, "mass": 0}]})"), "");
}

TYPED_TEST(SceneTest, ASceneThatCannotBeSteppedIsRefusedWithItsPlace) {
  const auto said = [](const char* rest) -> std::string {
    Scene<TypeParam> scene(
        SceneSource::fromText(std::string("{\"samestep\": 1,\n") + rest + "}", "test.json"));
    try {
      for (int i = 0; i < 9; ++i) scene.step();
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(said("\"bodies\": [\n{\"name\": \"a\", \"shapes\": [{\"circle\": 1}]}]"),
            "test.json:3: /bodies/0: mass is 0: set it, or give the body a shape with a mass");
  EXPECT_THAT(said(R"("bodies": [{"mass": 2}])"), HasSubstr("test.json:2: /bodies/0: moment is 0"));
  EXPECT_EQ(said(R"("bodies": [{"rotates": false, "mass": 2}, {"type": "static"}, {"type": "kinematic"}])"),
            "");
  EXPECT_THAT(said("\"events\": [\n{\"tick\": 5, \"do\": \"spawn\",\n\"body\": {\"mass\": 1}}]"),
              HasSubstr("test.json:4: /events/0/body: moment is 0"));
}

TYPED_TEST(SceneTest, ASpawnThatCannotBeIsRefusedBeforeTheSceneRuns) {
  EXPECT_THAT(complaint<TypeParam>(R"({"samestep": 1, "settings": {"worldExtent": 10},
      "events": [{"tick": 5, "do": "spawn", "body": {"position": [20, 0], "mass": 1, "moment": 1}}]})"),
              HasSubstr("test.json:2: /events/0/body: Space::add: the centre of mass is at (20, 0) m"));
}

TYPED_TEST(SceneTest, AnEventThatCannotBeDoneIsToldWithItsPlace) {
  Scene<TypeParam> scene(SceneSource::fromText(R"({"samestep": 1,
      "bodies": [{"name": "b", "mass": 1, "moment": 1}],
      "events": [{"tick": 1, "do": "velocity", "body": "b", "value": [1, 0]},
                 {"tick": 2, "do": "velocity", "body": "b", "value": [2000, 0]}]})",
                                               "test.json"));
  scene.step();
  try {
    scene.step();
    ADD_FAILURE();
  } catch (const SceneError& error) {
    EXPECT_STREQ(
        error.what(),
        "test.json:4: \"velocity\" at tick 2: Body::setVelocity: velocity is (2000, 0) m/s, allowed are "
        "-1024 to 1024 m/s");
  }
}

TYPED_TEST(SceneTest, FilesAreLookedForOnDiskUnlessOthersAreGiven) {
  for (const char* text : {R"({"samestep": 1, "bodies": [{"csv": "nowhere.csv"}]})",
                           R"({"samestep": 1, "inputs": "nowhere.csv"})"}) {
    EXPECT_EQ(complaint<TypeParam>(text), "nowhere.csv: is not in memory");
    try {
      Scene<TypeParam> scene(SceneSource::fromText(text, "test.json"));
      ADD_FAILURE() << text;
    } catch (const SceneError& error) {
      EXPECT_THAT(error.what(), HasSubstr("nowhere.csv: cannot be read"));
    }
  }
}

TYPED_TEST(SceneTest, DeepNestingIsRefusedBeforeItCanHarm) {
  const std::string deep(100000, '[');

  EXPECT_THAT(complaint<TypeParam>("{\"samestep\": " + deep), HasSubstr("nested deeper than 32"));
}

// Each of them takes fifty times as many bytes as in its file.
TYPED_TEST(SceneTest, ATextOfMoreValuesThanAllowedIsRefused) {
  std::string text = "{\"samestep\": 1,\n\"bodies\": [0";
  for (int i = 0; i < 1 << 21; ++i) text += ",0";
  text += "]}";

  EXPECT_THAT(complaint<TypeParam>(text), HasSubstr(":2: more than 2097152 values"));
}

TYPED_TEST(SceneTest, FamiliesComeInTheSizeAskedFor) {
  EXPECT_EQ(Scene<TypeParam>(SceneSource::find("pyramid:7")).space().bodyCount(), 28u + 2u);
  EXPECT_EQ(Scene<TypeParam>(SceneSource::find("soup:50")).space().bodyCount(), 50u + 4u);
  for (const char* wrong : {"pyramid:0", "pyramid:", "pyramid:1x", "pyramid:201", "soup:-1", "nothing:3"}) {
    EXPECT_THROW(SceneSource::find(wrong), SceneError) << wrong;
  }
}

TYPED_TEST(SceneTest, EverySceneOfTheFolderRuns) {
  const std::vector<SceneSummary> scenes = listScenes();
  EXPECT_GE(scenes.size(), 12u);
  for (const SceneSummary& summary : scenes) {
    SCOPED_TRACE(summary.name);
    EXPECT_FALSE(summary.about.empty());
    Scene<TypeParam> scene(SceneSource::find(summary.name));
    scene.step();
    EXPECT_GT(scene.space().shapeCount(), 0u);
  }
}

// The peers' scenes are data: of each, the sizes that their description tells.
TEST(SceneFilesTest, ThePeersScenesHaveTheirBodies) {
  const auto bodies = [](const char* name) {
    return Scene<Fixed>(SceneSource::find(name)).space().bodyCount();
  };
  EXPECT_EQ(bodies("pyramid40"), 820u + 2u);
  EXPECT_EQ(bodies("pyramids25"), 25u * 55u + 2u);
  EXPECT_EQ(bodies("circles"), 2000u + 4u);
  EXPECT_EQ(bodies("tumbler"), 1000u + 2u);
  EXPECT_EQ(bodies("soup"), 1000u + 4u);
  EXPECT_EQ(bodies("sparse"), 10000u + 1u);
}

TEST(SceneFilesTest, TheArenaIsDrivenByThousandsOfInputs) {
  Scene<Fixed> scene(SceneSource::find("arena"));
  std::uint32_t commands = 0;
  while (scene.tick() < 1200) {
    while (scene.nextCommand() != nullptr) ++commands;
    scene.step();
  }
  EXPECT_GT(commands, 3000u);
}

TYPED_TEST(SceneTest, APictureIsTheSameEachTimeAndShowsEachBody) {
  Scene<TypeParam> scene(SceneSource::find("stack"));
  for (int i = 0; i < 20; ++i) scene.step();

  const std::string picture = drawSvg(scene.space(), "a < b & c");

  EXPECT_EQ(drawSvg(scene.space(), "a < b & c"), picture);
  EXPECT_THAT(picture, HasSubstr("a &lt; b &amp; c"));
  EXPECT_THAT(picture, HasSubstr(">11</text>"));
  EXPECT_EQ(picture.substr(picture.size() - 7), "</svg>\n");
}

}  // namespace
}  // namespace samestep
