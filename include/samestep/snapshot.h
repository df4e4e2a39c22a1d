// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/space.h>
#include <samestep/space_codec.h>

namespace samestep {

// A snapshot: the whole state of a world in bytes that are the same from every platform and can be read on
// every other. docs/formats.md tells every byte. For rollback within one process, Space::save is faster.

/// The format that saveSnapshot writes; loadSnapshot reads every version from 1 up to it. 0 was a trial.
inline constexpr std::uint32_t kSnapshotVersion = kWorldFormat;

/// Header of a snapshot: what its first bytes say.
struct SnapshotInfo {
  std::uint32_t version = 0;
  std::uint32_t revision = 0;  ///< kSimulationRevision of the build that saved it.
  ScalarKind scalar = ScalarKind::fixed;
  std::uint64_t size = 0;  ///< Size of the whole snapshot, bytes.
};

/// @throws FormatError for what is no snapshot, and for one of a version that this build does not read
SnapshotInfo snapshotInfo(std::span<const std::uint8_t> bytes);

/// Treatment of a snapshot that another revision of the simulation saved.
enum class OtherRevision : std::uint8_t {
  refuse,
  /// Take the state it holds. It goes on by the rules of this build, not as it would have in the other.
  takeStateOnly,
};

/// Writes the world if `into` has room for it, else leaves `into` with bytes of no use. Callbacks that wait
/// and functions registered are not part of it. Allocates nothing. Asked with an empty span it says how much
/// room is needed; a larger span is as good.
/// @return the bytes of the snapshot
/// @throws SpaceLocked
template <Scalar S>
std::uint64_t saveSnapshot(const Space<S>& space, std::span<std::uint8_t> into);

/// Brings in a saved world, in place of the one there. Whatever the bytes are, the world is one that this
/// library could have saved, or the Space is as before.
/// @throws SpaceLocked; FormatError, with the offset of what is wrong, which is a RevisionError for a
/// snapshot
///         of another revision where those are refused; MissingCallback if this Space lacks a number the
///         world uses
template <Scalar S>
void loadSnapshot(Space<S>& space, std::span<const std::uint8_t> bytes,
                  OtherRevision otherRevision = OtherRevision::refuse, const WorldLimits& limits = {});

}  // namespace samestep
