// SPDX-License-Identifier: MIT
#include "contacts/seams.h"

#include "narrow_phase/clip.h"

namespace samestep {
namespace {

/// Directions whose sine is less than this are one.
template <Scalar S>
inline constexpr S kSameWay = S(0x1p-6);
/// Distance from a contact in which a face must be covered on the side on which it could be open.
template <Scalar S>
inline constexpr S kAlongFace = S(0x1p-6);
/// Number of faces that are tried in place of one that is covered.
constexpr int kMostTries = 4;

template <Scalar S>
bool sameWay(const Vector<S>& a, const Vector<S>& b) {
  return abs(cross(a, b)) <= kSameWay<S> && dot(a, b) > S(0);
}

/// An edge of a still shape, with a coordinate along it.
template <Scalar S>
struct Face {
  Vector<S> from, along, normal;
  S length, radius;

  Face(const PlacedShape<S>& shape, int face)
      : from(shape.planes[(face == 0 ? shape.count : face) - 1].v0),
        along(perp(shape.planes[face].n)),
        normal(shape.planes[face].n),
        length(max(dot(shape.planes[face].v0 - from, along), S(0))),
        radius(shape.radius) {}

  S placeOf(const Vector<S>& point) const { return clamp(dot(point - from, along), S(0), length); }
  /// A little outside of it.
  Vector<S> before(S place) const { return from + along * place + normal * (radius + kSeamGap<S>); }
};

/// Judgement of one contact: the shapes and faces it looks at.
template <Scalar S>
class Seam {
 public:
  Seam(const SeamContacts<S>& all, std::uint32_t which) : all_(all), which_(which), own_(all[which]) {}

  /// The face that the contact is one with, or -1.
  int face() const {
    int best = -1;
    S most(0);
    for (int i = 0; i < own_.still->count; ++i) {
      const Vector<S>& n = own_.still->planes[i].n;
      const S along = dot(n, own_.normal);
      if (along > most && sameWay(n, own_.normal)) {
        most = along;
        best = i;
      }
    }
    return best;
  }

  /// True if all of a face that the given points may touch is covered by others.
  bool isCovered(int index, const Vector<S>* points, int count) const {
    const Face<S> face(*own_.still, index);
    S low = face.placeOf(points[0]), high = low;
    for (int i = 1; i < count; ++i) {
      const S place = face.placeOf(points[i]);
      low = min(low, place);
      high = max(high, place);
    }
    return isCovered(face, low, S(-1)) && isCovered(face, high, S(1));
  }

  /// Tells whether the corner that the contact is at leaves it its direction; else the face of the still
  /// shape to take instead, or -1.
  bool cornerAllows(int& instead) const;

 private:
  /// Tells whether a place of a face is covered; and so, where what covers it ends toward that side, is what
  /// lies beyond: in the corner of a room, floor and wall both go on.
  bool isCovered(const Face<S>& face, S place, S side) const {
    bool covered = false, mayEnd = false;
    const Vector<S> here = face.before(place);
    eachOther(here, [&](const SeamContact<S>& other) {
      if (!covers(other, here)) return;
      covered = true;
      mayEnd = mayEnd || dot(other.normal, face.along) * side > ratio<S>(1, 2);
    });
    if (!covered || !mayEnd) return covered;
    const Vector<S> beyond = face.before(clamp(place + kAlongFace<S> * side, S(0), face.length));
    bool goesOn = false;
    eachOther(beyond, [&](const SeamContact<S>& other) { goesOn = goesOn || covers(other, beyond); });
    return goesOn;
  }

  /// The others whose boxes are around a place.
  template <class Visit>
  void eachOther(const Vector<S>& point, Visit&& visit) const {
    all_.around(point, [&](std::uint32_t i) {
      if (i != which_) visit(all_[i]);
    });
  }
  static bool covers(const SeamContact<S>& other, const Vector<S>& point) {
    return pointQuery(*other.still, point).distance <= kSeamStep<S>;
  }

  const SeamContacts<S>& all_;
  std::uint32_t which_;
  const SeamContact<S>& own_;
};

/// The directions in which a shape may be touched at a place of its surface.
template <Scalar S>
struct OpenDirections {
  bool isThere = false;  ///< True if the place belongs to the shape.
  bool allows = false;   ///< True if the direction asked for is one of them.
  S nearest{-1};         ///< The cosine of the nearest one, of normals of faces.
};

template <Scalar S>
bool isBetween(const Vector<S>& n, const Vector<S>& first, const Vector<S>& second) {
  return cross(first, n) >= -kSameWay<S> && cross(n, second) >= -kSameWay<S> &&
         (dot(first, n) > S(0) || dot(second, n) > S(0) || dot(first, second) < S(0));
}

template <Scalar S>
void lookAtFace(const PlacedShape<S>& shape, int index, const Vector<S>& point, const Vector<S>& n,
                OpenDirections<S>& open) {
  const Face<S> face(shape, index);
  const S above = dot(point - face.from, face.normal), place = dot(point - face.from, face.along);
  if (abs(above) > kSeamStep<S> || place < -kSeamGap<S> || place > face.length + kSeamGap<S>) return;
  open.nearest = max(open.nearest, dot(face.normal, n));
  if (sameWay(face.normal, n)) open.allows = true;
  const int next = index + 1 < shape.count ? index + 1 : 0;
  const Vector<S> toCorner = point - shape.planes[index].v0;
  if (max(abs(toCorner.x), abs(toCorner.y)) > kSeamGap<S>) return;
  if (isBetween(n, face.normal, shape.planes[next].n)) open.allows = true;
}

template <Scalar S>
OpenDirections<S> openDirections(const PlacedShape<S>& shape, const Vector<S>& point, const Vector<S>& n) {
  const PointQueryInfo<S> nearest = pointQuery(shape, point);
  if (nearest.distance > kSeamStep<S>) return {};
  OpenDirections<S> open;
  open.isThere = true;
  if (shape.radius > S(0)) {
    if (nearest.distance < -kSeamStep<S>) return open;
    open.nearest = dot(nearest.gradient, n);
    open.allows = sameWay(nearest.gradient, n);
    return open;
  }
  for (int i = 0; i < shape.count; ++i) lookAtFace(shape, i, point, n, open);
  return open;
}

/// The vertex that is farthest along n.
template <Scalar S>
int farthestVertex(const PlacedShape<S>& shape, const Vector<S>& n) {
  int best = 0;
  for (int i = 1; i < shape.count; ++i) {
    if (exactDot(shape.planes[i].v0 - shape.planes[best].v0, n) > Wide<S>{}) best = i;
  }
  return best;
}

/// Separation of the moving shape from the line of a face.
template <Scalar S>
S separationFrom(const SeamContact<S>& contact, int face) {
  const PlacedShape<S>& moving = *contact.moving;
  const Plane<S>& plane = contact.still->planes[face];
  const int vertex = farthestVertex(moving, -plane.n);
  return dot(moving.planes[vertex].v0 - plane.v0, plane.n) - (moving.radius + contact.still->radius);
}

/// True if the moving shape is on the outer side of a face for the greater part: what is not comes from
/// elsewhere.
template <Scalar S>
bool sticksOut(const SeamContact<S>& contact, int face) {
  const PlacedShape<S>& moving = *contact.moving;
  const Plane<S>& plane = contact.still->planes[face];
  const Vector<S> farthest = moving.planes[farthestVertex(moving, plane.n)].v0;
  const S outside = dot(farthest - plane.v0, plane.n) + (moving.radius - contact.still->radius);
  return outside > max(-separationFrom(contact, face), S(0));
}

template <Scalar S>
bool Seam<S>::cornerAllows(int& instead) const {
  const PlacedShape<S>& shape = *own_.still;
  const int vertex = farthestVertex(shape, own_.normal);
  const Vector<S> point = shape.planes[vertex].v0 + own_.normal * shape.radius;
  bool allowed = true;
  S nearest(-1);
  eachOther(point, [&](const SeamContact<S>& other) {
    const OpenDirections<S> open = openDirections(*other.still, point, own_.normal);
    if (!open.isThere) return;
    allowed = allowed && open.allows;
    nearest = max(nearest, open.nearest);
  });
  if (allowed) return true;
  const int after = vertex + 1 < shape.count ? vertex + 1 : 0;
  const S first = dot(shape.planes[vertex].n, own_.normal), second = dot(shape.planes[after].n, own_.normal);
  instead = -1;
  if (max(first, second) < nearest - kSameWay<S>) return false;
  // A segment's side is the one of its line that both ends came from.
  const bool alike = abs(first - second) <= kSameWay<S>;
  const bool takesFirst = alike ? separationFrom(own_, vertex) > separationFrom(own_, after) : first > second;
  instead = takesFirst ? vertex : after;
  return false;
}

template <Scalar S>
bool touchFaceRound(const SeamContact<S>& contact, int index, CollisionInfo<S>& info) {
  const PlacedShape<S>&moving = *contact.moving, &still = *contact.still;
  const Face<S> face(still, index);
  const Vector<S> offset = moving.center() - face.from;
  const S place = dot(offset, face.along);
  if (place < -kSeamGap<S> || place > face.length + kSeamGap<S>) return false;
  info.normal = face.normal;
  info.push(moving.center() - face.normal * (dot(offset, face.normal) - still.radius),
            moving.center() - face.normal * moving.radius, static_cast<std::uint32_t>(index) << 16);
  return true;
}

/// The contact of the moving shape with a face.
/// @return false where they do not face each other
template <Scalar S>
bool touchOpenFace(const SeamContact<S>& contact, int index, S margin, CollisionInfo<S>& info) {
  info.count = 0;
  if (separationFrom(contact, index) > margin || !sticksOut(contact, index)) return false;
  if (contact.moving->type == ShapeType::circle) return touchFaceRound(contact, index, info);
  const PlacedShape<S>&moving = *contact.moving, &still = *contact.still;
  const Vector<S>& n = still.planes[index].n;
  const SupportEdge<S> facing = edgeAt(moving, farthestVertex(moving, -n), -n);
  return clip(edgeTo(still, index), still.radius, facing, moving.radius, n, margin, info) && info.count > 0;
}

/// The face that the moving shape overlaps least, after those that were tried, or -1.
template <Scalar S>
int nextFace(const SeamContact<S>& contact, std::uint32_t tried) {
  int best = -1;
  S most{};
  for (int i = 0; i < contact.still->count; ++i) {
    if ((tried >> i & 1u) != 0) continue;
    const S separation = separationFrom(contact, i);
    if (best >= 0 && separation <= most) continue;
    best = i;
    most = separation;
  }
  return best;
}

template <Scalar S>
bool isOpenFace(const Seam<S>& seam, int face, const CollisionInfo<S>& info) {
  Vector<S> points[kMaxContactsPerPair];
  for (int i = 0; i < info.count; ++i) points[i] = info.points[i].pointA;
  return !seam.isCovered(face, points, info.count);
}

}  // namespace

template <Scalar S>
void SeamContacts<S>::sort() {
  BB<S> corners = entries_.front().contact.still->box;
  // A box is sorted by its lower left corner.
  corners.right = corners.left;
  corners.top = corners.bottom;
  for (const Entry& entry : entries_) {
    const BB<S>& box = entry.contact.still->box;
    corners = {min(corners.left, box.left), min(corners.bottom, box.bottom), max(corners.right, box.left),
               max(corners.top, box.bottom)};
  }
  byX_ = corners.right - corners.left >= corners.top - corners.bottom;
  for (Entry& entry : entries_) {
    const BB<S>& box = entry.contact.still->box;
    entry.low = byX_ ? box.left : box.bottom;
    entry.high = byX_ ? box.right : box.top;
  }
  const auto before = [](const Entry& x, const Entry& y) {
    return x.low != y.low ? x.low < y.low : x.number < y.number;
  };
  std::sort(entries_.begin(), entries_.end(), before);  // total order: each has a number of its own
  S highest = entries_.front().high;
  for (Entry& entry : entries_) entry.highest = highest = max(highest, entry.high);
}

template <Scalar S>
SeamVerdict judgeSeam(const SeamContacts<S>& all, std::uint32_t which, S margin, CollisionInfo<S>& info) {
  const SeamContact<S>& contact = all[which];
  if (contact.still->type == ShapeType::circle) return SeamVerdict::stays;
  const Seam<S> seam(all, which);
  const int face = seam.face();
  std::uint32_t tried = 0;
  int instead = -1;
  if (face >= 0) {
    if (!seam.isCovered(face, contact.points, contact.count)) return SeamVerdict::stays;
    tried = 1u << face;
    instead = nextFace(contact, tried);
  } else if (seam.cornerAllows(instead)) {
    return SeamVerdict::stays;
  }
  for (int i = 0; i < kMostTries && instead >= 0; ++i) {
    // Before a face that it does not face a shape is held by what covers the first one.
    if (!touchOpenFace(contact, instead, margin, info)) break;
    if (isOpenFace(seam, instead, info)) return SeamVerdict::changes;
    // A corner has no other face to offer.
    if (face < 0) break;
    tried |= 1u << instead;
    instead = nextFace(contact, tried);
  }
  return SeamVerdict::goes;
}

#define SAMESTEP_EACH_SCALAR      \
  template class SeamContacts<S>; \
  template SeamVerdict judgeSeam<S>(const SeamContacts<S>&, std::uint32_t, S, CollisionInfo<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
