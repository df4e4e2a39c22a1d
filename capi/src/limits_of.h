// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/space_codec.h>

#include "call.h"

namespace samestep::c {

/// Null gives the defaults.
/// @throws ValueOutOfRange
WorldLimits toLimits(const samestep_limits* limits);

}  // namespace samestep::c
