// SPDX-License-Identifier: MIT
#include "contacts/push_contacts.h"

#include <gtest/gtest.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <Scalar S>
class PushContactsTest : public ::testing::Test {
 protected:
  static CollisionInfo<S> twoPoints() {
    CollisionInfo<S> info;
    info.push({S(1), S(2)}, {S(3), S(4)}, 7);
    info.push({S(5), S(6)}, {S(7), S(8)}, 9);
    info.normal = {S(1), S(0)};
    return info;
  }
  /// A quarter turn, seen from the first; where the second stands.
  static Frame<S> turned() { return {{S(1), S(0)}, {S(0), S(1)}}; }
  static Frame<S> moved() { return {{S(10), S(20)}, {S(1), S(0)}}; }
};
TYPED_TEST_SUITE(PushContactsTest, AllScalars);

TYPED_TEST(PushContactsTest, APointOfTheSameFeaturesKeepsItsImpulses) {
  using S = TypeParam;
  Pair<S> pair;
  pair.count = 1;
  pair.contacts[0].feature = 9;
  pair.contacts[0].normalSpeed = S(10);
  pair.contacts[0].tangentSpeed = S(-11);

  pushContacts(pair, this->twoPoints(), this->turned(), this->moved());

  EXPECT_EQ(pair.count, 2);
  EXPECT_EQ(pair.contacts[0].feature, 7u);
  EXPECT_EQ(pair.contacts[0].anchorA, Vector<S>(S(2), S(0)));
  EXPECT_EQ(pair.contacts[0].normalSpeed, S(0));
  EXPECT_EQ(pair.contacts[1].anchorB, Vector<S>(S(-3), S(-12)));
  EXPECT_EQ(pair.localNormal, Vector<S>(S(0), S(-1)));
  EXPECT_EQ(pair.contacts[1].normalSpeed, S(10));
  EXPECT_EQ(pair.contacts[1].tangentSpeed, S(-11));
}

TYPED_TEST(PushContactsTest, MorePointsThanAPairHoldsAreAnInternalError) {
  using S = TypeParam;
  Pair<S> pair;
  pushContacts(pair, this->twoPoints(), this->turned(), this->moved());
  CollisionInfo<S> info;
  for (const int bad : {kMaxContactsPerPair + 1, -1}) {
    info.count = bad;
    EXPECT_THROW(pushContacts(pair, info, this->turned(), this->moved()), BufferOverflow);
    EXPECT_EQ(pair.count, 2);
    EXPECT_EQ(pair.contacts[1].feature, 9u);
  }
}

}  // namespace
}  // namespace samestep
