// SPDX-License-Identifier: MIT
#include "session/input_stream.h"

#include <samestep/expects.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace samestep::lockstep {
namespace {

/// Meaning of the low two bits of a run's tag; the number above them is the run's length or that of its
/// bytes.
enum Run : std::uint8_t {
  /// So many inputs that hold what the one before held; none of them: an input that holds as many bytes as
  /// the one before, with a bit for each that is another, and these.
  kRepeat = 0,
  kHeld = 1,      ///< An input that holds so many bytes.
  kCommands = 2,  ///< An input that holds what the one before held, with so many bytes of commands.
  kWhole = 3,     ///< An input that holds so many bytes, with commands and a control.
};

bool same(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

void copy(std::uint8_t* to, std::span<const std::uint8_t> from) {
  if (!from.empty()) std::memmove(to, from.data(), from.size());
}

bool plain(const InputEntry& entry) { return entry.commands.empty() && entry.control == Control::none; }

constexpr std::size_t kMostMasked = 8;

/// A bit for each byte that is another one than before.
std::uint8_t maskOf(std::span<const std::uint8_t> held, std::span<const std::uint8_t> before) {
  std::uint8_t mask = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i] != before[i]) mask = static_cast<std::uint8_t>(mask | 1u << i);
  }
  return mask;
}

/// True if few enough bytes changed for a mask to be shorter.
bool masked(std::span<const std::uint8_t> held, std::span<const std::uint8_t> before) {
  if (held.size() != before.size() || held.size() > kMostMasked) return false;
  return static_cast<std::size_t>(std::popcount(maskOf(held, before))) + 1 < held.size();
}

void encodeMasked(PacketWriter& writer, std::span<const std::uint8_t> held,
                  std::span<const std::uint8_t> before) {
  writer.u8(0);
  writer.u8(maskOf(held, before));
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i] != before[i]) writer.u8(held[i]);
  }
}

/// Changes the bytes of before.
InputEntry decodeMasked(PacketReader& reader, std::span<const std::uint8_t> before,
                        std::span<std::uint8_t, kMostMasked> into) {
  const std::uint8_t mask = reader.u8();
  if (before.empty() || before.size() > kMostMasked || mask >> before.size() != 0) {
    reader.fail();
    return {};
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    into[i] = (mask >> i & 1) != 0 ? reader.u8() : before[i];
  }
  return {into.first(before.size()), {}};
}

void encodeEntry(PacketWriter& writer, const InputEntry& entry, std::span<const std::uint8_t> before) {
  if (plain(entry) && masked(entry.held, before)) {
    encodeMasked(writer, entry.held, before);
  } else if (plain(entry)) {
    writer.varint(entry.held.size() << 2 | kHeld);
    writer.bytes(entry.held);
  } else if (entry.control == Control::none && same(entry.held, before)) {
    writer.varint(entry.commands.size() << 2 | kCommands);
    writer.bytes(entry.commands);
  } else {
    writer.varint(entry.held.size() << 2 | kWhole);
    writer.bytes(entry.held);
    writer.varint(entry.commands.size());
    writer.bytes(entry.commands);
    writer.u8(static_cast<std::uint8_t>(entry.control));
  }
}

/// Reads what follows the tag of a run that is no repeat.
InputEntry decodeEntry(PacketReader& reader, const InputStream& stream, std::uint64_t tag,
                       std::span<const std::uint8_t> before) {
  InputEntry entry;
  const std::uint64_t count = tag >> 2;
  const std::uint64_t most = (tag & 3) == kCommands ? stream.maxCommands() : stream.maxHeld();
  if (count > most) reader.fail();
  if ((tag & 3) == kCommands) {
    entry.held = before;
    entry.commands = reader.bytes(count);
    return entry;
  }
  entry.held = reader.bytes(count);
  if ((tag & 3) == kHeld) return entry;
  entry.commands = reader.bytes(reader.varint(stream.maxCommands()));
  const std::uint8_t control = reader.u8();
  if (control >= kControls) reader.fail();
  entry.control = static_cast<Control>(control);
  return entry;
}

}  // namespace

InputStream::InputStream(std::uint32_t maxHeld, std::uint32_t maxCommands)
    : maxHeld_(maxHeld),
      maxCommands_(maxCommands),
      stride_(2 * maxHeld + maxCommands),
      records_(kCapacity),
      bytes_(std::size_t{kCapacity} * stride_) {}

void InputStream::reset(Tick first) {
  first_ = first;
  end_ = first;
  std::fill(records_.begin(), records_.end(), Record{});
}

void InputStream::skipTo(Tick first) {
  for (Tick tick = std::max(end_, first - std::min(first, kCapacity)); tick < first; ++tick) {
    records_[tick % kCapacity] = Record{};
  }
  end_ = std::max(end_, first);
}

InputEntry InputStream::at(Tick tick) const {
  expects(has(tick));
  const Record& record = records_[tick % kCapacity];
  const std::uint8_t* bytes = bytesOf(tick);
  return {{bytes, record.held}, {bytes + 2 * maxHeld_, record.commands}, record.control};
}

std::span<const std::uint8_t> InputStream::heldBefore(Tick tick) const {
  const Tick last = std::min(tick, end_);
  return last > first_ && has(last - 1) ? at(last - 1).held : std::span<const std::uint8_t>{};
}

bool InputStream::append(const InputEntry& entry) {
  const Tick tick = end_++;
  Record& record = records_[tick % kCapacity];
  std::uint8_t* bytes = bytesOf(tick);
  const bool used = record.predictedTick == tick;
  record.held = static_cast<std::uint8_t>(entry.held.size());
  record.commands = static_cast<std::uint8_t>(entry.commands.size());
  record.control = entry.control;
  copy(bytes, entry.held);
  copy(bytes + 2 * maxHeld_, entry.commands);
  return !used || (entry.commands.empty() && same(at(tick).held, {bytes + maxHeld_, record.predicted}));
}

void InputStream::truncate(Tick end) { end_ = std::clamp(end, first_, end_); }

void InputStream::predict(Tick tick, std::span<const std::uint8_t> held) {
  Record& record = records_[tick % kCapacity];
  record.predictedTick = tick;
  record.predicted = static_cast<std::uint8_t>(held.size());
  copy(bytesOf(tick) + maxHeld_, held);
}

std::span<const std::uint8_t> InputStream::predicted(Tick tick) const {
  return {bytesOf(tick) + maxHeld_, records_[tick % kCapacity].predicted};
}

Tick encodeEntries(PacketWriter& writer, const InputStream& stream, Tick from, Tick to) {
  Tick tick = from;
  while (tick < to) {
    const InputEntry entry = stream.at(tick);
    const auto before = stream.heldBefore(tick);
    PacketWriter trial = writer;
    Tick next = tick + 1;
    if (plain(entry) && same(entry.held, before)) {
      while (next < to && plain(stream.at(next)) && same(stream.at(next).held, before)) ++next;
      trial.varint(std::uint64_t{next - tick} << 2 | kRepeat);
    } else {
      encodeEntry(trial, entry, before);
    }
    if (!trial.good()) break;
    writer = trial;
    tick = next;
  }
  return tick;
}

bool decodeEntries(PacketReader& reader, InputStream& stream, Tick base, Tick limit, Tick& wrong) {
  // Inputs that a later packet has said already need no reading, and what they are told relative to may be
  // forgotten.
  if (base > stream.end() || base < stream.first() || (base > stream.first() && !stream.has(base - 1))) {
    return true;
  }
  std::uint8_t held[256];
  std::uint8_t changed[kMostMasked] = {};
  std::uint32_t heldBytes = static_cast<std::uint32_t>(stream.heldBefore(base).size());
  copy(held, stream.heldBefore(base));
  Tick tick = base;
  while (reader.left() > 0) {
    const std::uint64_t tag = reader.varint(std::uint64_t{InputStream::kCapacity} << 2 | 3);
    const bool repeat = (tag & 3) == kRepeat && tag != 0;
    const std::span<const std::uint8_t> before{held, heldBytes};
    const InputEntry entry = repeat     ? InputEntry{before, {}}
                             : tag == 0 ? decodeMasked(reader, before, changed)
                                        : decodeEntry(reader, stream, tag, before);
    const std::uint64_t count = repeat ? tag >> 2 : 1;
    if (!reader.good() || tick + count > base + InputStream::kCapacity) return false;
    for (std::uint64_t i = 0; i < count; ++i, ++tick) {
      if (tick != stream.end()) continue;
      if (tick >= limit) return true;
      if (!stream.append(entry)) wrong = std::min(wrong, tick);
    }
    if (!repeat && (tag & 3) != kCommands) {
      heldBytes = static_cast<std::uint32_t>(entry.held.size());
      copy(held, entry.held);
    }
  }
  return true;
}

}  // namespace samestep::lockstep
