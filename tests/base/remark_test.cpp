// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <samestep/remark.h>

#include <string>

namespace samestep {
namespace {

TEST(RemarksTest, CountsPerKindWithoutAHook) {
  Remarks remarks;

  remarks.raise(Remark::HighIterWarning, "High GJK iterations: 20");
  remarks.raise(Remark::HighIterWarning, "High GJK iterations: 21");

  EXPECT_EQ(remarks.count(Remark::HighIterWarning), 2u);
  EXPECT_EQ(remarks.count(Remark::NotBBTreeWarn), 0u);
}

TEST(RemarksTest, PassesKindAndTextToTheHook) {
  Remarks remarks;
  std::string log;
  remarks.context = &log;
  remarks.hook = [](Remark remark, const char* text, void* context) {
    *static_cast<std::string*>(context) += std::to_string(static_cast<int>(remark)) + text;
  };

  remarks.raise(Remark::NotBBTreeWarn, "a");

  EXPECT_EQ(log, "1a");
}

}  // namespace
}  // namespace samestep
