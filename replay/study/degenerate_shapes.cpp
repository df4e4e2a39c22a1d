// SPDX-License-Identifier: MIT
#include "study/degenerate_shapes.h"

#include <cstring>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

namespace samestep {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 32;

constexpr RawPoint kOrigin[] = {{0, 0}};
constexpr RawPoint kHair[] = {{0, 0}, {1, 0}};
constexpr RawPoint kLine[] = {{-kOne, 0}, {kOne, 0}};
constexpr RawPoint kHorizon[] = {{-16384 * kOne, 0}, {16384 * kOne, 0}};
constexpr RawPoint kBox[] = {
    {kOne / 2, -kOne / 2}, {kOne / 2, kOne / 2}, {-kOne / 2, kOne / 2}, {-kOne / 2, -kOne / 2}};
constexpr RawPoint kNeedle[] = {{-128 * kOne, 0}, {128 * kOne, -2048}, {128 * kOne, 2048}};
constexpr RawPoint kSliver[] = {{-kOne, 0}, {kOne, 0}, {0, 1}};
constexpr RawPoint kDust[] = {{0, 0}, {2, 0}, {0, 2}};
constexpr RawPoint kPlank[] = {
    {200 * kOne, -kOne / 64}, {200 * kOne, kOne / 64}, {-200 * kOne, kOne / 64}, {-200 * kOne, -kOne / 64}};
constexpr RawPoint kGiant[] = {{11585 * kOne, -11585 * kOne},
                               {11585 * kOne, 11585 * kOne},
                               {-11585 * kOne, 11585 * kOne},
                               {-11585 * kOne, -11585 * kOne}};
constexpr RawPoint kCutCorner[] = {{kOne / 2, -kOne / 2},
                                   {kOne / 2, kOne / 2 - 1},
                                   {kOne / 2 - 1, kOne / 2},
                                   {-kOne / 2, kOne / 2},
                                   {-kOne / 2, -kOne / 2}};
constexpr RawPoint kBulge[] = {{kOne / 2, -kOne / 2},
                               {kOne / 2, kOne / 2},
                               {0, kOne / 2 + 1},
                               {-kOne / 2, kOne / 2},
                               {-kOne / 2, -kOne / 2}};
constexpr RawPoint kLeaning[] = {
    {kOne / 2, -kOne / 2}, {kOne / 2, kOne / 2 + 4}, {-kOne / 2, kOne / 2}, {-kOne / 2, -kOne / 2}};
constexpr RawPoint kBlade[] = {{-64 * kOne, 0}, {0, -3}, {64 * kOne, 0}, {0, 3}};
constexpr RawPoint kOffCentre[] = {
    {200 * kOne + kOne / 8, 0}, {200 * kOne, kOne / 8}, {200 * kOne - kOne / 8, 0}, {200 * kOne, -kOne / 8}};

constexpr RawPoint kInsideOut[] = {{32, 32}, {2611340116437, -1}, {78, 32}};
constexpr RawPoint kThorn[] = {{-1, -1}, {1002438656, -59649}, {0, -1}};
constexpr RawPoint kSpindle[] = {{-1, -8430215495680}, {32, 78}, {32, 2611340116437}, {-1, 32}};
constexpr RawPoint kAslant[] = {{0, 2465}, {92, 1024 * kOne - 86}};

/// A convex arc of 32 vertices, each edge turned by less than the last: no two are alike in length.
constexpr RawPoint kArc[] = {
    {0, 0},
    {32 * kOne, 1},
    {63 * kOne, 1 + kOne / 1024},
    {93 * kOne, 1 + 3 * (kOne / 1024)},
    {122 * kOne, 1 + 6 * (kOne / 1024)},
    {150 * kOne, 1 + 10 * (kOne / 1024)},
    {177 * kOne, 1 + 15 * (kOne / 1024)},
    {203 * kOne, 1 + 21 * (kOne / 1024)},
    {203 * kOne, 1 + 22 * (kOne / 1024)},
};
constexpr RawPoint kWheel[] = {
    {4294967296, 0},
    {4212440704, 837914551},
    {3968032378, 1643612827},
    {3571134792, 2386155981},
    {3037000500, 3037000500},
    {2386155981, 3571134792},
    {1643612827, 3968032378},
    {837914551, 4212440704},
    {0, 4294967296},
    {-837914551, 4212440704},
    {-1643612827, 3968032378},
    {-2386155981, 3571134792},
    {-3037000500, 3037000500},
    {-3571134792, 2386155981},
    {-3968032378, 1643612827},
    {-4212440704, 837914551},
    {-4294967296, 0},
    {-4212440704, -837914551},
    {-3968032378, -1643612827},
    {-3571134792, -2386155981},
    {-3037000500, -3037000500},
    {-2386155981, -3571134792},
    {-1643612827, -3968032378},
    {-837914551, -4212440704},
    {0, -4294967296},
    {837914551, -4212440704},
    {1643612827, -3968032378},
    {2386155981, -3571134792},
    {3037000500, -3037000500},
    {3571134792, -2386155981},
    {3968032378, -1643612827},
    {4212440704, -837914551},
};

enum Number {
  kPointCircle,
  kSpeck,
  kBall,
  kMoon,
  kHairSegment,
  kLineSegment,
  kFatLine,
  kHorizonSegment,
  kBoxPoly,
  kRoundBox,
  kNeedlePoly,
  kRoundNeedle,
  kSliverPoly,
  kDustPoly,
  kRoundDust,
  kPlankPoly,
  kGiantPoly,
  kCutCornerPoly,
  kBulgePoly,
  kLeaningPoly,
  kBladePoly,
  kOffCentrePoly,
  kArcPoly,
  kWheelPoly,
  kInsideOutPoly,
  kThornPoly,
  kSpindlePoly,
  kAslantSegment,
};

constexpr NastyShape kShapes[] = {
    {"point", "a circle without radius", ShapeType::circle, 0, kOrigin},
    {"speck", "a circle of the least radius", ShapeType::circle, 1, kOrigin},
    {"ball", "a circle of half a metre", ShapeType::circle, kOne / 2, kOrigin},
    {"moon", "the largest circle", ShapeType::circle, 16384 * kOne, kOrigin},
    {"hair", "the shortest segment", ShapeType::segment, 0, kHair},
    {"line", "a segment of two metres", ShapeType::segment, 0, kLine},
    {"fat line", "the same, rounded", ShapeType::segment, kOne / 4, kLine},
    {"horizon", "the longest segment", ShapeType::segment, 0, kHorizon},
    {"box", "a box of a metre", ShapeType::poly, 0, kBox},
    {"round box", "the same, rounded", ShapeType::poly, kOne / 8, kBox},
    {"needle", "256 m long, 2^-20 m wide", ShapeType::poly, 0, kNeedle},
    {"round needle", "the same, rounded by one unit", ShapeType::poly, 1, kNeedle},
    {"sliver", "two metres long, one unit high", ShapeType::poly, 0, kSliver},
    {"dust", "a triangle of two units", ShapeType::poly, 0, kDust},
    {"round dust", "the same, rounded by a metre", ShapeType::poly, kOne, kDust},
    {"plank", "400 m by 1/32 m", ShapeType::poly, 0, kPlank},
    {"giant", "a box as large as a shape may be", ShapeType::poly, 0, kGiant},
    {"cut corner", "a box with an edge of a unit for a corner", ShapeType::poly, 0, kCutCorner},
    {"bulge", "a box with a vertex a unit above a face", ShapeType::poly, 0, kBulge},
    {"leaning", "a box with one face 4 units from parallel", ShapeType::poly, 0, kLeaning},
    {"blade", "128 m long, 6 units wide, tips at both ends", ShapeType::poly, 0, kBlade},
    {"off centre", "a small square 200 m from its body", ShapeType::poly, 0, kOffCentre},
    {"arc", "edges that turn by 2^-15 rad from one to the next", ShapeType::poly, 0, kArc},
    {"wheel", "32 vertices on a circle of a metre", ShapeType::poly, 0, kWheel},
    {"inside out", "608 m long, 46 units wide: rounding turns it inside out", ShapeType::poly, 0, kInsideOut},
    {"thorn", "0.23 m long, its short edge one unit", ShapeType::poly, 0, kThorn},
    {"spindle", "2570 m long, 33 units wide, edges in line two by two", ShapeType::poly, 64, kSpindle},
    {"aslant", "a segment that leans by 92 units in a kilometre", ShapeType::segment, 0, kAslant},
};

constexpr RawPoint kZero = {0, 0};
constexpr std::int64_t kQuarter = 6746518852;  // pi / 2

constexpr NastyPair kPairs[] = {
    {"same box twice", "every feature coincides", kBoxPoly, kZero, 0, kBoxPoly, kZero, 0, true},
    {"same wheel twice", "every feature coincides", kWheelPoly, kZero, 0, kWheelPoly, kZero, 0, true},
    {"same line twice", "every feature coincides", kLineSegment, kZero, 0, kLineSegment, kZero, 0, true},
    {"same ball twice", "no direction between the centres", kBall, kZero, 0, kBall, kZero, 0, true},
    {"corner on corner", "one point in common", kBoxPoly, kZero, 0, kBoxPoly, {kOne, kOne}, 0, true},
    {"corner missed",
     "one unit apart at a corner",
     kBoxPoly,
     kZero,
     0,
     kBoxPoly,
     {kOne + 1, kOne + 1},
     0,
     false},
    {"faces meet", "no overlap, no gap", kBoxPoly, kZero, 0, kBoxPoly, {kOne, 0}, 0, true},
    {"faces missed", "one unit apart", kBoxPoly, kZero, 0, kBoxPoly, {kOne + 1, 0}, 0, false},
    {"nearly parallel",
     "a face 2^-30 rad from the other",
     kBoxPoly,
     kZero,
     0,
     kLeaningPoly,
     {0, -kOne},
     0,
     true},
    {"bulge on face", "a vertex of one unit in a face", kBulgePoly, kZero, 0, kBoxPoly, {0, kOne}, 0, true},
    {"cut on cut",
     "edges of one unit towards each other",
     kCutCornerPoly,
     kZero,
     0,
     kCutCornerPoly,
     {kOne - 1, kOne - 1},
     2 * kQuarter,
     true},
    {"needle in wheel",
     "a tip through the middle",
     kNeedlePoly,
     {128 * kOne, 0},
     0,
     kWheelPoly,
     kZero,
     0,
     true},
    {"needle on needle",
     "two tips in one place",
     kNeedlePoly,
     {128 * kOne, 0},
     0,
     kNeedlePoly,
     {-128 * kOne, 0},
     2 * kQuarter,
     true},
    {"blade across blade", "a cross of two slivers", kBladePoly, kZero, 0, kBladePoly, kZero, kQuarter, true},
    {"sliver along box", "lies in a face", kSliverPoly, {0, kOne / 2}, 0, kBoxPoly, kZero, 0, true},
    {"dust in giant",
     "huge beside tiny",
     kDustPoly,
     {5000 * kOne, 5000 * kOne},
     0,
     kGiantPoly,
     kZero,
     0,
     true},
    {"dust on giant",
     "huge beside tiny, on a face",
     kDustPoly,
     {11585 * kOne, 77 * kOne},
     0,
     kGiantPoly,
     kZero,
     0,
     true},
    {"speck on moon",
     "the smallest on the largest circle",
     kSpeck,
     {16384 * kOne, 0},
     0,
     kMoon,
     kZero,
     0,
     true},
    {"point on line", "a centre on a segment", kPointCircle, kZero, 0, kFatLine, kZero, 0, true},
    {"ball on end", "a centre on the end of a segment", kBall, {kOne, 0}, 0, kLineSegment, kZero, 0, true},
    {"ball on corner", "a centre on a vertex", kBall, {kOne / 2, kOne / 2}, 0, kBoxPoly, kZero, 0, true},
    {"ball in middle", "as deep as can be", kBall, kZero, 0, kBoxPoly, kZero, 0, true},
    {"lines end to end",
     "collinear, one point in common",
     kLineSegment,
     kZero,
     0,
     kLineSegment,
     {2 * kOne, 0},
     0,
     true},
    {"lines along each other",
     "collinear, half in common",
     kLineSegment,
     kZero,
     0,
     kLineSegment,
     {kOne, 0},
     0,
     true},
    {"lines across", "cross in the middle", kLineSegment, kZero, 0, kLineSegment, kZero, kQuarter, true},
    {"hair on horizon",
     "the shortest on the longest",
     kHairSegment,
     {9000 * kOne, 0},
     0,
     kHorizonSegment,
     kZero,
     0,
     true},
    {"edge of the world",
     "at the default limit",
     kBoxPoly,
     {32768 * kOne, -32768 * kOne},
     kOne / 3,
     kBoxPoly,
     {32768 * kOne - kOne / 2, -32768 * kOne},
     kOne,
     true},
    {"far corners",
     "at opposite ends of the largest world",
     kGiantPoly,
     {1048576 * kOne, 1048576 * kOne},
     0,
     kGiantPoly,
     {-1048576 * kOne, -1048576 * kOne},
     0,
     false},
    {"off centre",
     "turned 200 m from its body",
     kOffCentrePoly,
     kZero,
     kOne,
     kOffCentrePoly,
     {kOne / 16, 0},
     kOne,
     true},
    {"moon round a tip",
     "the tip of a sliver inside a circle",
     kInsideOutPoly,
     {16, 16},
     78,
     kMoon,
     {-1786706394652, 15},
     0,
     true},
    {"thorn before thorn",
     "tips apart, edges of one unit towards each other",
     kThornPoly,
     {1936946035, 1936946035},
     3 * kQuarter + 1936946035,
     kThornPoly,
     {2 * 1936946035LL, 2 * 1936946035LL},
     kQuarter + 2096329587,
     false},
    {"spindle along a line",
     "all edges in one line to some units",
     kSpindlePoly,
     {0, 13},
     0,
     kAslantSegment,
     {105, 2616},
     2 * kQuarter,
     true},
    {"arc on plank",
     "many nearly parallel edges",
     kArcPoly,
     {-100 * kOne, kOne / 64},
     0,
     kPlankPoly,
     kZero,
     0,
     true},
};

template <Scalar S>
std::vector<Vector<S>> pointsOf(const NastyShape& shape) {
  std::vector<Vector<S>> points;
  for (const RawPoint& p : shape.points) points.push_back(fromUnits<S>(p));
  return points;
}

}  // namespace

std::span<const NastyShape> nastyShapes() { return kShapes; }
std::span<const NastyPair> nastyPairs() { return kPairs; }

int findNastyShape(const char* name) {
  for (int i = 0; i < static_cast<int>(std::size(kShapes)); ++i) {
    if (std::strcmp(kShapes[i].name, name) == 0) return i;
  }
  return -1;
}

template <Scalar S>
Shape<S> makeNasty(const NastyShape& shape, BodyId body) {
  const std::vector<Vector<S>> points = pointsOf<S>(shape);
  const S radius = fromUnits<S>(shape.radius);
  switch (shape.type) {
    case ShapeType::circle:
      return circleShape(body, radius, points[0]);
    case ShapeType::segment:
      return segmentShape(body, points[0], points[1], radius);
    case ShapeType::poly:
      break;
  }
  return polyShapeRaw<S>(body, points, radius);
}

#define SAMESTEP_EACH_SCALAR template Shape<S> makeNasty<S>(const NastyShape&, BodyId);
#include <samestep/each_scalar.h>

}  // namespace samestep
