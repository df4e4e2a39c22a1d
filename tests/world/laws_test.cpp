// SPDX-License-Identifier: MIT
// Physical laws, exactly or within a bound that follows from the method.
#include <samestep/space.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class LawsTest : public ::testing::Test {
 protected:
  /// Discs thrown at each other in empty space.
  static std::vector<BodyId> throwDiscs(Space<S>& space, bool equalMasses) {
    Random random(21);
    std::vector<BodyId> ids;
    for (int i = 0; i < 16; ++i) {
      const S mass = equalMasses ? S(2) : S(random.between(1, 8));
      const Vector<S> place(S(2 * (i % 4)), S(2 * (i / 4)));
      const ShapeId disc = addDisc<S>(space, place, ratio<S>(15, 16), mass,
                                      {random.number<S>(-8, 8), random.number<S>(-8, 8)});
      space.change(disc, [&](Shape<S>& shape) {
        shape.setElasticity(random.number<S>(0, 1));
        shape.setFriction(random.number<S>(0, 1));
      });
      ids.push_back(bodyOf(space, disc));
    }
    return ids;
  }
  /// A body that cannot turn, with a disc of radius 1 just above or within a wall along the x axis.
  static BodyId slider(Space<S>& space, S friction, S elasticity, const Vector<S>& velocity, S height) {
    const ShapeId wall = addWall<S>(space, {S(-1000), S(0)}, {S(1000), S(0)});
    Body<S> body = Body<S>::nonRotating(S(1));
    body.setPosition({S(0), height});
    body.setVelocity(velocity);
    const BodyId id = space.add(body);
    const ShapeId disc = space.add(circleShape(id, S(1)));
    for (const ShapeId shape : {wall, disc}) {
      space.change(shape, [&](Shape<S>& s) {
        s.setFriction(shape == wall ? friction : S(1));
        s.setElasticity(shape == wall ? elasticity : S(1));
      });
    }
    return id;
  }
  /// Place within the slop of a wall: touching, and not pushed.
  static S resting() { return S(1) - ratio<S>(1, 256); }

  /// J, with the part that a step of the method shifts between motion and height: exact in free fall.
  static double energy(Space<S>& space) {
    const double dt = double(space.currentTimeStep());
    const double gx = double(space.gravity().x), gy = double(space.gravity().y);
    double sum = 0;
    space.eachBody([&](const Body<S>& body) {
      if (!body.isDynamic()) return;
      const double m = double(body.mass()), i = double(body.moment()), w = double(body.angularVelocity());
      const double vx = double(body.velocity().x), vy = double(body.velocity().y);
      const double height = gx * double(body.worldCenter().x) + gy * double(body.worldCenter().y);
      sum += m * (vx * vx + vy * vy) / 2 + i * w * w / 2 - m * height - m * dt * (gx * vx + gy * vy) / 2;
    });
    return sum;
  }
  /// Depths of the overlap of each pair of shapes, m, by their ids.
  using Depths = std::vector<std::pair<std::pair<ShapeId, ShapeId>, double>>;
  static Depths depthsOf(Space<S>& space) {
    Depths depths;
    space.eachArbiter([&](Arbiter<S>& arbiter) {
      double most = 0;
      for (int i = 0; i < arbiter.count(); ++i) most = std::max(most, -double(arbiter.depth(i)));
      depths.push_back({{arbiter.shapeA(), arbiter.shapeB()}, most});
    });
    return depths;
  }
  /// Depth by which overlaps have become less, m, summed over the pairs.
  static double removed(const Depths& before, const Depths& after) {
    double sum = 0;
    for (const auto& [pair, depth] : before) {
      double now = 0;
      for (const auto& [other, left] : after) {
        if (other == pair) now = left;
      }
      sum += std::max(0.0, depth - now);
    }
    return sum;
  }
  /// Overlaps that go lift what lies on them, with all its weight at most.
  static void expectEnergyGrowsOnlyByOverlapsRemoved(Space<S>& space, int steps, double slack) {
    double weight = 0;
    space.eachBody([&](const Body<S>& body) {
      weight += double(body.mass()) * std::hypot(double(space.gravity().x), double(space.gravity().y));
    });
    space.step(kTick<S>);
    for (int i = 0; i < steps; ++i) {
      const double before = energy(space);
      const Depths depths = depthsOf(space);
      space.step(kTick<S>);
      ASSERT_LE(energy(space), before + weight * removed(depths, depthsOf(space)) + slack) << "step " << i;
    }
  }
};
TYPED_TEST_SUITE(LawsTest, AllScalars);

// Positions move before velocities: after n steps v = -n g dt and y = -g dt^2 n (n - 1) / 2, both exact.
TYPED_TEST(LawsTest, FreeFallIsExact) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::sequentialImpulses);
  space.setGravity({S(3), S(-10)});
  const BodyId id = space.add(Body<S>(S(7), S(5)));
  for (int n = 1; n <= 300; ++n) {
    space.step(kTick<S>);
    const Body<S>& body = space.body(id);
    ASSERT_EQ(double(body.velocity().x), 3.0 * n / 64);
    ASSERT_EQ(double(body.velocity().y), -10.0 * n / 64);
    ASSERT_EQ(double(body.position().y), -10.0 * n * (n - 1) / 2 / 4096);
  }
}

// A contact gives one body what it takes from the other. In Fixed equal masses change by the same number of
// units, so nothing is lost at all. In double each addition to a velocity below 2^4 m/s rounds by 2^-50 at
// most; there are at most 2 bodies * 32 contacts * 11 passes * 400 steps of them, times the mass.
TYPED_TEST(LawsTest, MomentumOfEqualMassesIsKept) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::sequentialImpulses);
  const std::vector<BodyId> ids = this->throwDiscs(space, true);
  const auto total = [&] {
    Vector<S> sum;
    for (const BodyId id : ids) sum += space.body(id).velocity();
    return sum;
  };
  const Vector<S> before = total();
  bool touched = false;
  for (int i = 0; i < 400; ++i) {
    space.step(kTick<S>);
    space.eachArbiter([&](Arbiter<S>&) { touched = true; });
    if constexpr (FixedNumber<S>) {
      ASSERT_EQ(total(), before) << i;
    }
  }
  EXPECT_TRUE(touched);
  const double bound = 2.0 * 32 * 11 * 400 * 0x1p-50;
  EXPECT_NEAR(double(total().x), double(before.x), bound);
  EXPECT_NEAR(double(total().y), double(before.y), bound);
}

// A change u of the relative speed is shared by masses m and n >= m as u n/(m+n) and u m/(m+n), each factor
// and product rounded to 2^-33: at |u| <= 2^5 m/s both together lose less than 2^6 * (m + n) * 2^-32 N s.
TYPED_TEST(LawsTest, MomentumOfAllMassesIsKeptWithinTheRoundingOfTheImpulses) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::sequentialImpulses);
  const std::vector<BodyId> ids = this->throwDiscs(space, false);
  const auto total = [&](auto component) {
    double sum = 0;
    for (const BodyId id : ids) {
      sum += double(space.body(id).mass()) * double(component(space.body(id).velocity()));
    }
    return sum;
  };
  const auto x = [](const Vector<S>& v) { return v.x; };
  const auto y = [](const Vector<S>& v) { return v.y; };
  const double beforeX = total(x), beforeY = total(y);
  double contacts = 0;
  for (int i = 0; i < 400; ++i) {
    space.step(kTick<S>);
    space.eachArbiter([&](Arbiter<S>&) { contacts += 1; });
  }
  EXPECT_GT(contacts, 10);
  const double bound = contacts * 11 * 0x1p6 * 16 * 0x1p-32;
  EXPECT_NEAR(total(x), beforeX, bound);
  EXPECT_NEAR(total(y), beforeY, bound);
}

// One contact on a wall: v' = -e v, exactly.
TYPED_TEST(LawsTest, RestitutionIsTheRatioOfSpeeds) {
  using S = TypeParam;
  for (const S e : {S(0), ratio<S>(1, 4), ratio<S>(1, 2), S(1)}) {
    Space<S> space;
    space.setSolver(SolverKind::sequentialImpulses);
    const BodyId id = this->slider(space, S(0), e, {S(3), S(-8)}, S(1));
    space.step(kTick<S>);
    space.step(kTick<S>);
    EXPECT_EQ(space.body(id).velocity(), Vector<S>(S(3), S(8) * e));
  }
}

// Gravity tilted by 3:4 stands for an incline: mu >= 3/4 holds, exactly at rest.
TYPED_TEST(LawsTest, WithinTheFrictionConeNothingSlides) {
  using S = TypeParam;
  for (const S friction : {ratio<S>(25, 32), S(1), S(10)}) {
    Space<S> space;
    space.setSolver(SolverKind::sequentialImpulses);
    space.setGravity({S(6), S(-8)});
    const BodyId id = this->slider(space, friction, S(0), {}, this->resting());
    for (int i = 0; i < 300; ++i) space.step(kTick<S>);
    EXPECT_EQ(space.body(id).velocity(), Vector<S>());
    EXPECT_EQ(space.body(id).position(), Vector<S>(S(0), this->resting()));
  }
}

// Outside of it the acceleration is g (sin - mu cos) = 6 - 8 mu, exact for numbers both scalars hold; the way
// is a dt^2 n (n - 1) / 2 as in free fall.
TYPED_TEST(LawsTest, OutsideTheFrictionConeTheSlideIsCoulombs) {
  using S = TypeParam;
  for (const S friction : {S(0), ratio<S>(1, 4), ratio<S>(1, 2)}) {
    Space<S> space;
    space.setSolver(SolverKind::sequentialImpulses);
    space.setGravity({S(6), S(-8)});
    const BodyId id = this->slider(space, friction, S(0), {}, this->resting());
    const double a = 6 - 8 * double(friction);
    for (int n = 1; n <= 200; ++n) {
      space.step(kTick<S>);
      ASSERT_EQ(double(space.body(id).velocity().x), a * n / 64);
      ASSERT_EQ(double(space.body(id).position().x), a * n * (n - 1) / 2 / 4096);
    }
  }
}

// A slide from v = 4 m/s at mu g = 4 m/s^2 is at rest after 64 steps, having gone v^2 / (2 mu g) = 2 m and,
// as positions move before velocities, half a step of v more.
TYPED_TEST(LawsTest, ASlideEndsWhereCoulombSays) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::sequentialImpulses);
  space.setGravity({S(0), S(-8)});
  const BodyId id = this->slider(space, ratio<S>(1, 2), S(0), {S(4), S(0)}, this->resting());
  for (int n = 0; n < 200; ++n) space.step(kTick<S>);
  EXPECT_EQ(space.body(id).velocity(), Vector<S>());
  EXPECT_EQ(double(space.body(id).position().x), 2 + 4.0 / 64 / 2);
}

// Rounding only: 2^-32 of m g h per step and body is far below this.
constexpr double kRounding = 1e-6;

// A single body comes in at v < 0 and leaves at -e v: E loses at least (1 - e) |v| (v' - v) / 2 per kilogram.
// One that still touches while it leaves, slower than g dt, is stopped: E gains at most g dt v / 2, less than
// g times the way v dt by which its overlap has gone.
TYPED_TEST(LawsTest, EnergyOfABouncingDiscNeverGrows) {
  using S = TypeParam;
  for (const S e : {S(0), ratio<S>(1, 2), ratio<S>(3, 4), S(1)}) {
    Space<S> space;
    space.setSolver(SolverKind::sequentialImpulses);
    space.setGravity({S(0), S(-10)});
    this->slider(space, S(0), e, {S(1), S(0)}, S(3));
    this->expectEnergyGrowsOnlyByOverlapsRemoved(space, 400, kRounding);
  }
}

// Many bodies, plastic, with enough iterations to converge: each impulse only takes away.
TYPED_TEST(LawsTest, EnergyOfAPassivePileNeverGrows) {
  using S = TypeParam;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Space<S> space;
    space.setSolver(SolverKind::sequentialImpulses);
    space.setGravity({S(0), S(-10)});
    space.setIterations(100);
    Random random(seed);
    addWall<S>(space, {S(-20), S(0)}, {S(20), S(0)}, ratio<S>(1, 2));
    addWall<S>(space, {S(-5), S(0)}, {S(-5), S(20)}, ratio<S>(1, 2));
    addWall<S>(space, {S(5), S(0)}, {S(5), S(20)}, ratio<S>(1, 2));
    for (int i = 0; i < 12; ++i) {
      const Vector<S> place(S(3 * (i % 3) - 3) + random.number<S>(0, 1) * ratio<S>(1, 4), S(2 + 2 * (i / 3)));
      const S mass = S(random.between(1, 4));
      if (random.oneIn(2)) {
        addDisc<S>(space, place, ratio<S>(3, 4), mass);
      } else {
        addBox<S>(space, place, S(1), ratio<S>(3, 2), mass);
      }
    }
    space.eachShape([&](const Shape<S>& shape) {
      space.change(shape.id(), [](Shape<S>& s) { s.setFriction(ratio<S>(1, 2)); });
    });
    this->expectEnergyGrowsOnlyByOverlapsRemoved(space, 300, kRounding);
  }
}

// The ends of the supported ranges, all combined: CheckedFixed reports what Fixed would wrap. Both then give
// the same bits.

struct Ends {
  double massA, massB, sizeA, sizeB, speed, place, dt;
};

template <Scalar S>
std::uint64_t collideAtTheEnds(const Ends& ends, bool boxes, SolverKind solver) {
  Space<S> space;
  space.setSolver(solver);
  space.setWorldExtent(kMaxWorldExtent<S>);
  space.setGravity({S(0), -kMaxAcceleration<S>});
  space.setCollisionBias(S(0));
  const S place = S(ends.place);
  const Vector<S> center(place, -place);
  Body<S> resting = Body<S>::fixedInPlace();
  resting.setPosition(center);
  const BodyId ground = space.add(resting);
  const S reach = S(kMaxExtent - 1024);
  space.add(segmentShape(ground, Vector<S>(-reach, S(0)), Vector<S>(reach, S(0)), S(1)));
  const auto addOne = [&](S mass, S size, S x, S speed) {
    Body<S> body;
    const S limit = kMaxWorldExtent<S>;
    body.setPosition({clamp(place + x, -limit, limit), clamp(-place + size, -limit, limit)});
    body.setVelocity({speed, -abs(speed)});
    body.setAngularVelocity(speed > S(0) ? kMaxAngularSpeed<S> : -kMaxAngularSpeed<S>);
    const BodyId id = space.add(body);
    const S width = size * ratio<S>(11, 8);
    Shape<S> shape = boxes ? boxShape(id, width, width) : circleShape(id, size);
    shape.setMass(mass);
    space.add(shape);
  };
  const S sizeA = S(ends.sizeA), sizeB = S(ends.sizeB);
  addOne(S(ends.massA), sizeA, -sizeA, S(ends.speed));
  addOne(S(ends.massB), sizeB, sizeB, -S(ends.speed));
  addOne(S(ends.massA), sizeA, sizeB, S(0));
  space.eachShape([&](const Shape<S>& shape) {
    space.change(shape.id(), [](Shape<S>& s) {
      s.setFriction(S(kMaxMaterial));
      s.setElasticity(S(1));
    });
  });
  for (int i = 0; i < 12; ++i) {
    space.step(i % 4 == 3 ? S(1) : S(ends.dt));
    space.eachArbiter([](Arbiter<S>& arbiter) {
      arbiter.totalImpulse();
      arbiter.totalKE();
    });
  }
  return space.hash();
}

TEST(RangeEndsTest, NothingOverflowsAtTheEndsOfTheSupportedRanges) {
  int runs = 0;
  for (const double massA : {0.001, 1.0, 1e6}) {
    for (const double massB : {0.001, 1e6}) {
      for (const double sizeA : {0.03125, 1.0, 256.0}) {
        for (const double sizeB : {0.03125, 256.0}) {
          for (const double speed : {0.0, 1024.0}) {
            for (const double place : {0.0, 32768.0, 1048576.0}) {
              for (const double dt : {1.0 / 60, 1.0, 0x1p-30, 1.0 / 64, 1.0 / 1024}) {
                const bool boxes = runs / 2 % 2 == 1;
                const SolverKind solver =
                    runs % 2 == 0 ? SolverKind::sequentialImpulses : SolverKind::softStep;
                const Ends ends = {massA, massB, sizeA, sizeB, speed, place, dt};
                const auto what = [&] {
                  return ::testing::Message() << massA << " kg " << massB << " kg " << sizeA << " m " << sizeB
                                              << " m " << speed << " m/s at " << place << " dt " << dt
                                              << " boxes " << boxes << " solver " << int(solver);
                };
                try {
                  const std::uint64_t hash = collideAtTheEnds<CheckedFixed>(ends, boxes, solver);
                  EXPECT_EQ(hash, collideAtTheEnds<Fixed>(ends, boxes, solver)) << what();
                } catch (const std::exception& error) {
                  ADD_FAILURE() << error.what() << ": " << what();
                }
                ++runs;
              }
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace samestep
