// SPDX-License-Identifier: MIT
#include "recording/packing.h"

#include <samestep/error.h>
#include <samestep/recording.h>

#include "recording/recording_format.h"

#ifdef SAMESTEP_ZSTD
#include <zstd.h>
#endif

namespace samestep {

#ifdef SAMESTEP_ZSTD
namespace {

constexpr int kLevel = 3;

}  // namespace

bool packingAvailable() { return true; }

Packer::Packer() : context_(ZSTD_createCCtx()) {
  require<Fault::ValueOutOfRange>(context_ != nullptr, "There is no memory to pack with.");
}

Packer::~Packer() { ZSTD_freeCCtx(static_cast<ZSTD_CCtx*>(context_)); }

std::span<const std::uint8_t> Packer::pack(std::span<const std::uint8_t> plain) {
  if (plain.empty() || plain.size() > kMaxUnpackedBytes) return {};
  packed_.resize(ZSTD_compressBound(plain.size()));
  const std::size_t size = ZSTD_compressCCtx(static_cast<ZSTD_CCtx*>(context_), packed_.data(),
                                             packed_.size(), plain.data(), plain.size(), kLevel);
  if (ZSTD_isError(size) != 0 || size + kUnpackedLengthBytes >= plain.size()) return {};
  if (plain.size() / kMaxUnpackedPerByte >= size) return {};
  return std::span(packed_).first(size);
}

void unpack(std::span<const std::uint8_t> packed, std::uint32_t size, std::uint64_t offset,
            std::vector<std::uint8_t>& plain) {
  if (size == 0 || size > kMaxUnpackedBytes || size / kMaxUnpackedPerByte > packed.size()) {
    failFormat(offset, "unpacks to more than is allowed");
  }
  const bool whole = ZSTD_findFrameCompressedSize(packed.data(), packed.size()) == packed.size();
  if (!whole || ZSTD_getFrameContentSize(packed.data(), packed.size()) != size) {
    failFormat(offset, "not one whole zstd frame of the size it should have");
  }
  plain.resize(size);
  if (ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size()) != size) {
    failFormat(offset, "cannot be unpacked");
  }
}

#else

bool packingAvailable() { return false; }

Packer::Packer() : context_(nullptr) {
  fail<Fault::ValueOutOfRange>("This build lacks zstd, so recordings cannot be packed.");
}

Packer::~Packer() = default;

std::span<const std::uint8_t> Packer::pack(std::span<const std::uint8_t>) { return {}; }

void unpack(std::span<const std::uint8_t>, std::uint32_t, std::uint64_t offset, std::vector<std::uint8_t>&) {
  failFormat(offset, "packed by zstd, which this build lacks");
}

#endif

}  // namespace samestep
