// SPDX-License-Identifier: MIT
#include "recording/sections.h"

#include "base/require_ieee.h"
#include "state/canonical_reader.h"
#include "state/state_hash.h"

namespace samestep {

std::uint64_t chainOf(std::span<const std::uint8_t> header) {
  return XXH3_64bits(header.data(), header.size());
}

std::uint64_t chainAfter(std::uint64_t chain, std::span<const std::uint8_t> section) {
  return XXH3_64bits_withSeed(section.data(), section.size(), chain);
}

namespace {

void readKind(std::uint8_t byte, RecordingSection& section) {
  section.kind = static_cast<SectionKind>(byte & ~kPackedBit);
  section.packed = (byte & kPackedBit) != 0;
  const bool known = section.kind >= SectionKind::keyframe && section.kind <= SectionKind::end;
  if (!known) failFormat(section.at, "unknown section");
  const bool packable = section.kind == SectionKind::keyframe || section.kind == SectionKind::ticks;
  if (section.packed && !packable) failFormat(section.at, "a section that is never packed");
}

/// Section whose bytes end before it does, as far as it is there.
RecordingSection cutShort(RecordingSection section, std::uint64_t bytes, bool mayBeCut) {
  if (!mayBeCut) failFormat(section.at, "cut short: a section goes beyond the end");
  section.cut = true;
  section.end = bytes;
  const bool usable = section.payloadAt != 0 && !section.packed && section.payloadAt < bytes;
  section.payloadBytes = usable ? min(section.payloadBytes, bytes - section.payloadAt) : 0;
  return section;
}

}  // namespace

RecordingSection readSection(std::span<const std::uint8_t> bytes, std::uint64_t offset, bool mayBeCut) {
  ByteReader reader(bytes, offset);
  RecordingSection section;
  section.at = offset;
  if (reader.remaining() == 0) return cutShort(section, bytes.size(), mayBeCut);
  readKind(static_cast<std::uint8_t>(reader.load<1>()), section);
  const std::uint64_t head = section.packed ? 4 + kUnpackedLengthBytes : 4;
  if (reader.remaining() < head) return cutShort(section, bytes.size(), mayBeCut);
  section.payloadBytes = reader.load<4>();
  if (section.packed) section.unpackedBytes = static_cast<std::uint32_t>(reader.load<4>());
  section.payloadAt = reader.offset();
  if (reader.remaining() < section.payloadBytes + kChainBytes) {
    return cutShort(section, bytes.size(), mayBeCut);
  }
  section.end = section.payloadAt + section.payloadBytes + kChainBytes;
  return section;
}

void checkChain(std::span<const std::uint8_t> bytes, const RecordingSection& section, std::uint64_t& chain) {
  const std::uint64_t linkAt = section.end - kChainBytes;
  chain = chainAfter(chain, bytes.subspan(static_cast<std::size_t>(section.at),
                                          static_cast<std::size_t>(linkAt - section.at)));
  if (ByteReader(bytes, linkAt).load<8>() != chain) {
    failFormat(linkAt, "the chain is broken: the bytes were altered");
  }
}

}  // namespace samestep
