// SPDX-License-Identifier: MIT
// Collision handlers, functions of bodies and of the end of a step: what calls the caller's functions.
#include "base/require_ieee.h"
#include "definitions.h"

/// Contact that a handler sees: valid during its call.
struct samestep_contact {
  samestep_world* world;
};

namespace samestep::c {
namespace {

template <Scalar S>
struct ContactOf : samestep_contact {
  ContactOf(WorldOf<S>& its, Arbiter<S>& of) : samestep_contact{&its}, arbiter(of) {}
  Arbiter<S>& arbiter;
};

/// The functions that a Space calls for a handler of the caller's.
template <Scalar S>
struct HandlerCalls {
  using Record = typename WorldOf<S>::HandlerRecord;

  template <auto kFunction>
  static bool ask(Arbiter<S>& arbiter, Space<S>&, void* data) {
    const Record& record = *static_cast<const Record*>(data);
    ContactOf<S> contact(*record.world, arbiter);
    return (record.functions.*kFunction)(&contact, record.world, record.functions.data) != 0;
  }
  template <auto kFunction>
  static void tell(Arbiter<S>& arbiter, Space<S>&, void* data) {
    const Record& record = *static_cast<const Record*>(data);
    ContactOf<S> contact(*record.world, arbiter);
    (record.functions.*kFunction)(&contact, record.world, record.functions.data);
  }

  static CollisionHandler<S> of(Record& record) {
    CollisionHandler<S> handler;
    if (record.functions.begin != nullptr) handler.begin = ask<&samestep_handler::begin>;
    if (record.functions.pre_solve != nullptr) handler.preSolve = ask<&samestep_handler::pre_solve>;
    if (record.functions.post_solve != nullptr) handler.postSolve = tell<&samestep_handler::post_solve>;
    if (record.functions.separate != nullptr) handler.separate = tell<&samestep_handler::separate>;
    handler.data = &record;
    return handler;
  }
};

/// Registers a record under a number by action(number, record), and keeps it in place of the one before.
template <class Record, class Action>
void keep(std::map<CallbackNumber, std::unique_ptr<Record>>& records, CallbackNumber number, Record&& made,
          Action&& action) {
  auto record = std::make_unique<Record>(std::move(made));
  require<Fault::ValueOutOfRange>(number != 0, "Functions are registered under a number other than 0.");
  std::unique_ptr<Record>& kept = records[number];
  action(number, *record);
  kept = std::move(record);
}

template <Scalar S>
void move(Body<S>& body, S dt, void* data) {
  const auto& record = *static_cast<const typename WorldOf<S>::PositionRecord*>(data);
  record.function(record.world, toC(body.id()), toDouble(dt), record.data);
}

template <Scalar S>
void accelerate(Body<S>& body, const Vector<S>& gravity, S damping, S dt, void* data) {
  const auto& record = *static_cast<const typename WorldOf<S>::VelocityRecord*>(data);
  record.function(record.world, toC(body.id()), toDouble(gravity.x), toDouble(gravity.y), toDouble(damping),
                  toDouble(dt), record.data);
}

template <Scalar S>
void runPostStep(Space<S>&, std::uint64_t key, void* data) {
  WorldOf<S>& world = *static_cast<WorldOf<S>*>(data);
  // The key leaves the list first: the function may have itself run again.
  const auto waiting = world.postStep.extract(key);
  const InCallback inCallback(world);
  if (!waiting.empty()) waiting.mapped().function(&world, key, waiting.mapped().data);
}

/// The Space knows what waits; the records here are what it calls.
template <Scalar S>
bool addPostStep(WorldOf<S>& world, std::uint64_t key, samestep_post_step function, void* data) {
  requireOr(function != nullptr, SAMESTEP_NULL_ARGUMENT);
  const typename WorldOf<S>::PostStepRecord record{function, data};
  auto [place, isNew] = world.postStep.try_emplace(key, record);
  const typename WorldOf<S>::PostStepRecord before = std::exchange(place->second, record);
  bool added = false;
  try {
    added = world.space.addPostStepCallback(runPostStep<S>, key, &world);
  } catch (...) {
    world.postStep.insert_or_assign(key, before);
    throw;
  }
  if (!added) world.postStep.insert_or_assign(key, before);
  return added;
}

/// Runs action(arbiter, its world) on a contact. Nothing leaves it.
template <class Contact, class Action>
samestep_status callContact(Contact* contact, Action&& action) noexcept {
  if (contact == nullptr) return callFree([] { refuse(SAMESTEP_NULL_ARGUMENT); });
  return call(contact->world, [&]<class World>(World& of) {
    using S = typename World::Number;
    if constexpr (std::is_const_v<Contact>) {
      action(std::as_const(static_cast<const ContactOf<S>&>(*contact).arbiter), of);
    } else {
      action(static_cast<ContactOf<S>&>(*contact).arbiter, of);
    }
  });
}

template <Scalar S>
bool askWildcard(Space<S>& space, Arbiter<S>& arbiter, std::int32_t phase, bool ofB) {
  switch (phase) {
    case SAMESTEP_BEGIN:
      return ofB ? space.callWildcardBeginB(arbiter) : space.callWildcardBeginA(arbiter);
    case SAMESTEP_PRE_SOLVE:
      return ofB ? space.callWildcardPreSolveB(arbiter) : space.callWildcardPreSolveA(arbiter);
    case SAMESTEP_POST_SOLVE:
      ofB ? space.callWildcardPostSolveB(arbiter) : space.callWildcardPostSolveA(arbiter);
      return true;
    case SAMESTEP_SEPARATE:
      ofB ? space.callWildcardSeparateB(arbiter) : space.callWildcardSeparateA(arbiter);
      return true;
    default:
      refuse(SAMESTEP_UNKNOWN_VALUE);
  }
}

template <Scalar S>
ContactPointSet<S> toSet(const samestep_touch& touch) {
  ContactPointSet<S> set;
  set.count = touch.count;
  set.normal = vector<S>(touch.normal);
  require<Fault::ImmutableNumContacts>(touch.count >= 0 && touch.count <= kMaxContactsPerPair);
  for (std::int32_t i = 0; i < touch.count; ++i) {
    set.points[i].pointA = vector<S>(touch.point_a[i]);
    set.points[i].pointB = vector<S>(touch.point_b[i]);
  }
  return set;
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_world_register_handler(samestep_world* world, uint32_t number,
                                                const samestep_handler* handler) {
  return call(world, [&]<class World>(World& of) {
    using Record = typename World::HandlerRecord;
    keep(of.handlers, number, Record{&of, at(handler)}, [&](uint32_t under, Record& record) {
      of.space.registerHandler(under, HandlerCalls<typename World::Number>::of(record));
    });
  });
}

samestep_status samestep_world_add_handler(samestep_world* world, uint32_t type_a, uint32_t type_b,
                                           uint32_t number) {
  return call(world, [&](auto& of) { of.space.addCollisionHandler(type_a, type_b, number); });
}

samestep_status samestep_world_add_wildcard_handler(samestep_world* world, uint32_t type, uint32_t number) {
  return call(world, [&](auto& of) { of.space.addWildcardHandler(type, number); });
}

samestep_status samestep_world_add_default_handler(samestep_world* world, uint32_t number) {
  return call(world, [&](auto& of) { of.space.addDefaultCollisionHandler(number); });
}

samestep_status samestep_contact_get(const samestep_contact* contact, samestep_contact_state* state) {
  return callContact(contact, [&](const auto& arbiter, auto&) {
    at(state);
    *state = toC(arbiter);
  });
}

samestep_status samestep_contact_set_friction(samestep_contact* contact, double friction) {
  return callContact(contact, [&]<class S>(samestep::Arbiter<S>& arbiter, auto&) {
    arbiter.setFriction(number<S>(friction));
  });
}

samestep_status samestep_contact_set_restitution(samestep_contact* contact, double restitution) {
  return callContact(contact, [&]<class S>(samestep::Arbiter<S>& arbiter, auto&) {
    arbiter.setRestitution(number<S>(restitution));
  });
}

samestep_status samestep_contact_set_surface_velocity(samestep_contact* contact, double x, double y) {
  return callContact(contact, [&]<class S>(samestep::Arbiter<S>& arbiter, auto&) {
    arbiter.setSurfaceVelocity(vector<S>(x, y));
  });
}

samestep_status samestep_contact_set_touch(samestep_contact* contact, const samestep_touch* touch) {
  return callContact(contact, [&]<class S>(samestep::Arbiter<S>& arbiter, auto&) {
    arbiter.setContactPointSet(toSet<S>(at(touch)));
  });
}

samestep_status samestep_contact_ignore(samestep_contact* contact) {
  return callContact(contact, [&](auto& arbiter, auto&) { arbiter.ignore(); });
}

samestep_status samestep_contact_call_wildcard(samestep_contact* contact, int32_t phase, int32_t of_b,
                                               int32_t* answer) {
  return callContact(contact, [&](auto& arbiter, auto& of) {
    at(answer);
    *answer = askWildcard(of.space, arbiter, phase, of_b != 0) ? 1 : 0;
  });
}

samestep_status samestep_world_get_contacts(samestep_world* world, samestep_body_id body,
                                            const samestep_contact_state** contacts, size_t* count) {
  return call(world, [&](auto& of) {
    at(contacts), at(count);
    of.contacts.clear();
    const auto list = [&](auto& arbiter) { of.contacts.push_back(toC(arbiter)); };
    if (body == 0) {
      of.space.eachArbiter(list);
    } else {
      of.space.eachArbiter(fromC<samestep::BodyId>(body), list);
    }
    give(of.contacts, contacts, count);
  });
}

samestep_status samestep_world_register_position_function(samestep_world* world, uint32_t number,
                                                          samestep_position_function function, void* data) {
  return call(world, [&]<class World>(World& of) {
    using Record = typename World::PositionRecord;
    requireOr(function != nullptr, SAMESTEP_NULL_ARGUMENT);
    keep(of.positionFunctions, number, Record{&of, function, data}, [&](uint32_t under, Record& record) {
      of.space.registerPositionFunc(under, move<typename World::Number>, &record);
    });
  });
}

samestep_status samestep_world_register_velocity_function(samestep_world* world, uint32_t number,
                                                          samestep_velocity_function function, void* data) {
  return call(world, [&]<class World>(World& of) {
    using Record = typename World::VelocityRecord;
    requireOr(function != nullptr, SAMESTEP_NULL_ARGUMENT);
    keep(of.velocityFunctions, number, Record{&of, function, data}, [&](uint32_t under, Record& record) {
      of.space.registerVelocityFunc(under, accelerate<typename World::Number>, &record);
    });
  });
}

samestep_status samestep_world_add_post_step(samestep_world* world, samestep_post_step function, uint64_t key,
                                             void* data, int32_t* added) {
  return call(world, [&](auto& of) {
    const bool isNew = addPostStep(of, key, function, data);
    if (added != nullptr) *added = isNew ? 1 : 0;
  });
}

}  // extern "C"
