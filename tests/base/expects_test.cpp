// SPDX-License-Identifier: MIT
#include <samestep/expects.h>

#include <gtest/gtest.h>

namespace samestep {
namespace {

constexpr int half(int even) {
  expects(even % 2 == 0);
  return even / 2;
}

TEST(ExpectsTest, WhatHoldsIsNoticedByNobody) {
  static_assert(half(6) == 3);
  EXPECT_EQ(half(8), 4);
}

TEST(ExpectsTest, WhatDoesNotHoldEndsTheProgramWithThePlaceWhereThatIsChecked) {
  volatile int odd = 7;
  if constexpr (kExpects) {
    EXPECT_DEATH(half(odd), "expects_test.cpp:1[0-9]: .*does not hold");
  } else {
    EXPECT_EQ(half(odd), 3);
  }
}

}  // namespace
}  // namespace samestep
