// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include <samestep/bb_tree.h>
#include <samestep/make_room.h>
#include <samestep/saved_world.h>
#include <samestep/state.h>

#include "base/budget.h"
#include "contacts/push_contacts.h"

namespace samestep {

/// Pose of a body when its shapes were last placed.
template <Scalar S>
struct PlacedPose {
  Frame<S> frame{};
  BodyType type = BodyType::dynamicBody;
  bool known = false;

  static PlacedPose of(const Body<S>& body) { return {Frame<S>::of(body), body.type(), true}; }
  friend bool operator==(const PlacedPose&, const PlacedPose&) = default;
};

/// The surfaces of shapes. Most worlds have few, and shapes of one in a row: what pairs ask about shapes
/// takes half the memory without them.
template <Scalar S>
class Surfaces {
 public:
  void clear() { surfaces_.clear(); }
  /// The number of a surface.
  std::uint32_t number(const Surface<S>& surface) {
    // Surfaces are compared by bits: zeros of two signs are equal, and not the same.
    const bool same = !surfaces_.empty() && std::memcmp(&surfaces_.back(), &surface, sizeof(Surface<S>)) == 0;
    if (!same) surfaces_.push_back(surface);
    return static_cast<std::uint32_t>(surfaces_.size() - 1);
  }
  const Surface<S>& operator[](std::uint32_t number) const { return surfaces_[number]; }
  /// True if there are so many more than shapes that they should be counted anew.
  bool tooMany(std::size_t shapes) const { return surfaces_.size() > 2 * shapes + 64; }
  void reserve(std::size_t surfaces) { makeRoom(surfaces_, surfaces); }
  /// Bytes of memory that a copy takes.
  std::uint64_t bytes() const { return surfaces_.size() * sizeof(Surface<S>); }
  std::size_t size() const { return surfaces_.size(); }

 private:
  static_assert(std::is_trivially_copyable_v<Surface<S>> && sizeof(Surface<S>) == 4 * sizeof(S));

  std::vector<Surface<S>> surfaces_;
};

/// Traits of a shape that pairs ask about, close together.
template <Scalar S>
struct alignas(32) ShapeTraits {
  std::uint32_t surface = 0;  ///< Its number.
  std::uint32_t body = 0;
  ShapeFilter filter{};
  /// Distance from the body's origin beyond which nothing of the shape is; in units of 1 / kReachUnits m.
  std::int32_t reach = 0;
  bool sensor = false;
  bool round = false;    ///< A circle.
  bool rounded = false;  ///< Has a radius: its surface may roll.
  bool resists = false;  ///< Has a rolling resistance.

  static ShapeTraits of(const Shape<S>& shape, std::uint32_t surface) {
    return {surface,
            shape.body().index,
            shape.filter(),
            static_cast<std::int32_t>(shape.extent() * S(kReachUnits)) + 1,
            shape.sensor(),
            shape.type() == ShapeType::circle,
            shape.radius() != S(0),
            shape.rollingResistance() != S(0)};
  }
};

/// True if two shapes whose boxes overlap may collide at all.
template <Scalar S>
[[gnu::always_inline]] inline bool mayCollide(const ShapeTraits<S>& a, const ShapeTraits<S>& b) {
  return a.body != b.body && accepts(a.filter, b.filter);
}

/// The circle around a shape whose centre is the shape's centroid, in the body's coordinates.
template <Scalar S>
struct CircleAround {
  Vector<S> center{};
  S radius{};
  S thickness{};  ///< Half of what the shape measures where it is thinnest, rounding included, m.

  static CircleAround of(const Shape<S>& shape) {
    return {shape.massInfo().centroid, radiusAround(shape.massInfo().centroid, shape), thicknessOf(shape)};
  }

 private:
  static S radiusAround(const Vector<S>& center, const Shape<S>& shape) {
    const auto vertices = shape.vertices();
    S most = S(0);
    for (const Vector<S>& vertex : shape.type() == ShapeType::segment ? vertices.first(2) : vertices) {
      most = max(most, length(vertex - center));
    }
    return most + shape.radius();
  }
  /// The least width of a polygon is across one of its edges.
  static S thicknessOf(const Shape<S>& shape) {
    if (shape.type() != ShapeType::poly) return shape.radius();
    const auto vertices = shape.vertices();
    S least = S(2 * kMaxExtent);
    Vector<S> from = vertices.back();
    for (const Vector<S>& to : vertices) {
      const Vector<S> inward = perp(normalize(to - from));
      S width(0);
      for (const Vector<S>& vertex : vertices) width = max(width, dot(vertex - from, inward));
      least = min(least, width);
      from = to;
    }
    return least * ratio<S>(1, 2) + shape.radius();
  }
};

/// The least way that counts as far for shapes without any thickness, m.
template <Scalar S>
inline constexpr S kLeastRoom = S(0x1p-10);

/// Bulk of a body: the way on which it meets whatever is in it, without being looked at in between.
template <Scalar S>
struct BodyBulk {
  S room{-1};  ///< Such a way, m; negative while it is not known.
  S reach{};   ///< From the centre of mass, no point that a turn moves is farther, m.
  S way{};     ///< Half of the room, m.
  S turn{};    ///< Half of a turn that moves no point by more than that, rad.

  bool isKnown() const { return room >= S(0); }
};

/// The planes of shapes as their bodies hold them. Shapes of one geometry in a row, as in most worlds, share
/// them: a step then reads them from few places.
template <Scalar S>
class LocalPlanes {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  void clear();
  /// Makes room for the planes of one shape more.
  void reserve(std::uint32_t count);
  /// Takes one more user for planes that are equal to these, bit by bit, and returns where they stand.
  std::uint32_t use(const Plane<S>* planes, std::uint32_t count);
  /// One user less, of what use() answered, or kNone.
  void release(std::uint32_t geometry);
  const Plane<S>* of(std::uint32_t geometry) const { return data() + geometries_[geometry].offset; }
  const Plane<S>* data() const { return planes_.data(); }
  /// Bytes of memory that a copy takes.
  std::uint64_t bytes() const {
    return planes_.size() * sizeof(Plane<S>) + geometries_.size() * sizeof(Geometry);
  }

 private:
  struct Geometry {
    std::uint32_t offset, count, users;
    std::uint32_t nextFree;  ///< Next free one of those with as many planes.
  };

  std::vector<Plane<S>> planes_;
  std::vector<Geometry> geometries_;
  std::vector<std::uint32_t> firstFree_ = std::vector<std::uint32_t>(kMaxPolyVertices + 1, kNone);
  std::uint32_t last_ = kNone;
};

/// The pairs of each body, as ranges of one list; made on demand.
struct BodyPairs {
  bool known = false;
  std::vector<std::uint32_t> start;
  std::vector<std::uint32_t> pairs;
  std::vector<std::uint32_t> fill;
};

/// Data that a Space computes from its state and can compute again at any time, by body or shape slot. A
/// saved world holds a copy, which spares the next step the work.
template <Scalar S>
struct Derived {
  Derived() = default;
  Derived(const Derived&) = delete;
  Derived& operator=(const Derived&) = delete;
  /// Copies everything but poses.
  void copyFrom(const Derived& other);
  /// Copies into a saved world: instead of the poses which bodies stand where they were placed.
  void saveTo(Derived& saved) const;
  /// Takes the copy of a saved world whose state is in `world`.
  void restoreFrom(const Derived& saved, const WorldState<S>& world);
  /// Bytes that saveTo copies.
  std::uint64_t bytes() const;

  bool cached = false;
  // The hash covers all shapes, until one is added, changed or removed.
  bool shapesHashKnown = false;
  std::uint64_t shapesHash = 0;
  std::vector<PlacedPose<S>> poses;
  // A saved world holds this instead: whether each body stands where its shapes were placed.
  std::vector<std::uint8_t> stands;
  std::vector<std::uint32_t> firstShape;
  std::vector<std::uint32_t> lastShape;
  std::vector<std::uint32_t> nextShape;
  std::vector<PlacedShape<S>> placed;
  std::vector<ShapeTraits<S>> traits;
  std::vector<CircleAround<S>> around;
  // Bulk of each body, found when it is asked for.
  std::vector<BodyBulk<S>> bulks;
  Surfaces<S> surfaces;
  // This is true if the surfaces in all pairs that touched in the last step are those of the shapes.
  bool surfacesKnown = false;
  // This is true if pairs came from elsewhere, without the surfaces that callbacks and visits are shown.
  bool surfacesLacking = false;
  std::vector<std::uint32_t> planeOffset;
  std::vector<Plane<S>> planes;
  LocalPlanes<S> localPlanes;
  std::vector<std::uint32_t> geometry;  // Geometry of each shape, in localPlanes.
  // Bodies that may have been moved by hand since the last step, each once; and those that the next one
  // wakes.
  std::vector<std::uint32_t> touched;
  std::vector<std::uint8_t> isTouched;
  std::vector<std::uint32_t> planeRoom;
  BBTree<S> staticTree;
  BBTree<S> dynamicTree{nullptr, nullptr, &staticTree};

  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Budget of the Space, asked while much is computed; null in a saved world.
  Budget* budget = nullptr;

  // The following belong to one step, and so to no copy.

  /// Within a step queries see the shapes where it placed them, whatever callbacks have moved: a question
  /// asked there must not change its result.
  bool keepPlaced = false;
  BodyPairs bodyPairs;
  BodyPairs restingPairs;

  // These tell who moves, and are in no copy either: slots of bodies that steps move, by rising slot, and of
  // each slot whether it is a dynamic body that sleeps.
  bool activeKnown = false;
  std::vector<std::uint32_t> active;
  std::vector<std::uint8_t> sleeps;
  /// Number of sleepers, at most; kNone where nobody has counted.
  std::uint32_t mostSleepers = kNone;
  // Bodies whose joints keep their shapes from colliding, as pairs of slots, sorted; until a joint comes,
  // goes or changes.
  bool jointedKnown = false;
  std::vector<std::uint64_t> keptApart;

  /// Computes all that was forgotten.
  void ensure(const WorldState<S>& world) {
    if (!cached) compute(world);
  }
  /// Forgets everything. Changes no result.
  void forget() {
    cached = false;
    bodyPairs.known = restingPairs.known = false;
    jointedKnown = false;
    forgetWhoMoves();
  }
  void forgetWhoMoves() {
    activeKnown = compoundKnown = false;
    mostSleepers = kNone;
  }
  /// Brings `active` and `sleeps` up to date.
  void findActive(const WorldState<S>& world);
  /// False only if nothing sleeps.
  bool anySleeps(const WorldState<S>& world) {
    if (mostSleepers == kNone) findActive(world);
    return mostSleepers != 0;
  }
  /// Places one shape where its body is, and sleepers that nobody has placed: what eachSleeperNear needs.
  void placeForSleepers(const WorldState<S>& world, std::uint32_t shape);
  /// Calls visit(body slot) for each shape of a sleeper that the box of a shape is near and that may touch
  /// it.
  template <class Visit>
  void eachSleeperNear(const WorldState<S>& world, std::uint32_t shape, Visit&& visit) {
    const Settings<S>& settings = world.settings;
    const S margin = settings.solver == SolverKind::softStep ? settings.contactMargin : S(0);
    const BB<S> grown = inflate(placed[shape].box, margin);
    staticTree.collectIn(grown, near_);
    for (const std::uint32_t other : near_) {
      if (!world.bodies.valueAt(traits[other].body).isSleeping()) continue;
      if (mayCollide(traits[shape], traits[other]) && intersects(grown, placed[other].box)) {
        visit(traits[other].body);
      }
    }
  }
  /// Finds the pairs of bodies that joints keep from colliding, unless it is known.
  void findKeptApart(const WorldState<S>& world);
  bool areKeptApart(std::uint32_t a, std::uint32_t b) const;
  /// Sets the surfaces of pairs that came from elsewhere.
  void completePairs(WorldState<S>& world);
  /// Sets the surfaces of a pair to what its shapes have.
  static void takeShapesSurfaces(const WorldState<S>& world, Pair<S>& pair);
  /// Places the shapes of the bodies that may have been moved by hand.
  void refresh(const WorldState<S>& world);
  /// Places the shapes of a body, and moves their boxes if any moved.
  void placeShapesOf(const WorldState<S>& world, std::uint32_t body) {
    if (movePlaced(world, body)) putBoxesOf(world, body);
  }
  /// Places the shapes of a body; false where they stand already. Writes to nothing but these.
  bool movePlaced(const WorldState<S>& world, std::uint32_t body);
  void putBoxesOf(const WorldState<S>& world, std::uint32_t body);
  void dropBox(std::uint32_t shape);

  // Room is made before anything changes, by what may fail: linking, preparing and touching then cannot.

  void growBodies(std::uint32_t slots);
  void growShapes(std::uint32_t slots);
  /// Makes room for what prepareShape keeps of a shape.
  void reserveFor(const Shape<S>& shape);
  /// Makes room for takeTraits.
  void reserveSurface();
  void linkShape(std::uint32_t body, std::uint32_t shape);
  void unlinkShape(std::uint32_t body, std::uint32_t shape);
  void prepareShape(std::uint32_t index, const Shape<S>& shape);
  void takeTraits(std::uint32_t index, const Shape<S>& shape);

  /// The first shape of a body, by rising slot; kNone without.
  /// @throws BodyNotFound
  std::uint32_t firstShapeOf(const WorldState<S>& world, BodyId id) {
    world.bodies.template requireAlive<Fault::BodyNotFound>(id, "shapes or contacts of a body");
    ensure(world);
    return firstShape[id.index];
  }

  /// Tells whether a body has several shapes; hasCompound, whether one that may move has.
  bool isCompound(std::uint32_t body) const { return firstShape[body] != lastShape[body]; }
  bool hasCompound(const WorldState<S>& world);

  /// Bulk of a body that has shapes. Writes to nothing but that.
  const BodyBulk<S>& bulkOf(const WorldState<S>& world, std::uint32_t body) {
    if (!bulks[body].isKnown()) [[unlikely]]
      bulks[body] = findBulk(world, body);
    return bulks[body];
  }

  /// Notes that a body may have been moved by hand.
  void touch(std::uint32_t body);
  void touchAll(const WorldState<S>& world) {
    world.bodies.each([this](BodyId id, const Body<S>&) { touch(id.index); });
  }
  /// All but those that the next step looks at: see isRoused.
  void forgetTouched(const WorldState<S>& world);

  /// The pairs of a body, by rising number. O(its pairs) after the first call of a step.
  std::span<const std::uint32_t> pairsOf(const WorldState<S>& world, BodyId id) {
    return pairsOf(world, id, world.pairs, bodyPairs);
  }
  /// Pairs of a body among those that rest.
  std::span<const std::uint32_t> restingPairsOf(const WorldState<S>& world, BodyId id) {
    return pairsOf(world, id, world.restingPairs, restingPairs);
  }

  /// True if it is known whether a body that may move has several shapes.
  bool compoundKnown = false;

 private:
  BodyBulk<S> findBulk(const WorldState<S>& world, std::uint32_t body) const;
  /// Points each placed shape to its planes.
  void usePlanes();
  void countSurfaces();
  void compute(const WorldState<S>& world);
  void putBox(std::uint32_t shape, bool isStatic, const BB<S>& box, const Vector<S>& velocity);
  static void findBodyPairs(const WorldState<S>& world, const std::vector<Pair<S>>& pairs, BodyPairs& to);
  static std::span<const std::uint32_t> pairsOf(const WorldState<S>& world, BodyId id,
                                                const std::vector<Pair<S>>& pairs, BodyPairs& known);

  bool someCompound_ = false;
  std::vector<IndexKey> near_;
};

#define SAMESTEP_EACH_SCALAR extern template struct Derived<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
