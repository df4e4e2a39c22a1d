// SPDX-License-Identifier: MIT
#include "state/state_hash.h"

#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/space.h>
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class StateHashTest : public ::testing::Test {};
TYPED_TEST_SUITE(StateHashTest, AllScalars);

/// XXH3-64 of bytes put together by hand.
std::uint64_t hashOfBytes(const std::vector<std::uint8_t>& bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

// The canonical encoding: little-endian, in the order of the fields, nothing between.
TEST(StateHashTest, IsXxh3OverLittleEndianFields) {
  HandlerBinding binding;
  binding.typeA = 0x01020304;
  binding.typeB = 0x11121314;
  binding.number = 0x21222324;
  binding.kind = HandlerBinding::Kind::fallback;
  binding.unused[0] = 9;  // No field.

  EXPECT_EQ(hashOf(binding), hashOfBytes({4, 3, 2, 1, 0x14, 0x13, 0x12, 0x11, 0x24, 0x23, 0x22, 0x21, 2}));
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(StateHashTest, DoublesGoInAsTheirBits) {
  Contact<double> contact;
  contact.anchorA = {1.0, -2.0};
  contact.feature = 5;
  std::vector<std::uint8_t> bytes(6 * 8 + 4, 0);
  bytes[6] = 0xf0, bytes[7] = 0x3f;
  bytes[15] = 0xc0;
  bytes[48] = 5;
  EXPECT_EQ(hashOf(contact), hashOfBytes(bytes));
}
#endif

TEST(StateHashTest, FixedNumbersGoInAsTheirUnits) {
  Contact<Fixed> contact;
  contact.anchorA = {Fixed(1), Fixed(-1)};
  std::vector<std::uint8_t> bytes(6 * 8 + 4, 0);
  bytes[4] = 1;
  for (const std::size_t i : {12u, 13u, 14u, 15u}) bytes[i] = 0xff;
  EXPECT_EQ(hashOf(contact), hashOfBytes(bytes));
}

TEST(StateHashTest, LongInputsAreHashedAsAWhole) {
  HashSink sink;
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t i = 0; i < 5001; ++i) {
    sink.put(static_cast<std::uint8_t>(i));
    sink.put(std::uint64_t{i} << 40 | i);
    bytes.push_back(static_cast<std::uint8_t>(i));
    for (int k = 0; k < 8; ++k)
      bytes.push_back(static_cast<std::uint8_t>((std::uint64_t{i} << 40 | i) >> (8 * k)));
  }
  EXPECT_EQ(sink.finish(), hashOfBytes(bytes));
}

TEST(StateHashTest, IsTheSameWithEveryKernel) {
  for (const std::uint32_t numbers : {0u, 1u, 30u, 31u, 100u, 1023u, 1024u, 1025u, 5000u}) {
    std::vector<std::uint8_t> bytes;
    for (std::uint32_t i = 0; i < 8 * numbers; ++i) bytes.push_back(static_cast<std::uint8_t>(i * i >> 3));
    for (const KernelTarget target : availableKernels()) {
      HashSink sink(target);
      for (std::uint32_t i = 0; i < numbers; ++i) sink.put(loadLittleEndian<8>(bytes.data() + 8 * i));
      EXPECT_EQ(sink.finish(), hashOfBytes(bytes)) << kernelName(target) << ", " << numbers << " numbers";
    }
  }
}

TYPED_TEST(StateHashTest, EverySettingAndObjectCounts) {
  using S = TypeParam;
  const auto hashAfter = [](auto&& change) {
    Space<S> space;
    fillAtRandom(space, 5);
    space.step(kTick<S>);
    change(space);
    return space.hash();
  };
  std::vector<std::uint64_t> hashes = {hashAfter([](Space<S>&) {})};
  EXPECT_EQ(hashes[0], hashAfter([](Space<S>&) {}));
  const auto differs = [&](auto&& change) {
    const std::uint64_t hash = hashAfter(change);
    for (const std::uint64_t other : hashes) EXPECT_NE(hash, other);
    hashes.push_back(hash);
  };
  differs([](Space<S>& s) { s.setIterations(11); });
  differs([](Space<S>& s) { s.setGravity({S(0), S(-9)}); });
  differs([](Space<S>& s) { s.setDamping(ratio<S>(1, 2)); });
  differs([](Space<S>& s) { s.setCollisionSlop(S(1)); });
  differs([](Space<S>& s) { s.setCollisionBias(ratio<S>(1, 2)); });
  differs([](Space<S>& s) { s.setCollisionPersistence(4); });
  differs([](Space<S>& s) { s.setWorldExtent(S(64)); });
  differs([](Space<S>& s) { s.add(Body<S>(S(1), S(1))); });
  differs([](Space<S>& s) { s.add(circleShape(s.staticBody(), S(1))); });
  differs([](Space<S>& s) { s.remove(s.add(Body<S>(S(1), S(1)))); });  // The next id is another.
  differs([](Space<S>& s) { s.remove(s.add(circleShape(s.staticBody(), S(1)))); });
  differs([](Space<S>& s) { s.step(kTick<S>); });
  differs([](Space<S>& s) {
    s.registerHandler(3, {});
    s.addWildcardHandler(9, 3);
  });
  differs([](Space<S>& s) { s.filterArbiters(s.staticBody()); });
  differs([](Space<S>& s) { s.body(s.staticBody()).setUserData(1); });
}

TYPED_TEST(StateHashTest, WhatIsNoStateDoesNotCount) {
  using S = TypeParam;
  Space<S> space;
  fillAtRandom(space, 5);
  space.step(kTick<S>);
  const std::uint64_t before = space.hash();
  space.registerHandler(3, {});
  space.registerPositionFunc(3, [](Body<S>&, S, void*) {});
  space.setStageObserver([](const Space<S>&, Stage, void*) {});
  space.dropCache();
  space.lock();
  space.addPostStepCallback([](Space<S>&, std::uint64_t, void*) {}, 1);
  space.unlock(false);
  EXPECT_EQ(space.hash(), before);
}

TYPED_TEST(StateHashTest, SingleObjectsCanBeAsked) {
  using S = TypeParam;
  Space<S> space;
  const ShapeId a = addDisc<S>(space, {}, S(1), S(1));
  const ShapeId b = addDisc<S>(space, {S(9), S(0)}, S(1), S(1));
  const std::uint64_t bodyA = space.hash(bodyOf(space, a)), bodyB = space.hash(bodyOf(space, b));
  const std::uint64_t shapeA = space.hash(a), shapeB = space.hash(b);
  space.body(bodyOf(space, a)).setForce({S(1), S(0)});
  space.change(b, [](Shape<S>& shape) { shape.setFriction(S(1)); });
  EXPECT_NE(space.hash(bodyOf(space, a)), bodyA);
  EXPECT_EQ(space.hash(bodyOf(space, b)), bodyB);
  EXPECT_EQ(space.hash(a), shapeA);
  EXPECT_NE(space.hash(b), shapeB);
}

TYPED_TEST(StateHashTest, StagesCanBeCompared) {
  using S = TypeParam;
  const auto stagesOf = [](std::uint64_t seed) {
    Space<S> space;
    fillAtRandom(space, seed);
    std::vector<std::uint64_t> hashes;
    space.setStageObserver(
        [](const Space<S>& of, Stage, void* data) {
          static_cast<std::vector<std::uint64_t>*>(data)->push_back(of.hash());
        },
        &hashes);
    for (int i = 0; i < 10; ++i) space.step(kTick<S>);
    EXPECT_EQ(hashes.back(), space.hash());
    return hashes;
  };
  EXPECT_EQ(stagesOf(1), stagesOf(1));
  EXPECT_NE(stagesOf(1), stagesOf(2));
  EXPECT_EQ(stagesOf(1).size(), 80u);
}

#ifndef SAMESTEP_FIXED_ONLY
// Equal numbers, other bits: a hash tells what will be computed on, and 1 / 0 is not 1 / -0.
TEST(StateHashOfDoubleTest, ZeroAndMinusZeroAreTwoWorlds) {
  Space<double> plus, minus;
  const BodyId id = plus.add(Body<double>(1, 1));
  minus.add(Body<double>(1, 1));
  EXPECT_EQ(plus.hash(), minus.hash());
  minus.body(BodyId::fromBits(id.bits())).setVelocity({-0.0, 0.0});
  EXPECT_EQ(plus.body(id).velocity(), minus.body(BodyId::fromBits(id.bits())).velocity());
  EXPECT_NE(plus.hash(), minus.hash());
  plus.body(id).setVelocity({-0.0, 0.0});
  EXPECT_EQ(plus.hash(), minus.hash());
}
#endif

}  // namespace
}  // namespace samestep
