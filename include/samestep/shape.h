// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>

#include <samestep/bb.h>
#include <samestep/control.h>
#include <samestep/counted.h>
#include <samestep/id.h>
#include <samestep/transform.h>

namespace samestep {

enum class ShapeType : std::uint8_t { circle, segment, poly };

/// The most vertices a polygon may have.
inline constexpr int kMaxPolyVertices = 32;

/// Metres: no point of a shape may be farther than this from the origin of its body. What moves is held to
/// kMaxDynamicExtent, by the Space.
inline constexpr int kMaxExtent = 1 << 14;
inline constexpr int kMaxDynamicExtent = 1 << 8;

/// The largest friction and elasticity, and the largest component of a surface velocity in m/s.
inline constexpr int kMaxMaterial = 1 << 10;

/// Distances below this, in metres, have no direction worth reading: queries then answer with the normal of
/// the surface. MIS: MAGIC_EPSILON
template <Scalar S>
inline constexpr S kMagicEpsilon = S(1e-5);

/// Filter of the shapes that may touch. Two shapes do unless they share a group that is not 0, or either's
/// category is outside the other's mask.
struct ShapeFilter {
  std::uint32_t group = 0;
  std::uint32_t category = 0xffffffffu;
  std::uint32_t mask = 0xffffffffu;
  friend constexpr bool operator==(const ShapeFilter&, const ShapeFilter&) = default;
};

/// True if the filters let two shapes touch.
[[gnu::always_inline]] inline constexpr bool accepts(const ShapeFilter& a, const ShapeFilter& b) {
  return (a.group == 0 || a.group != b.group) && (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

/// The mass of a shape and how it lies. MIS section 5, ShapeMassInfo.
template <Scalar S>
struct ShapeMassInfo {
  S mass{};                ///< kg; 0 adds nothing to the body.
  Vector<S> centroid{};    ///< Place in the body's frame, metres.
  Scaled<S> unitMoment{};  ///< m^2: the moment about the centroid per kilogram.
  Scaled<S> area{};        ///< m^2, the rounding included.

  friend constexpr bool operator==(const ShapeMassInfo&, const ShapeMassInfo&) = default;
};

/// The places of a shape's vertices. A few stand in the list itself, which is enough for circles, segments,
/// triangles and boxes; more take memory of their own, which no copy shares. Copying a list of as many or
/// fewer into one takes no memory.
template <Scalar S>
class VertexList {
 public:
  static constexpr int kFew = 4;

  VertexList() = default;
  VertexList(const VertexList& other) { *this = other; }
  VertexList(VertexList&& other) noexcept { swap(other); }
  VertexList& operator=(const VertexList& other);
  VertexList& operator=(VertexList&& other) noexcept {
    swap(other);
    return *this;
  }
  ~VertexList() { delete[] many_; }

  /// Places that there are, at least kFew.
  int room() const { return room_; }
  /// Makes room for `count` vertices; what is there stays.
  void makeRoom(int count);
  const Vector<S>* data() const { return many_ == nullptr ? few_ : many_; }
  Vector<S>* data() { return many_ == nullptr ? few_ : many_; }

 private:
  void swap(VertexList& other) noexcept;

  Vector<S> few_[kFew];
  Vector<S>* many_ = nullptr;
  std::int32_t room_ = kFew;
  std::int32_t unused_ = 0;  // Keeps the record free of padding.
};

template <Scalar S>
class CircleShape;
template <Scalar S>
class SegmentShape;
template <Scalar S>
class PolyShape;

/// A collision shape: geometry in its body's frame, mass, surface, filter. MIS section 5.
/// A plain value, made by circleShape, segmentShape, polyShape and boxShape; geometry is read and changed
/// through CircleShape, SegmentShape and PolyShape. It carries the id its Space gave it, or none.
/// Every setter checks first and leaves the shape as it was when it throws.
template <Scalar S>
class Shape {
 public:
  /// A circle of radius 0 of no body: a place to assign to. MIS: shapeInit
  constexpr Shape() = default;

  constexpr ShapeType type() const { return type_; }
  /// MIS: shapeGetBody
  constexpr BodyId body() const { return body_; }
  /// Names the body of a shape outside of any Space; a Space moves no shape to another body.
  constexpr void setBody(BodyId bodyId) { body_ = bodyId; }

  /// The id its Space knows it by; not valid() outside of one. MIS: shapeGetSpace
  constexpr ShapeId id() const { return id_; }
  /// Makes the shape a Space's own, and so the id of its body.
  constexpr void attach(ShapeId id) {
    id_ = id;
    body_.space = id.space;
  }
  /// Copy of the shape outside of any Space. Its body is the one it was on: before another Space takes it, it
  /// needs one of that.
  constexpr Shape detached() const {
    Shape copy = *this;
    copy.id_ = ShapeId();
    return copy;
  }

  /// Kilograms. MIS: shapeGetMass
  constexpr S mass() const { return massInfo_.mass; }
  /// @param mass  kg: 0, or from 1e-3 to 1e6
  /// @throws NaNMass, NegativeMass, InfiniteMass, MassOutOfRange
  /// MIS: shapeSetMass
  void setMass(S mass);
  /// kg / m^2; 0 for a shape without area. MIS: shapeGetDensity
  S density() const;
  /// Sets the mass to density times area; a shape without area gets mass 0.
  /// @param density  kg / m^2, finite, >= 0
  /// @throws ValueOutOfRange (not finite), NegativeMass, MassOutOfRange
  /// MIS: shapeSetDensity
  void setDensity(S density);
  /// kg m^2 about the centroid; saturates. MIS: shapeGetMoment
  S moment() const;
  /// m^2, the rounding included; saturates. MIS: shapeGetArea
  S area() const;
  /// The centroid, in the body's frame. MIS: shapeGetCenterOfMass
  constexpr Vector<S> centerOfMass() const { return massInfo_.centroid; }
  /// All of that at full precision, to be summed over the shapes of a body.
  constexpr const ShapeMassInfo<S>& massInfo() const { return massInfo_; }

  /// MIS: shapeGetElasticity
  constexpr S elasticity() const { return elasticity_; }
  /// @param elasticity  0 (no bounce) to kMaxMaterial; 1 keeps all speed
  /// @throws ValueOutOfRange, NegativeElasticity
  /// MIS: shapeSetElasticity
  void setElasticity(S elasticity);
  /// MIS: shapeGetFriction
  constexpr S friction() const { return friction_; }
  /// @param friction  Coulomb's coefficient, 0 to kMaxMaterial; that of a contact is the product of two
  /// @throws ValueOutOfRange, NegativeFriction
  /// MIS: shapeSetFriction
  void setFriction(S friction);
  /// m/s, in world axes. MIS: shapeGetSurfaceVelocity
  constexpr Vector<S> surfaceVelocity() const { return surfaceVelocity_; }
  /// The speed of a conveyor belt: only friction feels it.
  /// @param velocity  m/s, each component within +-kMaxMaterial
  /// @throws ValueOutOfRange
  /// MIS: shapeSetSurfaceVelocity
  void setSurfaceVelocity(const Vector<S>& velocity);
  constexpr S rollingResistance() const { return rollingResistance_; }
  /// Has a contact oppose that its bodies turn against each other, by a torque of up to the larger
  /// coefficient of the two shapes times the larger radius times the force that presses them together. It
  /// begins a step after the touch.
  /// @param resistance  a part of the radius, 0, as at first, to kMaxMaterial
  /// @throws ValueOutOfRange
  void setRollingResistance(S resistance);
  /// MIS: shapeGetCollisionType
  constexpr CollisionType collisionType() const { return collisionType_; }
  /// MIS: shapeSetCollisionType
  constexpr void setCollisionType(CollisionType type) { collisionType_ = type; }
  constexpr const ShapeFilter& filter() const { return filter_; }
  constexpr void setFilter(const ShapeFilter& filter) { filter_ = filter; }
  /// A sensor reports contacts and never pushes. Of a shape that becomes one in contact, or is one no more,
  /// the contact goes on: no separate and no begin is called for that.
  constexpr bool sensor() const { return sensor_ != 0; }
  constexpr void setSensor(bool sensor) { sensor_ = sensor ? 1 : 0; }
  /// Any 64 bits; saved with the shape.
  constexpr std::uint64_t userData() const { return userData_; }
  constexpr void setUserData(std::uint64_t data) { userData_ = data; }

  /// Number of a game's own for what the surface is of; saved with the shape, and nothing to a step.
  constexpr std::uint32_t material() const { return material_; }
  constexpr void setMaterial(std::uint32_t material) { material_ = material; }

  /// Metres: of a circle, or by which a segment or polygon is rounded (grown) on all sides.
  constexpr S radius() const { return radius_; }
  /// Metres from the body's origin to the farthest point of the shape.
  S extent() const;

  /// The geometry as stored. Circle: the centre. Segment: its ends, then the tangents towards its neighbours.
  /// Polygon: the vertices, counter-clockwise.
  std::span<const Vector<S>> vertices() const {
    return {vertices_.data(), static_cast<std::size_t>(min<int>(count_, vertices_.room()))};
  }
  /// Bytes of the canonical form that stand outside of the record, at most.
  static constexpr unsigned kBytesOutside = (kMaxPolyVertices - VertexList<S>::kFew) * sizeof(Vector<S>);

  friend bool operator==(const Shape& a, const Shape& b) { return a.same(b); }

  /// Visits every field that is state, in order, as visit(name, field). `Self` is Shape or const Shape. The
  /// id is no state: it says in which slot of the state the shape is.
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("type", self.type_);
    visit("sensor", self.sensor_);
    visit("count", self.count_);
    visit("body", self.body_);
    visit("userData", self.userData_);
    visit("collisionType", self.collisionType_);
    visit("group", self.filter_.group);
    visit("category", self.filter_.category);
    visit("mask", self.filter_.mask);
    visit("material", self.material_);
    visit("elasticity", self.elasticity_);
    visit("friction", self.friction_);
    visit("rollingResistance", self.rollingResistance_);
    visit("surfaceVelocity", self.surfaceVelocity_);
    visit("radius", self.radius_);
    visit("mass", self.massInfo_.mass);
    visit("centroid", self.massInfo_.centroid);
    visit("unitMoment", self.massInfo_.unitMoment);
    visit("area", self.massInfo_.area);
    if constexpr (!std::is_const_v<Self>) self.vertices_.makeRoom(min<int>(self.count_, kMaxPolyVertices));
    const int count = min<int>(self.count_, min(self.vertices_.room(), kMaxPolyVertices));
    for (int i = 0; i < count; ++i) visit("vertex", self.vertices_.data()[i]);
  }

  /// True if the record could have been made by the functions of this library, the ids and the surface apart:
  /// for what was read from outside.
  bool wellFormed() const { return surfaceWellFormed() && geometryWellFormed(); }
  /// The two parts of that: the second takes longer, and is the same for shapes of the same geometry.
  bool surfaceWellFormed() const;
  bool geometryWellFormed() const;
  /// True if type, vertices, radius and mass are the same.
  bool sameGeometry(const Shape& other) const;

 private:
  friend class CircleShape<S>;
  friend class SegmentShape<S>;
  friend class PolyShape<S>;

  bool same(const Shape& other) const;
  void setGeometry(ShapeType type, std::span<const Vector<S>> vertices, S radius,
                   const ShapeMassInfo<S>& massInfo);

  ShapeMassInfo<S> massInfo_;
  S radius_{};
  S elasticity_{};
  S friction_{};
  S rollingResistance_{};
  Vector<S> surfaceVelocity_;
  std::uint64_t userData_ = 0;
  BodyId body_;
  ShapeId id_;
  CollisionType collisionType_ = kWildcardCollisionType;
  ShapeFilter filter_;
  std::uint32_t material_ = 0;
  std::uint8_t unusedByte_ = 0;  // Keeps the record free of padding.
  ShapeType type_ = ShapeType::circle;
  std::uint8_t sensor_ = 0;
  std::uint8_t count_ = 1;
  VertexList<S> vertices_;
};

/// A point and a unit vector: of a polygon, a vertex and the outward normal of the edge that ends there.
template <Scalar S>
struct Plane {
  Vector<S> v0;
  Vector<S> n;
};

/// The geometry of one shape where its body stands: what collide and the queries read. A cache, made from the
/// shape by prepare and moved by place.
template <Scalar S>
struct alignas(64) PlacedShape {
  BB<S> box;  ///< The smallest box around the shape, rounding included.
  /// Room for planeCount(shape) planes, given by the owner of the PlacedShape, in the world. Polygon: its
  /// planes. Segment: {a, -n}, {b, n}, {tangent at a, tangent at b}. Circle: v0 is its centre.
  Plane<S>* planes = nullptr;
  /// Planes as the body holds them; shapes of one geometry may share them.
  const Plane<S>* local = nullptr;
  S radius{};
  ShapeType type = ShapeType::circle;
  std::uint8_t count = 1;  ///< Vertices: circle 1, segment 2.
  /// True if the second half of the local planes is the first half turned by 180 degrees.
  bool halved = false;

  /// Centre of a circle, in the world.
  const Vector<S>& center() const { return planes[0].v0; }
};

/// Number of planes a PlacedShape of this shape needs: at most kMaxPolyVertices.
template <Scalar S>
int planeCount(const Shape<S>& shape);

/// Writes what does not depend on the pose, and its planes as the body holds them to `local`, with room for
/// planeCount(shape). `out.planes` must be set; call again when the shape changed.
template <Scalar S>
void prepare(const Shape<S>& shape, Plane<S>* local, PlacedShape<S>& out);

/// Moves a prepared shape to where a rigid `pose` puts it and returns its new box. MIS: shapeUpdate
template <Scalar S>
BB<S> place(const Transform<S>& pose, PlacedShape<S>& placed);

/// Both: prepare, then place. MIS: shapeCacheBB
template <Scalar S>
BB<S> place(const Shape<S>& shape, const Transform<S>& pose, Plane<S>* local, PlacedShape<S>& out);

/// A placed shape with its own room: for a single test, where no Space keeps the planes.
template <Scalar S>
class Placement {
 public:
  Placement(const Shape<S>& shape, const Transform<S>& pose) {
    placed_.planes = planes_;
    place(shape, pose, local_, placed_);
  }
  Placement(const Placement&) = delete;
  Placement& operator=(const Placement&) = delete;

  const PlacedShape<S>& operator*() const { return placed_; }
  const PlacedShape<S>* operator->() const { return &placed_; }

 private:
  Plane<S> planes_[kMaxPolyVertices], local_[kMaxPolyVertices];
  PlacedShape<S> placed_;
};

/// The smallest box around the shape under a pose. MIS: shapeGetBB
template <Scalar S>
BB<S> boundingBox(const Shape<S>& shape, const Transform<S>& pose);

/// Nearest point of a shape to a query point.
template <Scalar S>
struct PointQueryInfo {
  Vector<S> point;     ///< The nearest point of the surface, in the world.
  S distance{};        ///< Metres; negative inside.
  Vector<S> gradient;  ///< The unit direction in which the distance grows fastest.
};

/// Distance from a point, both within the world. Within kMagicEpsilon of the core of a shape (the centre of a
/// circle, the edge of a segment or polygon before rounding) the gradient is the normal there, (0, 1) for a
/// circle.
template <Scalar S>
PointQueryInfo<S> pointQuery(const PlacedShape<S>& shape, const Vector<S>& point);

/// First touch of a moving circle and a shape.
template <Scalar S>
struct SegmentQueryInfo {
  bool hit = false;
  S alpha{1};        ///< The part of the way, in [0, 1]; 1 without a hit.
  Vector<S> point;   ///< Point of the touch, on the surface of the shape; the end of the way without a hit.
  Vector<S> normal;  ///< The unit normal of the surface there; zero without a hit.
};

/// Moves a circle of `radius` >= 0 from a to b. To touch is to hit, where the way begins, where it ends and
/// in passing. One that begins in touch or inside hits at alpha 0, with point and gradient of the point query
/// there: from the very centre of a circle (0, 1), from that of a square the normal of its first edge, of an
/// unturned one (0, -1).
template <Scalar S>
SegmentQueryInfo<S> segmentQuery(const PlacedShape<S>& shape, const Vector<S>& a, const Vector<S>& b,
                                 S radius = S(0));

#define SAMESTEP_EACH_SCALAR extern template class Shape<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
