// SPDX-License-Identifier: MIT
// What moves over or past several shapes: the seams of a floor are not there, its corners and walls are, and
// what is passed is not felt.
#include <samestep/space.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

struct Solving {
  SolverKind kind;
  ContactPrecision precision;
};
constexpr Solving kSoft[] = {{SolverKind::softStep, ContactPrecision::accurate},
                             {SolverKind::softStep, ContactPrecision::fast}};
constexpr Solving kAll[] = {kSoft[0], kSoft[1], {SolverKind::sequentialImpulses, ContactPrecision::accurate}};

enum class Ground { boxes, segments, thickSegments };

template <Scalar S>
class SeamTest : public ::testing::Test {
 protected:
  static void set(Space<S>& space, const Solving& solving, bool falls = true) {
    space.setSolver(solving.kind);
    space.setPrecision(solving.precision);
    if (falls) space.setGravity({S(0), S(-10)});
  }
  static void addPart(Space<S>& space, Ground ground, const BB<S>& box) {
    if (ground == Ground::boxes) {
      space.add(boxShape<S>(space.staticBody(), box));
      return;
    }
    const S radius = ground == Ground::segments ? S(0) : ratio<S>(1, 8);
    addWall<S>(space, {box.left, box.top - radius}, {box.right, box.top - radius}, radius);
  }
  /// A floor whose top is y = 0 but for what the parts are shifted by.
  static void addFloor(Space<S>& space, Ground ground, int from, int to, S gap = S(0), S step = S(0)) {
    std::vector<int> order;
    for (int i = from; i < to; ++i) order.push_back(i);
    // This leaves them in no order.
    for (std::size_t i = 0; i + 3 < order.size(); i += 2) std::swap(order[i], order[i + 3]);
    for (const int i : order) {
      const S top = i % 2 == 0 ? S(0) : step;
      addPart(space, ground, BB<S>(S(i), S(-1), S(i + 1) - gap, top));
    }
  }
  static ShapeId addWalker(Space<S>& space, S x, S speed, S y = ratio<S>(1, 2)) {
    const ShapeId id = addBox<S>(space, {x, y}, ratio<S>(1, 2), S(1), S(1), {speed, S(0)});
    space.body(bodyOf(space, id)).setMoment(S(1 << 29));
    return id;
  }
  /// A body of four boxes in a row, as wide as high, that may turn.
  static BodyId addSled(Space<S>& space, const Vector<S>& place, const Vector<S>& velocity, S mass = S(1)) {
    Body<S> body;
    body.setPosition(place);
    body.setVelocity(velocity);
    const BodyId id = space.add(body);
    for (const int i : {2, 0, 3, 1}) {
      Shape<S> part = boxShape<S>(id, BB<S>(S(i - 2), S(0), S(i - 1), S(1)));
      part.setMass(mass);
      space.add(part);
    }
    return id;
  }
  /// Walks until it is past x.
  /// @return whether it arrives in the time that its speed says, and a tenth more
  static bool arrives(Space<S>& space, ShapeId walker, S x, S speed) {
    const double from = double(space.body(bodyOf(space, walker)).position().x);
    const int steps = int((double(x) - from) / double(speed) * 64 * 1.1) + 2;
    for (int i = 0; i < steps; ++i) {
      space.step(kTick<S>);
      if (space.body(bodyOf(space, walker)).position().x >= x) return true;
    }
    return false;
  }
};
TYPED_TEST_SUITE(SeamTest, AllScalars);

TYPED_TEST(SeamTest, ABallKeepsItsSpeedOverAFlushFloor) {
  using S = TypeParam;
  for (const Solving& solving : kAll) {
    for (const Ground ground : {Ground::boxes, Ground::segments, Ground::thickSegments}) {
      Space<S> space;
      TestFixture::set(space, solving);
      TestFixture::addFloor(space, ground, 0, 44);
      const S radius = ratio<S>(1, 4);
      const ShapeId id = addDisc<S>(space, {ratio<S>(1, 2), radius}, radius, S(1), {S(5), S(0)});
      double highest = 0;
      for (int i = 0; i < 512; ++i) {
        space.step(kTick<S>);
        highest = std::max(highest, double(space.body(bodyOf(space, id)).position().y - radius));
      }
      EXPECT_NEAR(double(space.body(bodyOf(space, id)).velocity().x), 5, 2e-3)
          << "ground " << int(ground) << ", solver " << int(solving.kind);
      EXPECT_LT(highest, 1e-3) << "ground " << int(ground);
    }
  }
}

TYPED_TEST(SeamTest, AWalkerArrivesAtAnySpeed) {
  using S = TypeParam;
  for (const Solving& solving : kAll) {
    for (const Ground ground : {Ground::boxes, Ground::segments, Ground::thickSegments}) {
      for (const int speed : {1, 2, 3, 6, 11}) {
        Space<S> space;
        TestFixture::set(space, solving);
        TestFixture::addFloor(space, ground, 0, 16);
        const ShapeId walker = TestFixture::addWalker(space, ratio<S>(13, 10), S(speed));
        EXPECT_TRUE(TestFixture::arrives(space, walker, ratio<S>(133, 10), S(speed)))
            << "ground " << int(ground) << ", " << speed << " m/s";
        EXPECT_NEAR(double(space.body(bodyOf(space, walker)).velocity().x), speed, 2e-3 * speed);
        EXPECT_NEAR(double(space.body(bodyOf(space, walker)).position().y), 0.5, 6e-3);
      }
    }
  }
}

// A sled of boxes has seams itself, over those of the ground.
TYPED_TEST(SeamTest, ABodyOfBoxesSlidesOverSeams) {
  using S = TypeParam;
  for (const Solving& solving : kAll) {
    for (const Ground ground : {Ground::boxes, Ground::segments, Ground::thickSegments}) {
      for (const int speed : {1, 3, 6}) {
        Space<S> space;
        TestFixture::set(space, solving);
        TestFixture::addFloor(space, ground, -4, 12);
        const BodyId sled = TestFixture::addSled(space, {ratio<S>(1, 3), S(0)}, {S(speed), S(0)});
        for (int i = 0; i < 64 * 6 / speed; ++i) space.step(kTick<S>);
        const Body<S>& body = space.body(sled);
        EXPECT_NEAR(double(body.position().x), 1.0 / 3 + 6, 0.05)
            << "ground " << int(ground) << ", " << speed << " m/s, solver " << int(solving.kind);
        EXPECT_NEAR(double(body.velocity().x), speed, 0.01 * speed);
        EXPECT_NEAR(double(body.position().y), 0, 6e-3);
      }
    }
  }
}

// The floor is of tiles that are a body each, kinematic, at rest or going the same way.
TYPED_TEST(SeamTest, AWalkerArrivesOnBodiesThatMoveAlike) {
  using S = TypeParam;
  for (const Solving& solving : kAll) {
    for (const int belt : {-1, 0, 1}) {
      for (const int speed : {1, 3, 6}) {
        Space<S> space;
        TestFixture::set(space, solving);
        for (int i = 0; i < 24; ++i) {
          Body<S> tile = belt == 0 && i % 2 == 0 ? Body<S>::fixedInPlace() : Body<S>::kinematic();
          tile.setPosition({S(i - 4), S(0)});
          if (belt != 0) tile.setVelocity({ratio<S>(belt, 2), S(0)});
          space.add(boxShape<S>(space.add(tile), BB<S>(S(0), S(-1), S(1), S(0))));
        }
        const ShapeId walker = TestFixture::addWalker(space, ratio<S>(13, 10), S(speed));
        EXPECT_TRUE(TestFixture::arrives(space, walker, ratio<S>(133, 10), S(speed)))
            << speed << " m/s, belt " << belt;
        EXPECT_NEAR(double(space.body(bodyOf(space, walker)).velocity().x), speed, 2e-3 * speed);
      }
    }
  }
}

// The floor moves itself: a heavy plank of boxes, free in space.
TYPED_TEST(SeamTest, ABallAndAWalkerKeepTheirSpeedOnABodyOfBoxes) {
  using S = TypeParam;
  for (const Solving& solving : kAll) {
    for (const bool round : {true, false}) {
      Space<S> space;
      TestFixture::set(space, solving);
      TestFixture::addFloor(space, Ground::boxes, -8, 8);
      const BodyId plank = TestFixture::addSled(space, {S(0), S(0)}, {}, S(1000));
      for (int i = 0; i < 32; ++i) space.step(kTick<S>);
      const S top = space.body(plank).position().y + S(1), start = ratio<S>(-14, 10);
      const ShapeId id =
          round ? addDisc<S>(space, {start, top + ratio<S>(1, 4)}, ratio<S>(1, 4), S(1), {S(3), S(0)})
                : TestFixture::addWalker(space, start, S(3), top + ratio<S>(1, 2));
      for (int i = 0; i < 58; ++i) space.step(kTick<S>);
      const Body<S>& body = space.body(bodyOf(space, id));
      EXPECT_NEAR(double(body.velocity().x), 3, 0.015)
          << "round " << round << ", solver " << int(solving.kind);
      EXPECT_NEAR(double(body.position().x), -1.4 + 3 * 58 / 64.0, 0.02) << round;
      EXPECT_NEAR(double(body.position().y), double(top) + (round ? 0.25 : 0.5), 6e-3) << round;
    }
  }
}

// Two bodies of boxes: each has seams for the other.
TYPED_TEST(SeamTest, ABodyOfBoxesSlidesOverAnother) {
  using S = TypeParam;
  for (const Solving& solving : kAll) {
    Space<S> space;
    TestFixture::set(space, solving);
    TestFixture::addFloor(space, Ground::boxes, -8, 8);
    const BodyId plank = TestFixture::addSled(space, {S(0), S(0)}, {}, S(1000));
    for (int i = 0; i < 32; ++i) space.step(kTick<S>);
    const S top = space.body(plank).position().y + S(1);
    const BodyId sled = TestFixture::addSled(space, {ratio<S>(-7, 10), top}, {S(2), S(0)});
    for (int i = 0; i < 48; ++i) space.step(kTick<S>);
    EXPECT_NEAR(double(space.body(sled).velocity().x), 2, 0.01) << int(solving.kind);
    EXPECT_NEAR(double(space.body(sled).position().x), -0.7 + 1.5, 0.02);
    EXPECT_NEAR(double(space.body(sled).position().y), double(top), 6e-3);
  }
}

// One that is larger than what it lies on, of which there are thousands: each asks only those near it.
TYPED_TEST(SeamTest, AFloorOfThousandsOfPartsTakesNoLonger) {
  using S = TypeParam;
  Space<S> space;
  TestFixture::set(space, kSoft[0]);
  for (int i = 0; i < 2048; ++i) {
    const S left = ratio<S>(i - 1024, 16);
    space.add(boxShape<S>(space.staticBody(), BB<S>(left, S(-1), left + ratio<S>(1, 16), S(0))));
  }
  const ShapeId plank = addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(120), S(1), S(1), {S(1), S(0)});
  space.body(bodyOf(space, plank)).setMoment(S(1 << 29));
  for (int i = 0; i < 16; ++i) space.step(kTick<S>);
  const Body<S>& body = space.body(bodyOf(space, plank));
  EXPECT_NEAR(double(body.velocity().x), 1, 2e-3);
  EXPECT_NEAR(double(body.position().y), 0.5, 6e-3);
}

// Wherever its corners are in a step: at a seam, just before, just behind.
TYPED_TEST(SeamTest, AWalkerArrivesFromWhereverItBegins) {
  using S = TypeParam;
  for (const Solving& solving : kAll) {
    for (const Ground ground : {Ground::boxes, Ground::segments, Ground::thickSegments}) {
      for (const S& start :
           {S(0), ratio<S>(1, 1000000), ratio<S>(-1, 1000000), ratio<S>(1, 10), ratio<S>(1, 2)}) {
        for (const int speed : {1, 3, 6}) {
          Space<S> space;
          TestFixture::set(space, solving);
          TestFixture::addFloor(space, ground, -3, 8);
          const ShapeId walker = TestFixture::addWalker(space, start, S(speed));
          const Body<S>& body = space.body(bodyOf(space, walker));
          for (int i = 0; i < 60 * 5 / speed; ++i) space.step(ratio<S>(1, 60));
          EXPECT_NEAR(double(body.position().x), double(start) + 5, 0.03)
              << "ground " << int(ground) << ", " << speed << " m/s, from " << double(start);
          EXPECT_NEAR(double(body.position().y), 0.5, 6e-3)
              << "ground " << int(ground) << ", " << speed << " m/s";
        }
      }
    }
  }
}

TYPED_TEST(SeamTest, SmallGapsAndStepsAreFlushToo) {
  using S = TypeParam;
  for (const S gap : {S(0), ratio<S>(3, 1000)}) {
    for (const S step : {S(0), ratio<S>(1, 1000), ratio<S>(-1, 1000)}) {
      Space<S> space;
      TestFixture::set(space, kSoft[0]);
      TestFixture::addFloor(space, Ground::boxes, 0, 16, gap, step);
      const ShapeId walker = TestFixture::addWalker(space, ratio<S>(13, 10), S(3), ratio<S>(51, 100));
      EXPECT_TRUE(TestFixture::arrives(space, walker, ratio<S>(133, 10), S(3)))
          << "gap " << double(gap) << ", step " << double(step);
    }
  }
}

TYPED_TEST(SeamTest, AStepIsAWall) {
  using S = TypeParam;
  for (const int height : {1, 5, 100}) {
    Space<S> space;
    TestFixture::set(space, kSoft[0]);
    TestFixture::addFloor(space, Ground::boxes, 0, 6);
    space.add(boxShape<S>(space.staticBody(), BB<S>(S(6), S(-1), S(7), ratio<S>(height, 100))));
    const ShapeId walker = TestFixture::addWalker(space, S(2), S(3));
    EXPECT_FALSE(TestFixture::arrives(space, walker, S(6), S(3))) << height;
    EXPECT_NEAR(double(space.body(bodyOf(space, walker)).position().x), 5.75, 5e-3);
    EXPECT_NEAR(double(space.body(bodyOf(space, walker)).velocity().x), 0, 1e-3);
  }
}

// Walls stand on the floor, beside its end, and in parts.
TYPED_TEST(SeamTest, ACornerOfARoomHoldsWhatIsPushedIntoIt) {
  using S = TypeParam;
  for (const int kind : {0, 1, 2}) {
    for (const int what : {0, 1, 2, 3}) {
      Space<S> space;
      TestFixture::set(space, kSoft[0]);
      space.setGravity({S(10), S(-10)});
      TestFixture::addFloor(space, Ground::boxes, -4, kind == 1 ? 4 : 6);
      for (int i = kind == 1 ? -1 : 0; i < 4; ++i) {
        space.add(boxShape<S>(space.staticBody(), BB<S>(S(4), S(i), S(5), S(i + 1))));
      }
      if (kind == 2) addWall<S>(space, {S(4), S(0)}, {S(4), S(4)});
      const S half = ratio<S>(1, 16), apart = ratio<S>(1, 100);
      const Vector<S> place(S(4) - half - apart, half + apart);
      ShapeId id = what == 0 ? addDisc<S>(space, place, half, S(1))
                             : addBox<S>(space, place, half + half, half + half, S(1));
      const BodyId body = bodyOf(space, id);
      if (what == 2) space.body(body).setAngle(ratio<S>(1, 3));
      if (what == 3) space.body(body).setVelocity({S(2), S(-2)});
      for (int i = 0; i < 256; ++i) space.step(kTick<S>);
      EXPECT_NEAR(double(space.body(body).position().x), 4 - 1.0 / 16, 3e-3) << kind << " " << what;
      EXPECT_NEAR(double(space.body(body).position().y), 1.0 / 16, 3e-3) << kind << " " << what;
    }
  }
}

// A stick against the wall, standing on the floor: its foot is in the corner.
TYPED_TEST(SeamTest, AStickInTheCornerStands) {
  using S = TypeParam;
  Space<S> space;
  TestFixture::set(space, kSoft[0]);
  TestFixture::addFloor(space, Ground::boxes, 0, 4);
  space.add(boxShape<S>(space.staticBody(), BB<S>(S(-1), S(-1), S(0), S(3))));
  Body<S> stick;
  stick.setPosition({S(0), ratio<S>(1, 100)});
  const BodyId id = space.add(stick);
  Shape<S> shape = segmentShape<S>(id, {S(0), S(0)}, {S(0), S(1)}, S(0));
  shape.setMass(S(1));
  space.add(shape);
  space.body(id).setMoment(S(1 << 29));
  for (int i = 0; i < 128; ++i) space.step(kTick<S>);
  EXPECT_NEAR(double(space.body(id).position().y), 0, 3e-3);
}

TYPED_TEST(SeamTest, WhatFallsOnASeamStaysThere) {
  using S = TypeParam;
  for (const Solving& solving : kSoft) {
    for (const int width : {10, 15, 100}) {
      for (const int aside : {0, 1, 5}) {
        Space<S> space;
        TestFixture::set(space, solving);
        TestFixture::addFloor(space, Ground::boxes, 0, 6);
        const S size = ratio<S>(width, 100), place = S(3) + ratio<S>(aside, 100);
        const ShapeId id = addBox<S>(space, {place, S(1)}, size, size, S(1), {S(0), S(-6)});
        space.body(bodyOf(space, id)).setMoment(S(1 << 29));
        for (int i = 0; i < 256; ++i) space.step(kTick<S>);
        const Body<S>& body = space.body(bodyOf(space, id));
        EXPECT_NEAR(double(body.position().x), double(place), 1e-3) << width << " " << aside;
        EXPECT_NEAR(double(body.position().y), double(size) / 2, 2e-3) << width << " " << aside;
      }
    }
  }
}

TYPED_TEST(SeamTest, AWallOfPartsLetsSlideDown) {
  using S = TypeParam;
  Space<S> space;
  TestFixture::set(space, kSoft[0]);
  space.setGravity({S(2), S(-10)});
  for (int i = 0; i < 16; ++i) {
    space.add(boxShape<S>(space.staticBody(), BB<S>(S(0), S(-i - 1), S(1), S(-i))));
  }
  const ShapeId id = TestFixture::addWalker(space, ratio<S>(-1, 4), S(0), S(-2));
  for (int i = 0; i < 64; ++i) space.step(kTick<S>);
  EXPECT_NEAR(double(space.body(bodyOf(space, id)).velocity().y), -10, 0.02);
  EXPECT_NEAR(double(space.body(bodyOf(space, id)).position().x), -0.25, 2e-3);
}

TYPED_TEST(SeamTest, ABallRollsOverARidge) {
  using S = TypeParam;
  // Down on both sides by a tenth: where they meet the ball neither drops nor jumps.
  Space<S> space;
  TestFixture::set(space, kSoft[0]);
  addWall<S>(space, {S(-4), ratio<S>(-4, 10)}, {S(0), S(0)});
  addWall<S>(space, {S(0), S(0)}, {S(4), ratio<S>(-4, 10)});
  const S radius = ratio<S>(1, 4);
  const ShapeId id =
      addDisc<S>(space, {ratio<S>(-1, 2), ratio<S>(-1, 20) + radius}, radius, S(1), {S(2), S(0)});
  double highest = 0;
  for (int i = 0; i < 64; ++i) {
    space.step(kTick<S>);
    highest = std::max(highest, double(space.body(bodyOf(space, id)).position().y - radius));
  }
  EXPECT_LT(highest, 6e-3);
  EXPECT_GT(double(space.body(bodyOf(space, id)).position().x), 1);
}

template <Scalar S>
ShapeId addPasser(Space<S>& space, int what, const Vector<S>& place, const Vector<S>& velocity) {
  const S size = ratio<S>(1, 5);
  if (what == 0) return addDisc<S>(space, place, ratio<S>(1, 10), S(1), velocity);
  if (what == 1) return addBox<S>(space, place, size, size, S(1), velocity);
  Body<S> body;
  body.setPosition(place);
  body.setVelocity(velocity);
  const BodyId id = space.add(body);
  Shape<S> shape = segmentShape<S>(id, {-ratio<S>(1, 10), S(0)}, {ratio<S>(1, 10), S(0)}, ratio<S>(1, 10));
  shape.setMass(S(1));
  return space.add(shape);
}

// Half a centimetre beside the corner of a box, both ways, at several speeds: a disc, a box with a corner, a
// capsule.
TYPED_TEST(SeamTest, WhatPassesACornerIsNotMoved) {
  using S = TypeParam;
  const double reach[] = {0.1, 0.2 * std::sqrt(0.5), 0.1 * std::sqrt(0.5) + 0.1};
  for (const Solving& solving : kSoft) {
    for (const int what : {0, 1, 2}) {
      for (const int speed : {-4, -2, -1, 1, 2, 4, 9}) {
        Space<S> space;
        TestFixture::set(space, solving, false);
        space.add(boxShape<S>(space.staticBody(), BB<S>(S(0), S(-1), S(1), S(0))));
        const int off = int(std::lround((reach[what] + 0.005) * std::sqrt(0.5) * 100000));
        const Vector<S> aside(ratio<S>(-off, 100000), ratio<S>(off, 100000));
        const S back = S(speed > 0 ? -1 : 1) * ratio<S>(1, 3);
        const Vector<S> velocity{S(speed), S(speed)};
        const ShapeId id = addPasser<S>(space, what, aside + Vector<S>(back, back), velocity);
        for (int i = 0; i < 64; ++i) space.step(kTick<S>);
        const Body<S>& body = space.body(bodyOf(space, id));
        EXPECT_NEAR(double(body.velocity().x), speed, 1e-6) << what << ", " << speed << " m/s";
        EXPECT_NEAR(double(body.velocity().y), speed, 1e-6) << what << ", " << speed << " m/s";
        EXPECT_NEAR(double(body.angularVelocity()), 0, 1e-6);
      }
    }
  }
}

TYPED_TEST(SeamTest, DiscsThatPassEachOtherAreNotMoved) {
  using S = TypeParam;
  for (const int speed : {1, 2, 5}) {
    Space<S> space;
    TestFixture::set(space, kSoft[0], false);
    const S radius = ratio<S>(1, 10);
    const ShapeId a = addDisc<S>(space, {S(-1), S(0)}, radius, S(1), {S(speed), S(0)});
    const ShapeId b = addDisc<S>(space, {S(1), ratio<S>(203, 1000)}, radius, S(1), {S(-speed), S(0)});
    for (int i = 0; i < 128; ++i) space.step(kTick<S>);
    EXPECT_EQ(space.body(bodyOf(space, a)).velocity(), Vector<S>(S(speed), S(0)));
    EXPECT_EQ(space.body(bodyOf(space, b)).velocity(), Vector<S>(S(-speed), S(0)));
  }
}

// Straight at a corner under 45 degrees: turned back the way it came, for it meets the corner head on.
TYPED_TEST(SeamTest, WhatMeetsACornerIsStoppedByIt) {
  using S = TypeParam;
  Space<S> space;
  TestFixture::set(space, kSoft[0], false);
  space.add(boxShape<S>(space.staticBody(), BB<S>(S(0), S(-1), S(1), S(0))));
  const ShapeId id = addDisc<S>(space, {S(-1), S(1)}, ratio<S>(1, 10), S(1), {S(1), S(-1)});
  for (int i = 0; i < 128; ++i) space.step(kTick<S>);
  const Body<S>& body = space.body(bodyOf(space, id));
  EXPECT_NEAR(double(body.velocity().x), 0, 1e-2);
  EXPECT_NEAR(double(body.velocity().y), 0, 1e-2);
  EXPECT_NEAR(std::hypot(double(body.position().x), double(body.position().y)), 0.1, 1e-3);
}

}  // namespace
}  // namespace samestep
