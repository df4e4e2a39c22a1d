// SPDX-License-Identifier: MIT
#include <samestep/error.h>

#include <samestep/id.h>
#include <samestep/scalar.h>
#include <samestep/vector.h>

#include <cstdio>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace samestep {
namespace {

TEST(ErrorTest, EveryFaultHasAMessageOfItsOwn) {
  std::set<std::string> messages;
  for (std::size_t i = 0; i < kFaults; ++i) {
    const std::string text = message(static_cast<Fault>(i));
    EXPECT_NE(text, "Unknown fault.") << i;
    messages.insert(text);
  }
  EXPECT_EQ(messages.size(), kFaults);
  EXPECT_STREQ(message(static_cast<Fault>(kFaults)), "Unknown fault.");
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

TEST(ErrorTest, EveryFaultIsThrownAsItself) {
  for (std::size_t i = 0; i < kFaults; ++i) {
    try {
      failAs(static_cast<Fault>(i));
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), static_cast<Fault>(i));
      EXPECT_STREQ(error.what(), message(static_cast<Fault>(i)));
    }
  }
  EXPECT_THROW(failAs(Fault::AttachedBody), AttachedBody);
  EXPECT_THROW(failAs(Fault::TooManyPairs), TooManyPairs);
}

template <class... Parts>
std::string textOf(const Parts&... parts) {
  return Error(Fault::IllegalBody, {ErrorPart(parts)...}).what();
}

TEST(ErrorTest, PartsAreWrittenExactlyAndShortly) {
  EXPECT_EQ(textOf(0, " ", 42, " ", -7, " ", std::uint8_t{200}), "0 42 -7 200");
  EXPECT_EQ(textOf(std::numeric_limits<std::int64_t>::min(), " ", std::numeric_limits<std::uint64_t>::max()),
            "-9223372036854775808 18446744073709551615");
  EXPECT_EQ(textOf(Fixed(-1), " ", ratio<Fixed>(1, 10), " ", Fixed(1 << 20)), "-1 0.1 1048576");
  EXPECT_EQ(textOf(Vector<Fixed>(ratio<Fixed>(1, 4), Fixed(-3))), "(0.25, -3)");
  EXPECT_EQ(textOf(BodyId{3, 5}, ", ", ShapeId()), "3 (generation 5), none");
#ifndef SAMESTEP_FIXED_ONLY
  EXPECT_EQ(textOf(-1.0, " ", 0.1, " ", -0.0, " ", 1e300, " ", 1.0 / 3),
            "-1 0.1 -0 1e300 0.3333333333333333");
  EXPECT_EQ(textOf(std::numeric_limits<double>::infinity(), " ", std::numeric_limits<double>::quiet_NaN()),
            "inf nan");
  EXPECT_EQ(textOf(Vector<double>(0.25, -3)), "(0.25, -3)");
#endif
}

TEST(ErrorTest, ATextThatIsTooLongIsCut) {
  const std::string longText(300, 'x');
  EXPECT_EQ(textOf(longText.c_str(), 5), std::string(Error::kTextBytes - 1, 'x'));
  const std::string nearly(Error::kTextBytes - 3, 'x');
  EXPECT_EQ(textOf(nearly.c_str(), 12345), nearly + "12");
  EXPECT_EQ(textOf(nearly.c_str(), Vector<Fixed>(Fixed(1), Fixed(2))), nearly + "(1");
}

TEST(ErrorTest, AnErrorHasItsTextInItself) {
  std::string text = "made here";
  const auto make = [&] { return FaultError<Fault::IllegalBody>({text.c_str(), " and ", 5}); };
  const IllegalBody error = make();
  const Error copy = error;
  text = "gone by now";
  EXPECT_STREQ(error.what(), "made here and 5");
  EXPECT_STREQ(copy.what(), "made here and 5");
  try {
    const std::string inner = "a reason";
    failFormat(7, inner.c_str());
  } catch (const FormatError& format) {
    EXPECT_STREQ(format.what(), "a reason");
    EXPECT_EQ(format.offset(), 7u);
  }
}

std::vector<std::string>& told() {
  static std::vector<std::string> all;
  return all;
}

/// Notes what the failure handler is told.
class ErrorHandlerTest : public ::testing::Test {
 protected:
  ErrorHandlerTest() {
    told().clear();
    setFailureHandler([](Fault, const char* text) { told().push_back(text); });
  }
  ~ErrorHandlerTest() override { setFailureHandler(nullptr); }
};

TEST_F(ErrorHandlerTest, TheHandlerIsAskedBeforeAnythingIsThrown) {
  EXPECT_THROW(fail<Fault::NegativeMass>("mass is ", -2), NegativeMass);
  EXPECT_THROW(require<Fault::IllegalBody>(false), IllegalBody);
  EXPECT_THROW(failFormat(3, "cut short"), FormatError);
  EXPECT_THROW(failRevision(3, 1, 2), RevisionError);
  ASSERT_EQ(told().size(), 4u);
  EXPECT_EQ(told()[0], "mass is -2");
  EXPECT_EQ(told()[1], message(Fault::IllegalBody));
  EXPECT_EQ(told()[2], "cut short");
  EXPECT_EQ(told()[3],
            "made by simulation revision 1, whose results differ from those of revision 2, this build's");
}

TEST_F(ErrorHandlerTest, WhatIsCaughtWithinIsToldOnceAsWhatItBecomes) {
  EXPECT_THROW(orFailFormat(9, [] { fail<Fault::NegativeMass>("mass is ", -2); }), FormatError);
  EXPECT_EQ(told(), (std::vector<std::string>{"mass is -2"}));
  EXPECT_THROW(orFailFormat(9, [] { fail<Fault::MissingCallback>(); }), MissingCallback);
  EXPECT_EQ(told().size(), 2u);
  EXPECT_THROW(fail<Fault::NegativeMass>(), NegativeMass);
  EXPECT_EQ(told().size(), 3u);
}

// A build without exceptions tells the handler, then the program ends.
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
