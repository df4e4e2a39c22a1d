// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include <samestep/bb_tree.h>
#include <samestep/space.h>

#include "contacts/push_contacts.h"
#include "parallel/crew.h"
#include "solver/sequential_impulse/sequential_impulse.h"
#include "solver/soft_step/contact_groups.h"
#include "solver/soft_step/soft_step.h"

namespace samestep {

/// Where a body stood when its shapes were last placed.
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
    // By bits: zeros of two signs are equal, and not the same.
    const bool same = !surfaces_.empty() && std::memcmp(&surfaces_.back(), &surface, sizeof(Surface<S>)) == 0;
    if (!same) surfaces_.push_back(surface);
    return static_cast<std::uint32_t>(surfaces_.size() - 1);
  }
  const Surface<S>& operator[](std::uint32_t number) const { return surfaces_[number]; }
  /// Whether there are so many more than shapes that they should be counted anew.
  bool tooMany(std::size_t shapes) const { return surfaces_.size() > 2 * shapes + 64; }
  /// Of memory that a copy takes.
  std::uint64_t bytes() const { return surfaces_.size() * sizeof(Surface<S>); }

 private:
  static_assert(std::is_trivially_copyable_v<Surface<S>> && sizeof(Surface<S>) == 4 * sizeof(S));

  std::vector<Surface<S>> surfaces_;
};

/// What pairs ask about a shape, close together.
template <Scalar S>
struct alignas(32) ShapeTraits {
  std::uint32_t surface = 0;  ///< Its number.
  std::uint32_t body = 0;
  ShapeFilter filter{};
  std::int32_t reach = 0;  ///< Whole metres from the body's origin, none of the shape is beyond.
  bool sensor = false;
  bool round = false;    ///< A circle.
  bool rounded = false;  ///< Has a radius: its surface may roll.

  static ShapeTraits of(const Shape<S>& shape, std::uint32_t surface) {
    return {surface,
            shape.body().index,
            shape.filter(),
            static_cast<std::int32_t>(shape.extent()) + 1,
            shape.sensor(),
            shape.type() == ShapeType::circle,
            shape.radius() != S(0)};
  }
};

/// The circle around a shape whose centre is the shape's centroid, in the body's coordinates.
template <Scalar S>
struct CircleAround {
  Vector<S> center{};
  S radius{};

  static CircleAround of(const Shape<S>& shape) {
    return {shape.massInfo().centroid, radiusAround(shape.massInfo().centroid, shape)};
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
};

/// The planes of shapes as their bodies hold them. Shapes of one geometry in a row, as in most worlds, share
/// them: a step then reads them from few places.
template <Scalar S>
class LocalPlanes {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  void clear();
  /// Where planes stand that are equal to these, bit by bit, for one more user.
  std::uint32_t use(const Plane<S>* planes, std::uint32_t count);
  /// One user less, of what use() answered, or kNone.
  void release(std::uint32_t geometry);
  const Plane<S>* of(std::uint32_t geometry) const { return data() + geometries_[geometry].offset; }
  const Plane<S>* data() const { return planes_.data(); }
  /// Of memory that a copy takes.
  std::uint64_t bytes() const {
    return planes_.size() * sizeof(Plane<S>) + geometries_.size() * sizeof(Geometry);
  }

 private:
  struct Geometry {
    std::uint32_t offset, count, users;
    std::uint32_t nextFree;  ///< Of those with as many planes.
  };

  std::vector<Plane<S>> planes_;
  std::vector<Geometry> geometries_;
  std::vector<std::uint32_t> firstFree_ = std::vector<std::uint32_t>(kMaxPolyVertices + 1, kNone);
  std::uint32_t last_ = kNone;
};

/// What a Space computes from its state and can compute again at any time, by body or shape slot. A saved
/// world holds a copy, which spares the next step the work.
template <Scalar S>
struct SpaceCache {
  SpaceCache() = default;
  SpaceCache(const SpaceCache&) = delete;
  SpaceCache& operator=(const SpaceCache&) = delete;
  void copyFrom(const SpaceCache& other);
  /// Bytes that copyFrom copies.
  std::uint64_t bytes() const;

  bool cached = false;
  // Of all shapes, until one is added, changed or removed.
  bool shapesHashKnown = false;
  std::uint64_t shapesHash = 0;
  std::vector<PlacedPose<S>> poses;
  std::vector<std::uint32_t> firstShape;
  std::vector<std::uint32_t> lastShape;
  std::vector<std::uint32_t> nextShape;
  std::vector<PlacedShape<S>> placed;
  std::vector<ShapeTraits<S>> traits;
  std::vector<CircleAround<S>> around;
  Surfaces<S> surfaces;
  // Whether the surfaces in all pairs that touched in the last step are those of the shapes.
  bool surfacesKnown = false;
  std::vector<std::uint32_t> planeOffset;
  std::vector<Plane<S>> planes;
  LocalPlanes<S> localPlanes;
  std::vector<std::uint32_t> geometry;  // Of each shape, in localPlanes.
  // Whether a step left midway: it may have moved bodies without placing them.
  bool leftMidway = false;
  // Bodies that may have been moved by hand since the last step, each once.
  std::vector<std::uint32_t> touched;
  std::vector<std::uint8_t> isTouched;
  std::vector<std::uint32_t> planeRoom;
  BBTree<S> staticTree;
  BBTree<S> dynamicTree{nullptr, nullptr, &staticTree};

  void usePlanes();
};

/// What a Space has beside its state.
template <Scalar S>
struct Space<S>::Impl : SpaceCache<S> {
  using SpaceCache<S>::poses, SpaceCache<S>::firstShape, SpaceCache<S>::lastShape, SpaceCache<S>::nextShape,
      SpaceCache<S>::placed, SpaceCache<S>::planeOffset, SpaceCache<S>::planes, SpaceCache<S>::touched,
      SpaceCache<S>::isTouched, SpaceCache<S>::planeRoom, SpaceCache<S>::traits, SpaceCache<S>::around,
      SpaceCache<S>::staticTree, SpaceCache<S>::dynamicTree, SpaceCache<S>::localPlanes,
      SpaceCache<S>::geometry, SpaceCache<S>::surfaces;

  // Wiring: who is told. By rising number.
  template <class Function>
  struct Registered {
    CallbackNumber number;
    Function function;
    void* data;
  };
  struct RegisteredHandler {
    CallbackNumber number;
    CollisionHandler<S> handler;
  };
  std::vector<Registered<PositionFunc>> positionFuncs;
  std::vector<Registered<VelocityFunc>> velocityFuncs;
  std::vector<RegisteredHandler> handlers;
  StageObserver observer = nullptr;
  void* observerData = nullptr;
  std::uint32_t serial = 0;
  TaskRunner* runner = nullptr;
  Crew crew;
  KernelTarget kernel = nextBestKernel(KernelTarget::best);
  std::uint32_t maxPairs = kDefaultMaxPairs;
  // How many times as many shapes may have boxes near each other as there may be pairs.
  static constexpr std::uint64_t kCandidatesPerPair = 8;
  /// Whether so many shapes can be more pairs than are allowed.
  bool mayFindTooMany(std::uint64_t shapes) const { return shapes * shapes / 2 > maxPairs; }

  struct PostStep {
    PostStepFunc function;
    std::uint64_t key;
    void* data;
  };
  std::vector<PostStep> postStep;
  bool runningPostStep = false;

  // Cache, of one step.
  bool keepPlaced = false;
  // The pairs of each body, as ranges of threadPairs; made on demand.
  bool threadsKnown = false;
  std::vector<std::uint32_t> threadStart;
  std::vector<std::uint32_t> threadPairs;
  std::vector<std::uint32_t> threadFill;

  // Scratch: of one step.
  ImpulseSolver<S> solver;
  SoftStep<S> soft;
  ContactGroups groups;
  struct SolvedPair {
    std::uint32_t pair;
    std::uint32_t a, b;
    bool roundA, roundB;
  };
  std::vector<SolvedPair> solvedPairs;
  std::vector<std::uint32_t> groupOrder;
  std::vector<std::uint32_t> solverIndex;
  std::vector<std::uint32_t> solverBodies;
  // Of each pair: whether its boxes overlap; whether it touched before and does not now.
  std::vector<std::uint8_t> overlapping;
  std::vector<std::uint8_t> left;
  struct NewPair {
    std::uint32_t to;
    std::uint32_t a, b;
  };
  std::vector<NewPair> newPairs;
  // Pairs of the last step that all move by as much; some of them may be gone.
  struct PairRun {
    std::uint32_t from, end;
    std::int64_t shift;
  };
  std::vector<PairRun> pairRuns;
  bool someLeft = false;
  std::vector<std::uint8_t> held;
  SlotMap<Body<S>, BodyId> bodiesBefore;  // Of a step that may be refused midway.
  std::vector<std::uint8_t> placedAnew;
  std::vector<std::uint32_t> found;
  std::vector<std::uint32_t> foundInOne;

  static constexpr std::uint32_t kNone = 0xffffffffu;
  // Of solverIndex: a body that touches nothing, by its place among them.
  static constexpr std::uint32_t kFree = 0x80000000u;
  // Fewer pairs, or bodies, are not worth waking other workers for.
  static constexpr std::uint32_t kFewPairs = 256;
  static constexpr std::uint32_t kFewBodies = 512;
  // What a part of the work has at least.
  static constexpr std::uint32_t kPairGrain = 32;
  static constexpr std::uint32_t kPlacedGrain = 64;

  template <class Entry>
  static const Entry* find(const std::vector<Entry>& entries, CallbackNumber number) {
    for (const Entry& entry : entries) {
      if (entry.number == number) return &entry;
    }
    return nullptr;
  }
  template <class Entry>
  static void set(std::vector<Entry>& entries, const Entry& entry) {
    for (Entry& present : entries) {
      if (present.number == entry.number) {
        present = entry;
        return;
      }
    }
    entries.push_back(entry);
  }

  std::uint32_t solverIndexOf(std::uint32_t body) {
    std::uint32_t& index = solverIndex[body];
    if (index == kNone) {
      index = static_cast<std::uint32_t>(solverBodies.size());
      solverBodies.push_back(body);
    }
    return index;
  }
  /// While it lives, queries see the shapes where the step placed them, whatever callbacks have moved: a
  /// question asked within a step must not change its result.
  class KeepPlaced {
   public:
    explicit KeepPlaced(Impl& impl) : impl_(impl) { impl_.keepPlaced = true; }
    ~KeepPlaced() { end(); }
    KeepPlaced(const KeepPlaced&) = delete;
    KeepPlaced& operator=(const KeepPlaced&) = delete;
    void end() { impl_.keepPlaced = false; }

   private:
    Impl& impl_;
  };

  void runPostStep(Space& space);
  void growBodies(std::uint32_t slots);
  void growShapes(std::uint32_t slots);
  void touch(std::uint32_t body);
  void touchAll(const WorldState<S>& world) {
    world.bodies.each([this](BodyId id, const Body<S>&) { touch(id.index); });
  }
  void forgetTouched();
  void putBox(std::uint32_t shape, bool isStatic, const BB<S>& box, const Vector<S>& velocity);
  void dropBox(std::uint32_t shape);
  void clearBoxes();
  void linkShape(std::uint32_t body, std::uint32_t shape);
  void unlinkShape(std::uint32_t body, std::uint32_t shape);
  void prepareShape(std::uint32_t index, const Shape<S>& shape);
  void takeTraits(std::uint32_t index, const Shape<S>& shape);
};

/// One function of each further file that defines members of Space, for space.cpp to refer to. Under gcc's
/// link-time optimisation what one of these files asks of another is a weak reference, since each
/// instantiates the class; and a weak one alone takes no file out of a static library.
namespace file_of {
void spaceCache();
void spaceHandlers();
void spaceQuery();
void spaceSoftStep();
void spaceStep();
}  // namespace file_of

}  // namespace samestep
