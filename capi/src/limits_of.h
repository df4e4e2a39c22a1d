// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/recording.h>

#include "call.h"

namespace samestep::c {

/// Null gives the defaults.
/// @throws Refusal, ValueOutOfRange
RecordingLimits toLimits(const samestep_limits* limits);

}  // namespace samestep::c
