#pragma once

#include <cstdint>
#include <string_view>

namespace samestep {

/// Changes whenever any result of a step changes, and only then. Every snapshot and recording carries it:
/// two builds of the same revision give the same bits.
inline constexpr std::uint32_t kSimulationRevision = 9;

/// Version of the library, "major.minor.patch".
std::string_view version();

/// Scalars that this build holds: "double fixed checked" or "fixed checked".
std::string_view builtScalars();

/// Compiler that built the library, with its version.
std::string_view compiler();

}  // namespace samestep
