// SPDX-License-Identifier: MIT
#include "solver/joints/joint_rows.h"

#include <samestep/high_water.h>

#include "base/require_ieee.h"
#include "contacts/contact_row.h"
#include "joints/joint_limits.h"

namespace samestep {
namespace {

/// Bound of an error of a place, m or rad: a larger one counts as this.
template <Scalar S>
inline constexpr S kMostOff = S(1 << 10);
/// The part of what a place is off that goes in a substep.
template <Scalar S>
inline constexpr S kCorrected = ratio<S>(1, 4);

/// Two directions, each the other's left perpendicular, along which a point of B on one of A answers apart.
/// @param inertia  xx, xy and yy of the inverse effective mass
template <Scalar S>
Vector<S> principal(S xx, S xy, S yy) {
  // This is the direction of twice the angle, which is halved against the x axis, or the y axis where that is
  // nearer.
  const Vector<S> twice = normalize(Vector<S>(xx - yy, xy + xy));
  if (twice == Vector<S>()) return {S(1), S(0)};
  return twice.x >= S(0) ? normalize(Vector<S>(S(1) + twice.x, twice.y))
                         : normalize(Vector<S>(twice.y, S(1) - twice.x));
}

/// Makes the rows of one joint.
template <Scalar S>
class RowMaker {
 public:
  RowMaker(const Joint<S>& joint, const JointWork<S>& work, const JointBody<S>& a, const JointBody<S>& b,
           const JointTiming<S>& timing, std::vector<JointRow<S>>& rows)
      : joint_(joint), work_(work), a_(a), b_(b), timing_(timing), rows_(rows) {
    armA_ = rotate(joint.anchorA - a.centerOfMass, a.turn);
    armB_ = rotate(joint.anchorB - b.centerOfMass, b.turn);
    apart_ = heldWithin((b.center - a.center) + ((b.moved - a.moved) + (armB_ - armA_)), kMaxSpeed<S>);
    angle_ = jointAngle(joint, a.angle + a.turned, b.angle + b.turned);
  }

  void make() {
    switch (joint_.kind) {
      case JointKind::revolute:
        turnFreely();
        return holdPoint();
      case JointKind::prismatic:
        slide();
        turn(kKeptAngular, angle_);
        return across();
      case JointKind::distance:
        return distance();
      case JointKind::weld:
        return weld();
      case JointKind::wheel:
        return wheel();
      case JointKind::target:
        return target();
      case JointKind::gear:
        if (isBare()) return turn(kKeptAngular, angle_);
        return turnFreely();
      case JointKind::ratchet:
        return ratchet();
    }
  }

 private:
  using Row = JointRow<S>;

  bool isBare() const { return joint_.spring == 0 && joint_.limited == 0 && joint_.motor == 0; }

  /// A row along n whose point on A is at `armA` from its centre.
  Row& along(JointSlot slot, const Vector<S>& n, const Vector<S>& armA) {
    Row& row = rows_.emplace_back();
    const PairResponse<S> response = work_.response.at(armA, armB_);
    row.n = n;
    row.armA = cross(armA, n);
    row.armB = cross(armB_, n);
    const S k = effectiveInverseMass(response, row.armA, row.armB);
    const S mass = reciprocal(k);
    row.speedA = response.massA * mass;
    row.speedB = response.massB * mass;
    row.spinA = response.momentA * row.armA * mass;
    row.spinB = response.momentB * row.armB * mass;
    row.scale = mass;
    row.perKept = k;
    row.slot = slot;
    bound(row, S(0));
    highWater<S>("joint: arm", max(abs(row.armA), abs(row.armB)));
    highWater<S>("joint: inverse effective mass k", k);
    return row;
  }
  /// A row that turns.
  Row& turning(JointSlot slot) {
    Row& row = rows_.emplace_back();
    row.armA = S(1);
    row.armB = joint_.kind == JointKind::gear ? joint_.ratio : S(1);
    row.spinA = work_.turnA;
    row.spinB = work_.turnB;
    row.scale = work_.turnScale;
    row.perKept = work_.turnPerKept;
    row.slot = slot;
    bound(row, S(0));
    return row;
  }
  bool turns() const { return work_.turnPerKept != S(0); }

  /// Turns a kept impulse into u, held.
  static S unitsOf(const Row& row, S kept) {
    const S limit = kMostKept<S> * row.scale;
    const S size = abs(kept);
    // Rows that turn may have a scale above 1.
    const S most = row.scale >= S(1) ? kMostKept<S> : limit;
    const S u = size >= most ? kMostKept<S> * min(S(1), row.perKept) : size * row.perKept;
    return kept < S(0) ? -u : u;
  }
  /// Holds the impulse of a row within what was asked for; 0: only within the range.
  static void bound(Row& row, S most) {
    row.high = unitsOf(row, most > S(0) ? most : kMostKept<S>);
    row.low = -row.high;
  }
  void take(Row& row, S kept) const { row.sum = clamp(unitsOf(row, kept), row.low, row.high); }

  /// Has a row bring back what is off.
  void correct(Row& row, S off) const {
    const S speed = clamp(off, -kMostOff<S>, kMostOff<S>) * (kCorrected<S> * timing_.perSubstep);
    row.bias = clamp(speed, -kMaxSpeed<S>, kMaxSpeed<S>);
    row.corrects = 1;
  }
  static void soften(Row& row, const Softness<S>& soft, S off) {
    row.massScale = soft.massScale;
    row.impulseScale = soft.impulseScale;
    row.bias = clamp(off, -kMostOff<S>, kMostOff<S>) * soft.biasRate;
  }

  template <class Make>
  void spring(S coordinate, Make&& make) const {
    if (joint_.spring == 0) return;
    Row& row = make(kKeptSpring);
    soften(row, work_.spring, coordinate - joint_.rest);
    take(row, work_.kept.spring);
  }
  template <class Make>
  void motor(Make&& make) const {
    if (joint_.motor == 0 || work_.motorMost == S(0)) return;
    Row& row = make(kKeptMotor);
    row.bias = -joint_.motorSpeed;
    bound(row, work_.motorMost);
    take(row, work_.kept.motor);
  }
  /// Makes a row along the coordinate, or against it, one that only pushes: `room` is left before it holds.
  void limit(Row& row, S room, S kept) const {
    row.low = S(0);
    if (room > S(0)) {
      row.bias = room * timing_.perSubstep;
    } else {
      correct(row, room);
    }
    take(row, kept);
  }
  /// True of a limit near enough to be reached in a substep.
  bool isNear(S room) const { return room < S(4) * kMaxSpeed<S> * timing_.substep; }
  static void reverse(Row& row) {
    row.n = -row.n;
    row.armA = -row.armA;
    row.armB = -row.armB;
    row.spinA = -row.spinA;
    row.spinB = -row.spinB;
  }
  template <class Make>
  void limits(S coordinate, Make&& make) const {
    if (joint_.limited == 0) return;
    const S above = coordinate - joint_.lower, below = joint_.upper - coordinate;
    // No distance is below 0: what passes the other anchor has not come to a limit.
    const bool hasLower = joint_.kind != JointKind::distance || joint_.lower > S(0);
    if (hasLower && isNear(above)) limit(make(kKeptLower), above, work_.kept.lower);
    if (!isNear(below)) return;
    Row& row = make(kKeptUpper);
    reverse(row);
    limit(row, below, work_.kept.upper);
  }

  void turnFreely() {
    if (!turns()) return;
    const auto make = [&](JointSlot slot) -> Row& { return turning(slot); };
    spring(angle_, make);
    motor(make);
    limits(angle_, make);
  }
  /// Holds an angle.
  void turn(JointSlot slot, S off) {
    if (!turns()) return;
    Row& row = turning(slot);
    bound(row, work_.torqueMost);
    correct(row, off);
    take(row, work_.kept.angular);
  }
  Vector<S> axis() const { return rotate(joint_.axis, a_.turn); }
  void slide() {
    const Vector<S> n = axis();
    const auto make = [&](JointSlot slot) -> Row& { return along(slot, n, armA_ + apart_); };
    const S coordinate = dot(n, apart_);
    spring(coordinate, make);
    if (!motorTurns(joint_)) motor(make);
    limits(coordinate, make);
  }
  void across() {
    const Vector<S> n = perp(axis());
    Row& row = along(kKeptAcross, n, armA_ + apart_);
    bound(row, work_.forceMost);
    correct(row, dot(n, apart_));
    take(row, work_.kept.linear.y);
  }
  void wheel() {
    slide();
    if (turns()) motor([&](JointSlot slot) -> Row& { return turning(slot); });
    across();
  }
  void distance() {
    const S length = samestep::length(apart_);
    // Any direction is as good where both points are in one place.
    const Vector<S> n = length > ratio<S>(1, 1 << 20) ? normalize(apart_) : axis();
    const auto make = [&](JointSlot slot) -> Row& { return along(slot, n, armA_); };
    if (isBare()) {
      Row& row = make(kKeptAlong);
      bound(row, work_.forceMost);
      correct(row, length - joint_.rest);
      return take(row, work_.kept.linear.x);
    }
    spring(length, make);
    motor(make);
    limits(length, make);
  }

  /// Two rows that answer apart.
  template <class Aim>
  void point(Aim&& aim) {
    const PairResponse<S> r = work_.response.at(armA_, armB_);
    const S xx = dot(r.momentA * armA_.y, armA_.y, r.momentB * armB_.y, armB_.y);
    const S yy = dot(r.momentA * armA_.x, armA_.x, r.momentB * armB_.x, armB_.x);
    const S xy = -dot(r.momentA * armA_.x, armA_.y, r.momentB * armB_.x, armB_.y);
    const Vector<S> n = principal(xx, xy, yy);
    for (const Vector<S>& direction : {n, perp(n)}) {
      // A greatest force bounds both rows together: see JointSolver::solveJoint.
      Row& row = along(kKeptPoint, direction, armA_);
      aim(row);
      take(row, dot(direction, work_.kept.linear));
    }
  }
  void holdPoint() {
    point([&](Row& row) { correct(row, dot(row.n, apart_)); });
  }
  void weld() {
    if (joint_.angularHertz == S(0)) {
      turn(kKeptAngular, angle_);
    } else if (turns()) {
      Row& row = turning(kKeptAngular);
      bound(row, work_.torqueMost);
      soften(row, work_.angularSpring, angle_);
      take(row, work_.kept.angular);
    }
    if (joint_.hertz == S(0)) return holdPoint();
    point([&](Row& row) { soften(row, work_.spring, dot(row.n, apart_)); });
  }
  void target() {
    if (work_.torqueMost > S(0) && turns()) {
      Row& row = turning(kKeptAngular);
      bound(row, work_.torqueMost);
      if (joint_.angularHertz == S(0)) {
        row.bias = -joint_.motorSpeed;
      } else {
        soften(row, work_.angularSpring, angle_);
      }
      take(row, work_.kept.angular);
    }
    if (work_.forceMost == S(0)) return;
    const Vector<S> wanted = rotate(joint_.velocity, a_.turn);
    point([&](Row& row) {
      if (joint_.hertz == S(0)) {
        row.bias = -dot(row.n, wanted);
      } else {
        soften(row, work_.spring, dot(row.n, apart_));
      }
    });
  }
  void ratchet() {
    if (!turns()) return;
    const bool forward = joint_.rest > S(0);
    const S room = (forward ? angle_ : -angle_) - joint_.latch;
    if (!isNear(room)) return;
    Row& row = turning(kKeptLower);
    if (!forward) reverse(row);
    bound(row, work_.torqueMost);
    limit(row, room, work_.kept.lower);
  }

  const Joint<S>& joint_;
  const JointWork<S>& work_;
  const JointBody<S>&a_, &b_;
  const JointTiming<S>& timing_;
  std::vector<JointRow<S>>& rows_;
  // From the centres of mass to the anchors; from the anchor of A to that of B, m.
  Vector<S> armA_, armB_, apart_;
  S angle_;
};

}  // namespace

template <Scalar S>
S jointAngle(const Joint<S>& joint, S angleA, S angleB) {
  const S most = kMaxJointCoordinate<S>;
  const S a = clamp(angleA, -most, most), b = clamp(angleB, -most, most);
  return (joint.kind == JointKind::gear ? b * joint.ratio : b) - a - joint.angle;
}

template <Scalar S>
S ratchetTooth(const Joint<S>& joint, S angle) {
  const S size = abs(joint.rest), along = joint.rest > S(0) ? angle : -angle;
  const S over = remainder(along, size);
  return over < S(0) ? along - over - size : along - over;
}

template <Scalar S>
void appendRows(const Joint<S>& joint, const JointWork<S>& work, const JointBody<S>& a, const JointBody<S>& b,
                const JointTiming<S>& timing, std::vector<JointRow<S>>& rows) {
  RowMaker<S>(joint, work, a, b, timing, rows).make();
}

#define SAMESTEP_EACH_SCALAR                                                             \
  template S jointAngle<S>(const Joint<S>&, S, S);                                       \
  template S ratchetTooth<S>(const Joint<S>&, S);                                        \
  template void appendRows<S>(const Joint<S>&, const JointWork<S>&, const JointBody<S>&, \
                              const JointBody<S>&, const JointTiming<S>&, std::vector<JointRow<S>>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
