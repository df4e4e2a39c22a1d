// SPDX-License-Identifier: MIT
#include "context/saved_records.h"

#include <samestep/expects.h>

#include <algorithm>

#include "base/require_ieee.h"
#include "contacts/push_contacts.h"
#include "dynamics/body_access.h"
#include "state/canonical_reader.h"

namespace samestep {
namespace {

/// Counts bytes instead of writing them.
struct ByteCount {
  std::size_t bytes = 0;
  template <unsigned kSize>
  void store(std::uint64_t) {
    bytes += kSize;
  }
};

/// Writes where there is room.
struct BytesTo {
  std::uint8_t* to;
  std::uint8_t* reserve(unsigned size) {
    std::uint8_t* room = to;
    to += size;
    return room;
  }
};

/// Reads what BytesTo wrote.
struct BytesFrom {
  const std::uint8_t* from;
  template <unsigned kSize>
  std::uint64_t load() {
    const std::uint64_t value = loadLittleEndian<kSize>(from);
    from += kSize;
    return value;
  }
  static std::uint64_t offset() { return 0; }
};

template <class Writer, class T>
void pack(Writer& write, const T& record) {
  write.put(record);
}
template <class Writer, Scalar S>
void pack(Writer& write, const Body<S>& body) {
  write.put(body);
  write.put(body.rotation());
}

/// The bytes of a packed record of a type: the same for all of them.
template <class T>
std::size_t packedBytes() {
  ByteCount count;
  CanonicalWriter<ByteCount> write(count);
  pack(write, T());
  return count.bytes;
}

/// Counts the bytes that the sections of a world need at most.
struct RoomFor {
  std::size_t bytes = 0;

  template <class T>
  void operator()(const char*, const T& field) {
    ByteCount count;
    CanonicalWriter<ByteCount>(count).put(field);
    bytes += count.bytes;
  }
  template <class T, class IdType>
  void operator()(const Section&, const SlotMap<T, IdType>& records) {
    bytes += sizeof(std::uint32_t) + records.slots() * (sizeof(std::uint32_t) + packedBytes<T>());
  }
  template <Scalar S>
  void operator()(const Section&, const SlotMap<Shape<S>, ShapeId>&) {}
  template <class T>
  void operator()(const Section&, const std::vector<T>& records) {
    bytes += sizeof(std::uint64_t) + records.size() * packedBytes<T>();
  }
};

/// Packs the sections of a world, but for the shapes.
struct Pack {
  BytesTo at;

  template <class T>
  void operator()(const char*, const T& field) {
    CanonicalWriter<BytesTo>(at).put(field);
  }
  template <class T, class IdType>
  [[gnu::flatten]] void operator()(const Section&, const SlotMap<T, IdType>& records) {
    BytesTo here = at;
    CanonicalWriter<BytesTo> write(here);
    write.put(records.slots());
    for (std::uint32_t slot = 0; slot < records.slots(); ++slot) write.put(records.generationAt(slot));
    for (std::uint32_t slot = 0; slot < records.slots(); ++slot) {
      if (records.aliveAt(slot)) pack(write, records.valueAt(slot));
    }
    at = here;
  }
  template <Scalar S>
  void operator()(const Section&, const SlotMap<Shape<S>, ShapeId>&) {}
  template <class T>
  [[gnu::flatten]] void operator()(const Section&, const std::vector<T>& records) {
    BytesTo here = at;
    CanonicalWriter<BytesTo> write(here);
    write.put(static_cast<std::uint64_t>(records.size()));
    for (const T& record : records) pack(write, record);
    at = here;
  }
};

/// Unpacks them into a world, whose shapes are set when their section comes.
template <Scalar S>
struct Unpack {
  BytesFrom at;
  const SlotMap<Shape<S>, ShapeId>& shapes;

  using Reader = FieldReader<BytesFrom>;

  template <class T>
  void operator()(const char*, T& field) {
    Reader(at).get(field);
  }
  template <class T, class IdType>
  [[gnu::flatten]] void operator()(const Section&, SlotMap<T, IdType>& records) {
    BytesFrom here = at;
    Reader read(here);
    const auto slots = read.template next<std::uint32_t>();
    records.setSlots(slots, [&](std::uint32_t) { return read.template next<std::uint32_t>(); });
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      if (records.aliveAt(slot)) unpack(read, records.valueAt(slot));
    }
    at = here;
  }
  void operator()(const Section&, SlotMap<Shape<S>, ShapeId>& records) { records = shapes; }
  template <class T>
  [[gnu::flatten]] void operator()(const Section&, std::vector<T>& records) {
    BytesFrom here = at;
    Reader read(here);
    records.resize(static_cast<std::size_t>(read.template next<std::uint64_t>()));
    for (T& record : records) unpack(read, record);
    at = here;
  }

  static void unpack(Reader& read, Body<S>& body) { BodyAccess<S>::unpack(body, read); }
  void unpack(Reader& read, Pair<S>& pair) const {
    read.get(pair);
    pair.a = shapes.idAt(pair.a.index);
    pair.b = shapes.idAt(pair.b.index);
    forgetResults(pair);
  }
  static void unpack(Reader& read, HandlerBinding& binding) { read.get(binding); }
  static void unpack(Reader& read, Joint<S>& joint) {
    read.get(joint);
    forgetResults(joint);
  }
};

/// Adds a number unless it is 0 or there.
void note(std::vector<CallbackNumber>& numbers, CallbackNumber number) {
  if (number == 0 || std::find(numbers.begin(), numbers.end(), number) != numbers.end()) return;
  numbers.push_back(number);
}

}  // namespace

template <Scalar S>
void SavedRecords<S>::take(const WorldState<S>& world) {
  clear();
  RoomFor room;
  WorldState<S>::sections(room, world);
  if (packed_.size() < room.bytes) packed_.resize(room.bytes + room.bytes / 8);
  Pack packing{{packed_.data()}};
  WorldState<S>::sections(packing, world);
  stamp_ = world.stamp;
  shapes_ = world.shapes;
  positionFuncs_.clear();
  velocityFuncs_.clear();
  handlers_.clear();
  world.bodies.each([&](BodyId, const Body<S>& body) {
    note(positionFuncs_, body.positionFunc());
    note(velocityFuncs_, body.velocityFunc());
  });
  for (const HandlerBinding& binding : world.handlers) note(handlers_, binding.number);
  used_ = static_cast<std::uint64_t>(packing.at.to - packed_.data());
}

template <Scalar S>
void SavedRecords<S>::giveTo(WorldState<S>& world) const {
  expects(!empty());
  Unpack<S> unpacking{{packed_.data()}, shapes_};
  WorldState<S>::sections(unpacking, world);
}

template <Scalar S>
std::uint64_t SavedRecords<S>::bytes() const {
  if (empty()) return 0;
  return used_ + shapes_.slots() * (sizeof(Shape<S>) + sizeof(std::uint32_t)) +
         (positionFuncs_.size() + velocityFuncs_.size() + handlers_.size()) * sizeof(CallbackNumber);
}

template <Scalar S>
void SavedRecords<S>::requireCallbacks(const SpaceWiring<S>& wiring) const {
  for (const CallbackNumber number : handlers_) {
    require<Fault::MissingCallback>(wiring.has(number), "no handler is registered under ", number);
  }
  for (const CallbackNumber number : positionFuncs_) {
    require<Fault::MissingCallback>(wiring.find(wiring.positionFuncs, number) != nullptr,
                                    "no position function is registered under ", number);
  }
  for (const CallbackNumber number : velocityFuncs_) {
    require<Fault::MissingCallback>(wiring.find(wiring.velocityFuncs, number) != nullptr,
                                    "no velocity function is registered under ", number);
  }
}

#define SAMESTEP_EACH_SCALAR template class SavedRecords<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
