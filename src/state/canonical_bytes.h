// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "state/canonical.h"

namespace samestep {

/// A sink of CanonicalWriter that appends to a vector.
class BytesSink {
 public:
  explicit BytesSink(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  std::uint8_t* reserve(unsigned size) {
    bytes_.resize(bytes_.size() + size);
    return bytes_.data() + bytes_.size() - size;
  }

 private:
  std::vector<std::uint8_t>& bytes_;
};

}  // namespace samestep
