// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace samestep {

/// Packs payloads by zstd, with memory that is taken once.
class Packer {
 public:
  /// @throws ValueOutOfRange where this build lacks zstd
  Packer();
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  /// Answers the packed bytes, which last until the next call; none where readers would refuse them or
  /// nothing is gained.
  std::span<const std::uint8_t> pack(std::span<const std::uint8_t> plain);

 private:
  void* context_;
  std::vector<std::uint8_t> packed_;
};

/// Unpacks one whole zstd frame of `size` bytes.
/// @param offset  of the payload in the recording, for errors
/// @throws FormatError for anything else, before memory is taken where it asks for more than is allowed
void unpack(std::span<const std::uint8_t> packed, std::uint32_t size, std::uint64_t offset,
            std::vector<std::uint8_t>& plain);

}  // namespace samestep
