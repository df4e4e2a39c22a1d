// SPDX-License-Identifier: MIT
#include <samestep/snapshot.h>

#include <samestep/version.h>

#include <algorithm>
#include <utility>

#include "base/require_ieee.h"
#include "state/canonical_reader.h"
#include "state/compact.h"
#include "state/state_hash.h"

namespace samestep {
namespace {

/// Magic that is not text, spoilt by whatever changes line ends or cuts the eighth bit.
constexpr std::uint8_t kSnapshotMagic[8] = {0x89, 'S', 'A', 'M', 'S', '\r', '\n', 0x1a};

// Offsets of the header.
constexpr std::uint64_t kVersionAt = 8;
constexpr std::uint64_t kRevisionAt = 12;
constexpr std::uint64_t kScalarAt = 16;
constexpr std::uint64_t kSizeAt = 20;
constexpr std::uint64_t kChecksumBytes = 8;

SnapshotInfo readInfo(ByteReader& bytes) {
  CanonicalReader read(bytes);
  const auto magic = bytes.take(sizeof kSnapshotMagic);
  if (!std::equal(magic.begin(), magic.end(), kSnapshotMagic)) failFormat(0, "not a snapshot");
  SnapshotInfo info;
  read.get(info.version);
  if (info.version > kSnapshotVersion) failFormat(kVersionAt, "a snapshot of a later format version");
  if (info.version == 0) failFormat(kVersionAt, "a snapshot of a trial format");
  read.get(info.revision);
  read.get(info.scalar);
  if (info.scalar != ScalarKind::fixed && info.scalar != ScalarKind::float64) {
    failFormat(kScalarAt, "unknown scalar");
  }
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t at = bytes.offset();
    if (read.next<std::uint8_t>() != 0) failFormat(at, "a byte that must be zero is not");
  }
  read.get(info.size);
  return info;
}

void writeInfo(SpanSink& sink, const SnapshotInfo& info) {
  CanonicalWriter<SpanSink> write(sink);
  for (const std::uint8_t byte : kSnapshotMagic) write.put(byte);
  write.put(info.version);
  write.put(info.revision);
  write.put(info.scalar);
  for (int i = 0; i < 3; ++i) write.put(std::uint8_t{0});
  write.put(info.size);
}

/// Reads the world of a snapshot whose checksum is right.
template <Scalar S>
WorldState<S> readWorld(std::span<const std::uint8_t> bytes, std::uint64_t& offset, std::uint32_t version,
                        const WorldLimits& limits) {
  return decodeWorld<S>(bytes, offset, limits, version);
}

template <Scalar S>
WorldState<S> readSnapshot(std::span<const std::uint8_t> bytes, OtherRevision otherRevision,
                           const WorldLimits& limits) {
  ByteReader reader(bytes);
  const SnapshotInfo info = readInfo(reader);
  if (info.scalar != ScalarTraits<S>::kKind) failFormat(kScalarAt, "a snapshot of another scalar");
  if (info.revision != kSimulationRevision && otherRevision == OtherRevision::refuse) {
    failRevision(kRevisionAt, info.revision, kSimulationRevision);
  }
  if (info.size > bytes.size()) failFormat(bytes.size(), "cut short");
  if (info.size < bytes.size()) failFormat(info.size, "something follows the end");
  std::uint64_t offset = reader.offset();
  if (info.size < offset + kChecksumBytes) failFormat(kSizeAt, "too small for a snapshot");

  const std::uint64_t checksumAt = info.size - kChecksumBytes;
  ByteReader end(bytes, checksumAt);
  if (end.load<8>() != XXH3_64bits(bytes.data(), static_cast<std::size_t>(checksumAt))) {
    failFormat(checksumAt, "the checksum is wrong: the bytes were altered");
  }
  WorldState<S> world =
      readWorld<S>(bytes.first(static_cast<std::size_t>(checksumAt)), offset, info.version, limits);
  if (offset != checksumAt) failFormat(offset, "something follows the world");
  return world;
}

}  // namespace

SnapshotInfo snapshotInfo(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  return readInfo(reader);
}

template <Scalar S>
std::uint64_t saveSnapshot(const Space<S>& space, std::span<std::uint8_t> into) {
  require<Fault::SpaceLocked>(!space.isLocked());
  SnapshotInfo info{kSnapshotVersion, kSimulationRevision, ScalarTraits<S>::kKind, 0};
  SpanSink header(into);
  writeInfo(header, info);
  const std::uint64_t worldAt = header.used();
  const auto from = static_cast<std::size_t>(std::min<std::uint64_t>(worldAt, into.size()));
  const std::uint64_t checksumAt = worldAt + encodeWorld(space.state(), into.subspan(from));
  info.size = checksumAt + kChecksumBytes;
  if (info.size > into.size()) return info.size;

  SpanSink again(into);
  writeInfo(again, info);
  const std::uint64_t checksum = XXH3_64bits(into.data(), static_cast<std::size_t>(checksumAt));
  storeLittleEndian<kChecksumBytes>(into.data() + checksumAt, checksum);
  return info.size;
}

template <Scalar S>
void loadSnapshot(Space<S>& space, std::span<const std::uint8_t> bytes, OtherRevision otherRevision,
                  const WorldLimits& limits) {
  require<Fault::SpaceLocked>(!space.isLocked());
  space.adopt(readSnapshot<S>(bytes, otherRevision, limits));
}

#define SAMESTEP_EACH_SCALAR                                                        \
  template std::uint64_t saveSnapshot<S>(const Space<S>&, std::span<std::uint8_t>); \
  template void loadSnapshot<S>(Space<S>&, std::span<const std::uint8_t>, OtherRevision, const WorldLimits&);
#include <samestep/each_scalar.h>

}  // namespace samestep
