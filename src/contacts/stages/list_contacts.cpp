// SPDX-License-Identifier: MIT
#include "contacts/stages/list_contacts.h"

#include <algorithm>

#include "base/require_ieee.h"
#include "contacts/contact_geometry.h"
#include "contacts/stages/contact_callbacks.h"

namespace samestep {
namespace {

/// Key of the shapes of a pair, by which pairs are sorted.
std::uint64_t sortKey(ShapeId a, ShapeId b) { return std::uint64_t{a.index} << 32 | b.index; }

template <Scalar S>
ContactEvent eventOf(const WorldState<S>& world, ShapeId a, ShapeId b) {
  const Shape<S>&shapeA = world.shapes.valueAt(a.index), &shapeB = world.shapes.valueAt(b.index);
  ContactEvent event{shapeA.id(), shapeB.id(), shapeA.body(), shapeB.body()};
  event.sensor = shapeA.sensor() || shapeB.sensor() ? 1 : 0;
  return event;
}

/// The speed at which a contact point approached as the step began.
template <Scalar S>
S approachOf(const ContactArms<S>& arms, const typename ContactLists<S>::Speed& a,
             const typename ContactLists<S>::Speed& b, const Vector<S>& normal) {
  const Vector<S> ofA = a.velocity + perp(arms.armA) * a.angularVelocity;
  const Vector<S> ofB = b.velocity + perp(arms.armB) * b.angularVelocity;
  return dot(ofA - ofB, normal);
}

}  // namespace

template <Scalar S>
void ListContacts<S>::begin(Context& context) {
  ContactLists<S>& lists = context.events.contacts;
  lists.touching.clear();
  if (context.wiring.listing.contacts) {
    for (const Pair<S>& pair : context.state.pairs) {
      if (ContactCallbacks<S>::hasBegun(pair)) lists.touching.push_back({pair.a, pair.b});
    }
  }
  if (!context.wiring.listing.impacts) return;
  const auto& bodies = context.state.bodies;
  lists.speeds.assign(bodies.slots(), {});
  bodies.each([&](BodyId id, const Body<S>& body) {
    lists.speeds[id.index] = {body.velocity(), body.angularVelocity()};
  });
}

template <Scalar S>
void ListContacts<S>::addBegun(Context& context, const std::vector<Pair<S>>& pairs) {
  using Touching = typename ContactLists<S>::Touching;
  if (!context.wiring.listing.contacts) return;
  std::vector<Touching>& touching = context.events.contacts.touching;
  for (const Pair<S>& pair : pairs) {
    if (ContactCallbacks<S>::hasBegun(pair)) touching.push_back({pair.a, pair.b});
  }
  // total order: a pair is in one list only
  std::sort(touching.begin(), touching.end(),
            [](const Touching& a, const Touching& b) { return sortKey(a.a, a.b) < sortKey(b.a, b.b); });
}

template <Scalar S>
void ListContacts<S>::finish(Context& context) {
  const EventListing<S>& listing = context.wiring.listing;
  ContactLists<S>& lists = context.events.contacts;
  lists.begins.clear();
  lists.ends.clear();
  lists.impacts.clear();
  lists.tick = listing.contacts || listing.impacts ? context.state.stamp : 0;
  if (listing.contacts) listChanges(context);
  if (!listing.impacts) return;
  for (Pair<S>& pair : context.state.pairs) {
    if (pair.solved != 0) listImpact(context, pair);
  }
}

template <Scalar S>
void ListContacts<S>::endBetween(Context& context, const Pair<S>& pair) {
  if (!context.wiring.listing.contacts) return;
  ContactEvent event = eventOf(context.state, pair.a, pair.b);
  event.removal = 1;
  context.events.contacts.endsBetween.push_back(event);
}

/// Lists the contacts that began in the step and those that ended. Both lists rise by ids.
template <Scalar S>
void ListContacts<S>::listChanges(Context& context) {
  ContactLists<S>& lists = context.events.contacts;
  lists.ends.swap(lists.endsBetween);
  const bool sorted = lists.ends.empty();
  auto before = lists.touching.begin();
  const auto end = [&] {
    lists.ends.push_back(eventOf(context.state, before->a, before->b));
    ++before;
  };
  for (const Pair<S>& pair : context.state.pairs) {
    const std::uint64_t key = sortKey(pair.a, pair.b);
    while (before != lists.touching.end() && sortKey(before->a, before->b) < key) end();
    const bool touched = before != lists.touching.end() && sortKey(before->a, before->b) == key;
    const bool touches = ContactCallbacks<S>::hasBegun(pair);
    if (touches && !touched) lists.begins.push_back(eventOf(context.state, pair.a, pair.b));
    if (touched && !touches)
      end();
    else if (touched)
      ++before;
  }
  while (before != lists.touching.end()) end();
  if (sorted) return;
  std::stable_sort(lists.ends.begin(), lists.ends.end(), [](const ContactEvent& a, const ContactEvent& b) {
    return std::pair(a.shapeA, a.shapeB) < std::pair(b.shapeA, b.shapeB);
  });
}

template <Scalar S>
void ListContacts<S>::listImpact(Context& context, Pair<S>& pair) {
  const WorldState<S>& world = context.state;
  const Shape<S>&shapeA = world.shapes.valueAt(pair.a.index), &shapeB = world.shapes.valueAt(pair.b.index);
  const Body<S>&a = world.bodies.valueAt(shapeA.body().index), &b = world.bodies.valueAt(shapeB.body().index);
  const ContactLists<S>& lists = context.events.contacts;
  const Vector<S> normal = worldNormal(pair, a);
  ImpactEvent<S> event{shapeA.id(), shapeB.id(), shapeA.body(), shapeB.body()};
  Scaled<S> push{};
  for (int i = 0; i < pair.count; ++i) {
    const ContactArms<S> arms = contactArms(pair.contacts[i], normal, a, b);
    const S speed =
        approachOf(arms, lists.speeds[shapeA.body().index], lists.speeds[shapeB.body().index], normal);
    push = push + toScaled(pair.contacts[i].normalTotal);
    if (i > 0 && speed <= event.speed) continue;
    event.speed = speed;
    event.point = a.worldCenter() + arms.armA;
  }
  if (!(event.speed >= context.wiring.listing.slowestImpact) || !(push > Scaled<S>{})) return;
  event.normal = normal;
  event.impulse = saturated<S>(push * lighterMass(a, b));
  context.events.contacts.impacts.push_back(event);
}

#define SAMESTEP_EACH_SCALAR template struct ListContacts<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
