// SPDX-License-Identifier: MIT
#include "relay/bundle.h"

#include <algorithm>
#include <cstring>

#include "session/byte_io.h"

namespace samestep::lockstep {
namespace {

constexpr std::uint32_t kMostWaiting = 256;
constexpr std::uint32_t kMostBytes = 1u << 16;
/// Type of a packet in its first byte, and that of inputs.
constexpr std::uint8_t kType = 15;
constexpr std::uint8_t kInputs = 2;
/// A length that does not fit into half a byte follows.
constexpr std::uint32_t kMore = 15;

/// Bytes that two packets share at the front and at the back.
struct Shared {
  std::uint32_t front = 0;
  std::uint32_t back = 0;
};

Shared sharedOf(std::span<const std::uint8_t> packet, std::span<const std::uint8_t> last) {
  Shared shared;
  const auto most = static_cast<std::uint32_t>(std::min(packet.size(), last.size()));
  while (shared.front < std::min(most, kMore) && packet[shared.front] == last[shared.front]) ++shared.front;
  while (shared.front + shared.back < most &&
         packet[packet.size() - 1 - shared.back] == last[last.size() - 1 - shared.back]) {
    ++shared.back;
  }
  return shared;
}

/// Writes a packet as what is another than in the one before.
void put(PacketWriter& writer, Seat seat, std::span<const std::uint8_t> packet,
         std::span<const std::uint8_t> last) {
  const Shared shared = sharedOf(packet, last);
  const auto middle = static_cast<std::uint32_t>(packet.size()) - shared.front - shared.back;
  const std::uint32_t back = std::min(shared.back, kMore);
  const std::uint32_t length = std::min(middle, kMore);
  writer.u8(static_cast<std::uint8_t>(seat << 4 | shared.front));
  writer.u8(static_cast<std::uint8_t>(back << 4 | length));
  if (back == kMore) writer.varint(shared.back);
  if (length == kMore) writer.varint(middle);
  writer.bytes(packet.subspan(shared.front, middle));
}

}  // namespace

BundleQueue::BundleQueue() {
  waiting_.reserve(kMostWaiting);
  bytes_.reserve(kMostBytes);
}

bool BundleQueue::add(Seat seat, std::span<const std::uint8_t> packet) {
  if (packet.empty() || packet.size() > kMaxPacket || seat >= kMaxPlayers) return false;
  if (waiting_.size() == kMostWaiting || bytes_.size() + packet.size() > kMostBytes) return false;
  if ((packet[0] & kType) == kInputs) {
    for (Waiting& older : waiting_) {
      if (older.seat == seat && older.size > 0 && (bytes_[older.offset] & kType) == kInputs) older.size = 0;
    }
  }
  waiting_.push_back(
      {seat, static_cast<std::uint32_t>(bytes_.size()), static_cast<std::uint32_t>(packet.size())});
  bytes_.insert(bytes_.end(), packet.begin(), packet.end());
  return true;
}

std::uint32_t BundleQueue::take(std::span<std::uint8_t> into) {
  PacketWriter writer(into.first(std::min<std::size_t>(into.size(), kMaxBundle)));
  writer.u8(kBundle);
  std::span<const std::uint8_t> last;
  for (; taken_ < waiting_.size(); ++taken_) {
    const Waiting& next = waiting_[taken_];
    if (next.size == 0) continue;
    const auto packet = std::span<const std::uint8_t>(bytes_).subspan(next.offset, next.size);
    PacketWriter trial = writer;
    put(trial, next.seat, packet, last);
    if (!trial.good()) break;
    writer = trial;
    last = packet;
  }
  if (taken_ == waiting_.size()) {
    waiting_.clear();
    bytes_.clear();
    taken_ = 0;
  }
  return writer.size() > 1 ? writer.size() : 0;
}

BundleReader::BundleReader(std::span<const std::uint8_t> bundle) : rest_(bundle) {
  good_ = !bundle.empty() && bundle[0] == kBundle;
  rest_ = good_ ? bundle.subspan(1) : std::span<const std::uint8_t>();
}

std::uint32_t BundleReader::next(Seat& seat, std::span<std::uint8_t> into) {
  if (!good_ || rest_.empty()) return 0;
  PacketReader reader(rest_);
  const std::uint8_t first = reader.u8();
  const std::uint8_t second = reader.u8();
  const std::uint32_t front = first & 15u;
  std::uint64_t back = second >> 4;
  std::uint64_t middle = second & 15u;
  if (back == kMore) back = reader.varint(kMaxPacket);
  if (middle == kMore) middle = reader.varint(kMaxPacket);
  const auto bytes = reader.bytes(middle);
  const std::uint64_t size = front + middle + back;
  good_ = reader.good() && front <= size_ && back <= size_ && size > 0 && size <= kMaxPacket &&
          size <= into.size();
  if (!good_) return 0;
  // Bytes shared with the back of the packet before may lie where this one is written.
  std::uint8_t packet[kMaxPacket];
  std::memcpy(packet, last_, front);
  if (!bytes.empty()) std::memcpy(packet + front, bytes.data(), bytes.size());
  std::memcpy(packet + front + middle, last_ + size_ - back, back);
  size_ = static_cast<std::uint32_t>(size);
  std::memcpy(last_, packet, size_);
  std::memcpy(into.data(), packet, size_);
  rest_ = rest_.subspan(reader.offset());
  seat = first >> 4;
  return size_;
}

}  // namespace samestep::lockstep
