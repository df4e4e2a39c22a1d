// SPDX-License-Identifier: MIT
// Joints as objects of a Space: how they come and go, what is refused, and that they are part of its state.
#include <samestep/space.h>

#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/snapshot.h>
#include <samestep/workers.h>
#include "support/joints.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr SolverKind kSolvers[] = {SolverKind::softStep, SolverKind::sequentialImpulses};

template <Scalar S>
class JointTest : public ::testing::Test {
 protected:
  JointTest() {
    space_.setGravity({S(0), S(-10)});
    a_ = bodyOf(space_, addBox<S>(space_, {S(0), S(0)}, S(1), S(1), S(1)));
    b_ = bodyOf(space_, addBox<S>(space_, {S(1), S(0)}, S(1), S(1), S(2)));
  }
  Joint<S> hinge() const { return revoluteJoint<S>(a_, b_, {ratio<S>(1, 2), S(0)}, {ratio<S>(-1, 2), S(0)}); }

  Space<S> space_;
  BodyId a_, b_;
};
TYPED_TEST_SUITE(JointTest, AllScalarsAndChecked);

TYPED_TEST(JointTest, IsFoundUnderItsIdUntilItIsRemoved) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  Joint<S> joint = this->hinge();
  joint.userData = 77;
  const JointId id = space.add(joint);
  EXPECT_TRUE(space.contains(id));
  EXPECT_EQ(space.jointCount(), 1u);
  EXPECT_EQ(space.joint(id).userData, 77u);
  EXPECT_EQ(space.joint(id).bodyB, this->b_);
  space.remove(id);
  EXPECT_FALSE(space.contains(id));
  expectRefused<JointNotFound>(space, [&] { space.joint(id); });
  expectRefused<JointNotFound>(space, [&] { space.remove(id); });
  expectRefused<JointNotFound>(space, [&] { space.replace(id, joint); });
  EXPECT_EQ(space.add(joint), (JointId{0, 3}));
}

TYPED_TEST(JointTest, GoesWithEitherBody) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  const BodyId other = space.add(Body<S>(S(1), S(1)));
  const JointId hinge = space.add(this->hinge());
  const JointId rope = space.add(ropeJoint<S>(this->b_, other, {}, {}, S(0), S(3)));
  const JointId kept = space.add(distanceJoint<S>(space.staticBody(), other, {}, {}, S(3)));
  space.removeWithShapes(this->b_);
  EXPECT_FALSE(space.contains(hinge));
  EXPECT_FALSE(space.contains(rope));
  EXPECT_TRUE(space.contains(kept));
  space.remove(other);
  EXPECT_EQ(space.jointCount(), 0u);
}

TYPED_TEST(JointTest, OfNoTwoBodiesOfTheSpaceIsRefused) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  Space<S> elsewhere;
  elsewhere.add(Body<S>(S(1), S(1)));
  const BodyId foreign = elsewhere.add(Body<S>(S(1), S(1)));
  const BodyId gone = space.add(Body<S>(S(1), S(1)));
  space.remove(gone);
  const JointId held = space.add(this->hinge());
  for (const BodyId wrong : {foreign, gone, BodyId{}, BodyId{4000, 1}}) {
    Joint<S> joint = this->hinge();
    joint.bodyA = wrong;
    expectRefused<BodyNotFound>(space, [&] { space.add(joint); });
    expectRefused<BodyNotFound>(space, [&] { space.replace(held, joint); });
    std::swap(joint.bodyA, joint.bodyB);
    expectRefused<BodyNotFound>(space, [&] { space.add(joint, {7, 1}); });
  }
  Joint<S> joint = this->hinge();
  joint.bodyB = joint.bodyA;
  expectRefused<IllegalJoint>(space, [&] { space.add(joint); });
}

TYPED_TEST(JointTest, WithANumberOutOfItsRangeIsRefused) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  const JointId held = space.add(this->hinge());
  const auto refuses = [&](auto&& spoil) {
    Joint<S> joint = this->hinge();
    spoil(joint);
    expectRefused<IllegalJoint>(space, [&] { space.add(joint); });
    expectRefused<IllegalJoint>(space, [&] { space.replace(held, joint); });
  };
  const S little = ratio<S>(1, 1024);
  refuses([&](Joint<S>& j) { j.anchorA.x = kMaxAnchor<S> + little; });
  refuses([&](Joint<S>& j) { j.anchorB.y = -kMaxAnchor<S> - little; });
  refuses([&](Joint<S>& j) { j.axis = {S(1), S(1)}; });
  refuses([&](Joint<S>& j) { j.axis = {}; });
  refuses([&](Joint<S>& j) { j.axis = {S(1 << 20), S(0)}; });
  refuses([&](Joint<S>& j) { j.velocity.x = kMaxSpeed<S> + little; });
  refuses([&](Joint<S>& j) { j.rest = kMaxJointCoordinate<S> + little; });
  refuses([&](Joint<S>& j) { j.angle = -kMaxJointCoordinate<S> - little; });
  refuses([&](Joint<S>& j) { j.lower = little; });
  refuses([&](Joint<S>& j) { j.upper = kMaxJointCoordinate<S> + little; });
  refuses([&](Joint<S>& j) { j.motorSpeed = kMaxAngularSpeed<S> + little; });
  refuses([&](Joint<S>& j) { j.motorMax = -little; });
  refuses([&](Joint<S>& j) { j.hertz = S(1000) + little; });
  refuses([&](Joint<S>& j) { j.damping = S(100) + little; });
  refuses([&](Joint<S>& j) { j.angularHertz = -little; });
  refuses([&](Joint<S>& j) { j.angularDamping = -little; });
  refuses([&](Joint<S>& j) { j.maxForce = kMaxForce<S> + little; });
  refuses([&](Joint<S>& j) { j.maxTorque = -little; });
  refuses([&](Joint<S>& j) { j.breakForce = -little; });
  refuses([&](Joint<S>& j) { j.breakTorque = kMaxForce<S> + little; });
  refuses([&](Joint<S>& j) { j.ratio = S(0); });
  refuses([&](Joint<S>& j) { j.ratio = S(-kMaxGearRatio) - little; });
  refuses([&](Joint<S>& j) { j.kind = static_cast<JointKind>(8); });
  refuses([&](Joint<S>& j) { j.limited = 2; });
  refuses([&](Joint<S>& j) { j.kind = JointKind::ratchet; });
  refuses([&](Joint<S>& j) {
    j.kind = JointKind::distance;
    j.rest = -little;
  });
  if constexpr (!FixedNumber<S>) {
    const S nan = std::numeric_limits<S>::quiet_NaN(), infinite = std::numeric_limits<S>::infinity();
    for (const S bad : {nan, infinite, -infinite}) {
      refuses([&](Joint<S>& j) { j.anchorA.y = bad; });
      refuses([&](Joint<S>& j) { j.axis.x = bad; });
      refuses([&](Joint<S>& j) { j.rest = bad; });
      refuses([&](Joint<S>& j) { j.lower = bad; });
      refuses([&](Joint<S>& j) { j.motorMax = bad; });
      refuses([&](Joint<S>& j) { j.ratio = bad; });
    }
  }
}

TYPED_TEST(JointTest, SaysWhatIsWrongAndWhatIsAllowed) {
  using S = TypeParam;
  Joint<S> joint = this->hinge();
  joint.hertz = S(1001);
  try {
    this->space_.add(joint);
    FAIL();
  } catch (const IllegalJoint& error) {
    EXPECT_STREQ(error.what(), "Space::add: a joint: hertz are out of range, allowed are 0 to 1000");
  }
}

TYPED_TEST(JointTest, WhileAStepRunsNoneComesGoesOrChanges) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  const JointId id = space.add(this->hinge());
  space.lock();
  expectRefused<SpaceLocked>(space, [&] { space.add(this->hinge()); });
  expectRefused<SpaceLocked>(space, [&] { space.remove(id); });
  expectRefused<SpaceLocked>(space, [&] { space.replace(id, this->hinge()); });
  space.unlock(true);
}

TYPED_TEST(JointTest, TheStaticBodyIsNotReplacedWhileItHasJoints) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  const JointId id = space.add(distanceJoint<S>(space.staticBody(), this->a_, {}, {}, S(1)));
  expectRefused<AttachedStaticBody>(space, [&] { space.setStaticBody(Body<S>::fixedInPlace()); });
  space.remove(id);
  EXPECT_NO_THROW(space.setStaticBody(Body<S>::fixedInPlace()));
}

TYPED_TEST(JointTest, ChangesKeepTheImpulsesOfTheSameKind) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  const JointId id = space.add(
      revoluteJoint<S>(space.staticBody(), this->a_, {ratio<S>(-1, 2), S(0)}, {ratio<S>(-1, 2), S(0)}));
  for (int i = 0; i < 5; ++i) space.step(kTick<S>);
  const JointImpulses<S> kept = space.joint(id).kept;
  EXPECT_NE(kept, JointImpulses<S>());
  space.change(id, [](Joint<S>& joint) { joint.userData = 5; });
  EXPECT_EQ(space.joint(id).kept, kept);
  space.change(id, [](Joint<S>& joint) { joint.kind = JointKind::weld; });
  EXPECT_EQ(space.joint(id).kept, JointImpulses<S>());
}

TYPED_TEST(JointTest, BodiesAreAskedForTheirJointsAndForWhatTheyConnect) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  std::vector<BodyId> more;
  for (int i = 0; i < 4; ++i) more.push_back(space.add(Body<S>(S(1), S(1))));
  const JointId first = space.add(this->hinge());
  const JointId second = space.add(distanceJoint<S>(this->b_, more[0], {}, {}, S(1)));
  space.add(distanceJoint<S>(more[0], space.staticBody(), {}, {}, S(1)));
  space.add(distanceJoint<S>(space.staticBody(), more[1], {}, {}, S(1)));
  space.add(distanceJoint<S>(more[2], more[3], {}, {}, S(1)));
  std::vector<JointId> joints;
  space.eachJoint(this->b_, [&](JointId id, const Joint<S>&) { joints.push_back(id); });
  EXPECT_EQ(joints, (std::vector<JointId>{first, second}));
  const auto connected = [&](BodyId of) {
    std::vector<BodyId> found;
    space.eachConnected(of, [&](BodyId id) { found.push_back(id); });
    return found;
  };
  EXPECT_EQ(connected(this->a_), (std::vector<BodyId>{space.staticBody(), this->b_, more[0]}));
  EXPECT_EQ(connected(more[1]), (std::vector<BodyId>{space.staticBody()}));
  EXPECT_EQ(connected(more[3]), (std::vector<BodyId>{more[2]}));
  EXPECT_EQ(connected(space.staticBody()), (std::vector<BodyId>{this->a_, this->b_, more[0], more[1]}));
}

TYPED_TEST(JointTest, KeepsItsBodiesFromCollidingUnlessToldOtherwise) {
  using S = TypeParam;
  Space<S>& space = this->space_;
  const auto touching = [&] {
    int count = 0;
    space.eachArbiter([&](Arbiter<S>&) { ++count; });
    return count;
  };
  space.setGravity({});
  space.step(kTick<S>);
  EXPECT_EQ(touching(), 1);
  Joint<S> joint = this->hinge();
  const JointId id = space.add(joint);
  space.step(kTick<S>);
  EXPECT_EQ(touching(), 0);
  joint.collideConnected = 1;
  space.replace(id, joint);
  space.step(kTick<S>);
  EXPECT_EQ(touching(), 1);
  joint.collideConnected = 0;
  space.replace(id, joint);
  space.step(kTick<S>);
  EXPECT_EQ(touching(), 0);
  space.remove(id);
  space.step(kTick<S>);
  EXPECT_EQ(touching(), 1);
}

TYPED_TEST(JointTest, TellsTheForceWithWhichItHolds) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setGravity({S(0), S(-10)});
    const BodyId load = space.add(Body<S>(S(3), S(1)));
    const JointId id = space.add(weldJoint<S>(space.staticBody(), load, {S(-2), S(0)}, {S(-2), S(0)}, S(0)));
    for (int i = 0; i < 120; ++i) space.step(kTick<S>);
    EXPECT_NEAR(double(space.joint(id).force.y), 30, 0.1);
    EXPECT_NEAR(double(space.joint(id).force.x), 0, 0.1);
    EXPECT_NEAR(double(space.joint(id).torque), 60, 1);
  }
}

TYPED_TEST(JointTest, BreaksAboveItsForceAndIsListed) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    for (const bool breaks : {false, true}) {
      Space<S> space;
      space.setSolver(solver);
      space.setGravity({S(0), S(-10)});
      EventListing<S> listing;
      listing.joints = true;
      space.setEventListing(listing);
      const BodyId load = space.add(Body<S>(S(3), S(1)));
      Joint<S> joint = weldJoint<S>(space.staticBody(), load, {}, {}, S(0));
      joint.breakForce = S(breaks ? 29 : 31);
      joint.userData = 9;
      const JointId id = space.add(joint);
      space.step(kTick<S>);
      EXPECT_EQ(space.contains(id), !breaks);
      ASSERT_EQ(space.jointEvents().size(), breaks ? 1u : 0u);
      if (breaks) {
        const JointEvent<S>& event = space.jointEvents()[0];
        EXPECT_EQ(event.joint, id);
        EXPECT_EQ(event.bodyB, load);
        EXPECT_EQ(event.change, JointChange::broke);
        EXPECT_EQ(event.userData, 9u);
        EXPECT_NEAR(double(event.force.y), 30, 0.1);
      }
      space.step(kTick<S>);
      EXPECT_TRUE(space.jointEvents().empty());
    }
  }
}

TYPED_TEST(JointTest, ListsALimitOnceForAsLongAsItHolds) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setGravity({S(0), S(-10)});
    EventListing<S> listing;
    listing.joints = true;
    space.setEventListing(listing);
    const BodyId load = space.add(Body<S>(S(3), S(1)));
    Joint<S> joint = prismaticJoint<S>(space.staticBody(), load, {}, {}, {S(0), S(1)});
    joint.limited = 1;
    joint.lower = ratio<S>(-1, 2);
    joint.upper = S(2);
    space.add(joint);
    int lower = 0, upper = 0;
    for (int i = 0; i < 240; ++i) {
      if (i == 120) space.setGravity({S(0), S(10)});
      space.step(kTick<S>);
      for (const JointEvent<S>& event : space.jointEvents()) {
        ++(event.change == JointChange::reachedLower ? lower : upper);
      }
    }
    EXPECT_EQ(lower, 1);
    EXPECT_EQ(upper, 1);
    EXPECT_NEAR(double(space.body(load).position().y), 2, 0.01);
  }
}

template <Scalar S>
void fillWithJoints(Space<S>& space, std::uint64_t seed, SolverKind solver) {
  space.setSolver(solver);
  fillAtRandom(space, seed);
  joinAtRandom(space, seed + 1000);
}

TYPED_TEST(JointTest, AWorldWithJointsGoesOnFromEverySaveAndSnapshot) {
  using S = TypeParam;
  std::size_t broken = 0;
  for (const SolverKind solver : kSolvers) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      Space<S> space, restored, loaded;
      fillWithJoints(space, seed, solver);
      const std::size_t joints = space.jointCount();
      SavedSpace<S> saved;
      for (int tick = 0; tick < 40; ++tick) {
        space.save(saved);
        restored.restore(saved);
        std::vector<std::uint8_t> bytes(saveSnapshot(space, {}));
        saveSnapshot<S>(space, bytes);
        loadSnapshot<S>(loaded, bytes);
        ASSERT_EQ(restored.hash(), space.hash());
        ASSERT_EQ(loaded.hash(), space.hash());
        space.step(kTick<S>);
        restored.step(kTick<S>);
        loaded.step(kTick<S>);
        space.dropCache();
        ASSERT_EQ(restored.hash(), space.hash()) << tick;
        ASSERT_EQ(loaded.hash(), space.hash()) << tick;
      }
      broken += joints - space.jointCount();
    }
  }
  EXPECT_GT(broken, 0u);
}

TYPED_TEST(JointTest, NoKernelOrNumberOfWorkersShows) {
  using S = TypeParam;
  WorkerPool pool(3);
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    const auto run = [&](KernelTarget kernel, TaskRunner* runner) {
      Space<S> space;
      space.forceKernel(kernel);
      space.setWorkers(runner, Sharing::always);
      fillWithJoints(space, seed, SolverKind::softStep);
      return hashesOf(space, 40);
    };
    const auto expected = run(KernelTarget::best, nullptr);
    EXPECT_EQ(run(KernelTarget::best, &pool), expected);
    for (const KernelTarget kernel : availableKernels()) EXPECT_EQ(run(kernel, nullptr), expected);
  }
}

TYPED_TEST(JointTest, SleepersWakeWhenAJointComesGoesOrChanges) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> space;
    space.setSolver(solver);
    space.setGravity({S(0), S(-10)});
    Settings<S> settings = space.settings();
    settings.sleepTimeThreshold = ratio<S>(1, 2);
    space.setSettings(settings);
    const BodyId upper = space.add(Body<S>(S(1), S(1))), lower = space.add(Body<S>(S(1), S(1)));
    const Vector<S> half(S(0), ratio<S>(1, 2));
    space.body(upper).setPosition(-half);
    space.body(lower).setPosition(-half * S(3));
    const JointId nail = space.add(revoluteJoint<S>(space.staticBody(), upper, {}, half));
    const JointId link = space.add(revoluteJoint<S>(upper, lower, -half, half));
    const auto sleep = [&] {
      for (int i = 0; i < 256 && !std::as_const(space).body(lower).isSleeping(); ++i) space.step(kTick<S>);
      ASSERT_TRUE(std::as_const(space).body(lower).isSleeping());
      ASSERT_TRUE(std::as_const(space).body(upper).isSleeping());
    };
    sleep();
    space.change(nail, [](Joint<S>& joint) { joint.anchorA.y = ratio<S>(1, 16); });
    for (int i = 0; i < 2; ++i) space.step(kTick<S>);
    EXPECT_FALSE(std::as_const(space).body(lower).isSleeping());
    EXPECT_GT(double(std::as_const(space).body(upper).position().y), -0.49);
    sleep();
    space.remove(link);
    space.step(kTick<S>);
    EXPECT_LT(space.body(lower).velocity().y, S(0));
    EXPECT_FALSE(std::as_const(space).body(upper).isSleeping());
  }
}

TYPED_TEST(JointTest, UnderGivenIdsTheOrderOfJointsDoesNotShow) {
  using S = TypeParam;
  for (const SolverKind solver : kSolvers) {
    Space<S> forward, backward;
    for (Space<S>* space : {&forward, &backward}) {
      space->setSolver(solver);
      fillAtRandom(*space, 5);
    }
    Space<S> source;
    fillWithJoints(source, 5, solver);
    std::vector<Joint<S>> joints;
    source.eachJoint([&](JointId, const Joint<S>& joint) { joints.push_back(joint); });
    const auto add = [&](Space<S>& space, std::size_t i) {
      Joint<S> joint = joints[i];
      joint.bodyA = joint.bodyA.anywhere();
      joint.bodyB = joint.bodyB.anywhere();
      space.add(joint, {static_cast<std::uint32_t>(2 * i), 1});
    };
    for (std::size_t i = 0; i < joints.size(); ++i) add(forward, i);
    for (std::size_t i = joints.size(); i-- > 0;) add(backward, i);
    ASSERT_EQ(backward.hash(), forward.hash());
    EXPECT_EQ(hashesOf(backward, 60), hashesOf(forward, 60));
  }
}

// Nothing in it leaves the range of a Fixed: CheckedFixed throws where something does.
TYPED_TEST(JointTest, StaysInRangeAtTheEndsOfAllRanges) {
  using S = TypeParam;
  int steps = 0;
  for (const SolverKind solver : kSolvers) {
    for (const auto& [massA, massB] :
         {std::pair{kMinMass<S>, kMaxMass<S>}, std::pair{kMaxMass<S>, kMinMass<S>},
          std::pair{kMaxMass<S>, kMaxMass<S>}}) {
      for (const S moment : {kMinMoment<S>, S(1), kMaxMoment<S>}) {
        for (const S anchor : {S(0), S(1), kMaxAnchor<S>}) {
          Space<S> space;
          space.setSolver(solver);
          space.setGravity({S(0), S(-10)});
          const BodyId a = space.add(Body<S>(massA, moment)), b = space.add(Body<S>(massB, moment));
          space.body(b).setPosition({S(1 << 14), S(3)});
          space.body(b).setVelocity({kMaxSpeed<S>, -kMaxSpeed<S>});
          space.body(a).setAngularVelocity(kMaxAngularSpeed<S>);
          space.body(b).setAngle(S(1 << 22));
          for (Joint<S> joint : jointsOfEachKind<S>(a, b, {anchor, -anchor}, {-anchor, anchor})) {
            joint.ratio = joint.ratio * S(128);
            joint.motorMax = joint.motorMax * S(1 << 20);
            joint.hertz = joint.hertz * S(100);
            joint.damping = S(0);
            space.add(joint);
            space.step(ratio<S>(1, 60));
            space.step(ratio<S>(1, 1 << 14));
            space.step(S(1));
            steps += 3;
          }
        }
      }
    }
  }
  EXPECT_EQ(steps, 2 * 27 * 18 * 3);
}

}  // namespace
}  // namespace samestep
