// SPDX-License-Identifier: MIT
#include "push_contacts.h"

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
    return info;
  }
};
TYPED_TEST_SUITE(PushContactsTest, AllScalars);

TYPED_TEST(PushContactsTest, APointOfTheSameFeaturesKeepsItsImpulses) {
  using S = TypeParam;
  Pair<S> pair;
  pair.count = 1;
  pair.contacts[0].feature = 9;
  pair.contacts[0].normalSpeed = S(10);
  pair.contacts[0].tangentSpeed = S(-11);

  pushContacts(pair, this->twoPoints());

  EXPECT_EQ(pair.count, 2);
  EXPECT_EQ(pair.contacts[0].feature, 7u);
  EXPECT_EQ(pair.contacts[0].pointA, Vector<S>(S(1), S(2)));
  EXPECT_EQ(pair.contacts[0].normalSpeed, S(0));
  EXPECT_EQ(pair.contacts[1].pointB, Vector<S>(S(7), S(8)));
  EXPECT_EQ(pair.contacts[1].normalSpeed, S(10));
  EXPECT_EQ(pair.contacts[1].tangentSpeed, S(-11));
}

TYPED_TEST(PushContactsTest, MorePointsThanAPairHoldsAreAnInternalError) {
  using S = TypeParam;
  Pair<S> pair;
  pushContacts(pair, this->twoPoints());
  CollisionInfo<S> info;
  for (const int bad : {kMaxContactsPerPair + 1, -1}) {
    info.count = bad;
    EXPECT_THROW(pushContacts(pair, info), BufferOverflow);
    EXPECT_EQ(pair.count, 2);
    EXPECT_EQ(pair.contacts[1].feature, 9u);
  }
}

}  // namespace
}  // namespace samestep
