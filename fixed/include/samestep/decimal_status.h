#pragma once

namespace samestep {

/// What became of a decimal text. Anything but ok leaves the number as it was.
enum class DecimalStatus { ok, empty, notANumber, outOfRange, tooLong };

}  // namespace samestep
