// SPDX-License-Identifier: MIT
#include <samestep/space_codec.h>

#include <gtest/gtest.h>

#include <limits>
#include <string_view>
#include <type_traits>

#include "state/state_hash.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <class S>
class SpaceCodecTest : public ::testing::Test {};
TYPED_TEST_SUITE(SpaceCodecTest, AllScalarsAndChecked);

template <Scalar S>
std::vector<std::uint8_t> encoded(const Space<S>& space) {
  std::vector<std::uint8_t> bytes;
  encodeWorld(space.state(), bytes);
  return bytes;
}

TYPED_TEST(SpaceCodecTest, AWorldReadBackContinuesAsTheOriginal) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Space<TypeParam> space;
    fillAtRandom(space, seed);
    for (int part = 0; part < 4; ++part) {
      const std::vector<std::uint8_t> bytes = encoded(space);
      std::uint64_t offset = 0;
      Space<TypeParam> copy;
      copy.adopt(decodeWorld<TypeParam>(bytes, offset));
      ASSERT_EQ(offset, bytes.size());
      ASSERT_EQ(copy.hash(), space.hash());
      ASSERT_EQ(encoded(copy), bytes);
      ASSERT_EQ(hashesOf(copy, 25), hashesOf(space, 25)) << "seed " << seed << ", part " << part;
    }
  }
}

TYPED_TEST(SpaceCodecTest, IdsMintedLaterAreTheSame) {
  Space<TypeParam> space;
  std::vector<BodyId> ids;
  for (int i = 0; i < 6; ++i) ids.push_back(space.add(Body<TypeParam>(TypeParam(1), TypeParam(1))));
  for (const int i : {4, 1, 2}) space.remove(ids[static_cast<std::size_t>(i)]);
  std::uint64_t offset = 0;
  Space<TypeParam> copy;
  copy.adopt(decodeWorld<TypeParam>(encoded(space), offset));

  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(copy.add(Body<TypeParam>()), space.add(Body<TypeParam>()));
  }
}

TYPED_TEST(SpaceCodecTest, EveryWorldOfALivingSpaceIsWithoutFlaw) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Space<TypeParam> space;
    fillAtRandom(space, seed);
    if (seed % 2 == 0) space.setSolver(SolverKind::softStep);
    for (int i = 0; i < 50; ++i) {
      space.step(kTick<TypeParam>);
      ASSERT_EQ(flawOf(space.state()), nullptr) << "seed " << seed << ", step " << i;
    }
  }
}

// The hash of the shapes is kept from step to step.
TYPED_TEST(SpaceCodecTest, TheHashFollowsEveryChangeOfAShape) {
  using S = TypeParam;
  Space<S> space;
  fillAtRandom(space, 6);
  const SavedSpace<S> start = space.save();
  const auto expectFresh = [&] {
    EXPECT_EQ(space.hash(), hashOfWorld(space.state(), hashOfShapes(space.state().shapes)));
  };
  const std::uint64_t before = space.hash();
  const ShapeId disc = addDisc(space, {S(1), S(9)}, S(1), S(2));
  expectFresh();
  space.change(disc, [](Shape<S>& shape) { shape.setFriction(ratio<S>(1, 8)); });
  expectFresh();
  space.step(kTick<S>);
  expectFresh();
  space.remove(disc);
  expectFresh();
  space.restore(start);
  expectFresh();
  EXPECT_EQ(space.hash(), before);
}

// The next step may solve them as they are.
TYPED_TEST(SpaceCodecTest, KeptContactsMustBeOnesThatShapesCanHave) {
  using S = TypeParam;
  Space<S> space;
  space.setSolver(SolverKind::softStep);
  addBox<S>(space, {}, S(1), S(1), S(1));
  addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1));
  space.step(kTick<S>);
  WorldState<S> world = space.state();
  ASSERT_EQ(world.pairs.size(), 1u);
  Pair<S>& pair = world.pairs[0];
  const Pair<S> good = pair;
  ASSERT_EQ(pair.manifold, Manifold::touching);
  ASSERT_EQ(flawOf(world), nullptr);
  const auto refused = [&] {
    EXPECT_NE(flawOf(world), nullptr);
    pair.manifold = Manifold::unknown;
    EXPECT_EQ(flawOf(world), nullptr);
    pair = good;
  };
  pair.count = 0;
  refused();
  pair.localNormal = pair.localNormal * ratio<S>(1, 2);
  refused();
  pair.contacts[0].anchorB.x = S(2 * kMaxExtent + 1);
  refused();
}

// A solver leaves pushes up to 2^20 m/s of the lighter body, friction up to 2^10 times that.
TYPED_TEST(SpaceCodecTest, KeptImpulsesMustBeOnesThatASolverLeaves) {
  using S = TypeParam;
  Space<S> space;
  addBox<S>(space, {}, S(1), S(1), S(1));
  addBox<S>(space, {S(0), ratio<S>(1, 2)}, S(1), S(1), S(1));
  space.step(kTick<S>);
  WorldState<S> world = space.state();
  ASSERT_EQ(world.pairs.size(), 1u);
  Contact<S>& contact = world.pairs[0].contacts[0];
  const S most(1 << 20), unit = ratio<S>(1, 1024);
  contact.normalSpeed = most;
  contact.tangentSpeed = kMaxForce<S> - S(1);
  EXPECT_EQ(flawOf(world), nullptr);
  contact.tangentSpeed = -contact.tangentSpeed;
  EXPECT_EQ(flawOf(world), nullptr);
  for (const S bad : {kMaxForce<S>, -kMaxForce<S>, std::numeric_limits<S>::lowest()}) {
    contact.tangentSpeed = bad;
    EXPECT_NE(flawOf(world), nullptr);
  }
  contact.tangentSpeed = S(0);
  for (const S bad : {most + unit, -unit}) {
    contact.normalSpeed = bad;
    EXPECT_NE(flawOf(world), nullptr);
  }
}

// All of them are added to speeds that a body may have: a step holds them, and so must what is read.
TYPED_TEST(SpaceCodecTest, AMovingBodyMustBeOneThatAStepLeaves) {
  using S = TypeParam;
  Space<S> space;
  const ShapeId box = addBox<S>(space, {}, S(1), S(1), S(1));
  const BodyId id = space.shape(box).body();
  const auto flawWith = [&](const char* name, const auto& value) {
    WorldState<S> world = space.state();
    Body<S>& body = world.bodies.valueAt(id.index);
    int found = 0;
    const auto set = [&](const char* field, auto& now) {
      if constexpr (requires { now = value; }) {
        if (std::string_view(field) != name) return;
        now = static_cast<std::remove_reference_t<decltype(now)>>(value);
        ++found;
      }
    };
    Body<S>::fields(body, set);
    EXPECT_EQ(found, 1) << name;
    return flawOf(world);
  };
  const S unit = ratio<S>(1, 1024);
  EXPECT_EQ(flawWith("velocityBias", Vector<S>(kMaxSpeed<S>, -kMaxSpeed<S>)), nullptr);
  EXPECT_NE(flawWith("velocityBias", Vector<S>(kMaxSpeed<S> + unit, S(0))), nullptr);
  EXPECT_EQ(flawWith("angularVelocityBias", -kMaxAngularSpeed<S>), nullptr);
  EXPECT_NE(flawWith("angularVelocityBias", -kMaxAngularSpeed<S> - unit), nullptr);
  EXPECT_EQ(flawWith("centerOfMass", Vector<S>(S(0), kMaxCenterOfMass<S>)), nullptr);
  EXPECT_NE(flawWith("centerOfMass", Vector<S>(S(0), kMaxCenterOfMass<S> + unit)), nullptr);
}

TYPED_TEST(SpaceCodecTest, IsRefusedWhereverItIsCutShort) {
  Space<TypeParam> space;
  fillAtRandom(space, 2);
  hashesOf(space, 40);
  const std::vector<std::uint8_t> bytes = encoded(space);
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    std::uint64_t offset = 0;
    EXPECT_THROW(decodeWorld<TypeParam>(std::span(bytes).first(length), offset), FormatError);
    EXPECT_EQ(offset, 0u);
  }
}

}  // namespace
}  // namespace samestep
