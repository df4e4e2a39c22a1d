// SPDX-License-Identifier: MIT
// The list of fields of each record is complete: it accounts for every byte, and the hash sees every number.
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/space.h>
#include "state/state_hash.h"
#include "support/fields.h"
#include "support/joints.h"
#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

template <Scalar S>
class FieldsTest : public ::testing::Test {
 protected:
  /// Polygon with as many vertices as there can be: a shape shows only those it has.
  static Shape<S> fullPolygon() {
    std::vector<Vector<S>> points;
    for (int i = 0; i < kMaxPolyVertices; ++i) {
      points.push_back(forAngle(kPi<S> * ratio<S>(2 * i, kMaxPolyVertices)) * S(4));
    }
    return polyShape<S>(BodyId{1, 1}, points);
  }
  template <class T>
  static void expectEveryFieldHashed(const T& record) {
    const std::uint64_t before = hashOf(record);
    const int count = leavesOf(record).count();
    for (int i = 0; i < count; ++i) {
      T changed = record;
      const std::string name = changeLeaf(changed, i);
      EXPECT_NE(hashOf(changed), before) << name;
    }
  }
};
TYPED_TEST_SUITE(FieldsTest, AllScalars);

TYPED_TEST(FieldsTest, RecordsOfMovingThingsAreTriviallyCopyable) {
  using S = TypeParam;
  static_assert(std::is_trivially_copyable_v<Body<S>>);
  static_assert(std::is_trivially_copyable_v<Contact<S>>);
  static_assert(std::is_trivially_copyable_v<Pair<S>>);
  static_assert(std::is_trivially_copyable_v<Settings<S>>);
  static_assert(std::is_trivially_copyable_v<HandlerBinding>);
  static_assert(std::is_trivially_copyable_v<Joint<S>>);
}

// These bytes are not visited: numbers that follow from the others, what only the step that wrote it and
// visits read, the ids a Space gives, and named fillers.
TYPED_TEST(FieldsTest, FieldsAccountForEveryByte) {
  using S = TypeParam;
  constexpr std::size_t kDerived = sizeof(Vector<S>) + 2 * sizeof(Scaled<S>) +
                                   sizeof(S);  // Rotation, inverse mass, moment, moment per mass.
  constexpr std::size_t kBelonging = sizeof(BodyId) + sizeof(S);  // Id and how far it may be set.
  constexpr std::size_t kWithinStep = 2;
  constexpr std::size_t kBodyFiller = 1;
  EXPECT_EQ(leavesOf(Body<S>()).bytes() + kDerived + kBelonging + kWithinStep + kBodyFiller, sizeof(Body<S>));
  constexpr std::size_t kIdAndSpace = 16;
  constexpr std::size_t kShapeFiller = 1;
  constexpr std::size_t kPlaces = sizeof(VertexList<S>) - VertexList<S>::kFew * sizeof(Vector<S>);
  EXPECT_EQ(leavesOf(boxShape(BodyId{1, 1}, S(2), S(3))).bytes() + kIdAndSpace + kShapeFiller + kPlaces,
            sizeof(Shape<S>));
  EXPECT_EQ(leavesOf(this->fullPolygon()).bytes() + kIdAndSpace + kShapeFiller + kPlaces,
            sizeof(Shape<S>) + Shape<S>::kBytesOutside);
  constexpr std::size_t kTotals = 2 * sizeof(S), kContactFiller = 4;
  EXPECT_EQ(leavesOf(Contact<S>()).bytes() + kTotals + kContactFiller, sizeof(Contact<S>));
  constexpr std::size_t kGenerations = 8, kSurfaces = 2 * sizeof(S) + sizeof(Vector<S>),
                        kSolved = 1 + 3 * sizeof(Vector<S>);
  EXPECT_EQ(leavesOf(Pair<S>()).bytes() + kMaxContactsPerPair * (kTotals + kContactFiller) + kGenerations +
                kSurfaces + kSolved,
            sizeof(Pair<S>));
  EXPECT_EQ(leavesOf(Settings<S>()).bytes() + 1, sizeof(Settings<S>));
  EXPECT_EQ(leavesOf(HandlerBinding()).bytes() + 3, sizeof(HandlerBinding));
  constexpr std::size_t kSpaces = 8, kResults = 3 * sizeof(S) + 1, kJointFiller = 2;
  EXPECT_EQ(leavesOf(Joint<S>()).bytes() + kSpaces + kResults + kJointFiller, sizeof(Joint<S>));
}

TYPED_TEST(FieldsTest, TheHashOfARecordSeesEveryField) {
  using S = TypeParam;
  this->expectEveryFieldHashed(Body<S>(S(2), S(3)));
  this->expectEveryFieldHashed(Body<S>::fixedInPlace());
  this->expectEveryFieldHashed(boxShape(BodyId{1, 1}, S(2), S(3)));
  this->expectEveryFieldHashed(this->fullPolygon());
  this->expectEveryFieldHashed(Contact<S>());
  this->expectEveryFieldHashed(Pair<S>());
  this->expectEveryFieldHashed(Settings<S>());
  this->expectEveryFieldHashed(HandlerBinding());
  this->expectEveryFieldHashed(Joint<S>());
}

// In the world's hash each record counts, at each place.
TYPED_TEST(FieldsTest, TheHashOfTheWorldSeesEveryFieldOfEveryRecord) {
  using S = TypeParam;
  Space<S> space;
  space.registerHandler(1, {});
  space.addWildcardHandler(1, 1);
  space.addCollisionHandler(1, 2, 1);
  for (int i = 0; i < 3; ++i) addDisc<S>(space, {ratio<S>(3 * i, 2), S(0)}, S(1), S(1), {S(1 - i), S(0)});
  addResting(space, {S(20), S(0)});
  joinNeighbours(space);
  space.step(kTick<S>);
  WorldState<S> world = space.state();
  ASSERT_EQ(world.pairs.size(), 2u);
  ASSERT_EQ(world.restingPairs.size(), 1u);
  const auto hash = [&] { return hashOfWorld(world, hashOfShapes(world.shapes)); };
  const std::uint64_t before = hash();
  ASSERT_EQ(before, space.hash());
  const auto check = [&](auto& record) {
    const auto kept = record;
    for (int i = 0; i < leavesOf(kept).count(); ++i) {
      const std::string name = changeLeaf(record, i);
      EXPECT_NE(hash(), before) << name;
      record = kept;
    }
    EXPECT_EQ(hash(), before);
  };
  check(world.settings);
  for (std::uint32_t i = 0; i < world.bodies.slots(); ++i) check(world.bodies.valueAt(i));
  for (std::uint32_t i = 0; i < world.shapes.slots(); ++i) check(world.shapes.valueAt(i));
  for (Pair<S>& pair : world.pairs) check(pair);
  for (Pair<S>& pair : world.restingPairs) check(pair);
  for (HandlerBinding& binding : world.handlers) check(binding);
  for (std::uint32_t i = 0; i < world.joints.slots(); ++i) check(world.joints.valueAt(i));
  const auto changes = [&](auto& number) {
    const auto kept = number;
    number = number + std::remove_cvref_t<decltype(number)>(1);
    EXPECT_NE(hash(), before);
    number = kept;
  };
  changes(world.stamp);
  changes(world.timeStep);
  changes(world.staticBody.index);
  changes(world.staticBody.generation);
  world.pairs.pop_back();
  EXPECT_NE(hash(), before);
}

TYPED_TEST(FieldsTest, DeriveComputesWhatFollows) {
  using S = TypeParam;
  Body<S> body(S(2), S(3));
  body.setAngle(S(1));
  const auto read = [&] {
    struct Copier {
      std::vector<std::uint8_t> bytes;
      std::uint8_t* reserve(unsigned size) {
        bytes.resize(bytes.size() + size);
        return bytes.data() + bytes.size() - size;
      }
    } sink;
    CanonicalWriter<Copier> write(sink);
    write.put(body);
    return sink.bytes;
  };
  EXPECT_EQ(read().size(), leavesOf(body).bytes());
  changeLeaf(body, 2);  // The mass, behind the back of the setters.
  body.derive();
  EXPECT_EQ(body.mass(), S(3));
  EXPECT_EQ(body.inverseMass(), reciprocal(toScaled(S(3))));
  EXPECT_EQ(body.rotation(), forAngle(S(1)));
}

}  // namespace
}  // namespace samestep
