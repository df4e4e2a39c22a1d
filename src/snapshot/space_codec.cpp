// SPDX-License-Identifier: MIT
// Worlds to bytes and, with everything checked, back.
#include <samestep/environment.h>
#include <samestep/space_codec.h>

#include <limits>
#include <tuple>
#include <utility>

#include "base/require_ieee.h"
#include "contacts/contact_row.h"
#include "contacts/push_contacts.h"
#include "state/canonical_reader.h"
#include "state/compact.h"

namespace samestep {
namespace {

template <Scalar S>
const char* flawOf(const Settings<S>& settings) {
  const auto in = [](S value, S low, S high) { return value >= low && value <= high; };
  const bool both = settings.solver <= SolverKind::softStep && settings.precision <= ContactPrecision::fast &&
                    within(settings.gravity, kMaxAcceleration<S>) && in(settings.damping, S(0), S(1)) &&
                    settings.worldExtent > S(0) && settings.worldExtent <= kMaxWorldExtent<S>;
  const bool sequential = settings.iterations >= 1 && settings.iterations <= 1000 &&
                          in(settings.collisionSlop, S(0), S(256)) && in(settings.collisionBias, S(0), S(1));
  const bool soft =
      settings.substeps >= 1 && settings.substeps <= 100 && in(settings.contactHertz, S(0), S(1000)) &&
      in(settings.contactDamping, S(0), S(100)) &&
      in(settings.contactPushSpeed, S(0), kMaxSpeed<S>)&&in(settings.contactMargin, S(0), S(1)) &&
      in(settings.bounceThreshold, S(0), kMaxSpeed<S>);
  return both && sequential && soft ? nullptr : "a setting is out of range";
}

/// Finds flaws of the shapes of a world, one after the other. Worlds have many shapes of one geometry in a
/// row, which is then looked at once.
template <Scalar S>
class ShapeCheck {
 public:
  explicit ShapeCheck(const WorldState<S>& world) : world_(world) {}

  /// @param shape  stays where it is as long as this object lives
  const char* flawOf(ShapeId id, const Shape<S>& shape) {
    if (shape.id() != id) return "a shape has another's id";
    if (!shape.surfaceWellFormed() || !hasGoodGeometry(shape)) return "a shape is malformed";
    const Body<S>* body = world_.bodies.find(shape.body());
    if (body == nullptr) return "a shape is on a body that does not exist";
    if (body->type() != BodyType::staticBody && extent_ > S(kMaxDynamicExtent)) {
      return "a shape of a moving body is too large";
    }
    return nullptr;
  }

 private:
  bool hasGoodGeometry(const Shape<S>& shape) {
    if (last_ != nullptr && shape.sameGeometry(*last_)) return true;
    if (!shape.geometryWellFormed()) return false;
    last_ = &shape;
    extent_ = shape.extent();
    return true;
  }

  const WorldState<S>& world_;
  const Shape<S>* last_ = nullptr;
  S extent_{};
};

template <Scalar S>
const char* flawOf(const Contact<S>& contact) {
  // Points of shapes at the end of their range, and those a callback may have set.
  const S far = S(1 << 23);
  // A push of the soft step, and what friction may make of it.
  const bool kept = contact.normalSpeed >= S(0) && contact.normalSpeed <= kMaxSum<S> &&
                    contact.tangentSpeed > -kMaxForce<S> && contact.tangentSpeed < kMaxForce<S>;
  const bool good = within(contact.anchorA, far) && within(contact.anchorB, far) && kept;
  return good ? nullptr : "a contact is out of range";
}

/// Of normal and points that the next step may solve without colliding the shapes again.
template <Scalar S>
const char* flawOfKept(const Pair<S>& pair) {
  const S far = S(2 * kMaxExtent), slack = ratio<S>(1, 64);
  const S unit = lengthSq(pair.localNormal);
  bool good = pair.count > 0 && unit >= S(1) - slack && unit <= S(1) + slack;
  for (const Contact<S>& contact : pair.contacts) {
    good = good && within(contact.anchorA, far) && within(contact.anchorB, far);
  }
  return good ? nullptr : "a contact that is kept is out of range";
}

template <Scalar S>
const char* flawOf(const WorldState<S>& world, const Pair<S>& pair) {
  const Shape<S>* a = world.shapes.find(pair.a);
  const Shape<S>* b = world.shapes.find(pair.b);
  if (a == nullptr || b == nullptr) return "a pair names a shape that does not exist";
  if (a->body() == b->body()) return "a pair is of one body";
  if (pair.count > kMaxContactsPerPair || pair.state > ArbiterState::cached ||
      pair.manifold > Manifold::apart) {
    return "a pair is malformed";
  }
  if (!within(pair.localNormal, ratio<S>(1026, 1024))) return "a pair is out of range";
  for (const Contact<S>& contact : pair.contacts) {
    if (const char* flaw = flawOf(contact)) return flaw;
  }
  return pair.manifold == Manifold::touching ? flawOfKept(pair) : nullptr;
}

const char* flawOf(const HandlerBinding& binding) {
  const bool good = binding.kind <= HandlerBinding::Kind::fallback && binding.number != 0;
  return good ? nullptr : "a handler is malformed";
}

bool inOrder(const HandlerBinding& a, const HandlerBinding& b) {
  return std::tuple(a.kind, a.typeA, a.typeB) < std::tuple(b.kind, b.typeA, b.typeB);
}

template <Scalar S>
bool inOrder(const Pair<S>& a, const Pair<S>& b) {
  return std::pair(a.a.index, a.b.index) < std::pair(b.a.index, b.b.index);
}

/// What settings, clock and static body must be; null if they are.
template <Scalar S>
const char* flawOfFrame(const WorldState<S>& world) {
  if (const char* flaw = flawOf(world.settings)) return flaw;
  if (!(world.timeStep >= S(0) && world.timeStep <= kMaxTimeStep<S>)) return "the time step is out of range";
  const Body<S>* fixed = world.bodies.find(world.staticBody);
  if (fixed == nullptr || fixed->type() != BodyType::staticBody) return "there is no static body";
  return nullptr;
}

/// Reads one world.
template <Scalar S>
class WorldReader {
 public:
  WorldReader(ByteReader& bytes, const WorldLimits& limits) : bytes_(bytes), read_(bytes), limits_(limits) {}

  WorldState<S> world() {
    const std::uint64_t start = bytes_.offset();
    read_.get(world_.settings);
    read_.get(world_.stamp);
    read_.get(world_.timeStep);
    read_.get(world_.staticBody);
    slots(world_.bodies, limits_.bodies, "more bodies than allowed", [](BodyId, Body<S>& body) {
      body.derive();
      return body.wellFormed() ? nullptr : "a body is malformed";
    });
    if (const char* flaw = flawOfFrame(world_)) failFormat(start, flaw);
    ShapeCheck<S> check(world_);
    slots(world_.shapes, limits_.shapes, "more shapes than allowed", [&](ShapeId id, Shape<S>& shape) {
      shape.attach(id, 0);
      return check.flawOf(id, shape);
    });
    list(world_.pairs, limits_.pairs, "more pairs than allowed", [this](Pair<S>& pair) {
      const auto exists = [&](ShapeId id) {
        return id.index < world_.shapes.slots() && world_.shapes.aliveAt(id.index);
      };
      if (exists(pair.a)) pair.a = world_.shapes.idAt(pair.a.index);
      if (exists(pair.b)) pair.b = world_.shapes.idAt(pair.b.index);
      const char* flaw = flawOf(world_, pair);
      if (flaw == nullptr) deriveSurfaces(pair);
      return flaw;
    });
    list(world_.handlers, limits_.handlers, "more handlers than allowed",
         [](const HandlerBinding& binding) { return flawOf(binding); });
    return std::move(world_);
  }

 private:
  /// What is no state, but what visits read until the next step.
  void deriveSurfaces(Pair<S>& pair) const {
    const Shape<S>& a = world_.shapes.valueAt(pair.a.index);
    const Shape<S>& b = world_.shapes.valueAt(pair.b.index);
    takeSurfaces(pair, Surface<S>::of(a), Surface<S>::of(b),
                 worldNormal(pair, world_.bodies.valueAt(a.body().index)));
  }

  template <class T, class IdType, class Flaw>
  void slots(SlotMap<T, IdType>& map, std::uint32_t most, const char* tooMany, Flaw&& flawIn) {
    const std::uint64_t start = bytes_.offset();
    const auto count = read_.next<std::uint32_t>();
    if (count > most || count > bytes_.remaining() / kCompactCodeBytes) failFormat(start, tooMany);
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
      if (const char* flaw = flawIn(id, values[i])) failFormat(at, flaw);
    }
    const bool good = map.restore(std::move(values), std::move(generations));
    if (!good) failFormat(start, "a generation is too high");
  }

  template <class T, class Flaw>
  void list(std::vector<T>& items, std::uint32_t most, const char* tooMany, Flaw&& flawIn) {
    const std::uint64_t start = bytes_.offset();
    const auto count = read_.next<std::uint64_t>();
    if (count > most || count > bytes_.remaining() / kCompactCodeBytes) failFormat(start, tooMany);
    items.resize(static_cast<std::size_t>(count));
    CompactReader records(bytes_);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t at = bytes_.offset();
      records.get(items[i]);
      if (const char* flaw = flawIn(items[i])) failFormat(at, flaw);
      if (i > 0 && !inOrder(items[i - 1], items[i])) failFormat(at, "a list is not in order");
    }
  }

  ByteReader& bytes_;
  CanonicalReader read_;
  const WorldLimits& limits_;
  WorldState<S> world_;
};

}  // namespace

template <Scalar S>
std::uint64_t encodeWorld(const WorldState<S>& world, std::span<std::uint8_t> into) {
  SpanSink sink(into);
  CanonicalWriter<SpanSink> plain(sink);
  const auto slots = [&](const auto& map) {
    plain.put(map.slots());
    CompactWriter records(sink);
    for (std::uint32_t i = 0; i < map.slots(); ++i) {
      if (map.aliveAt(i)) {
        records.put(map.generationAt(i), map.valueAt(i));
      } else {
        records.put(map.generationAt(i));
      }
    }
  };
  const auto list = [&](const auto& items) {
    plain.put(static_cast<std::uint64_t>(items.size()));
    CompactWriter records(sink);
    for (const auto& record : items) records.put(record);
  };
  writeFrame(plain, world);
  slots(world.bodies);
  slots(world.shapes);
  list(world.pairs);
  list(world.handlers);
  return sink.used();
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
                          const WorldLimits& limits) {
  // Rotations and inverse masses follow from what is read.
  requireSoundArithmetic<S>();
  ByteReader reader(bytes, offset);
  WorldState<S> world = WorldReader<S>(reader, limits).world();
  offset = reader.offset();
  return world;
}

template <Scalar S>
const char* flawOf(const WorldState<S>& world, const WorldLimits& limits) {
  if (world.bodies.slots() > limits.bodies) return "more bodies than allowed";
  if (world.shapes.slots() > limits.shapes) return "more shapes than allowed";
  if (world.pairs.size() > limits.pairs) return "more pairs than allowed";
  if (world.handlers.size() > limits.handlers) return "more handlers than allowed";
  const char* flaw = flawOfFrame(world);
  world.bodies.each([&](BodyId, const Body<S>& body) {
    if (flaw == nullptr && !body.wellFormed()) flaw = "a body is malformed";
  });
  ShapeCheck<S> check(world);
  world.shapes.each([&](ShapeId id, const Shape<S>& shape) {
    if (flaw == nullptr) flaw = check.flawOf(id, shape);
  });
  for (const Pair<S>& pair : world.pairs) {
    if (flaw == nullptr) flaw = flawOf(world, pair);
  }
  return flaw;
}

#define SAMESTEP_EACH_SCALAR                                                                                \
  template std::uint64_t encodeWorld<S>(const WorldState<S>&, std::span<std::uint8_t>);                     \
  template void encodeWorld<S>(const WorldState<S>&, std::vector<std::uint8_t>&);                           \
  template WorldState<S> decodeWorld<S>(std::span<const std::uint8_t>, std::uint64_t&, const WorldLimits&); \
  template const char* flawOf<S>(const WorldState<S>&, const WorldLimits&);
#include <samestep/each_scalar.h>

}  // namespace samestep
