// SPDX-License-Identifier: MIT
// Makes a client emit its own copy of every inline function that computes with double, under its own flags.
// If the library called one of them instead of inlining it, the linker could give it this copy.
#ifndef SAMESTEP_FIXED_ONLY
#include <samestep/bb.h>
#include <samestep/control.h>
#include <samestep/limits.h>
#include <samestep/math.h>
#include <samestep/transform.h>
#include <samestep/vector.h>

namespace samestep {

using D = double;
using V = Vector<double>;
using T = Transform<double>;
using B = BB<double>;

// The arrays have external linkage, so that the compiler must keep what they name.
D (*hostile1[])(D, D, D) = {mulAdd, mulDiv, clamp<D>, lerp<D>, lerpConst<D>};
D (*hostile2[])(D, D, D, D) = {dot, cross, exactDot, exactCross};
D (*hostile3)(D, D, D, D, D, D) = dot3;
D (*hostile4)(D, D, D, D, D, D, D, D) = dot4;
D (*hostile5[])(const V&, const V&) = {dot<D>, cross<D>, distanceSq<D>, distance<D>};
V (*hostile6[])(const V&, const V&) = {rotate<D>, unrotate<D>, project<D>};
V (*hostile7)(const V&, D, const V&) = mulAdd<D>;
D (*hostile8[])(const V&) = {lengthSq<D>, length<D>, toAngle<D>};
V (*hostile9)(const V&) = normalize<D>;
V (*hostile10)(const V&, D) = clampLength<D>;
V (*hostile11)(const V&, const V&, D) = lerp<D>;
V (*hostile12)(D) = forAngle<D>;
bool (*hostile13)(const V&, const V&, D) = near<D>;
V (*hostile14[])(const T&, const V&) = {transformPoint<D>, transformVect<D>};
T (*hostile15)(const T&, const T&) = operator*<D>;
T (*hostile16[])(const T&) = {inverse<D>, rigidInverse<D>};
B (*hostile17)(const T&, const B&) = transformBB<D>;
B (*hostile18[])(const B&, const B&) = {merge<D>};
V (*hostile19)(const B&) = center<D>;
D (*hostile20[])(const B&) = {area<D>, halfPerimeter<D>};
D (*hostile21)(const B&, const B&) = mergedArea<D>;
V (*hostile22[])(const B&, const V&) = {clampTo<D>};
D (*hostile23)(int, int) = ratio<D>;

}  // namespace samestep
#endif
