// SPDX-License-Identifier: MIT
#include <samestep/error.h>

#include <cstdio>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace samestep {
namespace {

constexpr int kFaults = static_cast<int>(Fault::ForeignWorld) + 1;

TEST(ErrorTest, EveryFaultHasAMessageOfItsOwn) {
  std::set<std::string> messages;
  for (int i = 0; i < kFaults; ++i) {
    const std::string text = message(static_cast<Fault>(i));
    EXPECT_NE(text, "Unknown fault.") << i;
    messages.insert(text);
  }
  EXPECT_EQ(static_cast<int>(messages.size()), kFaults);
}

TEST(ErrorTest, ErrorsCarryTheirFaultAndTheMessageOfTheSpecification) {
  try {
    fail<Fault::InvalidIter>();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::InvalidIter);
    EXPECT_STREQ(error.what(), "Iterations must be positive and non-zero.");
  }
}

TEST(ErrorTest, EachFaultIsATypeOfItsOwn) {
  EXPECT_THROW(fail<Fault::NegativeMass>(), NegativeMass);
  EXPECT_THROW(fail<Fault::NegativeMass>("with another text"), NegativeMass);
  EXPECT_THROW(fail<Fault::NegativeMass>(), std::exception);
  try {
    fail<Fault::NegativeMass>();
  } catch (const NegativeMoment&) {
    FAIL();
  } catch (const Error&) {
  }
}

TEST(ErrorTest, RequireFailsOnlyWhereTheConditionDoes) {
  EXPECT_NO_THROW(require<Fault::LeafError>(true));
  EXPECT_THROW(require<Fault::LeafError>(false), LeafError);
  try {
    require<Fault::IllegalBody>(false, "a sentence");
    FAIL();
  } catch (const IllegalBody& error) {
    EXPECT_STREQ(error.what(), "a sentence");
  }
}

// Without exceptions: the handler is told, then the program ends.
TEST(ErrorDeathTest, TheFailureHandlerIsToldBeforeTheEnd) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(
      {
        setFailureHandler([](Fault, const char* text) { std::fprintf(stderr, "told: %s\n", text); });
        failWithoutExceptions(Fault::NegativeMass, message(Fault::NegativeMass));
      },
      "told: Body's mass is negative.");
}

TEST(ErrorTest, ARevisionErrorNamesBothRevisions) {
  try {
    failRevision(12, 4294967295u, 30);
  } catch (const FormatError& error) {
    EXPECT_EQ(error.offset(), 12u);
    EXPECT_STREQ(
        error.what(),
        "made by simulation revision 4294967295, whose results differ from those of revision 30, this "
        "build's");
    const RevisionError copy = dynamic_cast<const RevisionError&>(error);
    EXPECT_STREQ(copy.what(), error.what());
    EXPECT_EQ(copy.found(), 4294967295u);
    EXPECT_EQ(copy.own(), 30u);
  }
}

}  // namespace
}  // namespace samestep
