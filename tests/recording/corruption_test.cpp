// SPDX-License-Identifier: MIT
// A few of the spoilt recordings that corrupt_recordings makes any number of.
#include <string>

#include <gtest/gtest.h>

#include "support/corruptions.h"
#include "support/scalars.h"

namespace samestep {
namespace {

template <class S>
class CorruptionTest : public ::testing::Test {};
TYPED_TEST_SUITE(CorruptionTest, AllScalars);

TYPED_TEST(CorruptionTest, NoneIsVerifiedThatIsAnotherMatch) {
  Corruptions<TypeParam> corruptions(21);
  for (std::uint64_t number = 0; number < 1500; ++number) {
    EXPECT_EQ(corruptions.run(number), "") << "number " << number;
  }
}

}  // namespace
}  // namespace samestep
