// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <samestep/array.h>

#include <memory>
#include <vector>

namespace samestep {
namespace {

using ::testing::ElementsAre;

TEST(ArrayTest, PushAppendsAndPopTakesTheLast) {
  Array<int> array;
  for (int i = 0; i < 10; ++i) array.push(i);

  EXPECT_EQ(array.pop(), 9);
  EXPECT_EQ(array.pop(), 8);
  EXPECT_EQ(array.size(), 8u);
  EXPECT_EQ(array[7], 7);
}

TEST(ArrayTest, PopOfEmptyThrowsIndexOutOfBounds) {
  Array<int> array(8);

  EXPECT_THROW(array.pop(), IndexOutOfBounds);
}

TEST(ArrayTest, IndexBeyondTheEndThrowsIndexOutOfBounds) {
  Array<int> array;
  array.push(1);
  const Array<int>& constant = array;

  EXPECT_THROW(array[1], IndexOutOfBounds);
  EXPECT_THROW(constant[1], IndexOutOfBounds);
}

TEST(ArrayTest, DeleteObjMovesTheLastIntoTheGap) {
  Array<int> array;
  for (const int i : {10, 11, 12, 13}) array.push(i);

  EXPECT_TRUE(array.deleteObj(11));

  EXPECT_THAT(std::vector<int>(array.begin(), array.end()), ElementsAre(10, 13, 12));
}

TEST(ArrayTest, DeleteObjTakesTheFirstOfEqualsAndTheLastElementToo) {
  Array<int> array;
  for (const int i : {5, 7, 5, 7}) array.push(i);

  EXPECT_TRUE(array.deleteObj(5));
  EXPECT_THAT(std::vector<int>(array.begin(), array.end()), ElementsAre(7, 7, 5));
  EXPECT_TRUE(array.deleteObj(5));

  EXPECT_THAT(std::vector<int>(array.begin(), array.end()), ElementsAre(7, 7));
}

TEST(ArrayTest, DeleteObjOfAbsentElementChangesNothing) {
  Array<int> array;
  array.push(1);

  EXPECT_FALSE(array.deleteObj(2));

  EXPECT_EQ(array.size(), 1u);
}

TEST(ArrayTest, ContainsFindsWhatWasPushedOnly) {
  Array<int> array;
  array.push(3);

  EXPECT_TRUE(array.contains(3));
  EXPECT_FALSE(array.contains(4));
}

TEST(ArrayTest, ClearPassesEachElementInOrderAndEmpties) {
  Array<int> array;
  for (const int i : {1, 2, 3}) array.push(i);
  std::vector<int> freed;

  array.clear([&freed](int i) { freed.push_back(i); });

  EXPECT_THAT(freed, ElementsAre(1, 2, 3));
  EXPECT_TRUE(array.empty());
}

TEST(ArrayTest, HoldsMoveOnlyElements) {
  Array<std::unique_ptr<int>> array;
  for (int i = 0; i < 6; ++i) array.push(std::make_unique<int>(i));

  EXPECT_EQ(*array.pop(), 5);
}

}  // namespace
}  // namespace samestep
