// SPDX-License-Identifier: MIT
#include <samestep/recording.h>

#include <samestep/version.h>

#include <algorithm>

#include "base/require_ieee.h"
#include "recording/recording_format.h"
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
  if (info.version != kRecordingVersion) failFormat(kVersionAt, "a recording of another format version");
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
    }
    failFormat(at, "unknown command");
  }

 private:
  template <class T>
  Command<S> plain() {
    return Command<S>(read_.template next<T>());
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

template <Scalar S>
RecordingReader<S>::RecordingReader(std::span<const std::uint8_t> bytes, const RecordingLimits& limits,
                                    const Interrupt& interrupt)
    : bytes_(bytes) {
  if (bytes.size() > limits.bytes) failFormat(limits.bytes, "more bytes than allowed");
  ByteReader reader(bytes);
  const RecordingInfo info = readInfo(reader);
  if (info.scalar != ScalarTraits<S>::kKind) failFormat(kScalarAt, "a recording of another scalar");
  if (info.revision != kSimulationRevision) {
    failRevision(kRevisionAt, info.revision, kSimulationRevision);
  }
  CanonicalReader read(reader);
  read.get(timeStep_);
  if (!(timeStep_ > S(0) && timeStep_ <= kMaxTimeStep<S>))
    failFormat(kTimeStepAt, "the time step is out of range");
  offset_ = reader.offset();
  world_ = decodeWorld<S>(bytes, offset_, limits);
  ByteReader after(bytes, offset_);
  initialHash_ = CanonicalReader(after).next<std::uint64_t>();
  offset_ = after.offset();
  countItems(limits.commandsPerTick, interrupt);
}

/// So many are read between two questions whether to go on: a spawn of many shapes is the longest.
constexpr std::uint32_t kItemsAtOnce = 64;

/// Looks at all items once, then goes back to the first.
template <Scalar S>
void RecordingReader<S>::countItems(std::uint32_t mostCommands, const Interrupt& interrupt) {
  const std::uint64_t first = offset_;
  std::uint64_t afterStep = first;
  std::uint32_t commands = 0;
  std::uint32_t items = 0;
  for (RecordingItem item = next(); item != RecordingItem::end; item = next()) {
    require<Fault::Interrupted>(++items % kItemsAtOnce != 0 || !interrupt.isWanted());
    if (item == RecordingItem::step) {
      ++ticks_;
      afterStep = offset_;
      commands = 0;
    } else if (++commands > mostCommands) {
      failFormat(itemOffset_, "more commands before a step than allowed");
    }
  }
  if (ticks_ == 0) failFormat(first, "a recording without a step");
  if (itemOffset_ != afterStep) failFormat(afterStep, "a command after the last step");
  offset_ = first;
}

template <Scalar S>
RecordingItem RecordingReader<S>::next() {
  ByteReader reader(bytes_, offset_);
  CanonicalReader read(reader);
  itemOffset_ = offset_;
  const auto item = read.next<RecordingItem>();
  switch (item) {
    case RecordingItem::step:
      read.get(hash_);
      break;
    case RecordingItem::command:
      command_ = CommandReader<S>(reader).command();
      break;
    case RecordingItem::end:
      readEnd(reader);
      // Stays here.
      return item;
    default:
      failFormat(itemOffset_, "neither a command nor a step nor the end");
  }
  offset_ = reader.offset();
  return item;
}

template <Scalar S>
Command<S> RecordingReader<S>::commandAt(std::span<const std::uint8_t> bytes, std::uint64_t& offset) {
  ByteReader reader(bytes, offset);
  if (CanonicalReader(reader).next<RecordingItem>() != RecordingItem::command) {
    failFormat(offset, "not a command");
  }
  Command<S> command = CommandReader<S>(reader).command();
  offset = reader.offset();
  return command;
}

template <Scalar S>
void RecordingReader<S>::readEnd(ByteReader& reader) const {
  CanonicalReader read(reader);
  const std::uint64_t countAt = reader.offset();
  if (read.next<std::uint64_t>() != ticks_) failFormat(countAt, "the number of steps is another");
  const std::uint64_t checksumAt = reader.offset();
  const std::uint64_t computed = XXH3_64bits(bytes_.data(), static_cast<std::size_t>(checksumAt));
  if (read.next<std::uint64_t>() != computed)
    failFormat(checksumAt, "the checksum is wrong: the bytes were altered");
  if (reader.remaining() > 0) failFormat(reader.offset(), "something follows the end");
}

#define SAMESTEP_EACH_SCALAR template class RecordingReader<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
