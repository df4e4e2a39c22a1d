// SPDX-License-Identifier: MIT
// Packets of a session, many in one datagram.
#pragma once

#include <samestep/game.h>
#include <samestep/transport.h>

#include <cstdint>
#include <span>
#include <vector>

namespace samestep::lockstep {

/// First byte of a bundle.
inline constexpr std::uint8_t kBundle = 0x71;
/// Longest bundle: a seal is added to it.
inline constexpr std::uint32_t kMaxBundle = kMaxDatagram - 21;

/// Packets that wait to be sent together. A packet of inputs tells all that its receiver lacks, so that a
/// later one of the same sender to the same receiver takes the place of one that waits.
class BundleQueue {
 public:
  BundleQueue();

  /// Adds a packet. @param seat  its sender, or its receiver: the one that the datagram does not tell
  /// @return false where there is no room for it
  bool add(Seat seat, std::span<const std::uint8_t> packet);
  bool empty() const { return waiting_.empty(); }
  /// Writes the next bundle of what waits. @return its length, or 0 where nothing waits
  std::uint32_t take(std::span<std::uint8_t> into);

 private:
  struct Waiting {
    Seat seat = 0;
    std::uint32_t offset = 0;
    std::uint32_t size = 0;
  };
  std::vector<Waiting> waiting_;
  std::vector<std::uint8_t> bytes_;
  std::size_t taken_ = 0;
};

/// Reads the packets of a bundle one by one, whatever its bytes are.
class BundleReader {
 public:
  BundleReader() = default;
  explicit BundleReader(std::span<const std::uint8_t> bundle);

  /// Writes the next packet. @return its length; 0 at the end, or where the bytes are no bundle
  std::uint32_t next(Seat& seat, std::span<std::uint8_t> into);
  /// True if all that was read was a bundle.
  bool good() const { return good_; }

 private:
  std::span<const std::uint8_t> rest_;
  std::uint8_t last_[kMaxPacket] = {};
  std::uint32_t size_ = 0;
  bool good_ = true;
};

}  // namespace samestep::lockstep
