// SPDX-License-Identifier: MIT
#include <samestep/recording.h>

#include <samestep/version.h>

#include <algorithm>

#include "base/require_ieee.h"
#include "recording/packing.h"
#include "recording/recording_format.h"
#include "recording/sections.h"
#include "state/canonical_reader.h"
#include "state/state_hash.h"

namespace samestep {
namespace {

RecordingInfo readInfo(ByteReader& bytes) {
  CanonicalReader read(bytes);
  const auto magic = bytes.take(sizeof kRecordingMagic);
  if (!std::equal(magic.begin(), magic.end(), kRecordingMagic)) failFormat(0, "not a recording");
  RecordingInfo info;
  read.get(info.version);
  if (info.version < kOldestRecordingVersion || info.version > kRecordingVersion) {
    failFormat(kVersionAt, "a recording of another format version");
  }
  read.get(info.revision);
  read.get(info.scalar);
  if (info.scalar != ScalarKind::fixed && info.scalar != ScalarKind::float64) {
    failFormat(kScalarAt, "unknown scalar");
  }
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t at = bytes.offset();
    if (read.next<std::uint8_t>() != 0) failFormat(at, "a byte that must be zero is not");
  }
  return info;
}

/// Reads the fields of one kind of command each.
template <Scalar S>
class CommandReader {
 public:
  explicit CommandReader(ByteReader& bytes) : bytes_(bytes), read_(bytes) {}

  Command<S> command() {
    const std::uint64_t at = bytes_.offset();
    switch (read_.next<CommandKind>()) {
      case CommandKind::applyImpulse:
        return plain<ApplyImpulse<S>>();
      case CommandKind::applyForce:
        return plain<ApplyForce<S>>();
      case CommandKind::setVelocity:
        return plain<SetVelocity<S>>();
      case CommandKind::setAngularVelocity:
        return plain<SetAngularVelocity<S>>();
      case CommandKind::setPosition:
        return plain<SetPosition<S>>();
      case CommandKind::setAngle:
        return plain<SetAngle<S>>();
      case CommandKind::spawn:
        return spawn();
      case CommandKind::remove:
        return plain<Remove>();
      case CommandKind::userInput:
        return input();
      case CommandKind::join:
        return joined<Join<S>>();
      case CommandKind::adjust:
        return joined<Adjust<S>>();
      case CommandKind::unjoin:
        return plain<Unjoin>();
    }
    failFormat(at, "unknown command");
  }

 private:
  template <class T>
  Command<S> plain() {
    return Command<S>(read_.template next<T>());
  }

  /// A command with a joint, whose impulses are none yet.
  template <class T>
  Command<S> joined() {
    const std::uint64_t at = bytes_.offset();
    T command = read_.template next<T>();
    if (!command.id.valid() && command.id != JointId{}) {
      failFormat(at, "an id without an index has a generation");
    }
    if (flawOfJoint(command.joint) != nullptr) failFormat(at, "a joint is out of range");
    if (command.joint.kept != JointImpulses<S>() || command.joint.latch != S(0)) {
      failFormat(at, "a new joint has kept something");
    }
    return command;
  }

  Command<S> spawn() {
    Command<S> command(std::in_place_type<Spawn<S>>);
    auto& made = std::get<Spawn<S>>(command);
    std::uint64_t at = bytes_.offset();
    read_.get(made.id);
    if (!made.id.valid() && made.id != BodyId{}) failFormat(at, "an id without an index has a generation");
    at = bytes_.offset();
    read_.get(made.body);
    made.body.derive();
    if (!made.body.wellFormed()) failFormat(at, "a body is malformed");
    at = bytes_.offset();
    const auto count = read_.template next<std::uint32_t>();
    if (count > kMaxSpawnShapes) failFormat(at, "more shapes than allowed");
    for (std::uint32_t i = 0; i < count; ++i) {
      at = bytes_.offset();
      Shape<S>& shape = made.shapes.emplace_back();
      read_.get(shape);
      if (shape.body() != BodyId{}) failFormat(at, "a new shape has a body");
      if (!shape.wellFormed()) failFormat(at, "a shape is malformed");
      if (made.id.valid()) {
        ShapeId id;
        read_.get(id);
        shape.attach(id);
      }
    }
    return command;
  }

  Command<S> input() {
    const std::uint64_t at = bytes_.offset();
    const auto count = read_.template next<std::uint32_t>();
    if (count > kMaxInputBytes) failFormat(at, "longer than allowed");
    const auto taken = bytes_.take(count);
    return UserInput{{taken.begin(), taken.end()}};
  }

  ByteReader& bytes_;
  CanonicalReader read_;
};

}  // namespace

RecordingInfo recordingInfo(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  return readInfo(reader);
}

namespace {

std::string_view text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A length in one byte, at least 1, and the key.
std::string_view readKey(ByteReader& reader) {
  const std::uint64_t at = reader.offset();
  const std::uint64_t length = reader.load<1>();
  if (length == 0) failFormat(at, "an empty key");
  return text(reader.take(length));
}

/// A length in four bytes and the value.
std::span<const std::uint8_t> readValue(ByteReader& reader, std::uint32_t most) {
  const std::uint64_t at = reader.offset();
  const std::uint64_t length = reader.load<4>();
  if (length > most) failFormat(at, "longer than allowed");
  return reader.take(length);
}

template <class Visit>
void eachNote(std::span<const std::uint8_t> bytes, const RecordingSection& section, Visit&& visit) {
  ByteReader reader(bytes.first(static_cast<std::size_t>(section.payloadAt + section.payloadBytes)),
                    section.payloadAt);
  while (reader.remaining() > 0) {
    const std::string_view key = readKey(reader);
    visit(Note{key, text(readValue(reader, kMaxNoteBytes))});
  }
}

/// The payload of a section as it was before packing, in `unpacked` where it was packed.
/// @param start  set to where it stands in the bytes that are answered
std::span<const std::uint8_t> plainPayload(std::span<const std::uint8_t> bytes,
                                           const RecordingSection& section,
                                           std::vector<std::uint8_t>& unpacked, std::uint64_t& start) {
  const auto at = static_cast<std::size_t>(section.payloadAt);
  const auto size = static_cast<std::size_t>(section.payloadBytes);
  start = section.packed ? 0 : section.payloadAt;
  if (!section.packed) return bytes.first(at + size);
  unpack(bytes.subspan(at, size), section.unpackedBytes, section.payloadAt, unpacked);
  return unpacked;
}

/// Does something within a section; what is wrong within a packed one stands, for the reader of an error,
/// where the section does.
template <class Action>
void inSection(bool packed, std::uint64_t at, Action&& action) {
  if (packed) {
    orFailFormat(at, action);
  } else {
    action();
  }
}

}  // namespace

/// Scan of all items: what it goes by.
template <Scalar S>
struct RecordingReader<S>::Scan {
  const RecordingLimits& limits;
  const Interrupt& interrupt;
  std::uint32_t items = 0;
  std::uint32_t commands = 0;  ///< Number since the last step.

  /// Takes notice of one item.
  void see(RecordingItem item, std::uint64_t offset) {
    // A spawn of many shapes is the longest.
    constexpr std::uint32_t kItemsAtOnce = 64;
    require<Fault::Interrupted>(++items % kItemsAtOnce != 0 || !interrupt.isWanted());
    if (item == RecordingItem::claim && commands > 0) failFormat(offset, "a claim within a tick");
    commands = item == RecordingItem::command ? commands + 1 : 0;
    if (commands > limits.commandsPerTick) failFormat(offset, "more commands before a step than allowed");
  }
};

template <Scalar S>
RecordingReader<S>::RecordingReader(std::span<const std::uint8_t> bytes, const RecordingLimits& limits,
                                    const Interrupt& interrupt, Ending ending)
    : bytes_(bytes) {
  if (bytes.size() > limits.bytes) failFormat(limits.bytes, "more bytes than allowed");
  ByteReader reader(bytes);
  const RecordingInfo info = readInfo(reader);
  version_ = info.version;
  if (info.scalar != ScalarTraits<S>::kKind) failFormat(kScalarAt, "a recording of another scalar");
  if (info.revision != kSimulationRevision) {
    failRevision(kRevisionAt, info.revision, kSimulationRevision);
  }
  CanonicalReader read(reader);
  read.get(timeStep_);
  if (!(timeStep_ > S(0) && timeStep_ <= kMaxTimeStep<S>))
    failFormat(kTimeStepAt, "the time step is out of range");
  Scan scan{limits, interrupt};
  if (version_ == kOldestRecordingVersion) {
    scanOldFormat(scan);
  } else {
    scanSections(scan, ending == Ending::mayBeCut);
  }
  if (ticks_ == 0) {
    failFormat(version_ == kOldestRecordingVersion ? firstSection_ : usableEnd_,
               "a recording without a step");
  }
  seek(0);
}

template <Scalar S>
void RecordingReader<S>::scanOldFormat(Scan& scan) {
  std::uint64_t offset = kWorldAt;
  world_ = decodeWorld<S>(bytes_, offset, scan.limits, worldFormat());
  ByteReader after(bytes_, offset);
  initialHash_ = CanonicalReader(after).next<std::uint64_t>();
  keyframes_.push_back({0, initialHash_, kWorldAt, after.offset() - kWorldAt, 0});
  firstSection_ = after.offset();
  usableEnd_ = sectionEnd_ = bytes_.size();
  position_ = firstSection_;

  std::uint64_t afterStep = firstSection_;
  for (RecordingItem item = next(); item != RecordingItem::end; item = next()) {
    scan.see(item, itemOffset_);
    if (item != RecordingItem::step) continue;
    ++ticks_;
    afterStep = position_;
  }
  if (itemOffset_ != afterStep) failFormat(afterStep, "a command after the last step");
}

template <Scalar S>
void RecordingReader<S>::scanSections(Scan& scan, bool mayBeCut) {
  usableEnd_ = bytes_.size();
  std::uint64_t chain = chainOf(bytes_.first(kWorldAt));
  std::uint64_t indexAt = 0;
  std::uint64_t unpacked = 0;
  for (std::uint64_t offset = firstSection_ = kWorldAt;;) {
    const RecordingSection section = readSection(bytes_, offset, mayBeCut);
    const bool first = offset == kWorldAt;
    if (first != keyframes_.empty() || (first && section.kind != SectionKind::keyframe)) {
      failFormat(offset, "a recording begins with its first world");
    }
    const std::uint64_t before = chain;
    if (!section.cut) checkChain(bytes_, section, chain);
    if (indexAt != 0) {
      if (section.cut) break;
      if (section.kind != SectionKind::end) failFormat(offset, "the end must follow the index");
      scanEnd(section, indexAt);
      return;
    }
    if (!scanSection(section, before, scan)) break;
    unpacked += section.unpackedBytes;
    if (unpacked > scan.limits.bytes) failFormat(offset, "unpacks to more bytes than allowed");
    if (section.kind == SectionKind::index) usableEnd_ = indexAt = offset;
    if (first) {
      world_ = world(0, scan.limits);
      initialHash_ = keyframes_[0].hash;
    }
    offset = section.end;
  }
  whole_ = false;
}

/// @return whether there may be more
template <Scalar S>
bool RecordingReader<S>::scanSection(const RecordingSection& section, std::uint64_t chainBefore, Scan& scan) {
  if (section.cut && section.kind != SectionKind::ticks) {
    if (keyframes_.empty()) failFormat(bytes_.size(), "cut short");
    usableEnd_ = section.at;
    return false;
  }
  switch (section.kind) {
    case SectionKind::keyframe:
      scanKeyframe(section, chainBefore);
      break;
    case SectionKind::ticks:
      scanTicks(section, scan);
      break;
    case SectionKind::notes:
      eachNote(bytes_, section, [](const Note&) {});
      notes_.push_back(section.at);
      break;
    case SectionKind::index:
      scanIndex(section);
      break;
    case SectionKind::end:
      failFormat(section.at, "an end without an index");
  }
  return !section.cut;
}

template <Scalar S>
void RecordingReader<S>::scanKeyframe(const RecordingSection& section, std::uint64_t chainBefore) {
  std::uint64_t start = 0;
  const auto plain = plainPayload(bytes_, section, unpacked_, start);
  Keyframe keyframe;
  inSection(section.packed, section.at, [&] {
    ByteReader reader(plain, start);
    keyframe.tick = reader.load<8>();
    keyframe.hash = reader.load<8>();
  });
  keyframe.offset = section.at;
  keyframe.bytes = section.end - section.at;
  keyframe.chain = chainBefore;
  const bool first = keyframes_.empty();
  if (keyframe.tick != ticks_ || (!first && keyframe.tick <= keyframes_.back().tick)) {
    failFormat(section.at, "a keyframe stands after another tick than it says");
  }
  if (!first && keyframe.hash != hash_) {
    failFormat(section.at, "a keyframe has another hash than the tick it stands after");
  }
  keyframes_.push_back(keyframe);
}

template <Scalar S>
void RecordingReader<S>::scanTicks(const RecordingSection& section, Scan& scan) {
  std::uint64_t whole = section.at;
  const auto read = [&] {
    load(section);
    while (position_ < sectionEnd_) {
      const RecordingItem item = readItem();
      scan.see(item, itemOffset_);
      if (item == RecordingItem::step) ++ticks_;
      if (item == RecordingItem::claim) ++claims_;
      if (scan.commands == 0) whole = position_;
    }
    if (scan.commands > 0 && !section.cut) {
      failFormat(section.at, "a command after the last step of its section");
    }
  };
  if (!section.cut) return read();
#if defined(__cpp_exceptions)
  try {
    if (!section.packed) read();
  } catch (const FormatError&) {
    // A crash leaves no whole last item.
  }
#else
  if (!section.packed) read();
#endif
  usableEnd_ = whole;
}

template <Scalar S>
void RecordingReader<S>::scanIndex(const RecordingSection& section) const {
  ByteReader reader(bytes_, section.payloadAt);
  CanonicalReader read(reader);
  const bool fits = section.payloadBytes == keyframes_.size() * kIndexEntryBytes;
  if (!fits) failFormat(section.payloadAt, "the index has another number of keyframes");
  for (const Keyframe& keyframe : keyframes_) {
    const std::uint64_t at = reader.offset();
    const bool same = read.next<std::uint64_t>() == keyframe.tick &&
                      read.next<std::uint64_t>() == keyframe.offset &&
                      read.next<std::uint64_t>() == keyframe.chain;
    if (!same) failFormat(at, "the index is false");
  }
}

template <Scalar S>
void RecordingReader<S>::scanEnd(const RecordingSection& section, std::uint64_t indexAt) const {
  if (section.payloadBytes != 16) failFormat(section.at, "the end is of another size");
  ByteReader reader(bytes_, section.payloadAt);
  if (reader.load<8>() != ticks_) failFormat(section.payloadAt, "the number of steps is another");
  if (reader.load<8>() != indexAt) failFormat(section.payloadAt + 8, "the index is elsewhere");
  if (section.end != bytes_.size()) failFormat(section.end, "something follows the end");
}

template <Scalar S>
void RecordingReader<S>::load(const RecordingSection& section) {
  packed_ = section.packed;
  sectionAt_ = section.at;
  std::uint64_t start = 0;
  const auto plain = plainPayload(bytes_, section, unpacked_, start);
  position_ = itemAt_ = start;
  sectionEnd_ = packed_ ? plain.size() : min<std::uint64_t>(plain.size(), usableEnd_);
}

/// Loads the next section that has items.
template <Scalar S>
bool RecordingReader<S>::loadNext() {
  while (nextSection_ < usableEnd_) {
    const RecordingSection section = readSection(bytes_, nextSection_, true);
    nextSection_ = section.end;
    if (section.kind != SectionKind::ticks) continue;
    load(section);
    if (position_ < sectionEnd_) return true;
  }
  return false;
}

template <Scalar S>
std::span<const std::uint8_t> RecordingReader<S>::items() const {
  return packed_ ? std::span<const std::uint8_t>(unpacked_)
                 : bytes_.first(static_cast<std::size_t>(sectionEnd_));
}

template <Scalar S>
RecordingItem RecordingReader<S>::next() {
  const bool old = version_ == kOldestRecordingVersion;
  if (!old && position_ == sectionEnd_ && !loadNext()) {
    itemOffset_ = usableEnd_;
    itemAt_ = position_;
    return RecordingItem::end;
  }
  return readItem();
}

template <Scalar S>
bool RecordingReader<S>::claimFollows() {
  if (version_ == kOldestRecordingVersion) return false;
  if (position_ == sectionEnd_ && !loadNext()) return false;
  return items()[static_cast<std::size_t>(position_)] == static_cast<std::uint8_t>(RecordingItem::claim);
}

template <Scalar S>
RecordingItem RecordingReader<S>::readItem() {
  const bool old = version_ == kOldestRecordingVersion;
  itemOffset_ = packed_ ? sectionAt_ : position_;
  itemAt_ = position_;
  ByteReader reader(items(), position_);
  CanonicalReader read(reader);
  RecordingItem item{};
  inSection(packed_, sectionAt_, [&] {
    read.get(item);
    if (item == RecordingItem::step) {
      read.get(hash_);
    } else if (item == RecordingItem::command) {
      command_ = CommandReader<S>(reader).command();
    } else if (item == RecordingItem::claim && !old) {
      claim_.key = readKey(reader);
      claim_.value = readValue(reader, kMaxClaimBytes);
    } else if (item == RecordingItem::end && old) {
      readOldEnd(reader);
    } else {
      failFormat(itemOffset_, "no item of a recording");
    }
  });
  // The end stays where it is.
  if (item != RecordingItem::end) position_ = reader.offset();
  return item;
}

template <Scalar S>
Command<S> RecordingReader<S>::commandAt(std::span<const std::uint8_t> items, std::uint64_t& offset) {
  ByteReader reader(items, offset);
  if (CanonicalReader(reader).next<RecordingItem>() != RecordingItem::command) {
    failFormat(offset, "not a command");
  }
  Command<S> command = CommandReader<S>(reader).command();
  offset = reader.offset();
  return command;
}

template <Scalar S>
void RecordingReader<S>::readOldEnd(ByteReader& reader) const {
  CanonicalReader read(reader);
  const std::uint64_t countAt = reader.offset();
  if (read.next<std::uint64_t>() != ticks_) failFormat(countAt, "the number of steps is another");
  const std::uint64_t checksumAt = reader.offset();
  const std::uint64_t computed = XXH3_64bits(bytes_.data(), static_cast<std::size_t>(checksumAt));
  if (read.next<std::uint64_t>() != computed)
    failFormat(checksumAt, "the checksum is wrong: the bytes were altered");
  if (reader.remaining() > 0) failFormat(reader.offset(), "something follows the end");
}

template <Scalar S>
std::vector<Note> RecordingReader<S>::notes() const {
  std::vector<Note> all;
  for (const std::uint64_t at : notes_) {
    eachNote(bytes_, readSection(bytes_, at, false), [&](const Note& note) { all.push_back(note); });
  }
  return all;
}

template <Scalar S>
WorldState<S> RecordingReader<S>::world(std::size_t index, const WorldLimits& limits) const {
  require<Fault::IndexOutOfBounds>(index < keyframes_.size());
  if (version_ == kOldestRecordingVersion) return world_;
  const Keyframe& keyframe = keyframes_[index];
  const RecordingSection section = readSection(bytes_, keyframe.offset, false);
  std::vector<std::uint8_t> unpacked;
  std::uint64_t offset = 0;
  const auto plain = plainPayload(bytes_, section, unpacked, offset);
  WorldState<S> world;
  inSection(section.packed, section.at, [&] {
    offset += kKeyframeHeadBytes;
    world = decodeWorld<S>(plain, offset, limits, worldFormat());
    if (offset != plain.size()) failFormat(offset, "something follows the world of a keyframe");
  });
  // The hash of the first world is compared by who replays it: a mismatch at tick 0.
  if (index > 0 && hashOfWorld(world, hashOfShapes(world.shapes)) != keyframe.hash) {
    failFormat(keyframe.offset, "the world of a keyframe has another hash than the tick it stands after");
  }
  return world;
}

template <Scalar S>
bool RecordingReader<S>::isWorld(std::size_t index, const WorldState<S>& world) const {
  require<Fault::IndexOutOfBounds>(index < keyframes_.size());
  std::vector<std::uint8_t> encoded;
  encodeWorld(world, encoded);
  if (worldFormat() < kWorldFormat) {
    // No world is written as these are any more.
    std::vector<std::uint8_t> again;
    encodeWorld(this->world(index), again);
    return encoded == again;
  }
  const RecordingSection section = readSection(bytes_, keyframes_[index].offset, false);
  std::vector<std::uint8_t> unpacked;
  std::uint64_t start = 0;
  const auto plain = plainPayload(bytes_, section, unpacked, start);
  const auto stands = plain.subspan(static_cast<std::size_t>(start + kKeyframeHeadBytes));
  return std::equal(encoded.begin(), encoded.end(), stands.begin(), stands.end());
}

template <Scalar S>
void RecordingReader<S>::seek(std::size_t keyframe) {
  require<Fault::IndexOutOfBounds>(keyframe < keyframes_.size());
  hash_ = keyframes_[keyframe].hash;
  packed_ = false;
  if (version_ == kOldestRecordingVersion) {
    position_ = firstSection_;
    return;
  }
  nextSection_ = keyframes_[keyframe].offset + keyframes_[keyframe].bytes;
  position_ = itemAt_ = sectionEnd_ = 0;
}

#define SAMESTEP_EACH_SCALAR template class RecordingReader<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
