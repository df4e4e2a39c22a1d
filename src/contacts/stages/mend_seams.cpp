// SPDX-License-Identifier: MIT
#include "contacts/stages/mend_seams.h"

#include <algorithm>

#include "base/require_ieee.h"
#include "contacts/push_contacts.h"

namespace samestep {
namespace {

/// Of contacts between what does not move: in one group with all that is static.
constexpr std::uint32_t kStatic = 0xffffffffu;

/// A contact as its moving shape sees it.
template <Scalar S>
SeamContact<S> seamContactOf(const Derived<S>& derived, const Pair<S>& pair, std::uint32_t moving) {
  const bool aMoves = pair.a.index == moving;
  const std::uint32_t still = aMoves ? pair.b.index : pair.a.index;
  const PlacedPose<S>& body = derived.poses[derived.traits[still].body];
  const Vector<S> normal =
      rotate(pair.localNormal, derived.poses[derived.traits[pair.a.index].body].frame.rotation);
  SeamContact<S> contact{&derived.placed[moving], &derived.placed[still]};
  contact.group = body.type == BodyType::staticBody ? kStatic : derived.traits[still].body;
  contact.normal = aMoves ? -normal : normal;
  contact.count = pair.count;
  for (int i = 0; i < pair.count; ++i) {
    contact.points[i] = body.frame.toWorld(aMoves ? pair.contacts[i].anchorB : pair.contacts[i].anchorA);
  }
  return contact;
}

}  // namespace

template <Scalar S>
void MendSeams<S>::run(StepContext<S>& step, std::vector<std::uint8_t>& found) {
  collect(step, found);
  const auto last = static_cast<std::uint32_t>(seams_.size());
  for (std::uint32_t begin = 0; begin < last;) {
    std::uint32_t end = begin + 1;
    while (end < last && seams_[end].moving == seams_[begin].moving) ++end;
    judge(step, found, begin, end);
    begin = end;
  }
}

/// Finds the contacts of shapes that have more than one.
template <Scalar S>
void MendSeams<S>::collect(const StepContext<S>& step, const std::vector<std::uint8_t>& found) {
  const Derived<S>& derived = step.derived;
  const auto movingOf = [&](std::uint32_t i) {
    const std::uint32_t a = step.state.pairs[i].a.index;
    const bool aMoves = derived.poses[derived.traits[a].body].type == BodyType::dynamicBody;
    return aMoves ? a : step.state.pairs[i].b.index;
  };
  asked_.clear();
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    if ((found[i] & ContactFound::kSeam) != 0) asked_.push_back(i);
  }
  count_.resize(step.state.shapes.slots(), 0);
  for (const std::uint32_t i : asked_) ++count_[movingOf(i)];
  seams_.clear();
  for (const std::uint32_t i : asked_) {
    const std::uint32_t moving = movingOf(i);
    if (count_[moving] > 1) seams_.push_back({moving, i});
  }
  for (const std::uint32_t i : asked_) count_[movingOf(i)] = 0;
  std::sort(seams_.begin(), seams_.end());  // total order: no pair is in it twice
}

/// Judges those of one moving shape, all by what was found; what was judged in an earlier step stands as it
/// stood.
template <Scalar S>
void MendSeams<S>::judge(StepContext<S>& step, std::vector<std::uint8_t>& found, std::uint32_t begin,
                         std::uint32_t end) {
  const Derived<S>& derived = step.derived;
  const auto isFresh = [&](std::uint32_t i) { return (found[seams_[i].pair] & ContactFound::kFresh) != 0; };
  contacts_.clear();
  bool anyFresh = false;
  for (std::uint32_t i = begin; i < end; ++i) anyFresh = anyFresh || isFresh(i);
  if (!anyFresh) return;
  for (std::uint32_t i = begin; i < end; ++i) {
    contacts_.push_back(seamContactOf(derived, step.state.pairs[seams_[i].pair], seams_[i].moving));
  }
  for (std::uint32_t i = begin; i < end; ++i) {
    if (!isFresh(i)) continue;
    Pair<S>& pair = step.state.pairs[seams_[i].pair];
    CollisionInfo<S> info;
    const SeamVerdict verdict = judgeSeam<S>(contacts_, i - begin, step.pairMargin(), info);
    if (verdict == SeamVerdict::stays) continue;
    // To be judged again.
    pair.manifold = Manifold::unknown;
    if (verdict == SeamVerdict::goes) {
      found[seams_[i].pair] = 0;
      continue;
    }
    const PlacedPose<S>& a = derived.poses[derived.traits[pair.a.index].body];
    const PlacedPose<S>& b = derived.poses[derived.traits[pair.b.index].body];
    pushContacts(pair, a.type == BodyType::dynamicBody ? exchanged(info) : info, a.frame, b.frame);
  }
}

#define SAMESTEP_EACH_SCALAR template class MendSeams<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
