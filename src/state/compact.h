// SPDX-License-Identifier: MIT
// Lists of records in few bytes: of each number only what cannot be guessed from the record before it.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include <samestep/error.h>

#include "state/canonical.h"
#include "state/canonical_reader.h"

namespace samestep {

/// Form of a number of a record, two bits each. A writer uses the first that fits and a reader insists on it:
/// a list of records has one encoding only.
enum class CompactCode : std::uint8_t {
  asBefore = 0,   ///< Equal to the number at the same place of the record before; before the first: zero.
  zero = 1,       ///< Zero.
  asTwoBack = 2,  ///< Equal to the last number but one of this record.
  given = 3,      ///< The bytes follow.
};

/// Numbers in a group, which begins with the two bytes of their codes, the first number's lowest.
inline constexpr unsigned kCompactGroup = 8;
inline constexpr unsigned kCompactCodeBytes = 2;
inline constexpr unsigned kCompactGroupBytes = kCompactCodeBytes + 8 * kCompactGroup;
/// Numbers that one record may have.
inline constexpr unsigned kMaxCompactNumbers = 256;

[[gnu::always_inline]] inline unsigned compactCode(std::uint64_t value, std::uint64_t before,
                                                   std::uint64_t twoBack) {
  return value == before ? 0u : value == 0 ? 1u : value == twoBack ? 2u : 3u;
}

/// The numbers of the records so far, by their places.
using CompactNumbers = std::array<std::uint64_t, kMaxCompactNumbers>;

/// Bytes written into a span as far as it goes, and counted beyond.
class SpanSink {
 public:
  explicit SpanSink(std::span<std::uint8_t> into) : into_(into) {}

  /// Bytes written or counted.
  std::uint64_t used() const { return used_; }
  bool fits() const { return used_ <= into_.size(); }

  std::uint8_t* reserve(unsigned size) {
    std::uint8_t* const room = begin(size);
    used_ += size;
    return room;
  }
  /// Room for up to `most` bytes, at most kCompactGroupBytes, to be followed by end().
  std::uint8_t* begin(unsigned most) {
    direct_ = used_ + most <= into_.size();
    return direct_ ? into_.data() + used_ : beyond_;
  }
  void end(unsigned size) {
    if (!direct_ && used_ + size <= into_.size()) std::memcpy(into_.data() + used_, beyond_, size);
    used_ += size;
  }

 private:
  std::span<std::uint8_t> into_;
  std::uint64_t used_ = 0;
  bool direct_ = false;
  std::uint8_t beyond_[kCompactGroupBytes];
};

/// Writes one list of records.
class CompactWriter {
 public:
  explicit CompactWriter(SpanSink& sink) : sink_(sink) {}

  /// One record: its parts, each a number or something with fields.
  template <class... Parts>
  [[gnu::flatten]] void put(const Parts&... parts) {
    Record record(sink_, before_);
    CanonicalWriter<Record> write(record);
    (write.put(parts), ...);
    record.finish();
  }

 private:
  class Record {
   public:
    Record(SpanSink& sink, CompactNumbers& before) : sink_(sink), before_(before.data()) { open(); }

    template <unsigned kSize>
    [[gnu::always_inline]] void store(std::uint64_t value) {
      const unsigned code = compactCode(value, before_[index_], twoBack_);
      before_[index_] = value;
      twoBack_ = oneBack_;
      oneBack_ = value;
      // The bytes are written in any case, and kept only if they are needed: no branch to guess.
      storeLittleEndian<kSize>(to_, value);
      to_ += code == static_cast<unsigned>(CompactCode::given) ? kSize : 0;
      codes_ |= code << (2 * (index_ % kCompactGroup));
      if (++index_ % kCompactGroup == 0) {
        close();
        open();
      }
    }
    void finish() {
      if (index_ % kCompactGroup != 0) close();
    }

   private:
    void open() {
      require<Fault::BufferOverflow>(index_ + kCompactGroup <= kMaxCompactNumbers,
                                     "Internal Error: A record has too many numbers.");
      start_ = sink_.begin(kCompactGroupBytes);
      to_ = start_ + kCompactCodeBytes;
      codes_ = 0;
    }
    void close() {
      storeLittleEndian<kCompactCodeBytes>(start_, codes_);
      sink_.end(static_cast<unsigned>(to_ - start_));
    }

    SpanSink& sink_;
    std::uint64_t* before_;
    std::uint8_t* start_ = nullptr;
    std::uint8_t* to_ = nullptr;
    unsigned index_ = 0;
    unsigned codes_ = 0;
    std::uint64_t oneBack_ = 0;
    std::uint64_t twoBack_ = 0;
  };

  SpanSink& sink_;
  CompactNumbers before_{};
};

/// Reads what a CompactWriter wrote; anything else is refused.
class CompactReader {
 public:
  explicit CompactReader(ByteReader& bytes) : bytes_(bytes) {}

  /// One record.
  /// @throws FormatError
  template <class... Parts>
  [[gnu::flatten]] void get(Parts&... parts) {
    Record record(bytes_, before_);
    FieldReader<Record> read(record);
    (read.get(parts), ...);
    record.finish();
  }
  /// A record whose first number says whether more of it follow: `next` is called after it.
  template <class First, class Rest>
  [[gnu::flatten]] void getIf(First& first, Rest&& rest) {
    Record record(bytes_, before_);
    FieldReader<Record> read(record);
    read.get(first);
    rest(read);
    record.finish();
  }

 private:
  class Record {
   public:
    Record(ByteReader& bytes, CompactNumbers& before)
        : bytes_(bytes),
          start_(bytes.rest().data()),
          at_(start_),
          end_(start_ + bytes.rest().size()),
          before_(before.data()) {}

    /// Offset of the record.
    std::uint64_t offset() const { return bytes_.offset(); }

    bool lacks(const char* name) const { return bytes_.lacks(name); }

    template <unsigned kSize>
    [[gnu::always_inline]] std::uint64_t load() {
      if (index_ % kCompactGroup == 0) open();
      const unsigned code = codes_ & 3;
      codes_ >>= 2;
      std::uint64_t value = 0;
      if (code == static_cast<unsigned>(CompactCode::given)) {
        if (end_ - at_ < std::ptrdiff_t{kSize}) [[unlikely]]
          failShort();
        value = loadLittleEndian<kSize>(at_);
        at_ += kSize;
      } else if (code == static_cast<unsigned>(CompactCode::asBefore)) {
        value = before_[index_];
      } else if (code == static_cast<unsigned>(CompactCode::asTwoBack)) {
        value = twoBack_;
      }
      // One that is too large for its place is taken for a wrong code.
      wrong_ |= code ^ compactCode(value, before_[index_], twoBack_);
      if constexpr (kSize < 8) wrong_ |= static_cast<unsigned>(value >> (8 * kSize) != 0);
      before_[index_] = value;
      twoBack_ = oneBack_;
      oneBack_ = value;
      ++index_;
      return value;
    }
    void finish() {
      if ((wrong_ | codes_) != 0) [[unlikely]]
        failFormat(offset(), "a record is not in its shortest form");
      bytes_.take(static_cast<std::uint64_t>(at_ - start_));
    }

   private:
    void open() {
      require<Fault::BufferOverflow>(index_ + kCompactGroup <= kMaxCompactNumbers,
                                     "Internal Error: A record has too many numbers.");
      if (end_ - at_ < std::ptrdiff_t{kCompactCodeBytes}) [[unlikely]]
        failShort();
      codes_ = static_cast<unsigned>(loadLittleEndian<kCompactCodeBytes>(at_));
      at_ += kCompactCodeBytes;
    }
    [[noreturn, gnu::cold, gnu::noinline]] void failShort() const {
      failFormat(offset() + static_cast<std::uint64_t>(at_ - start_), "cut short");
    }

    ByteReader& bytes_;
    const std::uint8_t* start_;
    const std::uint8_t* at_;
    const std::uint8_t* end_;
    std::uint64_t* before_;
    unsigned index_ = 0;
    unsigned codes_ = 0;
    unsigned wrong_ = 0;
    std::uint64_t oneBack_ = 0;
    std::uint64_t twoBack_ = 0;
  };

  ByteReader& bytes_;
  CompactNumbers before_{};
};

}  // namespace samestep
