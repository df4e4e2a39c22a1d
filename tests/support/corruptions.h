// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <samestep/judge.h>
#include <samestep/version.h>

#include "support/recordings.h"

namespace samestep {

/// Recordings spoilt in all ways that docs/fuzzing.md names, each by its number, and what must hold of each.
template <Scalar S>
class Corruptions {
 public:
  explicit Corruptions(std::uint64_t seed) : seed_(seed) {
    const KeyframeBudget often{4, 1u << 20};
    add(recordSmallMatch<S>(24, often));
    add(recordSmallMatch<S>(24, often, packingAvailable()));
    add(recordSmallMatch<S>(9));
    add(asVersion2<S>(recordSmallMatch<S>(24)));
  }
  /// Adds a file of an older revision, which is made to say that it is of this one: what it tells comes out
  /// otherwise, so that none made of it may be verified.
  void addFile(Bytes bytes) {
    if (bytes.size() < 28 || bytes[16] != static_cast<std::uint8_t>(ScalarTraits<S>::kKind)) return;
    by_hand::setNumber(bytes, 12, kSimulationRevision, 4);
    mendRecording(bytes);
    add(std::move(bytes));
  }

  /// Makes one, judges it, and says what must not be of it; empty for nothing.
  std::string run(std::uint64_t number) {
    random_.seed(seed_ * 0x9e3779b97f4a7c15u + number);
    const Source& source = sources_[below(sources_.size())];
    Bytes bytes = source.bytes;
    const bool sections = bytes[8] != 2 && below(2) == 0;
    if (sections) spoilSections(bytes);
    for (std::uint64_t i = sections ? below(2) : 1 + below(3); i > 0 && !bytes.empty(); --i)
      spoilBytes(bytes);
    if (below(2) == 0) mendRecording(bytes, below(2) == 0);
    return flawOf(bytes, source);
  }

 private:
  struct Source {
    Bytes bytes;
    std::vector<std::uint64_t> hashes;  ///< After each step; of one that verifies.
    std::uint64_t firstHash = 0;
  };

  void add(Bytes bytes) {
    Source source{bytes, {}, 0};
    source.firstHash = hashesOf(bytes, source.hashes);
    const Judgement judgement = judge<S>(bytes, testWiring<S>());
    if (judgement.verdict != Verdict::verified) source.hashes.clear();
    sources_.push_back(std::move(source));
  }
  static std::uint64_t hashesOf(const Bytes& bytes, std::vector<std::uint64_t>& hashes) {
    RecordingReader<S> reader(bytes);
    for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
      if (item == RecordingItem::step) hashes.push_back(reader.hash());
    }
    return reader.initialHash();
  }

  std::uint64_t below(std::uint64_t end) { return end == 0 ? 0 : random_() % end; }
  std::size_t place(const Bytes& bytes) { return static_cast<std::size_t>(below(bytes.size())); }
  auto at(Bytes& bytes, std::size_t offset) { return bytes.begin() + static_cast<std::ptrdiff_t>(offset); }

  /// Counts that no recording has room for, and those at the edge of it.
  std::uint64_t count() {
    constexpr std::uint64_t kCounts[] = {0,
                                         1,
                                         0x7fffffffu,
                                         0x80000000u,
                                         0xffffffffu,
                                         0xfffffffeu,
                                         4000000000u,
                                         std::uint64_t{1} << 40,
                                         ~std::uint64_t{0},
                                         65536,
                                         65537};
    return kCounts[below(std::size(kCounts))];
  }

  void spoilBytes(Bytes& bytes) {
    const std::size_t from = place(bytes);
    const std::size_t length = std::min<std::size_t>(bytes.size() - from, 1 + below(64));
    switch (below(8)) {
      case 0:
      case 1:
        bytes[from] = static_cast<std::uint8_t>(bytes[from] ^ (1u << below(8)));
        break;
      case 2:
        bytes[from] = static_cast<std::uint8_t>(random_());
        break;
      case 3:
        bytes.resize(from);
        break;
      case 4:
        for (std::size_t i = 0; i < 8 && from + i < bytes.size() && i < 4 + 4 * below(2); ++i) {
          bytes[from + i] = static_cast<std::uint8_t>(count() >> (8 * i));
        }
        break;
      case 5:
        bytes.erase(at(bytes, from), at(bytes, from + length));
        break;
      case 6: {
        const Bytes piece(at(bytes, from), at(bytes, from + length));
        const std::size_t to = place(bytes);
        bytes.insert(at(bytes, to), piece.begin(), piece.end());
        break;
      }
      default: {
        // Another recording from here on.
        const Bytes& other = sources_[below(sources_.size())].bytes;
        const std::size_t begin = static_cast<std::size_t>(below(other.size()));
        bytes.resize(from);
        bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(begin), other.end());
      }
    }
  }

  /// Changes sections, as a forger does, who knows the format.
  void spoilSections(Bytes& bytes) {
    by_hand::Recording parts = by_hand::takeApart(bytes);
    auto& sections = parts.sections;
    const std::size_t i = static_cast<std::size_t>(below(sections.size()));
    const std::size_t k = static_cast<std::size_t>(below(sections.size()));
    by_hand::Section& section = sections[i];
    switch (below(9)) {
      case 0:
        std::swap(sections[i], sections[k]);
        break;
      case 1:
        sections.erase(sections.begin() + static_cast<std::ptrdiff_t>(i));
        break;
      case 2:
        sections.insert(sections.begin() + static_cast<std::ptrdiff_t>(k), by_hand::Section(section));
        break;
      case 3:
        // A keyframe with the payload of another, a false index, an end of something else.
        section.payload = sections[k].payload;
        break;
      case 4:
        section.kind = static_cast<std::uint8_t>(random_());
        break;
      case 5:
        section.unpacked = static_cast<std::uint32_t>(count());
        section.kind |= by_hand::kPacked;
        break;
      case 6:
        section.payload = bomb(section.unpacked);
        section.kind |= by_hand::kPacked;
        break;
      case 7:
        if (!section.payload.empty())
          section.payload[place(section.payload)] ^= static_cast<std::uint8_t>(1 + below(255));
        break;
      default:
        if (section.payload.size() >= 8) {
          by_hand::setNumber(section.payload, static_cast<std::size_t>(below(section.payload.size() - 7)),
                             count(), 8);
        }
    }
    bytes = by_hand::putTogether(parts, below(4) > 0);
  }

  /// A frame of zstd that unpacks to many zeros: its header, then blocks of one byte repeated, as RFC 8878
  /// has them.
  Bytes bomb(std::uint32_t& unpacked) {
    const std::uint64_t blocks = 1 + below(600);
    constexpr std::uint32_t kBlock = 1u << 17;
    unpacked = static_cast<std::uint32_t>(below(2) == 0 ? blocks * kBlock : count());
    Bytes frame{0x28, 0xb5, 0x2f, 0xfd, 0xe0};
    by_hand::addNumber(frame, blocks * kBlock, 8);
    for (std::uint64_t i = 0; i < blocks; ++i) {
      by_hand::addNumber(frame, std::uint64_t{kBlock} << 3 | 2 | (i + 1 == blocks ? 1 : 0), 3);
      frame.push_back(0);
    }
    return frame;
  }

  std::string flawOf(const Bytes& bytes, const Source& source) {
    VerifyOptions options;
    options.limits.bodies = options.limits.shapes = 4096;
    options.limits.pairs = 4096;
    options.limits.work = 10000000;
    options.expected.firstHash = source.firstHash;
    if (!source.hashes.empty()) options.expected.ticks = source.hashes.size();
    options.expected.stepsPerSecond = 60;
    const Judgement judgement = judge<S>(bytes, testWiring<S>(), options);
    if (judgement.verdict == Verdict::stopped || !judgement.settled) return "it takes too long, or too much";
    // Forward, as a player does, with what keyframes say on the way.
    if (below(4) == 0) play(bytes, options);
    if (judgement.verdict != Verdict::verified) return {};
    if (source.hashes.empty()) return "verified, of a recording that is not";
    std::vector<std::uint64_t> hashes;
    const std::uint64_t first = hashesOf(bytes, hashes);
    return first == source.firstHash && hashes == source.hashes ? std::string()
                                                                : "verified, though another match";
  }
  void play(const Bytes& bytes, const VerifyOptions& options) {
    PlayerOptions how;
    how.limits = options.limits;
    try {
      Player<S> player(bytes, testWiring<S>(), how);
      player.seek(below(player.ticks() + 1));
      player.seek(below(player.ticks() + 1));
    } catch (const Error&) {
      // It says so: nothing more is asked of it.
    }
  }

  std::uint64_t seed_;
  std::mt19937_64 random_;
  std::vector<Source> sources_;
};

}  // namespace samestep
