// SPDX-License-Identifier: MIT
#include "state/compact.h"

#include <vector>

#include <gtest/gtest.h>

#include <samestep/arbiter.h>

namespace samestep {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Point {
  std::uint32_t x = 0;
  std::uint16_t y = 0;
  std::uint32_t z = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
  }
  friend bool operator==(const Point&, const Point&) = default;
};

struct Long {
  std::uint8_t values[11] = {};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    for (auto& value : self.values) visit("value", value);
  }
  friend bool operator==(const Long&, const Long&) = default;
};

struct Mixed {
  std::uint32_t wide = 0;
  std::uint32_t other = 0;
  std::uint8_t narrow = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("wide", self.wide);
    visit("other", self.other);
    visit("narrow", self.narrow);
  }
};

template <class T>
Bytes written(const std::vector<T>& records) {
  const auto write = [&](std::span<std::uint8_t> into) {
    SpanSink sink(into);
    CompactWriter writer(sink);
    for (const T& record : records) writer.put(record);
    return static_cast<std::size_t>(sink.used());
  };
  Bytes bytes(write({}));
  EXPECT_EQ(write(bytes), bytes.size());
  return bytes;
}

template <class T>
std::vector<T> readBack(const Bytes& bytes, std::size_t count) {
  ByteReader reader(bytes);
  CompactReader records(reader);
  std::vector<T> read(count);
  for (T& record : read) records.get(record);
  EXPECT_EQ(reader.remaining(), 0u);
  return read;
}

/// The offset at which reading one record and another is refused; -1 where it is not.
std::int64_t refusalOf(const Bytes& bytes, std::size_t count) {
  try {
    ByteReader reader(bytes);
    CompactReader records(reader);
    for (std::size_t i = 0; i < count; ++i) {
      Point point;
      records.get(point);
    }
  } catch (const FormatError& error) {
    return static_cast<std::int64_t>(error.offset());
  }
  return -1;
}

constexpr unsigned codes(CompactCode x, CompactCode y, CompactCode z) {
  return static_cast<unsigned>(x) | static_cast<unsigned>(y) << 2 | static_cast<unsigned>(z) << 4;
}

TEST(CompactTest, NumbersAreGivenOnlyWhereNothingElseTells) {
  using enum CompactCode;
  const std::vector<Point> points = {{5, 0, 5}, {5, 7, 0}, {5, 0, 0x01020304}};

  const Bytes bytes = written(points);

  // Before the first record all numbers count as zero.
  const Bytes expected = {codes(given, asBefore, asTwoBack), 0, 5, 0, 0, 0,  //
                          codes(asBefore, given, zero),      0, 7, 0,        //
                          codes(asBefore, zero, given),      0, 4, 3, 2, 1};
  EXPECT_EQ(bytes, expected);
  EXPECT_EQ(readBack<Point>(bytes, 3), points);
}

TEST(CompactTest, LongRecordsHaveAGroupOfCodesForEveryEightNumbers) {
  const std::vector<Long> records = {{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}},
                                     {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12}}};

  const Bytes bytes = written(records);

  const Bytes expected = {0xff, 0xff, 1, 2, 3, 4, 5, 6, 7, 8, 0x3f, 0, 9, 10, 11, 0, 0, 0x30, 0, 12};
  EXPECT_EQ(bytes, expected);
  EXPECT_EQ(readBack<Long>(bytes, 2), records);
}

TEST(CompactTest, WhatCouldBeShorterIsRefused) {
  using enum CompactCode;
  const auto record = [](unsigned code, const Bytes& rest) {
    Bytes bytes(2 + rest.size(), 0);
    bytes[0] = static_cast<std::uint8_t>(code);
    bytes[1] = static_cast<std::uint8_t>(code >> 8);
    for (std::size_t i = 0; i < rest.size(); ++i) bytes[2 + i] = rest[i];
    return bytes;
  };

  EXPECT_EQ(refusalOf(record(codes(given, given, given), {1, 0, 0, 0, 2, 0, 3, 0, 0, 0}), 1), -1);
  EXPECT_EQ(refusalOf(record(codes(given, given, given), {0, 0, 0, 0, 2, 0, 3, 0, 0, 0}), 1), 0);
  EXPECT_EQ(refusalOf(record(codes(given, given, given), {1, 0, 0, 0, 2, 0, 1, 0, 0, 0}), 1), 0);
  EXPECT_EQ(refusalOf(record(codes(zero, asBefore, asBefore), {}), 1), 0);
  EXPECT_EQ(refusalOf(record(codes(asTwoBack, asBefore, asBefore), {}), 1), 0);
  // Codes of numbers that are not there.
  EXPECT_EQ(refusalOf(record(codes(given, asBefore, asBefore) | 1 << 6, {1, 0, 0, 0}), 1), 0);
}

TEST(CompactTest, ANumberTooLargeForItsPlaceIsRefused) {
  using enum CompactCode;
  const Bytes bytes = {codes(given, asBefore, asTwoBack), 0, 0x05, 0x01, 0, 0};
  ByteReader reader(bytes);
  CompactReader records(reader);
  Mixed mixed;

  EXPECT_THROW(records.get(mixed), FormatError);
}

TEST(CompactTest, IsRefusedWhereverItIsCutShort) {
  const Bytes bytes = written(std::vector<Point>{{5, 0, 5}, {5, 7, 0}, {5, 0, 0x01020304}});
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const std::int64_t offset = refusalOf(cut, 3);
    EXPECT_GE(offset, 0);
    EXPECT_LE(offset, static_cast<std::int64_t>(length));
  }
}

TEST(CompactTest, ASpanThatIsTooSmallIsLeftAtItsEndAndTheSizeIsRight) {
  std::vector<Pair<Fixed>> pairs(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    pairs[i].a = {i, 1};
    pairs[i].b = {i + 7, 3};
    pairs[i].localNormal = {Fixed(1), Fixed(static_cast<int>(i))};
  }
  const Bytes whole = written(pairs);
  for (std::size_t room = 0; room <= whole.size() + 80; ++room) {
    Bytes bytes(room + 100, 0xee);
    const std::span<std::uint8_t> into(bytes.data(), room);
    SpanSink sink(into);
    CompactWriter writer(sink);
    for (const Pair<Fixed>& pair : pairs) writer.put(pair);
    ASSERT_EQ(sink.used(), whole.size());
    ASSERT_EQ(sink.fits(), room >= whole.size());
    for (std::size_t i = room; i < bytes.size(); ++i) ASSERT_EQ(bytes[i], 0xee) << room;
    if (sink.fits()) {
      bytes.resize(whole.size());
      ASSERT_EQ(bytes, whole);
    }
  }
}

}  // namespace
}  // namespace samestep
