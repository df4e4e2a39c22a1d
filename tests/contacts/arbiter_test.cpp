// SPDX-License-Identifier: MIT
#include <samestep/arbiter.h>

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class ArbiterTest : public ::testing::Test {
 public:
  /// Discs of radius 1 and the masses at (0, 0) and (x, 0), approaching each other.
  void twoDiscs(S massA, S massB, S speedA, S speedB, S x = S(1)) {
    a_ = addDisc<S>(space_, {}, S(1), massA, {speedA, S(0)});
    b_ = addDisc<S>(space_, {x, S(0)}, S(1), massB, {speedB, S(0)});
    space_.setCollisionBias(S(1));  // Nothing is pushed apart: velocities come from impulses alone.
  }
  /// Runs a step, and a call from within it.
  void step(bool (*preSolve)(Arbiter<S>&, Space<S>&, void*),
            void (*postSolve)(Arbiter<S>&, Space<S>&, void*)) {
    CollisionHandler<S> handler;
    handler.data = this;
    handler.preSolve = preSolve;
    handler.postSolve = postSolve;
    space_.registerHandler(1, handler);
    space_.addDefaultCollisionHandler(1);
    space_.step(ratio<S>(1, 1024));
  }
  Vector<S> velocity(ShapeId shape) { return space_.body(bodyOf(space_, shape)).velocity(); }
  Arbiter<S> make() {
    shapeA_.attach(pair_.a);
    shapeB_.attach(pair_.b);
    return {pair_, bodyA_, bodyB_, shapeA_, shapeB_};
  }

  Space<S> space_;
  ShapeId a_, b_;

  // An arbiter of its own, without a Space.
  Pair<S> pair_ = [] {
    Pair<S> pair;
    pair.a = {3, 1};
    pair.b = {5, 1};
    pair.localNormal = {S(1), S(0)};
    pair.count = 2;
    pair.state = ArbiterState::firstCollision;
    pair.contacts[0].anchorA = {S(2), S(1)};
    pair.contacts[0].anchorB = {S(1), S(1)};
    pair.contacts[1].anchorA = {S(2), S(-1)};
    pair.contacts[1].anchorB = {ratio<S>(3, 2), S(-1)};
    pair.manifold = Manifold::touching;
    return pair;
  }();
  Body<S> bodyA_{S(1), S(1)};
  Body<S> bodyB_{S(2), S(1)};
  Shape<S> shapeA_;
  Shape<S> shapeB_;
  int calls_ = 0;
};
TYPED_TEST_SUITE(ArbiterTest, AllScalarsAndChecked);

TYPED_TEST(ArbiterTest, ReadsThePair) {
  using S = TypeParam;
  Arbiter<S> arbiter = this->make();
  EXPECT_EQ(arbiter.shapeA(), (ShapeId{3, 1}));
  EXPECT_EQ(arbiter.shapeB(), (ShapeId{5, 1}));
  EXPECT_EQ(arbiter.count(), 2);
  EXPECT_EQ(arbiter.normal(), Vector<S>(S(1), S(0)));
  EXPECT_EQ(arbiter.pointA(1), Vector<S>(S(2), S(-1)));
  EXPECT_EQ(arbiter.pointB(1), Vector<S>(ratio<S>(3, 2), S(-1)));
  EXPECT_EQ(arbiter.depth(0), S(-1));
  EXPECT_EQ(arbiter.depth(1), ratio<S>(-1, 2));
  EXPECT_TRUE(arbiter.isFirstContact());
  EXPECT_FALSE(arbiter.isRemoval());
  EXPECT_FALSE(arbiter.ignored());
  const ContactPointSet<S> set = arbiter.contactPointSet();
  EXPECT_EQ(set.count, 2);
  EXPECT_EQ(set.normal, arbiter.normal());
  EXPECT_EQ(set.points[0].pointA, arbiter.pointA(0));
  EXPECT_EQ(set.points[1].pointB, arbiter.pointB(1));
  EXPECT_EQ(set.points[1].distance, arbiter.depth(1));
}

TYPED_TEST(ArbiterTest, IndicesOutOfBoundsAreRefused) {
  using S = TypeParam;
  Arbiter<S> arbiter = this->make();
  for (const int bad : {-1, 2, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    EXPECT_THROW(arbiter.pointA(bad), ContactIndexOutOfBounds);
    EXPECT_THROW(arbiter.pointB(bad), ContactIndexOutOfBounds);
    EXPECT_THROW(arbiter.depth(bad), ContactIndexOutOfBounds);
  }
  this->pair_.count = 1;
  EXPECT_THROW(arbiter.pointA(1), ContactIndexOutOfBounds);
  this->pair_.state = ArbiterState::cached;  // The state is that in separate.
  EXPECT_EQ(arbiter.count(), 0);
  EXPECT_THROW(arbiter.pointA(0), ContactIndexOutOfBounds);
  EXPECT_EQ(arbiter.contactPointSet().count, 0);
}

TYPED_TEST(ArbiterTest, SettersRefuseWhatIsOutOfRangeAndChangeNothing) {
  using S = TypeParam;
  Arbiter<S> arbiter = this->make();
  arbiter.setRestitution(ratio<S>(1, 2));
  arbiter.setFriction(ratio<S>(1, 4));
  arbiter.setSurfaceVelocity({S(1), S(2)});
  EXPECT_THROW(arbiter.setRestitution(S(-1)), NegativeElasticity);
  EXPECT_THROW(arbiter.setFriction(S(-1)), NegativeFriction);
  EXPECT_THROW(arbiter.setRestitution(S(kMaxMaterial) + S(1)), ValueOutOfRange);
  EXPECT_THROW(arbiter.setFriction(S(kMaxMaterial) + S(1)), ValueOutOfRange);
  EXPECT_THROW(arbiter.setSurfaceVelocity({S(0), S(-kMaxMaterial) - S(1)}), ValueOutOfRange);
  if constexpr (std::numeric_limits<S>::has_quiet_NaN) {
    const S nan = std::numeric_limits<S>::quiet_NaN();
    EXPECT_THROW(arbiter.setRestitution(nan), ValueOutOfRange);
    EXPECT_THROW(arbiter.setFriction(nan), ValueOutOfRange);
    EXPECT_THROW(arbiter.setSurfaceVelocity({nan, nan}), ValueOutOfRange);
  }
  EXPECT_EQ(arbiter.restitution(), ratio<S>(1, 2));
  EXPECT_EQ(arbiter.friction(), ratio<S>(1, 4));
  EXPECT_EQ(arbiter.surfaceVelocity(), Vector<S>(S(1), S(2)));
}

TYPED_TEST(ArbiterTest, ContactPointSetKeepsItsNumberOfPoints) {
  using S = TypeParam;
  Arbiter<S> arbiter = this->make();
  ContactPointSet<S> set = arbiter.contactPointSet();
  for (const int bad : {0, 1, 3, -2}) {
    set.count = bad;
    EXPECT_THROW(arbiter.setContactPointSet(set), ImmutableNumContacts);
  }
  set.count = 2;
  const auto refused = [&](const ContactPointSet<S>& bad) {
    EXPECT_THROW(arbiter.setContactPointSet(bad), ValueOutOfRange);
    EXPECT_EQ(arbiter.normal(), Vector<S>(S(1), S(0)));
    EXPECT_EQ(arbiter.pointA(0), Vector<S>(S(2), S(1)));
  };
  for (const Vector<S>& bad :
       {Vector<S>(), Vector<S>(S(1), S(1)), Vector<S>(std::numeric_limits<S>::max(), S(0))}) {
    ContactPointSet<S> wrong = set;
    wrong.normal = bad;
    refused(wrong);
  }
  ContactPointSet<S> far = set;
  far.points[0].pointA = {S(7), S(7)};
  far.points[1].pointB = {kMaxWorldExtent<S> + S(1), S(0)};
  refused(far);
  // A body that moves has a limit for what a point turns; a static one is not turned.
  far.points[1].pointB = {S(1 << 11), S(0)};
  refused(far);

  set.normal = {S(0), S(1)};
  set.points[0].pointA = {S(7), S(7)};
  arbiter.setContactPointSet(set);
  EXPECT_EQ(arbiter.normal(), Vector<S>(S(0), S(1)));
  EXPECT_EQ(arbiter.pointA(0), Vector<S>(S(7), S(7)));
  EXPECT_EQ(this->pair_.manifold, Manifold::unknown);
}

TYPED_TEST(ArbiterTest, NormalAndPointsFollowTheBodies) {
  using S = TypeParam;
  Arbiter<S> arbiter = this->make();
  this->bodyA_.setPosition({S(10), S(20)});
  this->bodyB_.setPosition({S(11), S(20)});
  EXPECT_EQ(arbiter.pointA(0), Vector<S>(S(12), S(21)));
  EXPECT_EQ(arbiter.pointB(0), Vector<S>(S(12), S(21)));
  EXPECT_EQ(arbiter.depth(0), S(0));
  this->bodyA_.setAngle(kPi<S> * ratio<S>(1, 2));
  EXPECT_NEAR(double(arbiter.normal().x), 0, 1e-8);
  EXPECT_NEAR(double(arbiter.normal().y), 1, 1e-8);
  EXPECT_NEAR(double(arbiter.pointA(0).x), 9, 1e-8);
  EXPECT_NEAR(double(arbiter.pointA(0).y), 22, 1e-8);
  EXPECT_NEAR(double(arbiter.depth(0)), -1, 1e-8);
}

TYPED_TEST(ArbiterTest, IgnoreAnswersFalse) {
  Arbiter<TypeParam> arbiter = this->make();
  EXPECT_FALSE(arbiter.ignore());
  EXPECT_TRUE(arbiter.ignored());
  EXPECT_FALSE(arbiter.isFirstContact());
}

// Material of a collision.

TYPED_TEST(ArbiterTest, MaterialsMultiply) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(1), S(0), S(0));
  this->space_.change(this->a_, [](Shape<S>& shape) {
    shape.setElasticity(ratio<S>(1, 2));
    shape.setFriction(ratio<S>(3, 4));
    shape.setSurfaceVelocity({S(5), S(2)});
  });
  this->space_.change(this->b_, [](Shape<S>& shape) {
    shape.setElasticity(ratio<S>(1, 4));
    shape.setFriction(ratio<S>(1, 2));
    shape.setSurfaceVelocity({S(1), S(7)});
  });
  this->step(
      [](Arbiter<S>& arbiter, Space<S>&, void*) {
        EXPECT_EQ(arbiter.restitution(), ratio<S>(1, 8));
        EXPECT_EQ(arbiter.friction(), ratio<S>(3, 8));
        // B's less A's, along the tangent.
        EXPECT_EQ(arbiter.surfaceVelocity(), Vector<S>(S(0), S(5)));
        return true;
      },
      nullptr);
}

// Equal discs, head on: v' = -e v for both, exactly.
TYPED_TEST(ArbiterTest, RestitutionTurnsTheApproachRound) {
  using S = TypeParam;
  for (const S e : {S(0), ratio<S>(1, 2), S(1)}) {
    struct Fresh : ArbiterTest<S> {
      void TestBody() override {}
    } fresh;
    fresh.twoDiscs(S(1), S(1), S(2), S(-2));
    for (const ShapeId id : {fresh.a_, fresh.b_}) {
      fresh.space_.change(id, [&](Shape<S>& shape) { shape.setElasticity(id == fresh.a_ ? e : S(1)); });
    }
    fresh.space_.step(ratio<S>(1, 1024));
    EXPECT_EQ(fresh.velocity(fresh.a_), Vector<S>(S(-2) * e, S(0)));
    EXPECT_EQ(fresh.velocity(fresh.b_), Vector<S>(S(2) * e, S(0)));
  }
}

TYPED_TEST(ArbiterTest, RestitutionCanBeOverriddenForTheStep) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(1), S(2), S(-2));
  this->step(
      [](Arbiter<S>& arbiter, Space<S>&, void*) {
        arbiter.setRestitution(S(1));
        return true;
      },
      nullptr);
  EXPECT_EQ(this->velocity(this->a_), Vector<S>(S(-2), S(0)));
  EXPECT_EQ(this->velocity(this->b_), Vector<S>(S(2), S(0)));
}

// A disc of mass 1 and radius 1 sliding over a wall at 4 m/s while it falls at 1 m/s. The wall takes the
// 1 N s of the fall, so friction mu takes mu N s sideways: v' = 4 - mu, w' = -mu / I = -2 mu for I = 1/2.
TYPED_TEST(ArbiterTest, FrictionCanBeOverriddenForTheStep) {
  using S = TypeParam;
  const S radius = S(1);
  const ShapeId wall = addWall<S>(this->space_, {S(-9), S(0)}, {S(9), S(0)});
  this->a_ = addDisc<S>(this->space_, {S(0), ratio<S>(1023, 1024)}, radius, S(1), {S(4), S(-1)});
  this->space_.setCollisionBias(S(1));
  EXPECT_EQ(this->space_.shape(wall).friction(), S(0));
  this->step(
      [](Arbiter<S>& arbiter, Space<S>&, void*) {
        arbiter.setFriction(ratio<S>(1, 2));
        return true;
      },
      nullptr);
  // The arm is longer or shorter than 1 by the depth of 2^-9 m at most: 2 * 2^-9 of the spin.
  EXPECT_NEAR(double(this->velocity(this->a_).x), 3.5, 1e-8);
  EXPECT_NEAR(double(this->velocity(this->a_).y), 0, 1e-8);
  const S spin = this->space_.body(bodyOf(this->space_, this->a_)).angularVelocity();
  EXPECT_NEAR(double(spin), -1, 1.0 / 256);
}

// A belt of 3 m/s under a disc that cannot slip: its surface ends at the speed of the belt. Chipmunk: the
// surface velocity of B less that of A is added to the relative velocity, so a belt moving things to +x has
// surface velocity +x.
TYPED_TEST(ArbiterTest, SurfaceVelocityDrivesWhatRestsOnIt) {
  using S = TypeParam;
  const ShapeId wall = addWall<S>(this->space_, {S(-9), S(0)}, {S(9), S(0)});
  this->a_ = addDisc<S>(this->space_, {S(0), ratio<S>(1023, 1024)}, S(1), S(1), {S(0), S(-8)});
  this->space_.setCollisionBias(S(1));
  this->space_.change(wall, [](Shape<S>& shape) { shape.setSurfaceVelocity({S(3), S(0)}); });
  this->step(
      [](Arbiter<S>& arbiter, Space<S>&, void*) {
        arbiter.setFriction(S(10));
        return true;
      },
      nullptr);
  const Body<S>& disc = this->space_.body(bodyOf(this->space_, this->a_));
  const double surface = double(disc.velocityAt(disc.worldCenter() + Vector<S>(S(0), S(-1))).x);
  EXPECT_NEAR(surface, 3, 0.02);
  EXPECT_NEAR(double(disc.velocity().x), 1,
              0.02);  // A third of it goes into moving a disc, the rest into spin.
}

TYPED_TEST(ArbiterTest, SurfaceVelocityOverrideIsSeenByTheOtherSideTurnedRound) {
  using S = TypeParam;
  Arbiter<S> arbiter = this->make();
  arbiter.setSurfaceVelocity({S(0), S(4)});
  EXPECT_EQ(this->pair_.surfaceVelocity, Vector<S>(S(0), S(4)));
}

TYPED_TEST(ArbiterTest, ChangedContactPointsAreWhatIsSolved) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(1), S(2), S(-2));
  this->step(
      [](Arbiter<S>& arbiter, Space<S>&, void*) {
        ContactPointSet<S> set = arbiter.contactPointSet();
        set.normal = {S(0), S(1)};  // This is across the approach: nothing to stop.
        arbiter.setContactPointSet(set);
        return true;
      },
      nullptr);
  EXPECT_EQ(this->velocity(this->a_), Vector<S>(S(2), S(0)));
  EXPECT_EQ(this->velocity(this->b_), Vector<S>(S(-2), S(0)));
}

TYPED_TEST(ArbiterTest, TotalImpulseIsTheChangeOfMomentumOfB) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(3), S(2), S(-2));
  this->step(nullptr, [](Arbiter<S>& arbiter, Space<S>&, void* data) {
    ++static_cast<ArbiterTest<S>*>(data)->calls_;
    // Common speed (2 - 6) / 4 = -1: B gains 3 * 1 N s.
    EXPECT_NEAR(double(arbiter.totalImpulse().x), 3, 1e-8);
    EXPECT_NEAR(double(arbiter.totalImpulse().y), 0, 1e-8);
  });
  EXPECT_EQ(this->calls_, 1);
  EXPECT_NEAR(double(this->velocity(this->a_).x), -1, 1e-8);
  EXPECT_NEAR(double(this->velocity(this->b_).x), -1, 1e-8);
}

// A plastic impact of masses 1 and 3 at 4 m/s: mu v^2 with mu = 3/4, twice the loss, as in Chipmunk.
TYPED_TEST(ArbiterTest, TotalKEIsTwiceTheEnergyAPlasticImpactTakes) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(3), S(2), S(-2));
  this->step(nullptr, [](Arbiter<S>& arbiter, Space<S>&, void* data) {
    ++static_cast<ArbiterTest<S>*>(data)->calls_;
    EXPECT_NEAR(double(arbiter.totalKE()), 12, 1e-7);
  });
  EXPECT_EQ(this->calls_, 1);
}

TYPED_TEST(ArbiterTest, TotalKEOfAnElasticImpactIsNothing) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(3), S(2), S(-2));
  for (const ShapeId id : {this->a_, this->b_}) {
    this->space_.change(id, [](Shape<S>& shape) { shape.setElasticity(S(1)); });
  }
  this->step(nullptr, [](Arbiter<S>& arbiter, Space<S>&, void* data) {
    ++static_cast<ArbiterTest<S>*>(data)->calls_;
    EXPECT_NEAR(double(arbiter.totalKE()), 0, 1e-7);
  });
  EXPECT_EQ(this->calls_, 1);
}

TYPED_TEST(ArbiterTest, ImpulseAndEnergyAreNothingWhereNothingWasSolved) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(3), S(2), S(-2));
  this->space_.change(this->a_, [](Shape<S>& shape) { shape.setSensor(true); });
  this->space_.step(kTick<S>);
  int visits = 0;
  this->space_.eachArbiter([&](Arbiter<S>& arbiter) {
    ++visits;
    EXPECT_EQ(arbiter.totalImpulse(), Vector<S>());
    EXPECT_EQ(arbiter.totalKE(), S(0));
  });
  EXPECT_EQ(visits, 1);
}

TYPED_TEST(ArbiterTest, ABodyAddedAfterTheThreadsWereMadeHasNone) {
  using S = TypeParam;
  this->twoDiscs(S(1), S(3), S(2), S(-2));
  this->space_.step(kTick<S>);
  int visits = 0;
  const auto visit = [&](Arbiter<S>&) { ++visits; };
  this->space_.eachArbiter(bodyOf(this->space_, this->a_), visit);
  EXPECT_EQ(visits, 1);
  std::vector<BodyId> added;
  for (int i = 0; i < 20; ++i) added.push_back(this->space_.add(Body<S>(S(1), S(1))));
  for (const BodyId id : added) this->space_.eachArbiter(id, visit);
  EXPECT_EQ(visits, 1);
}

TYPED_TEST(ArbiterTest, APairThatNothingMovesIsUnsolvable) {
  using S = TypeParam;
  Pair<S> pair = this->pair_;
  pair.solved = 1;
  Body<S> a = Body<S>::fixedInPlace();
  Body<S> b = Body<S>::kinematic();
  Arbiter<S> arbiter(pair, a, b, this->shapeA_, this->shapeB_);
  EXPECT_THROW(arbiter.totalKE(), UnsolvableCollision);
}

TYPED_TEST(ArbiterTest, GettersSaturateAtTheEndsOfTheRanges) {
  using S = TypeParam;
  Pair<S> pair = this->pair_;
  pair.solved = 1;
  pair.state = ArbiterState::normal;
  for (Contact<S>& contact : pair.contacts) {
    contact.normalTotal = S(1 << 20);
    contact.tangentTotal = S(1 << 20);
    contact.anchorA += Vector<S>(S(200), S(200));
    contact.anchorB -= Vector<S>(S(200), S(200));
  }
  pair.solvedImpulse = {S(1 << 21), S(1 << 21)};
  Body<S> a(kMaxMass<S>, kMinMoment<S>);
  Body<S> b(kMaxMass<S>, kMinMoment<S>);
  a.setPosition({S(-200), S(-200)});
  b.setPosition({S(200), S(200)});
  Arbiter<S> arbiter(pair, a, b, this->shapeA_, this->shapeB_);
  EXPECT_GT(arbiter.totalImpulse().x, S(1 << 30));
  EXPECT_GT(arbiter.totalKE(), S(1 << 30));
}

}  // namespace
}  // namespace samestep
