// SPDX-License-Identifier: MIT
#include <samestep/query_view.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include <samestep/error.h>
#include <samestep/space.h>

#include "support/random.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class QueryViewTest : public ::testing::Test {
 protected:
  static void fill(Space<S>& space, std::uint64_t seed) {
    fillAtRandom(space, seed);
    for (int i = 0; i < 10; ++i) space.step(kTick<S>);
  }
  static Vector<S> place(Random& random) { return {random.number<S>(-9, 9), random.number<S>(-9, 9)}; }
  static Transform<S> poseOf(const Space<S>& space, const Shape<S>& shape) {
    return space.body(shape.body()).transform();
  }
  static std::vector<ShapeId> idsOf(const std::vector<SegmentHit<S>>& hits) {
    std::vector<ShapeId> ids;
    for (const SegmentHit<S>& hit : hits) ids.push_back(hit.shape);
    return ids;
  }
  static bool before(const SegmentHit<S>& a, const SegmentHit<S>& b) {
    return a.alpha != b.alpha ? a.alpha < b.alpha : a.shape < b.shape;
  }
};
TYPED_TEST_SUITE(QueryViewTest, AllScalars);

TYPED_TEST(QueryViewTest, ARayGivesWhatTheSegmentQueryFindsByDistance) {
  using S = TypeParam;
  Random random(3);
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Space<S> space;
    TestFixture::fill(space, seed);
    const QueryView<S> view = space.queries();
    for (int i = 0; i < 10; ++i) {
      const Vector<S> from = TestFixture::place(random), to = TestFixture::place(random);
      const S radius = random.oneIn(2) ? S(0) : random.number<S>(0, 1);
      std::vector<SegmentHit<S>> expected;
      space.segmentQuery(from, to, radius, {}, expected);
      std::sort(expected.begin(), expected.end(), TestFixture::before);
      found += expected.size();
      std::vector<SegmentHit<S>> hits(expected.size() + 2);
      ASSERT_EQ(view.castRay(from, to, {}, hits, radius), expected.size());
      hits.resize(expected.size());
      EXPECT_EQ(TestFixture::idsOf(hits), TestFixture::idsOf(expected));
      EXPECT_EQ(view.meetsAny(from, to, {}, radius), !expected.empty());
      SegmentHit<S> nearest;
      ASSERT_EQ(view.castRay(from, to, {}, nearest, radius), !expected.empty());
      if (expected.empty()) continue;
      EXPECT_EQ(nearest.shape, expected[0].shape);
      EXPECT_EQ(nearest.point, expected[0].point);
      EXPECT_EQ(nearest.alpha, expected[0].alpha);
    }
  }
  EXPECT_GT(found, 100u);
}

TYPED_TEST(QueryViewTest, ASmallRoomHoldsTheNearestAndAllAreCounted) {
  using S = TypeParam;
  Space<S> space;
  std::vector<ShapeId> shapes;
  for (int i = 9; i > 0; --i) shapes.push_back(addDisc<S>(space, {S(i), S(0)}, ratio<S>(1, 4), S(1)));
  // Two in one place come by id.
  shapes.push_back(addDisc<S>(space, {S(1), S(0)}, ratio<S>(1, 4), S(1)));
  SegmentHit<S> hits[3];
  EXPECT_EQ(space.queries().castRay({S(0), S(0)}, {S(20), S(0)}, {}, hits), 10u);
  EXPECT_EQ(hits[0].shape, shapes[8]);
  EXPECT_EQ(hits[1].shape, shapes[9]);
  EXPECT_EQ(hits[2].shape, shapes[7]);
  EXPECT_EQ(hits[0].normal, Vector<S>(S(-1), S(0)));
  EXPECT_EQ(space.queries().castRay({S(0), S(0)}, {S(20), S(0)}, {}, std::span<SegmentHit<S>>()), 10u);
}

TYPED_TEST(QueryViewTest, MasksSensorsAndPredicatesLeaveOut) {
  using S = TypeParam;
  Space<S> space;
  const ShapeId masked = addDisc<S>(space, {S(1), S(0)}, ratio<S>(1, 4), S(1));
  const ShapeId sensor = addDisc<S>(space, {S(2), S(0)}, ratio<S>(1, 4), S(1));
  const ShapeId refused = addDisc<S>(space, {S(3), S(0)}, ratio<S>(1, 4), S(1));
  const ShapeId wanted = addDisc<S>(space, {S(4), S(0)}, ratio<S>(1, 4), S(1));
  space.change(masked, [](Shape<S>& shape) { shape.setFilter({0, 2, 0xffffffffu}); });
  space.change(sensor, [](Shape<S>& shape) { shape.setSensor(true); });
  ShapeId not1 = refused;
  const QueryFilter filter{{0, 1, 0xfffffffdu},
                           false,
                           [](ShapeId id, void* data) { return id != *static_cast<ShapeId*>(data); },
                           &not1};
  const QueryView<S> view = space.queries();
  const Shape<S> ball = circleShape<S>({}, ratio<S>(1, 8));
  SegmentHit<S> hits[4];
  ASSERT_EQ(view.castRay({}, {S(9), S(0)}, filter, hits), 1u);
  EXPECT_EQ(hits[0].shape, wanted);
  ASSERT_EQ(view.castShape(ball, {{}, {}, S(0), {S(9), S(0)}, S(0)}, filter, hits), 1u);
  EXPECT_EQ(hits[0].shape, wanted);
  NearHit<S> near[4];
  ASSERT_EQ(view.nearest(ball, Transform<S>(), S(9), filter, near), 1u);
  EXPECT_EQ(near[0].shape, wanted);
  ShapeId ids[4];
  const Shape<S> all = boxShape<S>({}, S(20), S(1));
  ASSERT_EQ(view.overlapping(all, Transform<S>(), filter, ids), 1u);
  EXPECT_EQ(ids[0], wanted);
  EXPECT_EQ(view.overlapping(all, Transform<S>(), {}, ids), 4u);
}

TYPED_TEST(QueryViewTest, ShapesAreCastAndMeasuredAgainstEveryShape) {
  using S = TypeParam;
  Random random(4);
  std::size_t casts = 0, overlaps = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Space<S> space;
    TestFixture::fill(space, seed);
    const QueryView<S> view = space.queries();
    for (int i = 0; i < 6; ++i) {
      const Shape<S> asked = random.oneIn(2) ? boxShape<S>({}, S(1), ratio<S>(1, 2), ratio<S>(1, 16))
                                             : segmentShape<S>({}, {S(-1), S(0)}, {S(1), S(0)}, S(0));
      const RigidMotion<S> motion{{},
                                  TestFixture::place(random),
                                  random.number<S>(-3, 3),
                                  TestFixture::place(random),
                                  random.number<S>(-3, 3)};
      const Transform<S> pose = motion.at(S(0));
      std::vector<SegmentHit<S>> expected;
      std::vector<std::pair<S, ShapeId>> near;
      std::vector<ShapeId> touched;
      space.eachShape([&](const Shape<S>& shape) {
        const Body<S>& body = space.body(shape.body());
        const Impact<S> impact =
            timeOfImpact(asked, motion, shape, RigidMotion<S>::still(body.position(), body.angle()));
        if (impact.hit) expected.push_back({shape.id(), {}, {}, impact.part});
        const S distance = shapesDistance(asked, pose, shape, TestFixture::poseOf(space, shape)).distance;
        if (distance <= S(1)) near.push_back({distance, shape.id()});
        if (distance <= S(0)) touched.push_back(shape.id());
      });
      std::sort(expected.begin(), expected.end(), TestFixture::before);
      std::sort(near.begin(), near.end());
      casts += expected.size();
      overlaps += touched.size();
      std::vector<SegmentHit<S>> hits(64);
      ASSERT_EQ(view.castShape(asked, motion, {}, hits), expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_EQ(hits[k].shape, expected[k].shape);
        EXPECT_EQ(hits[k].alpha, expected[k].alpha);
      }
      std::vector<NearHit<S>> measured(64);
      ASSERT_EQ(view.nearest(asked, pose, S(1), {}, measured), near.size());
      for (std::size_t k = 0; k < near.size(); ++k) EXPECT_EQ(measured[k].shape, near[k].second);
      std::vector<ShapeId> ids(64);
      ASSERT_EQ(view.overlapping(asked, pose, {}, ids), touched.size());
      ids.resize(touched.size());
      EXPECT_EQ(ids, touched);
    }
  }
  EXPECT_GT(casts, 50u);
  EXPECT_GT(overlaps, 20u);
}

// Rewinding: where things were when a shot was fired.
TYPED_TEST(QueryViewTest, ASavedWorldIsAskedWithoutRestoringIt) {
  using S = TypeParam;
  for (const bool dropped : {false, true}) {
    Space<S> space;
    TestFixture::fill(space, 5);
    // Moved by hand, and not placed since.
    const ShapeId moved = addDisc<S>(space, {S(0), S(20)}, S(1), S(1));
    space.step(kTick<S>);
    space.body(bodyOf(space, moved)).setPosition({S(0), S(30)});
    if (dropped) space.dropCache();
    SavedSpace<S> saved = space.save();
    SegmentHit<S> before[64], then[64];
    const auto shoot = [&](const QueryView<S>& view, SegmentHit<S>* hits) {
      return view.castRay({S(0), S(40)}, {S(0), S(-9)}, {}, std::span<SegmentHit<S>>(hits, 64));
    };
    const std::size_t count = shoot(space.queries(), before);
    ASSERT_GT(count, 1u);
    EXPECT_EQ(before[0].shape, moved);
    for (int i = 0; i < 60; ++i) space.step(kTick<S>);
    ASSERT_EQ(shoot(saved.queries(), then), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(then[i].shape, before[i].shape);
      EXPECT_EQ(then[i].point, before[i].point);
    }
    Space<S> other;
    other.restore(saved);
    space.restore(saved);
    for (int i = 0; i < 30; ++i) {
      other.step(kTick<S>);
      space.step(kTick<S>);
      ASSERT_EQ(other.hash(), space.hash());
    }
  }
  EXPECT_THROW(SavedSpace<S>().queries(), ForeignWorld);
}

TYPED_TEST(QueryViewTest, RefusesWhatIsOutOfRange) {
  using S = TypeParam;
  Space<S> space;
  const QueryView<S> view = space.queries();
  const S beyond = kMaxWorldExtent<S> + S(1);
  const Shape<S> ball = circleShape<S>({}, S(1));
  SegmentHit<S> hit;
  NearHit<S> near;
  EXPECT_THROW(view.castRay({beyond, S(0)}, {}, {}, hit), ValueOutOfRange);
  EXPECT_THROW(view.castRay({}, {S(0), beyond}, {}, hit), ValueOutOfRange);
  EXPECT_THROW(view.castRay({}, {}, {}, hit, S(-1)), NegativeRadius);
  EXPECT_THROW(view.castShape(ball, RigidMotion<S>::still({beyond, S(0)}), {}, hit), ValueOutOfRange);
  EXPECT_THROW(view.nearest(ball, Transform<S>(), S(-1), {}, near), ValueOutOfRange);
  EXPECT_THROW(view.nearest(ball, Transform<S>::translation({beyond, S(0)}), S(0), {}, near),
               ValueOutOfRange);
  EXPECT_THROW(view.distance({}, {}), ShapeNotFound);
}

TYPED_TEST(QueryViewTest, MeasuresTwoShapesOfTheWorld) {
  using S = TypeParam;
  Space<S> space;
  const ShapeId a = addDisc<S>(space, {S(0), S(0)}, S(1), S(1)),
                b = addBox<S>(space, {S(5), S(0)}, S(2), S(2), S(1));
  const ShapeDistance<S> there = space.queries().distance(a, b);
  EXPECT_EQ(there.distance, S(3));
  EXPECT_EQ(there.normal, Vector<S>(S(1), S(0)));
  EXPECT_EQ(there.pointA, Vector<S>(S(1), S(0)));
  EXPECT_EQ(there.pointB, Vector<S>(S(4), S(0)));
}

}  // namespace
}  // namespace samestep
