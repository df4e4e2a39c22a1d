// SPDX-License-Identifier: MIT
#include "input.h"

#include <array>

namespace samestep::fuzz {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 32;
constexpr std::int64_t kMost = kMaxNumber * kOne;

/// Numbers that the engine compares with, in raw units.
constexpr std::array<std::int64_t, 24> kLandmarks = {
    kOne / 10,   kOne / 3,   kOne * 2 / 3, 3037000500,  kOne * 3 / 5,  kOne * 4 / 5,
    kOne << 15,  kOne << 14, kOne << 8,    kOne >> 5,   kOne / 100000, kOne >> 24,
    kOne / 50,   kOne / 200, kOne << 10,   kOne / 1000, kOne * 1000,   kOne * 1000000,
    13493037705, 6746518852, kOne / 60,    kOne >> 20,  kOne / 64,     kOne << 20,
};

constexpr std::int64_t held(std::int64_t raw) { return raw > kMost ? kMost : raw < -kMost ? -kMost : raw; }

}  // namespace

Fixed Input::number() {
  const std::uint64_t bits = word();
  const auto payload = static_cast<std::int64_t>(bits) >> 8;
  const auto byte = static_cast<std::int8_t>(bits >> 8);
  const auto half = static_cast<std::int16_t>(bits >> 16);
  const auto low = static_cast<std::int32_t>(bits >> 24);
  std::int64_t raw = 0;
  switch (bits & 15) {
    case 0:
    case 12:
      raw = byte * kOne;
      break;
    case 1:
      raw = half * (kOne >> 4);
      break;
    case 2:
      raw = half * (kOne >> 10);
      break;
    case 3:
      raw = low;
      break;
    case 4: {
      const auto exponent = static_cast<unsigned>(byteOf(bits, 2)) % 53;
      const std::int64_t power = std::int64_t{1} << exponent;
      raw = (byteOf(bits, 3) & 1) != 0 ? byte - power : power + byte;
      break;
    }
    case 5:
      raw = payload >> 3;
      break;
    case 6:
      raw = last_ + byte;
      break;
    case 7:
      raw = (bits >> 8 & 1) != 0 ? -last_ : last_;
      break;
    case 8:
      raw = before_ + byte;
      break;
    case 9:
      raw = static_cast<std::int64_t>(low) * 4;
      break;
    case 10: {
      const std::int64_t landmark = kLandmarks[byteOf(bits, 2) % kLandmarks.size()];
      raw = (byteOf(bits, 3) & 1) != 0 ? byte - landmark : landmark + byte;
      break;
    }
    case 11:
      raw = (bits >> 8 & 1) != 0 ? -before_ : before_;
      break;
    case 13:
      raw = last_ + half * (kOne >> 10);
      break;
    case 14:
      raw = static_cast<std::int64_t>(low) * 256;
      break;
    default:
      raw = half;
      break;
  }
  before_ = last_;
  last_ = held(raw);
  return Fixed::fromRaw(last_);
}

Fixed Input::numberIn(Fixed low, Fixed high) {
  const std::int64_t raw = number().raw();
  if (raw >= low.raw() && raw <= high.raw()) return Fixed::fromRaw(raw);
  const std::int64_t size = high.raw() - low.raw() + 1;
  const std::int64_t rest = (raw - low.raw()) % size;
  return Fixed::fromRaw(low.raw() + (rest < 0 ? rest + size : rest));
}

}  // namespace samestep::fuzz
