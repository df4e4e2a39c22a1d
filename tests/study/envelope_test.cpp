// SPDX-License-Identifier: MIT
#include "study/envelope.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string fileOfProject(const std::string& name) {
  std::ifstream stream(std::string(SAMESTEP_PROJECT) + "/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Limits that scripts/envelope wrote.
const std::vector<Limit>& expectedLimits() {
  static const std::vector<Limit> limits = readLimits(fileOfProject("tests/envelope_limits.csv"));
  return limits;
}

// The search, on ladders of numbers.

TEST(EnvelopeSearchTest, FindsTheLastRungThatHolds) {
  for (const int limit : {0, 1, 2, 3, 7, 8, 9, 63, 64, 99, 100}) {
    EXPECT_EQ(lastThatHolds(100, [&](int rung) { return rung <= limit; }), limit);
  }
}

TEST(EnvelopeSearchTest, StopsAtTheTop) {
  for (const int top : {1, 2, 3, 100, 128}) {
    EXPECT_EQ(lastThatHolds(top,
                            [&](int rung) {
                              EXPECT_LE(rung, top);
                              return true;
                            }),
              top);
  }
}

TEST(EnvelopeSearchTest, DoublesThenHalves) {
  std::vector<int> tried;
  lastThatHolds(1000, [&](int rung) {
    tried.push_back(rung);
    return rung <= 10;
  });

  EXPECT_THAT(tried, ElementsAre(1, 2, 4, 8, 16, 12, 10, 11));
}

TEST(EnvelopeSearchTest, WhereRungsHoldAndFailInTurnItFindsOneThatHoldsBelowOneThatFails) {
  const auto holds = [](int rung) { return rung < 20 || (rung % 7 == 0 && rung < 60); };
  const int limit = lastThatHolds(1000, holds);

  EXPECT_TRUE(holds(limit));
  EXPECT_FALSE(holds(limit + 1));
}

TEST(EnvelopeSearchTest, TellsEachRungBeforeItIsTried) {
  std::vector<int> told;
  const Ladder ladder{"l", "h", "t", "f", 50, [](const Setting&, int rung) { return rung <= 3; }};
  const Setting setting = limitSettings().front();
  const Limit limit = limitOf(ladder, setting, [&](int rung) { told.push_back(rung); });

  EXPECT_THAT(told, ElementsAre(1, 2, 4, 3));
  EXPECT_EQ(limit, (Limit{"l", setting.method->name, setting.count, 3, 50}));
}

// The files.

TEST(EnvelopeFileTest, CsvIsReadBackAsItWasWritten) {
  const std::vector<Limit> limits{{"stack", "a method", 4, 17, 100}, {"bullet", "b", 10, 0, 9}};

  EXPECT_EQ(limitsCsv(limits), "ladder,method,count,holds,top\nstack,a method,4,17,100\nbullet,b,10,0,9\n");
  EXPECT_EQ(readLimits(limitsCsv(limits)), limits);
}

TEST(EnvelopeFileTest, WhatIsNoTableOfLimitsIsRefusedWithItsLine) {
  for (const char* wrong : {"x\n", "ladder,method,count,holds,top\nstack,a,4,17\n",
                            "ladder,method,count,holds,top\nstack,a,4,17,100,\n",
                            "ladder,method,count,holds,top\nstack,a,four,17,100\n"}) {
    EXPECT_THROW(readLimits(wrong), std::runtime_error) << wrong;
  }
  try {
    readLimits("ladder,method,count,holds,top\nstack,a,4,1,1\n,\n");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("line 3"));
  }
}

TEST(EnvelopeFileTest, TableHasARowPerSettingAndTheColumnsThatHaveLimits) {
  const Setting setting = limitSettings()[1];
  const std::string table =
      limitsTable(std::vector<Limit>{{"stack", setting.method->name, setting.count, 17, 100},
                                     {"mass-ratio", setting.method->name, setting.count, 8, 8}});

  EXPECT_THAT(table, HasSubstr("| " + setting.name() + " | 17 | at least 8 |\n"));
  EXPECT_EQ(table.find("wall"), std::string::npos);
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(EnvelopeFileTest, TheDocumentationShowsTheseLimitsAndWhatFailingMeans) {
  const std::string page = fileOfProject("docs/stability.md");

  EXPECT_THAT(page, HasSubstr(limitsTable(expectedLimits())));
  for (const Ladder& ladder : ladders()) EXPECT_THAT(page, HasSubstr(describe(ladder)));
}
#endif

// Every limit, from both sides.

struct Case {
  const Ladder* ladder;
  Setting setting;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Ladder& ladder : ladders()) {
    for (const Setting& setting : limitSettings()) all.push_back({&ladder, setting});
  }
  return all;
}

class EnvelopeTest : public ::testing::TestWithParam<Case> {};

TEST_P(EnvelopeTest, HoldsAtTheLimitAndFailsOneRungFurther) {
  const auto& [ladder, setting] = GetParam();
  const auto ofCase = [&, &ladderOf = ladder, &settingOf = setting](const Limit& limit) {
    return limit.ladder == ladderOf->name && limit.method == settingOf.method->name &&
           limit.count == settingOf.count;
  };
  const auto limit = std::find_if(expectedLimits().begin(), expectedLimits().end(), ofCase);

  ASSERT_NE(limit, expectedLimits().end()) << "scripts/envelope writes the expected limits";
  EXPECT_EQ(limit->top, ladder->top);
  if (limit->holds > 0) {
    EXPECT_TRUE(ladder->holds(setting, limit->holds));
  }
  if (limit->holds < ladder->top) {
    EXPECT_FALSE(ladder->holds(setting, limit->holds + 1));
  }
}

std::string nameOf(const ::testing::TestParamInfo<Case>& info) {
  std::string name = std::string(info.param.ladder->name) + " " + info.param.setting.name();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(AllLimits, EnvelopeTest, ::testing::ValuesIn(cases()), nameOf);

}  // namespace
}  // namespace samestep
