// SPDX-License-Identifier: MIT
#include <samestep/space.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include <samestep/make_room.h>

#include "base/change.h"
#include "base/require_ieee.h"
#include "contacts/stages/contact_callbacks.h"
#include "context/saved_parts.h"
#include "dynamics/body_access.h"
#include "state/state_hash.h"
#include "world/objects.h"
#include "world/queries.h"
#include "world/space_parts.h"

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

template <class T>
void requireIn(const char* is, T value, T low, T high, const char* unit = "") {
  require<Fault::ValueOutOfRange>(value >= low && value <= high, "settings of a Space: ", is, value, unit,
                                  ", allowed are ", low, " to ", high, unit);
}

void requireNotMain(BodyId id, BodyId staticBody, const char* asked) {
  require<Fault::MainStaticBody>(id != staticBody, asked, ": body ", id,
                                 " is the static body of the Space, which stays");
}

void requireFunction(CallbackNumber number, bool given, const char* asked) {
  require<Fault::ValueOutOfRange>(number != 0 && given, asked, number,
                                  given ? ", allowed are 1 and above" : " comes with a null function");
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

// Settings.

namespace {

/// Refuses settings that any setter would refuse.
template <Scalar S>
void check(const Settings<S>& s) {
  require<Fault::InvalidIter>(s.iterations >= 1 && s.iterations <= 1000,
                              "settings of a Space: iterations are ", s.iterations,
                              ", allowed are 1 to 1000");
  require<Fault::InvalidIter>(s.substeps >= 1 && s.substeps <= 100, "settings of a Space: substeps are ",
                              s.substeps, ", allowed are 1 to 100");
  requireIn<int>("solver is number ", static_cast<int>(s.solver), 0, static_cast<int>(SolverKind::softStep));
  requireIn<int>("precision is number ", static_cast<int>(s.precision), 0,
                 static_cast<int>(ContactPrecision::fast));
  require<Fault::ValueOutOfRange>(within(s.gravity, kMaxAcceleration<S>), "settings of a Space: gravity is ",
                                  s.gravity, " m/s^2, allowed are up to ", kMaxAcceleration<S>,
                                  " m/s^2 along each axis");
  requireIn("damping is ", s.damping, S(0), S(1));
  requireIn("collision slop is ", s.collisionSlop, S(0), S(256), " m");
  requireIn("collision bias is ", s.collisionBias, S(0), S(1));
  requireIn("contact hertz are ", s.contactHertz, S(0), S(1000));
  requireIn("contact damping is ", s.contactDamping, S(0), S(100));
  requireIn("contact push speed is ", s.contactPushSpeed, S(0), S(1 << 10), " m/s");
  requireIn("contact margin is ", s.contactMargin, S(0), S(1), " m");
  requireIn("bounce threshold is ", s.bounceThreshold, S(0), S(1 << 10), " m/s");
  require<Fault::ValueOutOfRange>(s.worldExtent > S(0) && s.worldExtent <= kMaxWorldExtent<S>,
                                  "settings of a Space: world extent is ", s.worldExtent,
                                  " m, allowed are above 0 to ", kMaxWorldExtent<S>, " m");
}

template <Scalar S, class T>
Settings<S> with(Settings<S> settings, T Settings<S>::*field, std::type_identity_t<T> value) {
  settings.*field = value;
  return settings;
}

}  // namespace

template <Scalar S>
void Space<S>::setSettings(const Settings<S>& settings) {
  requireUsable();
  check(settings);
  const bool otherSolver = settings.solver != state_.settings.solver;
  const bool otherExtent = settings.worldExtent != state_.settings.worldExtent;
  const bool otherContacts = otherSolver || settings.contactMargin != state_.settings.contactMargin;
  state_.settings = settings;
  if (otherExtent) {
    state_.bodies.each(
        [&](BodyId id, Body<S>& body) { BodyAccess<S>::attach(body, id, settings.worldExtent); });
  }
  // What sequential impulses left to push in the next step means nothing to another solver, nor later.
  if (otherSolver) state_.bodies.each([](BodyId, Body<S>& body) { BodyAccess<S>::forgetBias(body); });
  if (!otherContacts) return;
  for (Pair<S>& pair : state_.pairs) pair.manifold = Manifold::unknown;
}

template <Scalar S>
void Space<S>::setIterations(int iterations) {
  setSettings(with(state_.settings, &Settings<S>::iterations, iterations));
}

template <Scalar S>
void Space<S>::setPrecision(ContactPrecision precision) {
  setSettings(with(state_.settings, &Settings<S>::precision, precision));
}

template <Scalar S>
void Space<S>::setSolver(SolverKind kind) {
  setSettings(with(state_.settings, &Settings<S>::solver, kind));
}

template <Scalar S>
void Space<S>::setSubsteps(int substeps) {
  setSettings(with(state_.settings, &Settings<S>::substeps, substeps));
}

template <Scalar S>
void Space<S>::setGravity(const Vector<S>& gravity) {
  setSettings(with(state_.settings, &Settings<S>::gravity, gravity));
}

template <Scalar S>
void Space<S>::setDamping(S damping) {
  setSettings(with(state_.settings, &Settings<S>::damping, damping));
}

template <Scalar S>
void Space<S>::setCollisionSlop(S slop) {
  setSettings(with(state_.settings, &Settings<S>::collisionSlop, slop));
}

template <Scalar S>
void Space<S>::setCollisionBias(S bias) {
  setSettings(with(state_.settings, &Settings<S>::collisionBias, bias));
}

template <Scalar S>
void Space<S>::setCollisionPersistence(std::uint32_t steps) {
  setSettings(with(state_.settings, &Settings<S>::collisionPersistence, steps));
}

template <Scalar S>
void Space<S>::setWorldExtent(S extent) {
  setSettings(with(state_.settings, &Settings<S>::worldExtent, extent));
}

template <Scalar S>
void Space<S>::setContactSoftness(S hertz, S damping) {
  Settings<S> next = state_.settings;
  next.contactHertz = hertz;
  next.contactDamping = damping;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setContactPushSpeed(S speed) {
  setSettings(with(state_.settings, &Settings<S>::contactPushSpeed, speed));
}

template <Scalar S>
void Space<S>::setContactMargin(S margin) {
  setSettings(with(state_.settings, &Settings<S>::contactMargin, margin));
}

template <Scalar S>
void Space<S>::setBounceThreshold(S speed) {
  setSettings(with(state_.settings, &Settings<S>::bounceThreshold, speed));
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
  Objects<S>::erase(world, id);
}

template <Scalar S>
void Space<S>::removeWithShapes(BodyId id) {
  requireUnlocked();
  state_.bodies.template requireAlive<Fault::BodyNotFound>(id, "Space::removeWithShapes");
  requireNotMain(id, state_.staticBody, "Space::removeWithShapes");
  LockGuard guard(*this);
  StepContext<S> world = contextOf();
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

// Locking and callbacks.

template <Scalar S>
void Space<S>::unlock(bool runPostStep) {
  require<Fault::SpaceLockUnderflow>(locked_ > 0);
  --locked_;
  if (!runPostStep || locked_ > 0 || parts_->postStep.running()) return;
  parts_->postStep.run(*this);
}

template <Scalar S>
bool Space<S>::addPostStepCallback(PostStepFunc function, std::uint64_t key, void* data) {
  require<Fault::ValueOutOfRange>(function != nullptr, "Space::addPostStepCallback: key ", key,
                                  " comes with a null function");
  if (!parts_->postStep.add(function, key, data)) return false;
  if (locked_ == 0 && !parts_->postStep.running()) {
    lock();
    unlock(true);
  }
  return true;
}

template <Scalar S>
void Space<S>::registerHandler(CallbackNumber number, const CollisionHandler<S>& handler) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ValueOutOfRange>(number != 0,
                                  "Space::registerHandler: number is 0, allowed are 1 and above");
  Wiring<S>& wiring = parts_->wiring;
  Wiring<S>::set(wiring.handlers, typename Wiring<S>::RegisteredHandler{number, handler});
  wiring.bound.take(state_.handlers, wiring.handlers);
}

template <Scalar S>
void Space<S>::registerPositionFunc(CallbackNumber number, PositionFunc function, void* data) {
  require<Fault::SpaceLocked>(locked_ == 0);
  requireFunction(number, function != nullptr, "Space::registerPositionFunc: number ");
  Wiring<S>::set(parts_->wiring.positionFuncs, {number, function, data});
}

template <Scalar S>
void Space<S>::registerVelocityFunc(CallbackNumber number, VelocityFunc function, void* data) {
  require<Fault::SpaceLocked>(locked_ == 0);
  requireFunction(number, function != nullptr, "Space::registerVelocityFunc: number ");
  Wiring<S>::set(parts_->wiring.velocityFuncs, {number, function, data});
}

namespace {

/// Puts a binding in its place, or in that of one for the same collisions.
template <Scalar S>
void bind(StepContext<S> world, const HandlerBinding& binding, const char* asked) {
  require<Fault::MissingCallback>(world.wiring.has(binding.number), asked,
                                  ": no handler is registered under ", binding.number,
                                  "; see Space::registerHandler");
  auto& all = world.state.handlers;
  makeRoom(all, all.size() + 1);
  world.wiring.bound.reserve(all.size() + 1);
  const auto place = std::lower_bound(all.begin(), all.end(), binding, HandlerBinding::before);
  if (place != all.end() && !HandlerBinding::before(binding, *place)) {
    *place = binding;
  } else {
    all.insert(place, binding);
  }
  world.wiring.bound.take(all, world.wiring.handlers);
}

}  // namespace

template <Scalar S>
void Space<S>::addCollisionHandler(CollisionType typeA, CollisionType typeB, CallbackNumber number) {
  requireUnlocked();
  bind(contextOf(), {typeA, typeB, number, HandlerBinding::Kind::pair}, "Space::addCollisionHandler");
}

template <Scalar S>
void Space<S>::addWildcardHandler(CollisionType type, CallbackNumber number) {
  requireUnlocked();
  bind(contextOf(), {type, kWildcardCollisionType, number, HandlerBinding::Kind::wildcard},
       "Space::addWildcardHandler");
}

template <Scalar S>
void Space<S>::addDefaultCollisionHandler(CallbackNumber number) {
  requireUnlocked();
  bind(contextOf(), {kWildcardCollisionType, kWildcardCollisionType, number, HandlerBinding::Kind::fallback},
       "Space::addDefaultCollisionHandler");
}

template <Scalar S>
void Space<S>::setStageObserver(StageObserver observer, void* data) {
  parts_->wiring.observer = observer;
  parts_->wiring.observerData = data;
}

template <Scalar S>
void Space<S>::setMaxPairs(std::uint32_t pairs) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ValueOutOfRange>(pairs <= kMostPairs, "Space::setMaxPairs: pairs are ", pairs,
                                  ", allowed are 0 to ", kMostPairs);
  parts_->wiring.maxPairs = pairs;
}

template <Scalar S>
std::uint32_t Space<S>::maxPairs() const {
  return parts_->wiring.maxPairs;
}

template <Scalar S>
void Space<S>::setInterrupt(const Interrupt& interrupt) {
  parts_->wiring.budget.interrupt = interrupt;
}

template <Scalar S>
void Space<S>::setMaxWork(std::uint64_t work) {
  parts_->wiring.budget.most = work;
}

template <Scalar S>
std::uint64_t Space<S>::work() const {
  return parts_->wiring.budget.spent();
}

// Who computes.

template <Scalar S>
void Space<S>::setWorkers(TaskRunner* runner, Sharing sharing) {
  require<Fault::SpaceLocked>(locked_ == 0);
  // Checked numbers note their high-water marks in one table, and report by exception.
  constexpr bool kAlone = requires { requires S::kChecks; };
  parts_->team.set(kAlone ? nullptr : runner, sharing);
  parts_->wiring.runner = runner;
}

template <Scalar S>
TaskRunner* Space<S>::workers() const {
  return parts_->wiring.runner;
}

template <Scalar S>
void Space<S>::setKernel(KernelTarget target) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ValueOutOfRange>(target <= KernelTarget::simd128, "Space::setKernel: target is number ",
                                  static_cast<int>(target), ", allowed are 0 to ",
                                  static_cast<int>(KernelTarget::simd128));
  if (!isAvailable(target)) {
    parts_->wiring.remarks.raise(
        Remark::OtherKernel,
        "This build or this processor does not have that kernel: the next best one is taken. No "
        "result differs.");
  }
  forceKernel(nextBestKernel(target));
}

template <Scalar S>
void Space<S>::forceKernel(KernelTarget target) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::KernelUnavailable>(isAvailable(target), "Space::forceKernel: ", kernelName(target),
                                    " is not in this build, or not for this processor");
  parts_->wiring.kernel = nextBestKernel(target);
  parts_->step.soft.setKernel(parts_->wiring.kernel);
}

template <Scalar S>
KernelTarget Space<S>::kernel() const {
  return parts_->wiring.kernel;
}

// Saving.

template <Scalar S>
void Space<S>::save(SavedSpace<S>& into) const {
  requireUnlocked();
  if (into.parts_ == nullptr) into.parts_ = new SavedParts<S>;
  into.parts_->take(state_, parts_->derived);
}

template <Scalar S>
SavedSpace<S> Space<S>::save() const {
  SavedSpace<S> saved;
  save(saved);
  return saved;
}

namespace {

/// @throws ForeignWorld, MissingCallback
template <Scalar S>
void checkAdoptable(const Wiring<S>& wiring, const WorldState<S>& state) {
  require<Fault::ForeignWorld>(state.bodies.contains(state.staticBody), "Nothing was saved there.");
  for (const HandlerBinding& binding : state.handlers) {
    require<Fault::MissingCallback>(wiring.has(binding.number),
                                    "a world: its handlers need one registered under ", binding.number,
                                    "; see Space::registerHandler");
  }
  state.bodies.each([&](BodyId, const Body<S>& body) { wiring.requireCallbacks(body); });
}

/// Gives the objects of a world, whose records have an id, to its Space, together with how far it reaches.
template <Scalar S>
struct GiveObjects {
  S worldExtent;

  template <class T>
  void operator()(const char*, T&) {}
  template <class T>
  void operator()(const Section&, std::vector<T>&) {}
  template <class T, class IdType>
  void operator()(const Section&, SlotMap<T, IdType>& objects) {
    objects.each([&](IdType id, T& object) { give(object, id); });
  }
  void give(Body<S>& body, BodyId id) { BodyAccess<S>::attach(body, id, worldExtent); }
  void give(Shape<S>& shape, ShapeId id) { shape.attach(id); }
};

/// Makes a state that came from elsewhere the Space's own.
template <Scalar S>
void takeOver(StepContext<S> world) {
  ++world.wiring.worldsBroughtIn;
  WorldState<S>::sections(GiveObjects<S>{world.state.settings.worldExtent}, world.state);
  world.wiring.bound.take(world.state.handlers, world.wiring.handlers);
  world.derived.shapesHashKnown = false;
  world.derived.forget();
  world.derived.surfacesLacking = true;
  world.events.range.clear();
}

}  // namespace

template <Scalar S>
std::uint64_t Space<S>::worldsBroughtIn() const {
  return parts_->wiring.worldsBroughtIn;
}

template <Scalar S>
template <class Bring>
void Space<S>::bringIn(std::uint32_t theirs, Bring&& bring) {
  const std::uint32_t space = theirs != 0 ? theirs : state_.bodies.space();
  Change change(leftMidway_);
  parts_->postStep.drop();
  bring();
  giveIds(space);
  takeOver(contextOf());
  change.done();
  leftMidway_ = false;
}

template <Scalar S>
void Space<S>::restore(const SavedSpace<S>& saved) {
  require<Fault::SpaceLocked>(locked_ == 0);
  require<Fault::ForeignWorld>(saved.parts_ != nullptr && !saved.parts_->records.empty(),
                               "Nothing was saved there.");
  saved.parts_->records.requireCallbacks(parts_->wiring);
  bringIn(saved.parts_->records.space(), [&] { saved.parts_->records.giveTo(state_); });
  Change change(leftMidway_);
  parts_->derived.restoreFrom(saved.parts_->derived, state_);
  change.done();
}

template <Scalar S>
void Space<S>::adopt(const WorldState<S>& state) {
  require<Fault::SpaceLocked>(locked_ == 0);
  checkAdoptable(parts_->wiring, state);
  bringIn(state.bodies.space(), [&] { state_ = state; });
}

template <Scalar S>
void Space<S>::adopt(WorldState<S>&& state) {
  require<Fault::SpaceLocked>(locked_ == 0);
  checkAdoptable(parts_->wiring, state);
  bringIn(state.bodies.space(), [&] { state_ = std::move(state); });
}

template <Scalar S>
void Space<S>::dropCache() {
  require<Fault::SpaceLocked>(locked_ == 0);
  parts_->derived.forget();
}

// Collisions.

template <Scalar S>
void Space<S>::visitArbiters(const BodyId* of, void (*visit)(Arbiter<S>&, void*), void* data) {
  requireUsable();
  StepContext<S> world = contextOf();
  world.derived.completePairs(state_);
  const auto visitPair = [&](Pair<S>& pair) {
    if (!ContactCallbacks<S>::touching(pair)) return;
    Arbiter<S> arbiter = ContactCallbacks<S>::arbiterOf(world, pair);
    visit(arbiter, data);
  };
  if (of == nullptr) {
    LockGuard guard(*this);
    for (Pair<S>& pair : state_.pairs) visitPair(pair);
    guard.finish();
  } else {
    const std::span<const std::uint32_t> pairs = parts_->derived.pairsOf(state_, *of);
    LockGuard guard(*this);
    for (const std::uint32_t index : pairs) visitPair(state_.pairs[index]);
    guard.finish();
  }
}

template <Scalar S>
void Space<S>::filterArbiters(BodyId body, ShapeId shape) {
  requireUnlocked();
  state_.bodies.template requireAlive<Fault::BodyNotFound>(body, "Space::filterArbiters");
  if (shape.valid())
    state_.shapes.template requireAlive<Fault::ShapeNotFound>(shape, "Space::filterArbiters");
  require<Fault::ShapeNotFound>(!shape.valid() || state_.shapes.valueAt(shape.index).body() == body,
                                "Space::filterArbiters: shape ", shape, " is not one of body ", body);
  LockGuard guard(*this);
  StepContext<S> world = contextOf();
  Change change(leftMidway_);
  ContactCallbacks<S>::dropPairs(world, body, shape);
  change.done();
  guard.finish();
}

template <Scalar S>
bool Space<S>::callWildcardBeginA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardBegin(world, arbiter, false);
}

template <Scalar S>
bool Space<S>::callWildcardBeginB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardBegin(world, arbiter, true);
}

template <Scalar S>
bool Space<S>::callWildcardPreSolveA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardPreSolve(world, arbiter, false);
}

template <Scalar S>
bool Space<S>::callWildcardPreSolveB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  return ContactCallbacks<S>::wildcardPreSolve(world, arbiter, true);
}

template <Scalar S>
void Space<S>::callWildcardPostSolveA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardPostSolve(world, arbiter, false);
}

template <Scalar S>
void Space<S>::callWildcardPostSolveB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardPostSolve(world, arbiter, true);
}

template <Scalar S>
void Space<S>::callWildcardSeparateA(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardSeparate(world, arbiter, false);
}

template <Scalar S>
void Space<S>::callWildcardSeparateB(Arbiter<S>& arbiter) {
  StepContext<S> world = contextOf();
  ContactCallbacks<S>::wildcardSeparate(world, arbiter, true);
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

// Hashes.

template <Scalar S>
std::uint64_t Space<S>::hash() const {
  requireUsable();
  Derived<S>& derived = parts_->derived;
  if (!derived.shapesHashKnown) {
    derived.shapesHash = hashOfShapes(state_.shapes);
    derived.shapesHashKnown = true;
  }
  return hashOfWorld(state_, derived.shapesHash);
}

template <Scalar S>
std::uint64_t Space<S>::hash(BodyId id) const {
  return hashOf(body(id));
}

template <Scalar S>
std::uint64_t Space<S>::hash(ShapeId id) const {
  return hashOf(shape(id));
}

#define SAMESTEP_EACH_SCALAR template class Space<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
