// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace samestep::program {

/// Takes from this process, for good, what a verification does not need, so that a recording that a fault of
/// the program lets in finds nothing to do: it makes no file longer, starts no process and leaves no memory
/// image, and takes no more memory than it may. On Linux (x86-64, AArch64) it also opens no file for writing,
/// makes, renames and removes none, has no network, and sends other processes no signal; such calls fail with
/// EPERM. What is open stays so.
/// @param megabytes  of memory; 0 for any
/// @return whether the kernel holds it to all of that
bool confineThisProcess(std::uint64_t megabytes);

}  // namespace samestep::program
