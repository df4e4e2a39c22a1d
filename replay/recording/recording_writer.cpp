// SPDX-License-Identifier: MIT
#include "recording/recording_writer.h"

#include <samestep/make_room.h>

#include <algorithm>

#include "base/require_ieee.h"
#include "recording/sections.h"
#include "state/canonical_bytes.h"

namespace samestep {
namespace {

/// A section of ticks ends where it has so many bytes or so many ticks.
constexpr std::uint64_t kSectionBytes = 8192;
constexpr std::uint64_t kSectionTicks = 240;
/// Room for the index of some hours.
constexpr std::size_t kUsualKeyframes = 1024;

/// Worlds of a match differ a little in size, so that each might be the largest so far.
void reserveAhead(std::vector<std::uint8_t>& bytes) {
  if (bytes.capacity() < bytes.size() + bytes.size() / 2) bytes.reserve(2 * bytes.size());
}

}  // namespace

RecordingWriter::RecordingWriter(ByteSink sink, void* data) : sink_(sink), data_(data) {
  marks_.resize(std::size_t{kDefaultRewindTicks} + 1);
  items_.reserve(2 * kSectionBytes);
  section_.reserve(2 * kSectionBytes);
  index_.reserve(kUsualKeyframes);
}

void RecordingWriter::begin(std::span<const std::uint8_t> header, std::uint64_t hash,
                            std::span<const std::uint8_t> world) {
  sink_(header, data_);
  offset_ = header.size();
  chain_ = chainOf(header);
  markOf(0) = {0, hash};
  // One that waits, and one that is too large for now.
  waiting_.resize(2);
  for (Waiting& waiting : waiting_) waiting.bytes.reserve(2 * (world.size() + kKeyframeHeadBytes));
  waiting_[0].tick = 0;
  waiting_[0].bytes.resize(kKeyframeHeadBytes);
  storeLittleEndian<8>(waiting_[0].bytes.data() + 8, hash);
  waiting_[0].bytes.insert(waiting_[0].bytes.end(), world.begin(), world.end());
  waiting_[0].pace.bytes = waiting_[0].bytes.size();
  waitingCount_ = 1;
  giveFirstWaiting();
  dropFirstWaiting();
}

std::uint64_t RecordingWriter::oldestAfter(std::uint64_t ticks) const {
  return ticks - oldest_ >= marks_.size() ? ticks - marks_.size() + 1 : oldest_;
}

void RecordingWriter::prepareTick() {
  constexpr std::size_t kStepBytes = 1 + 8;
  settleTo(min(oldestAfter(ticks_ + 1), ticks_));
  makeRoom(items_, items_.size() + kStepBytes);
}

void RecordingWriter::endTick(std::uint64_t hash) {
  oldest_ = oldestAfter(++ticks_);
  markOf(ticks_) = {itemsGiven_ + items_.size(), hash};
}

std::vector<std::uint8_t>* RecordingWriter::keyframeDue() {
  const Pace last = pace();
  const std::uint64_t since = ticks_ - last.taken;
  if (budget_.ticks == 0 || since < budget_.ticks || since * budget_.bytesPerTick < last.bytes)
    return nullptr;
  if (waiting_.size() == waitingCount_) waiting_.emplace_back();
  Waiting& due = waiting_[waitingCount_++];
  due.tick = ticks_;
  due.pace = last;
  due.bytes.resize(kKeyframeHeadBytes);
  storeLittleEndian<8>(due.bytes.data(), ticks_);
  storeLittleEndian<8>(due.bytes.data() + 8, markOf(ticks_).hash);
  return &due.bytes;
}

void RecordingWriter::endKeyframe() {
  Waiting& due = waiting_[waitingCount_ - 1];
  due.pace.bytes = due.bytes.size();
  reserveAhead(due.bytes);
  if (due.pace.bytes > (ticks_ - due.pace.taken) * budget_.bytesPerTick) {
    due.bytes.clear();
  } else {
    due.pace.taken = ticks_;
  }
}

void RecordingWriter::dropKeyframe() {
  if (waitingCount_ > 0 && waiting_[waitingCount_ - 1].tick == ticks_) --waitingCount_;
}

void RecordingWriter::insertAfterTick(std::span<const std::uint8_t> item) {
  Mark& mark = markOf(ticks_);
  items_.insert(items_.begin() + static_cast<std::ptrdiff_t>(mark.end - itemsGiven_), item.begin(),
                item.end());
  mark.end += item.size();
}

void RecordingWriter::note(std::string_view key, std::string_view value) {
  makeRoom(notes_, notes_.size() + 1 + key.size() + 4 + value.size());
  BytesSink sink(notes_);
  CanonicalWriter<BytesSink> write(sink);
  write.put(static_cast<std::uint8_t>(key.size()));
  notes_.insert(notes_.end(), key.begin(), key.end());
  write.put(static_cast<std::uint32_t>(value.size()));
  notes_.insert(notes_.end(), value.begin(), value.end());
}

void RecordingWriter::rewind(std::uint64_t tick) {
  ticks_ = tick;
  items_.resize(static_cast<std::size_t>(markOf(tick).end - itemsGiven_));
  while (waitingCount_ > 0 && waiting_[waitingCount_ - 1].tick > tick) --waitingCount_;
}

void RecordingWriter::confirm(std::uint64_t tick) {
  oldest_ = max(oldest_, tick);
  settleTo(ticks_ == 0 ? 0 : min(oldest_, ticks_ - 1));
}

void RecordingWriter::setRewindTicks(std::uint32_t most) {
  if (ticks_ - oldest_ > most) confirm(ticks_ - most);
  // There is a mark of the last tick that is not given, too, whose section is not cut yet.
  std::vector<Mark> kept(std::size_t{most} + 1);
  for (std::uint64_t tick = oldest_; tick <= ticks_; ++tick) {
    kept[static_cast<std::size_t>(tick % kept.size())] = markOf(tick);
  }
  marks_ = std::move(kept);
}

void RecordingWriter::setPacking(bool packing) { packer_ = packing ? std::make_unique<Packer>() : nullptr; }

/// Looks for the ends of sections up to a tick that stays.
void RecordingWriter::settleTo(std::uint64_t tick) {
  for (; settled_ < tick; ++settled_) settle(settled_ + 1);
}

void RecordingWriter::settle(std::uint64_t tick) {
  const bool full = markOf(tick).end - itemsGiven_ >= kSectionBytes || tick - lastCut_ >= kSectionTicks;
  const bool looked = waitingCount_ > 0 && waiting_[0].tick == tick;
  if (full || (looked && !waiting_[0].bytes.empty())) cutAfter(tick);
  if (!looked) return;
  if (!waiting_[0].bytes.empty()) giveFirstWaiting();
  dropFirstWaiting();
}

void RecordingWriter::cutAfter(std::uint64_t tick) {
  if (!notes_.empty()) {
    giveSection(SectionKind::notes, notes_);
    notes_.clear();
  }
  const auto bytes = static_cast<std::size_t>(markOf(tick).end - itemsGiven_);
  if (bytes > 0) giveSection(SectionKind::ticks, std::span(items_).first(bytes));
  items_.erase(items_.begin(), items_.begin() + static_cast<std::ptrdiff_t>(bytes));
  itemsGiven_ += bytes;
  lastCut_ = tick;
}

void RecordingWriter::giveFirstWaiting() {
  makeRoom(index_, index_.size() + 1);
  const IndexEntry entry{waiting_[0].tick, offset_, chain_};
  giveSection(SectionKind::keyframe, waiting_[0].bytes);
  index_.push_back(entry);
}

void RecordingWriter::dropFirstWaiting() {
  pace_ = waiting_[0].pace;
  std::rotate(waiting_.begin(), waiting_.begin() + 1,
              waiting_.begin() + static_cast<std::ptrdiff_t>(waitingCount_));
  --waitingCount_;
}

void RecordingWriter::giveSection(SectionKind kind, std::span<const std::uint8_t> payload) {
  const auto byte = static_cast<std::uint8_t>(kind);
  const bool packable = kind == SectionKind::keyframe || kind == SectionKind::ticks;
  const auto packed = packer_ && packable ? packer_->pack(payload) : std::span<const std::uint8_t>();
  if (packed.empty()) return putSection(byte, payload.size(), {}, payload);
  std::uint8_t length[kUnpackedLengthBytes];
  storeLittleEndian<kUnpackedLengthBytes>(length, payload.size());
  putSection(byte | kPackedBit, packed.size(), length, packed);
}

void RecordingWriter::putSection(std::uint8_t kind, std::uint64_t length, std::span<const std::uint8_t> more,
                                 std::span<const std::uint8_t> payload) {
  require<Fault::ValueOutOfRange>(length <= 0xffffffffu, "What is done in one tick takes less than 4 GB.");
  section_.clear();
  BytesSink sink(section_);
  CanonicalWriter<BytesSink> write(sink);
  write.put(kind);
  write.put(static_cast<std::uint32_t>(length));
  section_.insert(section_.end(), more.begin(), more.end());
  section_.insert(section_.end(), payload.begin(), payload.end());
  reserveAhead(section_);
  const std::uint64_t chain = chainAfter(chain_, section_);
  write.put(chain);
  // It may throw: nothing has changed then.
  sink_(section_, data_);
  chain_ = chain;
  offset_ += section_.size();
}

void RecordingWriter::finish() {
  settleTo(ticks_);
  items_.resize(static_cast<std::size_t>(markOf(ticks_).end - itemsGiven_));
  if (!items_.empty() || !notes_.empty()) cutAfter(ticks_);
  std::vector<std::uint8_t> payload;
  BytesSink sink(payload);
  CanonicalWriter<BytesSink> write(sink);
  for (const IndexEntry& entry : index_) {
    write.put(entry.tick);
    write.put(entry.offset);
    write.put(entry.chain);
  }
  const std::uint64_t indexAt = offset_;
  giveSection(SectionKind::index, payload);
  payload.clear();
  write.put(ticks_);
  write.put(indexAt);
  giveSection(SectionKind::end, payload);
}

}  // namespace samestep
