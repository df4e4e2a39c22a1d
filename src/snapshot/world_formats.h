// SPDX-License-Identifier: MIT
#pragma once

namespace samestep {

/// Fields and sections that worlds have since format 2.
inline constexpr const char* kSince2[] = {
    "sleepTimeThreshold", "idleSpeedThreshold", "restTime",       "island",     "activity",
    "maySleep",           "resting pair",       "rotationA",      "rotationB",  "joint",
    "gravityScale",       "linearDamping",      "angularDamping", "speedLimit", "spinLimit",
    "material",           "rollingResistance",  "bullet",         "continuous"};

}  // namespace samestep
