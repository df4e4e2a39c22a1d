// SPDX-License-Identifier: MIT
// Bodies from tables.
#include <samestep/scene.h>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/scenes.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

template <class S>
class SceneCsvTest : public ::testing::Test {};
TYPED_TEST_SUITE(SceneCsvTest, AllScalars);

const std::string kHeader =
    "body,type,x,y,angle,vx,vy,w,shape,radius,n,v0x,v0y,v1x,v1y,v2x,v2y,v3x,v3y,v4x,v4y,v5x,v5y,v6x,v6y,v7x,"
    "v7y\n";
const std::string kNoVertices(15, ',');

const std::string kScene =
    R"({"samestep": 1, "bodies": [{"csv": "table", "density": 2, "friction": 0.5, "elasticity": 0.25}]})";

TYPED_TEST(SceneCsvTest, RowsBecomeBodiesAndShapes) {
  using S = TypeParam;
  const Scene<S> scene = sceneFrom<S>(
      kScene, {{"table", "# a word\n" + kHeader +
                             "a,dynamic,1,2,0.5,3,-4,0.25,polygon,0,3,0,0,1,0,0,1,,,,,,,,,,\r\n"
                             "a,dynamic,1,2,0.5,3,-4,0.25,circle,0.5,0," +
                             kNoVertices + "\n\nb,kinematic,5,6,0,1,0,0,circle,2,0," + kNoVertices +
                             "\nc,static,7,8,0,0,0,0,polygon,0.125,4,0,0,1,0,1,1,0,1,,,,,,,,"}});

  std::vector<Body<S>> bodies;
  scene.space().eachBody([&](const Body<S>& body) {
    if (body.id() != scene.space().staticBody()) bodies.push_back(body);
  });
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_EQ(bodies[0].type(), BodyType::dynamicBody);
  EXPECT_NEAR(static_cast<double>(bodies[0].position().x), 1, 1e-8);
  EXPECT_NEAR(static_cast<double>(bodies[0].position().y), 2, 1e-8);
  EXPECT_EQ(bodies[0].angle(), ratio<S>(1, 2));
  EXPECT_EQ(bodies[0].velocity(), Vector<S>(S(3), S(-4)));
  EXPECT_EQ(bodies[0].angularVelocity(), ratio<S>(1, 4));
  EXPECT_EQ(bodies[0].mass(), S(1)) << "of its first shape, half a square metre of 2 kg each";
  EXPECT_EQ(bodies[1].type(), BodyType::kinematicBody);
  EXPECT_EQ(bodies[2].type(), BodyType::staticBody);
  EXPECT_EQ(bodies[2].position(), Vector<S>(S(7), S(8)));

  std::vector<BodyId> owners;
  scene.space().eachShape([&](const Shape<S>& shape) {
    owners.push_back(shape.body());
    EXPECT_EQ(shape.friction(), ratio<S>(1, 2));
    EXPECT_EQ(shape.elasticity(), ratio<S>(1, 4));
  });
  EXPECT_EQ(owners, (std::vector<BodyId>{bodies[0].id(), bodies[0].id(), bodies[1].id(), bodies[2].id()}));
}

TYPED_TEST(SceneCsvTest, MalformedTablesAreRefusedWithLineAndReason) {
  const auto said = [](const std::string& table) { return complaint<TypeParam>(kScene, {{"table", table}}); };
  const auto saidOf = [&](const std::string& row) { return said(kHeader + row + "\n"); };
  const std::string place = "a,dynamic,1,2,0,0,0,0,";

  EXPECT_THAT(said(""), StartsWith("table:1: the first line must be: body,type,"));
  EXPECT_THAT(said("# only a word\n\n"), StartsWith("table:1: the first line must be: "));
  EXPECT_THAT(said("\nbody,type\n"), StartsWith("table:2: the first line must be: "));
  EXPECT_THAT(saidOf("a,dynamic,1"), StartsWith("table:2: 27 columns are wanted"));
  EXPECT_THAT(saidOf(place + "circle,1,0," + kNoVertices + ","),
              StartsWith("table:2: 27 columns are wanted"));
  EXPECT_THAT(saidOf("a,soft,1,2,0,0,0,0,circle,1,0," + kNoVertices),
              StartsWith("table:2: /type: dynamic, "));
  EXPECT_THAT(saidOf("a,dynamic,1,2,zero,0,0,0,circle,1,0," + kNoVertices),
              StartsWith("table:2: /column 5: not a number"));
  EXPECT_THAT(saidOf("a,dynamic,1e99,2,0,0,0,0,circle,1,0," + kNoVertices), StartsWith("table:2: "));
  EXPECT_THAT(saidOf(place + "square,1,0," + kNoVertices),
              StartsWith("table:2: /shape: circle or polygon is wanted"));
  EXPECT_THAT(saidOf(place + "circle,-1,0," + kNoVertices),
              HasSubstr("radius is -1 m, allowed are 0 and above"));
  for (const char* n : {"", "9", "-1", "33", "x"}) {
    EXPECT_THAT(saidOf(place + "polygon,0," + n + "," + kNoVertices),
                StartsWith("table:2: /n: a number from 0 to 8 is wanted"))
        << n;
  }
  EXPECT_THAT(saidOf(place + "polygon,0,0," + kNoVertices), StartsWith("table:2: "));
  EXPECT_THAT(saidOf(place + "polygon,0,3,0,0,1,1,2,2,,,,,,,,,,"), StartsWith("table:2: "));
  EXPECT_THAT(saidOf(place + "polygon,0,4,0,0,1,0,1,1,,,,,,,,,,"),
              StartsWith("table:2: /column 18: not a number"));
}

TYPED_TEST(SceneCsvTest, ATableThatIsNotThereIsNamed) {
  EXPECT_EQ(complaint<TypeParam>(kScene), "table: is not in memory");
}

}  // namespace
}  // namespace samestep
