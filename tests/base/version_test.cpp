#include "samestep/version.h"

#include <gmock/gmock.h>

namespace samestep {
namespace {

TEST(Version, HasThreeNumbers) { EXPECT_THAT(version(), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+")); }

TEST(Version, NamesScalarsAndCompiler) {
  EXPECT_THAT(builtScalars(), testing::HasSubstr("fixed checked"));
  EXPECT_THAT(compiler(), testing::MatchesRegex(".+ [0-9.]+"));
}

}  // namespace
}  // namespace samestep
