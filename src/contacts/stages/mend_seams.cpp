// SPDX-License-Identifier: MIT
#include "contacts/stages/mend_seams.h"

#include <algorithm>

#include "base/require_ieee.h"
#include "contacts/push_contacts.h"

namespace samestep {
namespace {

/// A contact as one of its shapes sees it.
template <Scalar S>
SeamContact<S> seamContactOf(const Derived<S>& derived, const Pair<S>& pair, std::uint32_t shape) {
  const bool byA = pair.a.index == shape;
  const std::uint32_t other = byA ? pair.b.index : pair.a.index;
  const Frame<S>& frame = derived.poses[derived.traits[other].body].frame;
  const Vector<S> normal =
      rotate(pair.localNormal, derived.poses[derived.traits[pair.a.index].body].frame.rotation);
  SeamContact<S> contact{&derived.placed[shape], &derived.placed[other]};
  contact.normal = byA ? -normal : normal;
  contact.count = pair.count;
  for (int i = 0; i < pair.count; ++i) {
    contact.points[i] = frame.toWorld(byA ? pair.contacts[i].anchorB : pair.contacts[i].anchorA);
  }
  return contact;
}

}  // namespace

template <Scalar S>
void MendSeams<S>::run(StepContext<S>& step, std::vector<std::uint8_t>& found) {
  collect(step, found);
  changes_.clear();
  judged_ = 0;
  const std::span<const Side> all(sides_);
  for (std::size_t begin = 0, end; begin < all.size(); begin = end) {
    end = begin + 1;
    while (end < all.size() && all[end].isWith(all[begin])) ++end;
    if (end - begin > 1) judge(step, found, all.subspan(begin, end - begin));
  }
  apply(step, found);
}

/// Finds the pairs that may lie at a seam, seen by either shape.
template <Scalar S>
void MendSeams<S>::collect(const StepContext<S>& step, const std::vector<std::uint8_t>& found) {
  asked_.clear();
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    if ((found[i] & ContactFound::kSeam) != 0) asked_.push_back(i);
  }
  sides_.clear();
  for (const std::uint32_t i : asked_) {
    addSide(step, i, true);
    addSide(step, i, false);
  }
  std::sort(sides_.begin(), sides_.end());  // total order: no side is in it twice
}

template <Scalar S>
void MendSeams<S>::addSide(const StepContext<S>& step, std::uint32_t pair, bool ofA) {
  const Derived<S>& derived = step.derived;
  const Pair<S>& seen = step.state.pairs[pair];
  const std::uint32_t shape = ofA ? seen.a.index : seen.b.index, other = ofA ? seen.b.index : seen.a.index;
  const std::uint32_t body = derived.traits[other].body;
  const BodyType type = derived.poses[body].type;
  const Body<S>& moving = step.state.bodies.valueAt(body);
  if (type == BodyType::staticBody) {
    sides_.push_back({shape, kAlike, pair, {}});
  } else if (type == BodyType::kinematicBody && moving.angularVelocity() == S(0)) {
    sides_.push_back({shape, kAlike, pair, moving.velocity()});
  } else if (derived.isCompound(body)) {
    sides_.push_back({shape, body, pair, {}});
  }
}

template <Scalar S>
bool MendSeams<S>::Side::operator<(const Side& other) const {
  if (shape != other.shape) return shape < other.shape;
  if (group != other.group) return group < other.group;
  if (velocity.x != other.velocity.x) return velocity.x < other.velocity.x;
  if (velocity.y != other.velocity.y) return velocity.y < other.velocity.y;
  return pair < other.pair;
}

/// Judges those of one shape and group, all by what was found; what was judged in an earlier step stands as
/// it stood.
template <Scalar S>
void MendSeams<S>::judge(const StepContext<S>& step, const std::vector<std::uint8_t>& found,
                         std::span<const Side> sides) {
  const auto isFresh = [&](const Side& side) { return (found[side.pair] & ContactFound::kFresh) != 0; };
  if (std::none_of(sides.begin(), sides.end(), isFresh)) return;
  contacts_.clear();
  for (const Side& side : sides) {
    contacts_.add(seamContactOf(step.derived, step.state.pairs[side.pair], side.shape), side.pair);
  }
  contacts_.sort();
  for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
    const std::uint32_t pair = contacts_.numberOf(i);
    if ((found[pair] & ContactFound::kFresh) == 0) continue;
    if (++judged_ % kJudgedAtOnce == 0) step.wiring.budget.pay(Budget::kPerPair * kJudgedAtOnce);
    Change change{pair, step.state.pairs[pair].a.index == sides.front().shape, SeamVerdict::stays, {}};
    change.verdict = judgeSeam<S>(contacts_, i, step.pairMargin(), change.info);
    if (change.verdict != SeamVerdict::stays) changes_.push_back(change);
  }
}

/// Takes, where both shapes say that a contact changes, the change with which they overlap less.
template <Scalar S>
void MendSeams<S>::apply(StepContext<S>& step, std::vector<std::uint8_t>& found) {
  const auto before = [](const Change& x, const Change& y) {
    return x.pair != y.pair ? x.pair < y.pair : x.byA < y.byA;
  };
  std::sort(changes_.begin(), changes_.end(), before);  // total order: a pair has two sides
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const Change& first = changes_[i];
    if (i + 1 == changes_.size() || changes_[i + 1].pair != first.pair) {
      applyOne(step, found[first.pair], first);
      continue;
    }
    const Change& second = changes_[++i];
    const bool oneGoes = first.verdict == SeamVerdict::goes || second.verdict == SeamVerdict::goes;
    const S apartFirst = oneGoes ? S(0) : leastSeparation(first.info);
    const S apartSecond = oneGoes ? S(0) : leastSeparation(second.info);
    if (oneGoes) {
      applyOne(step, found[first.pair], first.verdict == SeamVerdict::goes ? first : second);
    } else if (apartFirst != apartSecond) {
      applyOne(step, found[first.pair], apartFirst > apartSecond ? first : second);
    }
  }
}

template <Scalar S>
void MendSeams<S>::applyOne(StepContext<S>& step, std::uint8_t& found, const Change& change) const {
  Pair<S>& pair = step.state.pairs[change.pair];
  // An unknown manifold is judged again.
  pair.manifold = Manifold::unknown;
  if (change.verdict == SeamVerdict::goes) {
    found = 0;
    return;
  }
  const Derived<S>& derived = step.derived;
  const Frame<S>& a = derived.poses[derived.traits[pair.a.index].body].frame;
  const Frame<S>& b = derived.poses[derived.traits[pair.b.index].body].frame;
  pushContacts(pair, change.byA ? exchanged(change.info) : change.info, a, b);
}

#define SAMESTEP_EACH_SCALAR template class MendSeams<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
