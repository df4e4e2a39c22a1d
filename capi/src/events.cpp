// SPDX-License-Identifier: MIT
// Events of contacts, read after a step.
#include "base/require_ieee.h"
#include "definitions.h"

namespace samestep::c {
namespace {

void list(std::span<const ContactEvent> from, std::vector<samestep_contact_event>& events) {
  events.clear();
  for (const ContactEvent& event : from) {
    events.push_back({toC(event.shapeA), toC(event.shapeB), toC(event.bodyA), toC(event.bodyB), event.sensor,
                      event.removal});
  }
}

template <Scalar S>
void list(std::span<const ImpactEvent<S>> from, std::vector<samestep_impact_event>& events) {
  events.clear();
  for (const ImpactEvent<S>& event : from) {
    events.push_back({toC(event.shapeA), toC(event.shapeB), toC(event.bodyA), toC(event.bodyB),
                      toVec2(event.point), toVec2(event.normal), toDouble(event.speed),
                      toDouble(event.impulse)});
  }
}

template <class Event>
void give(const std::vector<Event>& events, const Event*& to, std::uint32_t& count) {
  to = events.data();
  count = static_cast<std::uint32_t>(events.size());
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_world_list_events(samestep_world* world, int32_t contacts, int32_t impacts,
                                           double slowest_impact) {
  return call(world, [&]<class World>(World& of) {
    using S = typename World::Number;
    of.space.setEventListing(
        {contacts != 0, impacts != 0, number<S>(slowest_impact), of.space.eventListing().joints});
  });
}

samestep_status samestep_world_get_events(samestep_world* world, samestep_events* events) {
  return call(world, [&](auto& of) {
    at(events);
    const auto found = of.space.contactEvents();
    list(found.begins, of.begins);
    list(found.ends, of.ends);
    list(found.impacts, of.impacts);
    *events = {};
    events->tick = found.tick;
    give(of.begins, events->begins, events->begin_count);
    give(of.ends, events->ends, events->end_count);
    give(of.impacts, events->impacts, events->impact_count);
  });
}

samestep_status samestep_world_list_joint_events(samestep_world* world, int32_t joints) {
  return call(world, [&](auto& of) {
    auto listing = of.space.eventListing();
    listing.joints = joints != 0;
    of.space.setEventListing(listing);
  });
}

samestep_status samestep_world_get_joint_events(samestep_world* world, const samestep_joint_event** events,
                                                size_t* count) {
  return call(world, [&](auto& of) {
    at(events), at(count);
    of.jointEvents.clear();
    for (const auto& event : of.space.jointEvents()) {
      of.jointEvents.push_back({toC(event.joint), toC(event.bodyA), toC(event.bodyB), event.userData,
                                toVec2(event.force), toDouble(event.torque),
                                static_cast<int32_t>(event.change), 0});
    }
    samestep::c::give(of.jointEvents, events, count);
  });
}

}  // extern "C"
