// SPDX-License-Identifier: MIT
#include <samestep/space.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "base/change.h"
#include "base/require_ieee.h"
#include "world/joints.h"
#include "world/objects.h"
#include "world/queries.h"
#include "world/space_contacts.h"
#include "world/space_parts.h"
#include "world/space_saving.h"
#include "world/space_settings.h"
#include "world/space_wiring.h"

namespace samestep {
namespace {

/// Tells the objects of one Space from those of another; 0 is nobody's. Never part of a result.
std::uint32_t nextSerial() {
  static std::atomic<std::uint32_t> last{0};
  // After 2^32 of them it begins again.
  const std::uint32_t next = ++last;
  return next != 0 ? next : nextSerial();
}

constexpr const char* kReindexLocked =
    "You cannot manually reindex objects while the space is locked. Wait until the current query or step is "
    "complete.";

void requireNotMain(BodyId id, BodyId staticBody, const char* asked) {
  require<Fault::MainStaticBody>(id != staticBody, asked, ": body ", id,
                                 " is the static body of the Space, which stays");
}

}  // namespace

template <Scalar S>
Space<S>::Space() : parts_(nullptr) {
  // No destructor runs where what follows fails.
  auto made = std::make_unique<SpaceParts<S>>();
  parts_ = made.get();
  giveIds(nextSerial());
  parts_->derived.budget = &parts_->wiring.budget;
  state_.staticBody = add(Body<S>::fixedInPlace());
  made.release();
}

template <Scalar S>
Space<S>::~Space() {
  delete parts_;
}

template <Scalar S>
void Space<S>::giveIds(std::uint32_t space) {
  state_.bodies.setSpace(space);
  state_.shapes.setSpace(space);
  state_.joints.setSpace(space);
  state_.staticBody.space = space;
}

template <Scalar S>
void Space<S>::requireUnlocked() const {
  requireUsable();
  require<Fault::SpaceLocked>(locked_ == 0);
}

template <Scalar S>
StepContext<S> Space<S>::contextOf(S dt) {
  return {*this, state_, parts_->derived, parts_->wiring, parts_->team, parts_->events, leftMidway_, dt,
          S(0),  false};
}

// Bodies.

template <Scalar S>
BodyId Space<S>::add(const Body<S>& body) {
  requireUnlocked();
  StepContext<S> world = contextOf();
  Objects<S>::checkNew(world, body);
  const BodyId id = state_.bodies.nextId();
  require<Fault::IllegalSize>(id.index < BodyId::kNoIndex);
  Objects<S>::insert(world, body, id);
  return id;
}

template <Scalar S>
BodyId Space<S>::add(const Body<S>& body, BodyId id) {
  requireUnlocked();
  StepContext<S> world = contextOf();
  Objects<S>::checkNew(world, body);
  state_.bodies.checkGiven(id);
  Objects<S>::insert(world, body, id);
  return state_.bodies.idAt(id.index);
}

template <Scalar S>
BodyId Space<S>::setStaticBody(const Body<S>& body) {
  requireUnlocked();
  require<Fault::AttachedStaticBody>(firstShape(staticBody()) == ShapeId::kNoIndex,
                                     "Space::setStaticBody: the present one, ", staticBody(), ", has shapes");
  require<Fault::AttachedStaticBody>(!Joints<S>::hasAny(state_, staticBody()),
                                     "Space::setStaticBody: the present one, ", staticBody(), ", has joints");
  require<Fault::IllegalBody>(body.type() == BodyType::staticBody,
                              "Space::setStaticBody: the body is not static");

  const BodyId before = state_.staticBody;
  state_.staticBody = add(body);
  remove(before);
  return state_.staticBody;
}

template <Scalar S>
void Space<S>::remove(BodyId id) {
  requireUnlocked();
  state_.bodies.template requireAlive<Fault::BodyNotFound>(id, "Space::remove");
  requireNotMain(id, state_.staticBody, "Space::remove");
  require<Fault::BodyHasShapes>(firstShape(id) == ShapeId::kNoIndex, "Space::remove: body ", id,
                                " has shapes; see Space::removeWithShapes");

  StepContext<S> world = contextOf();
  Joints<S>::eraseOf(world, id);
  Objects<S>::erase(world, id);
}

template <Scalar S>
void Space<S>::removeWithShapes(BodyId id) {
  requireUnlocked();
  state_.bodies.template requireAlive<Fault::BodyNotFound>(id, "Space::removeWithShapes");
  requireNotMain(id, state_.staticBody, "Space::removeWithShapes");
  LockGuard guard(*this);
  StepContext<S> world = contextOf();
  Joints<S>::eraseOf(world, id);
  Objects<S>::eraseWithShapes(world, id);
  guard.finish();
}

template <Scalar S>
Body<S>& Space<S>::body(BodyId id) {
  requireUsable();
  Body<S>& found = state_.bodies.template at<Fault::BodyNotFound>(id, "Space::body");
  parts_->derived.touch(id.index);
  return found;
}

template <Scalar S>
const Body<S>& Space<S>::body(BodyId id) const {
  requireUsable();
  return state_.bodies.template at<Fault::BodyNotFound>(id, "Space::body");
}

template <Scalar S>
void Space<S>::setType(BodyId id, BodyType type) {
  requireUnlocked();
  StepContext<S> world = contextOf();
  Objects<S>::setType(world, id, type);
}

// Shapes.

template <Scalar S>
ShapeId Space<S>::add(const Shape<S>& shape) {
  requireUnlocked();
  const ShapeId id = state_.shapes.nextId();
  StepContext<S> world = contextOf();
  Objects<S>::insert(world, shape, id);
  return id;
}

template <Scalar S>
ShapeId Space<S>::add(const Shape<S>& shape, ShapeId id) {
  requireUnlocked();
  state_.shapes.checkGiven(id);
  StepContext<S> world = contextOf();
  Objects<S>::insert(world, shape, id);
  return state_.shapes.idAt(id.index);
}

template <Scalar S>
void Space<S>::remove(ShapeId id) {
  requireUnlocked();
  state_.shapes.template requireAlive<Fault::ShapeNotFound>(id, "Space::remove");

  LockGuard guard(*this);
  StepContext<S> world = contextOf();
  Objects<S>::erase(world, id);
  guard.finish();
}

template <Scalar S>
const Shape<S>& Space<S>::shape(ShapeId id) const {
  requireUsable();
  return state_.shapes.template at<Fault::ShapeNotFound>(id, "Space::shape");
}

template <Scalar S>
void Space<S>::replace(ShapeId id, const Shape<S>& shape) {
  requireUsable();
  StepContext<S> world = contextOf();
  Objects<S>::replace(world, id, shape, isLocked());
}

template <Scalar S>
void Space<S>::accumulateMassFromShapes(BodyId id) {
  requireUsable();
  StepContext<S> world = contextOf();
  Objects<S>::accumulateMass(world, id);
}

template <Scalar S>
std::uint32_t Space<S>::firstShape(BodyId id) const {
  requireUsable();
  return parts_->derived.firstShapeOf(state_, id);
}

template <Scalar S>
std::uint32_t Space<S>::nextShape(std::uint32_t index) const {
  return parts_->derived.nextShape[index];
}

template <Scalar S>
BB<S> Space<S>::boundingBox(ShapeId id) {
  requireUsable();
  state_.shapes.template requireAlive<Fault::ShapeNotFound>(id, "Space::boundingBox");
  parts_->derived.refresh(state_);
  return parts_->derived.placed[id.index].box;
}

template <Scalar S>
void Space<S>::reindexStatic() {
  requireUsable();
  require<Fault::SpaceLocked>(locked_ == 0, kReindexLocked);
  parts_->derived.refresh(state_);
}

template <Scalar S>
void Space<S>::reindexShape(ShapeId id) {
  requireUsable();
  require<Fault::SpaceLocked>(locked_ == 0, kReindexLocked);
  state_.shapes.template requireAlive<Fault::ShapeNotFound>(id, "Space::reindexShape");
  parts_->derived.refresh(state_);
}

template <Scalar S>
void Space<S>::reindexShapesForBody(BodyId id) {
  requireUsable();
  require<Fault::SpaceLocked>(locked_ == 0, kReindexLocked);
  state_.bodies.template requireAlive<Fault::BodyNotFound>(id, "Space::reindexShapesForBody");
  parts_->derived.refresh(state_);
}

// Joints.

template <Scalar S>
JointId Space<S>::add(const Joint<S>& joint) {
  requireUnlocked();
  StepContext<S> world = contextOf();
  const JointId id = state_.joints.nextId();
  require<Fault::IllegalSize>(id.index < JointId::kNoIndex);
  Joints<S>::insert(world, joint, id);
  return id;
}

template <Scalar S>
JointId Space<S>::add(const Joint<S>& joint, JointId id) {
  requireUnlocked();
  StepContext<S> world = contextOf();
  state_.joints.checkGiven(id);
  Joints<S>::insert(world, joint, id);
  return state_.joints.idAt(id.index);
}

template <Scalar S>
void Space<S>::remove(JointId id) {
  requireUnlocked();
  state_.joints.template requireAlive<Fault::JointNotFound>(id, "Space::remove");
  StepContext<S> world = contextOf();
  Joints<S>::erase(world, id);
}

template <Scalar S>
const Joint<S>& Space<S>::joint(JointId id) const {
  requireUsable();
  return state_.joints.template at<Fault::JointNotFound>(id, "Space::joint");
}

template <Scalar S>
void Space<S>::replace(JointId id, const Joint<S>& joint) {
  requireUnlocked();
  StepContext<S> world = contextOf();
  Joints<S>::replace(world, id, joint);
}

template <Scalar S>
std::vector<BodyId> Space<S>::connectedTo(BodyId of) const {
  body(of);
  return Joints<S>::connectedTo(state_, of);
}

// Stepping.

template <Scalar S>
void Space<S>::step(S dt) {
  requireUnlocked();
  if (dt == S(0)) return;
  StepContext<S> context = contextOf(dt);
  Step<S>::check(context);
  context.pay(0);
  LockGuard guard(*this);
  const std::size_t waiting = parts_->postStep.size();
  if (!parts_->step.run(context)) {
    parts_->postStep.dropFrom(waiting);
    fail<Fault::TooManyPairs>("Space::step: more shapes are near each other than the ",
                              parts_->wiring.maxPairs, " pairs allowed; see Space::setMaxPairs");
  }
  guard.finish();
}

template <Scalar S>
std::span<const RangeEvent> Space<S>::rangeEvents() const {
  return parts_->events.range;
}

template <Scalar S>
void Space<S>::setEventListing(const EventListing<S>& listing) {
  requireUnlocked();
  require<Fault::ValueOutOfRange>(listing.slowestImpact >= S(0) &&
                                  listing.slowestImpact <= S(2) * kMaxSpeed<S>);
  parts_->wiring.listing = listing;
  if (!listing.contacts) parts_->events.contacts.endsBetween.clear();
}

template <Scalar S>
const EventListing<S>& Space<S>::eventListing() const {
  return parts_->wiring.listing;
}

template <Scalar S>
ContactEvents<S> Space<S>::contactEvents() const {
  const ContactLists<S>& lists = parts_->events.contacts;
  return {lists.tick, lists.begins, lists.ends, lists.impacts};
}

template <Scalar S>
std::span<const JointEvent<S>> Space<S>::jointEvents() const {
  return parts_->events.joints;
}

template <Scalar S>
const CollisionStats& Space<S>::collisionStats() const {
  return parts_->events.collisionStats;
}

template <Scalar S>
std::uint64_t Space<S>::accurateInstead() const {
  return parts_->events.accurateInstead;
}

template <Scalar S>
Remarks& Space<S>::remarks() {
  return parts_->wiring.remarks;
}

template <Scalar S>
const Remarks& Space<S>::remarks() const {
  return parts_->wiring.remarks;
}

// Queries.

template <Scalar S>
QueryView<S> Space<S>::queries() {
  requireUsable();
  Derived<S>& derived = parts_->derived;
  derived.refresh(state_);
  return QueryView<S>(state_.shapes, derived.dynamicTree, derived.staticTree, derived.placed.data());
}

template <Scalar S>
void Space<S>::pointQuery(const Vector<S>& point, S distance, const ShapeFilter& filter,
                          std::vector<PointHit<S>>& hits) {
  requireUsable();
  Queries<S>{state_, *parts_}.point(point, distance, filter, hits);
}

template <Scalar S>
void Space<S>::segmentQuery(const Vector<S>& start, const Vector<S>& end, S radius, const ShapeFilter& filter,
                            std::vector<SegmentHit<S>>& hits) {
  requireUsable();
  Queries<S>{state_, *parts_}.segment(start, end, radius, filter, hits);
}

template <Scalar S>
void Space<S>::boxQuery(const BB<S>& box, const ShapeFilter& filter, std::vector<ShapeId>& hits) {
  requireUsable();
  Queries<S>{state_, *parts_}.box(box, filter, hits);
}

#define SAMESTEP_EACH_SCALAR template class Space<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
