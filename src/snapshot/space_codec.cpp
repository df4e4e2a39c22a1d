// SPDX-License-Identifier: MIT
// Worlds to bytes and, with everything checked, back.
#include <samestep/environment.h>
#include <samestep/space_codec.h>

#include <utility>

#include "base/require_ieee.h"
#include "snapshot/world_check.h"
#include "snapshot/world_formats.h"
#include "state/canonical_reader.h"
#include "state/compact.h"

namespace samestep {
namespace {

/// Checks the single fields of a world whose sections are read and checked.
template <Scalar S>
struct FieldFlaw {
  const WorldCheck<S>& check;
  const char* found = nullptr;

  template <class T>
  void operator()(const char*, const T& field) {
    if (found == nullptr) found = check.flawOf(field);
  }
  template <class T>
  void operator()(const Section&, const T&) {}
};

/// Reads the fields and sections of one world.
template <Scalar S>
class WorldReader {
 public:
  WorldReader(ByteReader& bytes, const WorldLimits& limits) : bytes_(bytes), read_(bytes), limits_(limits) {}

  WorldState<S> world() {
    const std::uint64_t start = bytes_.offset();
    WorldState<S>::sections(*this, world_);
    FieldFlaw<S> fields{check_};
    WorldState<S>::sections(fields, world_);
    if (fields.found == nullptr) fields.found = check_.flawOfRest();
    if (fields.found != nullptr) failFormat(start, fields.found);
    return std::move(world_);
  }

  template <class T>
  void operator()(const char*, T& field) {
    read_.get(field);
  }

  template <class T, class IdType>
  void operator()(const Section& section, SlotMap<T, IdType>& map) {
    if (bytes_.lacks(section.object)) return;
    const std::uint64_t start = bytes_.offset();
    const auto count = countOf<std::uint32_t>(section);
    std::vector<T> values(count);
    std::vector<std::uint32_t> generations(count);
    CompactReader records(bytes_);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint64_t at = bytes_.offset();
      records.getIf(generations[i], [&](auto& read) {
        if ((generations[i] & 1) != 0) read.get(values[i]);
      });
      if ((generations[i] & 1) == 0) continue;
      IdType id;
      id.index = i;
      id.generation = generations[i];
      if (const char* flaw = accept(id, values[i])) failFormat(at, flaw);
    }
    const bool good = map.restore(std::move(values), std::move(generations));
    if (!good) failFormat(start, "a generation is too high");
  }

  template <class T>
  void operator()(const Section& section, std::vector<T>& items) {
    if (bytes_.lacks(section.object)) return;
    items.resize(static_cast<std::size_t>(countOf<std::uint64_t>(section)));
    CompactReader records(bytes_);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::uint64_t at = bytes_.offset();
      records.get(items[i]);
      if (const char* flaw = accept(items[i])) failFormat(at, flaw);
      if (i > 0 && !T::before(items[i - 1], items[i])) failFormat(at, WorldFlaw<S>::kNotInOrder);
    }
  }

 private:
  /// The count of a section's records: no more than allowed, nor than the bytes left could tell of.
  template <class Count>
  Count countOf(const Section& section) {
    const std::uint64_t start = bytes_.offset();
    const auto count = read_.next<Count>();
    if (count > limits_.*section.limit || count > bytes_.remaining() / kCompactCodeBytes) {
      failFormat(start, section.tooMany);
    }
    return count;
  }

  // `accept` computes what follows from the fields of a record, then checks the record: the flaw or null.

  const char* accept(BodyId id, Body<S>& body) {
    body.derive();
    return check_.flawOf(id, body);
  }
  const char* accept(ShapeId id, Shape<S>& shape) {
    shape.attach(id);
    return check_.flawOf(id, shape);
  }
  const char* accept(Pair<S>& pair) {
    const auto exists = [&](ShapeId id) {
      return id.index < world_.shapes.slots() && world_.shapes.aliveAt(id.index);
    };
    if (exists(pair.a)) pair.a = world_.shapes.idAt(pair.a.index);
    if (exists(pair.b)) pair.b = world_.shapes.idAt(pair.b.index);
    if (bytes_.lacks("rotationA") && exists(pair.a) && exists(pair.b)) {
      const auto rotationOf = [&](ShapeId shape) {
        return world_.bodies.valueAt(world_.shapes.valueAt(shape.index).body().index).rotation();
      };
      keepRotations(pair, rotationOf(pair.a), rotationOf(pair.b));
    }
    return check_.flawOf(pair);
  }
  const char* accept(JointId id, const Joint<S>& joint) { return check_.flawOf(id, joint); }
  const char* accept(const HandlerBinding& binding) { return check_.flawOf(binding); }

  ByteReader& bytes_;
  CanonicalReader read_;
  const WorldLimits& limits_;
  WorldState<S> world_;
  WorldCheck<S> check_{world_, limits_};
};

/// Writes the fields and sections of one world.
class WorldWriter {
 public:
  explicit WorldWriter(std::span<std::uint8_t> into) : sink_(into) {}

  template <class T>
  void operator()(const char*, const T& field) {
    plain_.put(field);
  }
  template <class T, class IdType>
  void operator()(const Section&, const SlotMap<T, IdType>& map) {
    plain_.put(map.slots());
    CompactWriter records(sink_);
    for (std::uint32_t i = 0; i < map.slots(); ++i) {
      if (map.aliveAt(i)) {
        records.put(map.generationAt(i), map.valueAt(i));
      } else {
        records.put(map.generationAt(i));
      }
    }
  }
  template <class T>
  void operator()(const Section&, const std::vector<T>& items) {
    plain_.put(static_cast<std::uint64_t>(items.size()));
    CompactWriter records(sink_);
    for (const T& record : items) records.put(record);
  }
  std::uint64_t used() const { return sink_.used(); }

 private:
  SpanSink sink_;
  CanonicalWriter<SpanSink> plain_{sink_};
};

}  // namespace

template <Scalar S>
std::uint64_t encodeWorld(const WorldState<S>& world, std::span<std::uint8_t> into) {
  WorldWriter write(into);
  WorldState<S>::sections(write, world);
  return write.used();
}

template <Scalar S>
void encodeWorld(const WorldState<S>& world, std::vector<std::uint8_t>& bytes) {
  const std::size_t before = bytes.size();
  const auto size = static_cast<std::size_t>(encodeWorld(world, std::span<std::uint8_t>()));
  bytes.resize(before + size);
  encodeWorld(world, std::span(bytes).subspan(before));
}

template <Scalar S>
WorldState<S> decodeWorld(std::span<const std::uint8_t> bytes, std::uint64_t& offset,
                          const WorldLimits& limits, std::uint32_t format) {
  // Rotations and inverse masses follow from what is read.
  requireSoundArithmetic<S>();
  ByteReader reader(bytes, offset);
  if (format < 2) reader.setLacking(kSince2);
  WorldState<S> world = WorldReader<S>(reader, limits).world();
  offset = reader.offset();
  return world;
}

template <Scalar S>
const char* flawOf(const WorldState<S>& world, const WorldLimits& limits) {
  WorldFlaw<S> flaw(world, limits);
  WorldState<S>::sections(flaw, world);
  flaw.finish();
  return flaw.found;
}

#define SAMESTEP_EACH_SCALAR                                                                               \
  template std::uint64_t encodeWorld<S>(const WorldState<S>&, std::span<std::uint8_t>);                    \
  template void encodeWorld<S>(const WorldState<S>&, std::vector<std::uint8_t>&);                          \
  template WorldState<S> decodeWorld<S>(std::span<const std::uint8_t>, std::uint64_t&, const WorldLimits&, \
                                        std::uint32_t);                                                    \
  template const char* flawOf<S>(const WorldState<S>&, const WorldLimits&);
#include <samestep/each_scalar.h>

}  // namespace samestep
