// SPDX-License-Identifier: MIT
#include <samestep/shape.h>

#include <algorithm>
#include <utility>

#include "geometry/shape_geometry.h"

namespace samestep {

template <Scalar S>
VertexList<S>& VertexList<S>::operator=(const VertexList& other) {
  if (this == &other) return *this;
  // Room beyond the count is left as it is: it is never looked at.
  makeRoom(other.room_);
  const Vector<S>* from = other.data();
  std::copy(from, from + other.room_, data());
  return *this;
}

template <Scalar S>
void VertexList<S>::makeRoom(int count) {
  if (count <= room_) return;
  Vector<S>* const more = new Vector<S>[static_cast<std::size_t>(count)]();
  std::copy(data(), data() + room_, more);
  delete[] many_;
  many_ = more;
  room_ = count;
}

template <Scalar S>
void VertexList<S>::swap(VertexList& other) noexcept {
  std::swap_ranges(few_, few_ + kFew, other.few_);
  std::swap(many_, other.many_);
  std::swap(room_, other.room_);
}

template <Scalar S>
void Shape<S>::setMass(S mass) {
  requireMass(mass, "Shape::setMass");
  massInfo_.mass = mass;
}

template <Scalar S>
S Shape<S>::density() const {
  if (sign(massInfo_.area) == 0) return S(0);
  return toScalar<S>(toScaled(massInfo_.mass) / massInfo_.area);
}

template <Scalar S>
void Shape<S>::setDensity(S density) {
  require<Fault::ValueOutOfRange>(isFinite(density), "Shape::setDensity: density is ", density,
                                  " kg/m^2, which is not finite");
  require<Fault::NegativeMass>(density >= S(0), "Shape::setDensity: density is ", density,
                               " kg/m^2, allowed are 0 and above");
  const Scaled<S> mass = toScaled(density) * massInfo_.area;
  require<Fault::MassOutOfRange>(mass <= toScaled(kMaxMass<S>), "Shape::setDensity: density is ", density,
                                 " kg/m^2 and the mass more than ", kMaxMass<S>, " kg, the most allowed");
  setMass(toScalar<S>(mass));
}

template <Scalar S>
S Shape<S>::moment() const {
  return toScalar<S>(toScaled(massInfo_.mass) * massInfo_.unitMoment);
}

template <Scalar S>
S Shape<S>::area() const {
  return toScalar<S>(massInfo_.area);
}

template <Scalar S>
void Shape<S>::setElasticity(S elasticity) {
  requireMaterial<Fault::NegativeElasticity>(elasticity, "Shape::setElasticity: elasticity is ");
  elasticity_ = elasticity;
}

template <Scalar S>
void Shape<S>::setFriction(S friction) {
  requireMaterial<Fault::NegativeFriction>(friction, "Shape::setFriction: friction is ");
  friction_ = friction;
}

template <Scalar S>
void Shape<S>::setRollingResistance(S resistance) {
  require<Fault::ValueOutOfRange>(resistance >= S(0) && resistance <= S(kMaxMaterial),
                                  "Shape::setRollingResistance: resistance is ", resistance,
                                  ", allowed are 0 to ", kMaxMaterial);
  rollingResistance_ = resistance;
}

template <Scalar S>
void Shape<S>::setSurfaceVelocity(const Vector<S>& velocity) {
  require<Fault::ValueOutOfRange>(within(velocity, S(kMaxMaterial)),
                                  "Shape::setSurfaceVelocity: velocity is ", velocity,
                                  " m/s, allowed are up to ", kMaxMaterial, " m/s along each axis");
  surfaceVelocity_ = velocity;
}

template <Scalar S>
S Shape<S>::extent() const {
  return extentOf(type_ == ShapeType::segment ? vertices().first(2) : vertices(), radius_);
}

template <Scalar S>
void Shape<S>::setGeometry(ShapeType type, std::span<const Vector<S>> vertices, S radius,
                           const ShapeMassInfo<S>& massInfo) {
  // The vertices may be this shape's own: then there is room.
  const int count = static_cast<int>(vertices.size());
  vertices_.makeRoom(count);
  Vector<S>* const to = vertices_.data();
  for (int i = 0; i < vertices_.room(); ++i)
    to[i] = i < count ? vertices[static_cast<std::size_t>(i)] : Vector<S>();
  type_ = type;
  count_ = static_cast<std::uint8_t>(vertices.size());
  radius_ = radius;
  massInfo_ = massInfo;
}

template <Scalar S>
bool Shape<S>::surfaceWellFormed() const {
  const S most(kMaxMaterial);
  if (!(elasticity_ >= S(0) && elasticity_ <= most && friction_ >= S(0) && friction_ <= most)) return false;
  if (!(rollingResistance_ >= S(0) && rollingResistance_ <= most)) return false;
  return sensor_ <= 1 && within(surfaceVelocity_, most);
}

template <Scalar S>
bool Shape<S>::sameGeometry(const Shape& other) const {
  const std::span<const Vector<S>> own = vertices(), others = other.vertices();
  return type_ == other.type_ && radius_ == other.radius_ && massInfo_ == other.massInfo_ &&
         count_ == other.count_ && count_ <= kMaxPolyVertices &&
         std::equal(own.begin(), own.end(), others.begin(), others.end());
}

template <Scalar S>
bool Shape<S>::same(const Shape& other) const {
  return sameGeometry(other) && elasticity_ == other.elasticity_ && friction_ == other.friction_ &&
         surfaceVelocity_ == other.surfaceVelocity_ && userData_ == other.userData_ && body_ == other.body_ &&
         id_ == other.id_ && id_.space == other.id_.space && collisionType_ == other.collisionType_ &&
         filter_ == other.filter_ && sensor_ == other.sensor_ && material_ == other.material_ &&
         rollingResistance_ == other.rollingResistance_;
}

template <Scalar S>
bool Shape<S>::geometryWellFormed() const {
  if (count_ < 1 || count_ > kMaxPolyVertices || count_ > vertices_.room()) return false;
  if (!massSupported(massInfo_.mass)) return false;

  const S limit(kMaxExtent);
  const std::span<const Vector<S>> core =
      type_ == ShapeType::segment ? vertices().first(min<std::size_t>(2, count_)) : vertices();
  for (const Vector<S>& v : vertices()) {
    if (!within(v, limit + limit)) return false;
  }
  if (!(radius_ >= S(0)) || !sizeSupported(core, radius_)) return false;
  switch (type_) {
    case ShapeType::circle:
      return count_ == 1 && massInfo_ == circleMassInfo(massInfo_.mass, radius_, core[0]);
    case ShapeType::segment:
      return count_ == 4 && core[0] != core[1] &&
             massInfo_ == segmentMassInfo(massInfo_.mass, core[0], core[1], radius_);
    case ShapeType::poly:
      return strictlyConvex(core) && massInfo_ == polyMassInfo(massInfo_.mass, core, radius_);
  }
  return false;
}

namespace {

/// Planes of a segment.
constexpr int kSegmentPlanes = 3;

template <Scalar S>
void prepareSegment(std::span<const Vector<S>> v, Plane<S>* local) {
  const Vector<S> normal = rperp(normalize(v[1] - v[0]));
  local[0] = {v[0], -normal};
  local[1] = {v[1], normal};
  local[2] = {v[2], v[3]};
}

template <Scalar S>
void preparePoly(std::span<const Vector<S>> v, Plane<S>* local) {
  Vector<S> previous = v.back();
  for (const Vector<S>& vertex : v) {
    *local++ = {vertex, rperp(normalize(vertex - previous))};
    previous = vertex;
  }
}

/// True if the second half of the planes is the first turned by 180 degrees, as those of a box around its
/// body's origin, and stays so bit by bit however it is turned: where zero has no sign.
template <Scalar S>
bool halves([[maybe_unused]] const Plane<S>* local, [[maybe_unused]] std::size_t count) {
  if constexpr (FixedNumber<S>) {
    const std::size_t half = count / 2;
    for (std::size_t i = 0; i < half; ++i) {
      if (local[half + i].v0 != -local[i].v0 || local[half + i].n != -local[i].n) return false;
    }
    return count % 2 == 0;
  }
  return false;
}

/// movePlanes for such planes.
template <Scalar S>
BB<S> moveHalves(const Transform<S>& pose, const Plane<S>* local, Plane<S>* world, int count) {
  const Vector<S> turn(pose.a, pose.b), origin(pose.tx, pose.ty);
  const int half = count / 2;
  Vector<S> reach;
  for (int i = 0; i < half; ++i) {
    const Vector<S> v = rotate(local[i].v0, turn), n = rotate(local[i].n, turn);
    world[i] = {origin + v, n};
    world[half + i] = {origin - v, -n};
    reach = {max(reach.x, abs(v.x)), max(reach.y, abs(v.y))};
  }
  return {origin.x - reach.x, origin.y - reach.y, origin.x + reach.x, origin.y + reach.y};
}

/// Moves vertices and normals, and returns the box around the vertices.
template <Scalar S>
BB<S> movePlanes(const Transform<S>& pose, const Plane<S>* local, Plane<S>* world, int count) {
  const Vector<S> turn(pose.a, pose.b), origin(pose.tx, pose.ty);
  const Vector<S> first = rotate(local[0].v0, turn) + origin;
  Vector<S> low = first, high = first;
  world[0].v0 = first;
  // One after the other: both at once need more registers than there are.
  for (int i = 1; i < count; ++i) {
    const Vector<S> v = rotate(local[i].v0, turn) + origin;
    world[i].v0 = v;
    low = {min(low.x, v.x), min(low.y, v.y)};
    high = {max(high.x, v.x), max(high.y, v.y)};
  }
  for (int i = 0; i < count; ++i) world[i].n = rotate(local[i].n, turn);
  return {low.x, low.y, high.x, high.y};
}

}  // namespace

template <Scalar S>
int planeCount(const Shape<S>& shape) {
  switch (shape.type()) {
    case ShapeType::circle:
      return 1;
    case ShapeType::segment:
      return kSegmentPlanes;
    case ShapeType::poly:
      return static_cast<int>(shape.vertices().size());
  }
  return 0;
}

template <Scalar S>
void prepare(const Shape<S>& shape, Plane<S>* local, PlacedShape<S>& out) {
  const std::span<const Vector<S>> v = shape.vertices();
  out.local = local;
  out.type = shape.type();
  out.radius = shape.radius();
  switch (shape.type()) {
    case ShapeType::circle:
      out.count = 1;
      local[0] = {v[0], Vector<S>()};
      break;
    case ShapeType::segment:
      out.count = 2;
      prepareSegment(v, local);
      break;
    case ShapeType::poly:
      out.count = static_cast<std::uint8_t>(v.size());
      preparePoly(v, local);
      out.halved = halves(local, v.size());
      break;
  }
}

template <Scalar S>
BB<S> place(const Transform<S>& pose, PlacedShape<S>& placed) {
  BB<S> core;
  switch (placed.type) {
    case ShapeType::circle: {
      const Vector<S> c = transformPoint(pose, placed.local[0].v0);
      placed.planes[0] = {c, Vector<S>()};
      core = BB<S>(c.x, c.y, c.x, c.y);
      break;
    }
    case ShapeType::segment: {
      const Plane<S>* local = placed.local;
      core = movePlanes(pose, local, placed.planes, 2);
      placed.planes[2] = {transformVect(pose, local[2].v0), transformVect(pose, local[2].n)};
      break;
    }
    case ShapeType::poly:
      core = placed.halved ? moveHalves(pose, placed.local, placed.planes, placed.count)
                           : movePlanes(pose, placed.local, placed.planes, placed.count);
      break;
  }
  return placed.box = inflate(core, placed.radius);
}

template <Scalar S>
BB<S> place(const Shape<S>& shape, const Transform<S>& pose, Plane<S>* local, PlacedShape<S>& out) {
  prepare(shape, local, out);
  return place(pose, out);
}

template <Scalar S>
BB<S> boundingBox(const Shape<S>& shape, const Transform<S>& pose) {
  return Placement<S>(shape, pose)->box;
}

#define SAMESTEP_EACH_SCALAR                                                                 \
  template class VertexList<S>;                                                              \
  template class Shape<S>;                                                                   \
  template int planeCount<S>(const Shape<S>&);                                               \
  template void prepare<S>(const Shape<S>&, Plane<S>*, PlacedShape<S>&);                     \
  template BB<S> place<S>(const Transform<S>&, PlacedShape<S>&);                             \
  template BB<S> place<S>(const Shape<S>&, const Transform<S>&, Plane<S>*, PlacedShape<S>&); \
  template BB<S> boundingBox<S>(const Shape<S>&, const Transform<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
