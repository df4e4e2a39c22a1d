// SPDX-License-Identifier: MIT
#include "netsim/seal.h"

#include <algorithm>
#include <cstring>

namespace samestep::netsim {
namespace {

void put(std::uint32_t value, std::uint8_t* to) {
  for (unsigned i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::uint32_t get(const std::uint8_t* from) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{from[i]} << (8 * i);
  return value;
}

}  // namespace

std::uint32_t Seal::tagOf(std::uint64_t match, Address name, std::uint32_t number,
                          std::span<const std::uint8_t> bytes) {
  std::uint64_t value = lockstep::mix(match, name << 32 | number);
  while (!bytes.empty()) {
    std::uint64_t word = bytes.size();
    const std::size_t size = std::min<std::size_t>(bytes.size(), 8);
    std::memcpy(&word, bytes.data(), size);
    value = lockstep::mix(value, word);
    bytes = bytes.subspan(size);
  }
  return static_cast<std::uint32_t>(value);
}

void Seal::close(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> into) {
  into[0] = static_cast<std::uint8_t>(name_);
  put(++sent_, &into[1]);
  put(tagOf(match_, name_, sent_, bytes), &into[5]);
  std::copy(bytes.begin(), bytes.end(), into.begin() + kBytes);
}

std::uint32_t Seal::open(const Datagram& datagram, Address& from, std::span<std::uint8_t> into) {
  const std::span<const std::uint8_t> all(datagram.bytes);
  const bool sealed = all.size() > kBytes && all.size() - kBytes <= into.size() && all[0] < nodes_.size();
  const auto inner = sealed ? all.subspan(kBytes) : std::span<const std::uint8_t>();
  const std::uint32_t number = sealed ? get(&all[1]) : 0;
  if (!sealed || (!broken_ && get(&all[5]) != tagOf(match_, all[0], number, inner))) {
    ++forged_;
    return 0;
  }
  from = all[0];
  // A peer that begins anew counts from the start again.
  const bool newer = number > numbers_[from] || number < numbers_[from] / 2;
  if (newer) {
    numbers_[from] = number;
    nodes_[from] = datagram.from;
  }
  std::copy(inner.begin(), inner.end(), into.begin());
  return static_cast<std::uint32_t>(inner.size());
}

}  // namespace samestep::netsim
