// SPDX-License-Identifier: MIT
#include <samestep/fingerprint.h>

#include <ctime>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <Scalar S>
class FingerprintTest : public ::testing::Test {};
TYPED_TEST_SUITE(FingerprintTest, AllScalarsAndChecked);

/// Golden fingerprints by scalar; scripts/golden writes them.
std::map<std::string, std::uint64_t> goldenFingerprints() {
  std::map<std::string, std::uint64_t> golden;
  std::ifstream stream(SAMESTEP_GOLDEN "/fingerprint.txt");
  std::string scalar;
  std::uint64_t value = 0;
  while (stream >> scalar >> std::hex >> value) golden[scalar] = value;
  return golden;
}

// On every platform; other values need another kSimulationRevision.
TYPED_TEST(FingerprintTest, IsTheOneWrittenDown) {
  const bool isFixed = ScalarTraits<TypeParam>::kKind == ScalarKind::fixed;

  EXPECT_EQ(fingerprint<TypeParam>(), goldenFingerprints()[isFixed ? "fixed" : "double"]);
}

TYPED_TEST(FingerprintTest, IsTheSameEachTime) {
  EXPECT_EQ(fingerprint<TypeParam>(), fingerprint<TypeParam>());
}

#ifndef SAMESTEP_FIXED_ONLY
TEST(FingerprintOfScalarsTest, TellsScalarsApart) { EXPECT_NE(fingerprint<double>(), fingerprint<Fixed>()); }
#endif

}  // namespace
}  // namespace samestep
