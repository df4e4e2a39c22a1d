// SPDX-License-Identifier: MIT
#include "distance.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

namespace samestep::fuzz {
namespace {

__extension__ typedef __int128 Int128;

/// The number type that holds a product of two differences: exactly for Fixed.
template <Scalar S>
using Product = std::conditional_t<std::is_same_v<S, double>, double, Int128>;

template <Scalar S>
auto rawOf(S x) {
  if constexpr (kIsFixed<S>) {
    return Int128{x.raw()};
  } else {
    return x;
  }
}
template <Scalar S>
Product<S> crossOf(const Vector<S>& a, const Vector<S>& b) {
  return rawOf(a.x) * rawOf(b.y) - rawOf(a.y) * rawOf(b.x);
}
template <Scalar S>
Product<S> dotOf(const Vector<S>& a, const Vector<S>& b) {
  return rawOf(a.x) * rawOf(b.x) + rawOf(a.y) * rawOf(b.y);
}
template <Scalar S>
double squareMetres(Product<S> product) {
  return static_cast<double>(product) * (kIsFixed<S> ? 0x1p-64 : 1.0);
}
template <Scalar S>
double lengthOf(const Vector<S>& v) {
  const double x = static_cast<double>(v.x), y = static_cast<double>(v.y);
  const double square = x * x + y * y;
  return square > 0x1p-900 ? std::sqrt(square) : std::hypot(x, y);
}

/// Visits the edges with the outside to their right; of a segment both sides, of a circle none.
template <Scalar S, class Visit>
void eachEdge(const Vector<S>* points, int count, Visit&& visit) {
  if (count < 2) return;
  for (int i = 0; i < count; ++i) {
    const Vector<S>&from = points[i == 0 ? count - 1 : i - 1], &to = points[i];
    if (from != to) visit(from, to);
  }
}

/// The faces of both cores, one core after the other.
template <Scalar S>
struct FaceTrial {
  BruteAnswer& answer;
  double size;  ///< Size of the pair, m.
  double unit;  ///< Distance by which rounding may have moved a vertex, m.
  double bestDoubt = 0;
  double farthest = -1e300;  ///< Distance of the farthest face, at most.

  void tryAll(const Vector<S>* points, int count, const Vector<S>* others, int otherCount);
};

template <Scalar S>
void FaceTrial<S>::tryAll(const Vector<S>* points, int count, const Vector<S>* others, int otherCount) {
  eachEdge(points, count, [&](const Vector<S>& from, const Vector<S>& to) {
    const Vector<S> edge = to - from;
    Product<S> least = crossOf(others[0] - from, edge);
    for (int i = 1; i < otherCount; ++i) least = std::min(least, crossOf(others[i] - from, edge));
    // Rounding may turn the smallest polygons inside out, so the own vertices count as well.
    Product<S> most = 0;
    for (int i = 0; i < count; ++i) most = std::max(most, crossOf(points[i] - from, edge));
    const double length = lengthOf(edge), apart = squareMetres<S>(least - most) / length;
    // The face may be so far where rounding may have turned the edge.
    const double doubt = size * std::min(1.0, unit / length);
    if (apart > answer.bestFace) {
      answer.lead = apart - doubt - std::max(answer.bestFace, farthest);
      answer.bestFace = apart;
      bestDoubt = doubt;
    } else {
      answer.lead = std::min(answer.lead, answer.bestFace - bestDoubt - (apart + doubt));
    }
    farthest = std::max(farthest, apart + doubt);
  });
}

template <Scalar S>
double distanceToEdge(const Vector<S>& from, const Vector<S>& to, const Vector<S>& p, bool& corner) {
  const Vector<S> edge = to - from;
  corner = true;
  if (dotOf(edge, p - from) <= 0) return lengthOf(p - from);
  if (dotOf(edge, p - to) >= 0) return lengthOf(p - to);
  corner = false;
  return std::fabs(squareMetres<S>(crossOf(p - from, edge))) / lengthOf(edge);
}

template <Scalar S>
void tryVertices(const Vector<S>* points, int count, const Vector<S>* others, int otherCount,
                 BruteAnswer& answer) {
  for (int i = 0; i < otherCount; ++i) {
    const auto closer = [&](double distance, bool corner) {
      if (distance > answer.distance) return;
      answer.corners = corner && (distance < answer.distance || answer.corners);
      answer.distance = distance;
    };
    closer(lengthOf(others[i] - points[0]), true);
    eachEdge(points, count, [&](const Vector<S>& from, const Vector<S>& to) {
      bool corner = false;
      const double distance = distanceToEdge(from, to, others[i], corner);
      closer(distance, corner);
    });
  }
}

/// True if vertices go round an area counter-clockwise, once, without a dent.
bool isConvex(const Vector<Fixed>* points, int count) {
  bool area = false;
  for (int i = 1; i < count; ++i) {
    const Vector<Fixed>&from = points[i - 1], &to = points[i];
    if (crossOf(to - from, points[i + 1 < count ? i + 1 : 0] - to) < 0) return false;
    const Int128 fan = crossOf(from - points[0], to - points[0]);
    if (fan < 0) return false;
    area = area || fan > 0;
  }
  return area;
}

}  // namespace

int makeConvex(Vector<Fixed>* points, int count) {
  std::sort(points, points + count, [](const Vector<Fixed>& a, const Vector<Fixed>& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;  // total order: equal points are the same.
  });
  Vector<Fixed> chain[2 * kMaxPolyVertices];
  int kept = 0;
  const auto add = [&](const Vector<Fixed>& p, int least) {
    while (kept >= least + 2 && crossOf(chain[kept - 1] - chain[kept - 2], p - chain[kept - 1]) <= 0) --kept;
    chain[kept++] = p;
  };
  for (int i = 0; i < count; ++i) add(points[i], 0);
  const int lower = kept - 1;
  for (int i = count - 2; i >= 0; --i) add(points[i], lower);
  // The first point closes the chain; points that are all one do not turn it.
  while (kept > 1 && chain[kept - 1] == chain[0]) --kept;
  std::copy(chain, chain + kept, points);
  return kept;
}

template <Scalar S>
Cores<S>::Cores(const PlacedShape<S>& first, const PlacedShape<S>& second) {
  const auto vertex = [](const PlacedShape<S>& shape, int i) { return shape.planes[i].v0; };
  countA = first.count;
  countB = second.count;
  origin = vertex(first, 0);
  const auto take = [&](const PlacedShape<S>& shape, Vector<S>* to) {
    for (int i = 0; i < shape.count; ++i) {
      to[i] = vertex(shape, i) - origin;
      size =
          std::max({size, std::fabs(static_cast<double>(to[i].x)), std::fabs(static_cast<double>(to[i].y))});
    }
  };
  take(first, a);
  take(second, b);
  for (const auto& [points, count] : {std::pair(a, countA), std::pair(b, countB)}) {
    int edges = 0;
    eachEdge(points, count, [&](const Vector<S>& from, const Vector<S>& to) {
      shortest = std::min(shortest, lengthOf(to - from));
      ++edges;
    });
    doubled = doubled || (count > 2 && edges < count);
  }
  if constexpr (std::is_same_v<S, Fixed>) {
    // Rounding may turn a thin polygon inside out; collide sees its vertices.
    for (auto [points, count] : {std::pair(a, &countA), std::pair(b, &countB)}) {
      if (*count <= 2 || isConvex(points, *count)) continue;
      *count = makeConvex(points, *count);
      dented = true;
    }
  }
  size *= 2;
  reach = size + std::fabs(static_cast<double>(origin.x)) + std::fabs(static_cast<double>(origin.y));
}

template <Scalar S>
BruteAnswer bruteDistance(const Cores<S>& cores, double limit) {
  BruteAnswer answer;
  FaceTrial<S> faces{answer, cores.size, kIsFixed<S> ? 0x1p-31 : cores.reach * 0x1p-51};
  faces.tryAll(cores.a, cores.countA, cores.b, cores.countB);
  faces.tryAll(cores.b, cores.countB, cores.a, cores.countA);
  answer.distance = answer.bestFace;
  // A dent leaves faces in line of which the hull knows only one.
  if (cores.dented) answer.lead = 0;
  // Cores without area between them may be apart along a line that no face is across.
  const bool flat = cores.countA <= 2 && cores.countB <= 2;
  const bool noFaces = answer.bestFace == -1e300;
  if (!noFaces && (answer.bestFace > limit || answer.bestFace < 0 || (answer.bestFace == 0 && !flat))) {
    return answer;
  }
  answer.distance = 1e300;
  tryVertices(cores.a, cores.countA, cores.b, cores.countB, answer);
  tryVertices(cores.b, cores.countB, cores.a, cores.countA, answer);
  if (flat && answer.bestFace == 0 && cores.countA == 2 && cores.countB == 2) {
    // Two segments: all that touch lie in one line, or an end of one is on the other.
    answer.lead = 0;
  }
  return answer;
}

template <Scalar S>
double separationAlong(const Cores<S>& cores, const Vector<S>& normal) {
  Product<S> most = dotOf(cores.a[0], normal), least = dotOf(cores.b[0], normal);
  for (int i = 1; i < cores.countA; ++i) most = std::max(most, dotOf(cores.a[i], normal));
  for (int i = 1; i < cores.countB; ++i) least = std::min(least, dotOf(cores.b[i], normal));
  return squareMetres<S>(least - most);
}

template <Scalar S>
double widthTowards(const Vector<S>* points, int count, const Vector<S>& direction) {
  if (count < 2) return 1;
  int tip = 0;
  for (int i = 1; i < count; ++i) {
    if (dotOf(points[i], direction) > dotOf(points[tip], direction)) tip = i;
  }
  double width = 0;
  for (const int other : {tip == 0 ? count - 1 : tip - 1, tip + 1 < count ? tip + 1 : 0}) {
    const Vector<S> edge = points[other] - points[tip];
    const double across = std::fabs(squareMetres<S>(crossOf(edge, direction)));
    if (across > 0x1p-24) width = std::max(width, across / lengthOf(edge));
  }
  return width;
}

/// Reach of points across an edge, times its length.
template <Scalar S>
double areaAcross(const Vector<S>* points, int count, const Vector<S>& edge) {
  Product<S> low = crossOf(points[0], edge), high = low;
  for (int i = 1; i < count; ++i) {
    low = std::min(low, crossOf(points[i], edge));
    high = std::max(high, crossOf(points[i], edge));
  }
  return squareMetres<S>(high - low);
}

template <Scalar S>
double leastWidth(const Cores<S>& cores) {
  if (cores.narrowest >= 0) return cores.narrowest;
  double least = 1e300;
  for (const auto& [points, count] : {std::pair(cores.a, cores.countA), std::pair(cores.b, cores.countB)}) {
    if (count < 3) continue;
    eachEdge(points, count, [&, own = points, size = count](const Vector<S>& from, const Vector<S>& to) {
      least = std::min(least, areaAcross(own, size, to - from) / lengthOf(to - from));
    });
  }
  cores.narrowest = least;
  return least;
}

template <Scalar S>
double thickness(const Cores<S>& cores) {
  double least = 1e300;
  for (const auto& [points, count] : {std::pair(cores.a, cores.countA), std::pair(cores.b, cores.countB)}) {
    eachEdge(points, count, [&](const Vector<S>& from, const Vector<S>& to) {
      const Vector<S> edge = to - from;
      const double width = areaAcross(cores.a, cores.countA, edge) + areaAcross(cores.b, cores.countB, edge);
      least = std::min(least, width / lengthOf(edge));
    });
  }
  return least;
}

template <Scalar S>
double distanceToCore(const Vector<S>* points, int count, const Vector<S>& p) {
  double outside = -1e300, nearest = lengthOf(p - points[0]);
  bool corner = false;
  eachEdge(points, count, [&](const Vector<S>& from, const Vector<S>& to) {
    outside = std::max(outside, squareMetres<S>(crossOf(p - from, to - from)) / lengthOf(to - from));
    nearest = std::min(nearest, distanceToEdge(from, to, p, corner));
  });
  return outside <= 0 && count > 2 ? 0 : nearest;
}

namespace {

struct RationalVector {
  mpq_class x, y;
};
RationalVector operator-(const RationalVector& a, const RationalVector& b) { return {a.x - b.x, a.y - b.y}; }
mpq_class crossOf(const RationalVector& a, const RationalVector& b) { return a.x * b.y - a.y * b.x; }
mpq_class dotOf(const RationalVector& a, const RationalVector& b) { return a.x * b.x + a.y * b.y; }

mpq_class sizeOf(const RationalVector& v) { return dotOf(v, v); }

template <Scalar S>
std::vector<RationalVector> rational(const Vector<S>* points, int count) {
  std::vector<RationalVector> result;
  for (int i = 0; i < count; ++i) {
    // Differences of at most 2^21 m: exact in double.
    result.push_back(
        {mpq_class(static_cast<double>(points[i].x)), mpq_class(static_cast<double>(points[i].y))});
  }
  return result;
}

/// A signed length as the sign and the square.
struct SignedSquare {
  int sign;
  mpq_class square;
};
bool operator<(const SignedSquare& a, const SignedSquare& b) {
  if (a.sign != b.sign) return a.sign < b.sign;
  return a.sign > 0 ? a.square < b.square : b.square < a.square;
}
SignedSquare signedSquare(const mpq_class& x) { return {sgn(x), x * x}; }

void rationalFaces(const std::vector<RationalVector>& points, const std::vector<RationalVector>& others,
                   SignedSquare& best) {
  for (std::size_t i = 0; points.size() > 1 && i < points.size(); ++i) {
    const RationalVector &to = points[i], &from = points[i == 0 ? points.size() - 1 : i - 1];
    const RationalVector edge = to - from;
    const mpq_class size = sizeOf(edge);
    if (size == 0) continue;
    mpq_class least = crossOf(others[0] - from, edge);
    for (const RationalVector& p : others) least = std::min(least, crossOf(p - from, edge));
    const SignedSquare apart = {sgn(least), least * least / size};
    if (best < apart) best = apart;
  }
}

mpq_class rationalNearest(const std::vector<RationalVector>& points,
                          const std::vector<RationalVector>& others) {
  mpq_class nearest = sizeOf(others[0] - points[0]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RationalVector &to = points[i], &from = points[i == 0 ? points.size() - 1 : i - 1];
    const RationalVector edge = to - from;
    const mpq_class size = sizeOf(edge);
    for (const RationalVector& p : others) {
      nearest = std::min(nearest, sizeOf(p - to));
      if (size == 0 || dotOf(edge, p - from) <= 0 || dotOf(edge, p - to) >= 0) continue;
      const mpq_class across = crossOf(p - from, edge);
      nearest = std::min(nearest, mpq_class(across * across / size));
    }
  }
  return nearest;
}

}  // namespace

template <Scalar S>
bool nearExactDistance(const Cores<S>& cores, double distance, double tolerance) {
  const auto a = rational(cores.a, cores.countA), b = rational(cores.b, cores.countB);
  SignedSquare exact{-2, 0};
  rationalFaces(a, b, exact);
  rationalFaces(b, a, exact);
  if (exact.sign == -2 || exact.sign > 0 || (exact.sign == 0 && a.size() <= 2 && b.size() <= 2)) {
    const mpq_class nearest = std::min(rationalNearest(a, b), rationalNearest(b, a));
    exact = {sgn(nearest), nearest};
  }
  return !(exact < signedSquare(mpq_class(distance) - mpq_class(tolerance))) &&
         !(signedSquare(mpq_class(distance) + mpq_class(tolerance)) < exact);
}

template struct Cores<double>;
template struct Cores<Fixed>;
template BruteAnswer bruteDistance<double>(const Cores<double>&, double);
template BruteAnswer bruteDistance<Fixed>(const Cores<Fixed>&, double);
template double separationAlong<double>(const Cores<double>&, const Vector<double>&);
template double separationAlong<Fixed>(const Cores<Fixed>&, const Vector<Fixed>&);
template double widthTowards<double>(const Vector<double>*, int, const Vector<double>&);
template double widthTowards<Fixed>(const Vector<Fixed>*, int, const Vector<Fixed>&);
template double leastWidth<double>(const Cores<double>&);
template double leastWidth<Fixed>(const Cores<Fixed>&);
template double thickness<double>(const Cores<double>&);
template double thickness<Fixed>(const Cores<Fixed>&);
template double distanceToCore<double>(const Vector<double>*, int, const Vector<double>&);
template double distanceToCore<Fixed>(const Vector<Fixed>*, int, const Vector<Fixed>&);
template bool nearExactDistance<double>(const Cores<double>&, double, double);
template bool nearExactDistance<Fixed>(const Cores<Fixed>&, double, double);

}  // namespace samestep::fuzz
