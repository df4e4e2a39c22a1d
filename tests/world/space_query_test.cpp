// SPDX-License-Identifier: MIT
// Queries answer as a search through all shapes does, by rising id.
#include <samestep/space.h>

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class SpaceQueryTest : public ::testing::Test {
 protected:
  static Transform<S> poseOf(const Space<S>& space, const Shape<S>& shape) {
    return space.body(shape.body()).transform();
  }

  static void expectAllQueriesRight(Space<S>& space, Random& random) {
    const Vector<S> point(random.number<S>(-9, 9), random.number<S>(-7, 9));
    const Vector<S> end(random.number<S>(-9, 9), random.number<S>(-7, 9));
    const S size = random.number<S>(0, 3);
    ShapeFilter filter;
    if (random.oneIn(3)) filter.group = random.below(3);
    if (random.oneIn(5)) filter.mask = 0;

    std::vector<PointHit<S>> points;
    std::vector<SegmentHit<S>> segments;
    std::vector<ShapeId> boxes;
    space.pointQuery(point, size, filter, points);
    space.segmentQuery(point, end, size, filter, segments);
    const BB<S> box = BB<S>::forExtents(point, size, size);
    space.boxQuery(box, filter, boxes);

    std::size_t p = 0, s = 0, b = 0;
    space.eachShape([&](const Shape<S>& shape) {
      if (!accepts(shape.filter(), filter)) return;
      const Placement<S> placed(shape, poseOf(space, shape));
      const PointQueryInfo<S> near = pointQuery(*placed, point);
      if (near.distance <= size) {
        ASSERT_LT(p, points.size());
        EXPECT_EQ(points[p].shape, shape.id());
        EXPECT_EQ(points[p].point, near.point);
        EXPECT_EQ(points[p].distance, near.distance);
        EXPECT_EQ(points[p].gradient, near.gradient);
        ++p;
      }
      const SegmentQueryInfo<S> hit = segmentQuery(*placed, point, end, size);
      if (hit.hit) {
        ASSERT_LT(s, segments.size());
        EXPECT_EQ(segments[s].shape, shape.id());
        EXPECT_EQ(segments[s].point, hit.point);
        EXPECT_EQ(segments[s].normal, hit.normal);
        EXPECT_EQ(segments[s].alpha, hit.alpha);
        ++s;
      }
      if (intersects(placed->box, box)) {
        ASSERT_LT(b, boxes.size());
        EXPECT_EQ(boxes[b], shape.id());
        ++b;
      }
      EXPECT_EQ(std::as_const(space).shape(shape.id()).id(), shape.id());
    });
    EXPECT_EQ(p, points.size());
    EXPECT_EQ(s, segments.size());
    EXPECT_EQ(b, boxes.size());
    found_ += p + s + b;
  }

  static inline std::size_t found_ = 0;
};
TYPED_TEST_SUITE(SpaceQueryTest, AllScalars);

TYPED_TEST(SpaceQueryTest, AnswersAreThoseOfASearchThroughAllShapes) {
  using S = TypeParam;
  this->found_ = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Space<S> space;
    Random random(seed + 100);
    fillAtRandom(space, seed);
    std::vector<BodyId> bodies;
    space.eachBody([&](const Body<S>& body) { bodies.push_back(body.id()); });
    for (int round = 0; round < 40; ++round) {
      this->expectAllQueriesRight(space, random);
      // Moved by hand, also the static body: the queries see it at once.
      const BodyId moved = bodies[random.below(static_cast<std::uint32_t>(bodies.size()))];
      space.body(moved).setPosition({random.number<S>(-6, 6), random.number<S>(-4, 6)});
      space.body(moved).setAngle(random.number<S>(-3, 3));
      this->expectAllQueriesRight(space, random);
      if (random.oneIn(4)) space.step(kTick<S>);
      if (random.oneIn(8)) space.dropCache();
      if (random.oneIn(8)) space.setType(bodies.back(), BodyType(random.below(3)));
      if (random.oneIn(8)) {
        space.change(space.state().shapes.idAt(random.below(space.state().shapes.slots())),
                     [&](Shape<S>& shape) { CircleShape<S>::assign(shape, random.number<S>(1, 2), {}); });
      }
    }
  }
  EXPECT_GT(this->found_, 1000u);
}

TYPED_TEST(SpaceQueryTest, EmptyWorldAnswersNothing) {
  using S = TypeParam;
  Space<S> space;
  std::vector<PointHit<S>> points(3);
  std::vector<SegmentHit<S>> segments(3);
  std::vector<ShapeId> boxes(3);
  space.pointQuery({}, S(100), {}, points);
  space.segmentQuery({}, {S(1), S(0)}, S(1), {}, segments);
  space.boxQuery({S(-1), S(-1), S(1), S(1)}, {}, boxes);
  EXPECT_TRUE(points.empty());
  EXPECT_TRUE(segments.empty());
  EXPECT_TRUE(boxes.empty());
}

TYPED_TEST(SpaceQueryTest, QueriesOutOfRangeAreRefusedAndKeepTheAnswersTheyGot) {
  using S = TypeParam;
  Space<S> space;
  addDisc<S>(space, {}, S(1), S(1));
  std::vector<PointHit<S>> points(3);
  std::vector<SegmentHit<S>> segments(3);
  std::vector<ShapeId> boxes(3);
  std::vector<S> wild = {kMaxWorldExtent<S> + S(1), std::numeric_limits<S>::max(),
                         std::numeric_limits<S>::lowest()};
  if constexpr (std::numeric_limits<S>::has_quiet_NaN) {
    wild.push_back(std::numeric_limits<S>::quiet_NaN());
    wild.push_back(std::numeric_limits<S>::infinity());
  }
  for (const S bad : wild) {
    expectRefused<ValueOutOfRange>(space, [&] { space.pointQuery({bad, S(0)}, S(1), {}, points); });
    expectRefused<ValueOutOfRange>(space, [&] { space.pointQuery({S(0), bad}, S(1), {}, points); });
    expectRefused<ValueOutOfRange>(space, [&] { space.pointQuery({}, bad, {}, points); });
    expectRefused<ValueOutOfRange>(space, [&] { space.segmentQuery({bad, S(0)}, {}, S(0), {}, segments); });
    expectRefused<ValueOutOfRange>(space, [&] { space.segmentQuery({}, {S(0), bad}, S(0), {}, segments); });
    expectRefused<Error>(space, [&] { space.segmentQuery({}, {S(1), S(0)}, bad, {}, segments); });
    expectRefused<ValueOutOfRange>(space, [&] { space.boxQuery({bad, S(0), S(1), S(1)}, {}, boxes); });
    expectRefused<ValueOutOfRange>(space, [&] { space.boxQuery({S(0), S(0), S(1), bad}, {}, boxes); });
  }
  expectRefused<ValueOutOfRange>(space, [&] { space.pointQuery({}, S(-1), {}, points); });
  expectRefused<NegativeRadius>(space, [&] { space.segmentQuery({}, {S(1), S(0)}, S(-1), {}, segments); });
  expectRefused<NegativeHalfDimensions>(space, [&] { space.boxQuery({S(1), S(0), S(0), S(1)}, {}, boxes); });
  EXPECT_EQ(points.size(), 3u);
  EXPECT_EQ(segments.size(), 3u);
  EXPECT_EQ(boxes.size(), 3u);
}

TYPED_TEST(SpaceQueryTest, AtTheEdgeOfTheWorldQueriesStillFind) {
  using S = TypeParam;
  Space<S> space;
  space.setWorldExtent(kMaxWorldExtent<S>);
  const S far = kMaxWorldExtent<S>;
  const ShapeId disc = addDisc<S>(space, {far, -far}, S(1), S(1));
  std::vector<PointHit<S>> points;
  space.pointQuery({far, -far}, S(0), {}, points);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].shape, disc);
  EXPECT_EQ(points[0].distance, S(-1));
  std::vector<SegmentHit<S>> segments;
  space.segmentQuery({far, S(0)}, {far, -far}, S(0), {}, segments);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].normal, Vector<S>(S(0), S(1)));
  std::vector<ShapeId> boxes;
  space.boxQuery({-far, -far, far, far}, {}, boxes);
  EXPECT_EQ(boxes.size(), 1u);
}

TYPED_TEST(SpaceQueryTest, BoundingBoxFollowsTheBodyAtOnce) {
  using S = TypeParam;
  Space<S> space;
  const ShapeId disc = addDisc<S>(space, {}, S(2), S(1));
  EXPECT_EQ(space.boundingBox(disc), BB<S>(S(-2), S(-2), S(2), S(2)));
  space.body(bodyOf(space, disc)).setPosition({S(5), S(6)});
  EXPECT_EQ(space.boundingBox(disc), BB<S>(S(3), S(4), S(7), S(8)));
  space.change(disc, [](Shape<S>& shape) { CircleShape<S>(shape).setRadius(S(1)); });
  EXPECT_EQ(space.boundingBox(disc), BB<S>(S(4), S(5), S(6), S(7)));
}

}  // namespace
}  // namespace samestep
