// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <samestep/scalar.h>

namespace samestep {

#ifndef SAMESTEP_FIXED_ONLY
using AllScalars = ::testing::Types<double, Fixed>;
using AllScalarsAndChecked = ::testing::Types<double, Fixed, CheckedFixed>;
#else
using AllScalars = ::testing::Types<Fixed>;
using AllScalarsAndChecked = ::testing::Types<Fixed, CheckedFixed>;
#endif

}  // namespace samestep
