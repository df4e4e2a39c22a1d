// SPDX-License-Identifier: MIT
#include <samestep/space.h>

#include <algorithm>
#include <atomic>
#include <tuple>

#include "base/require_ieee.h"
#include "state/state_hash.h"
#include "world/space_impl.h"

namespace samestep {
namespace {

/// Tells the objects of one Space from those of another; 0 is nobody's. Never part of a result.
std::uint32_t nextSerial() {
  static std::atomic<std::uint32_t> last{0};
  return ++last;
}

constexpr const char* kReindexLocked =
    "You cannot manually reindex objects while the space is locked. Wait until the current query or step is "
    "complete.";

template <Scalar S>
void requireIn(S value, S low, S high) {
  require<Fault::ValueOutOfRange>(value >= low && value <= high);
}

}  // namespace

const char* stageName(Stage stage) {
  switch (stage) {
    case Stage::integratePositions:
      return "integrate positions";
    case Stage::updateShapes:
      return "update shapes";
    case Stage::findPairs:
      return "find pairs";
    case Stage::collide:
      return "collide";
    case Stage::preStep:
      return "pre-step";
    case Stage::integrateVelocities:
      return "integrate velocities";
    case Stage::solve:
      return "solve";
    case Stage::callbacks:
      return "callbacks";
  }
  return "unknown";
}

template <Scalar S>
Space<S>::Space() : impl_(new Impl) {
  impl_->serial = nextSerial();
  state_.staticBody = add(Body<S>::fixedInPlace());
}

template <Scalar S>
Space<S>::~Space() {
  delete impl_;
}

template <Scalar S>
void Space<S>::requireUnlocked() const {
  require<Fault::SpaceLocked>(locked_ == 0);
}

// Settings.

namespace {

/// Refuses settings that any setter would refuse.
template <Scalar S>
void check(const Settings<S>& s) {
  require<Fault::InvalidIter>(s.iterations >= 1 && s.iterations <= 1000);
  require<Fault::InvalidIter>(s.substeps >= 1 && s.substeps <= 100, "Substeps must be from 1 to 100.");
  require<Fault::ValueOutOfRange>(s.solver <= SolverKind::softStep && s.precision <= ContactPrecision::fast);
  require<Fault::ValueOutOfRange>(within(s.gravity, kMaxAcceleration<S>));
  requireIn(s.damping, S(0), S(1));
  requireIn(s.collisionSlop, S(0), S(256));
  requireIn(s.collisionBias, S(0), S(1));
  requireIn(s.contactHertz, S(0), S(1000));
  requireIn(s.contactDamping, S(0), S(100));
  requireIn(s.contactPushSpeed, S(0), S(1 << 10));
  requireIn(s.contactMargin, S(0), S(1));
  requireIn(s.bounceThreshold, S(0), S(1 << 10));
  require<Fault::ValueOutOfRange>(s.worldExtent > S(0) && s.worldExtent <= kMaxWorldExtent<S>);
}

}  // namespace

template <Scalar S>
void Space<S>::setSettings(const Settings<S>& settings) {
  check(settings);
  const bool otherContacts =
      settings.solver != state_.settings.solver || settings.contactMargin != state_.settings.contactMargin;
  const bool otherSolver = settings.solver != state_.settings.solver;
  state_.settings = settings;
  // What sequential impulses left to push in the next step means nothing to another solver, nor later.
  if (otherSolver) state_.bodies.each([](BodyId, Body<S>& body) { body.forgetBias(); });
  if (!otherContacts) return;
  for (Pair<S>& pair : state_.pairs) pair.manifold = Manifold::unknown;
}

template <Scalar S>
void Space<S>::setIterations(int iterations) {
  Settings<S> next = state_.settings;
  next.iterations = iterations;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setPrecision(ContactPrecision precision) {
  Settings<S> next = state_.settings;
  next.precision = precision;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setSolver(SolverKind kind) {
  Settings<S> next = state_.settings;
  next.solver = kind;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setSubsteps(int substeps) {
  Settings<S> next = state_.settings;
  next.substeps = substeps;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setGravity(const Vector<S>& gravity) {
  Settings<S> next = state_.settings;
  next.gravity = gravity;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setDamping(S damping) {
  Settings<S> next = state_.settings;
  next.damping = damping;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setCollisionSlop(S slop) {
  Settings<S> next = state_.settings;
  next.collisionSlop = slop;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setCollisionBias(S bias) {
  Settings<S> next = state_.settings;
  next.collisionBias = bias;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setCollisionPersistence(std::uint32_t steps) {
  Settings<S> next = state_.settings;
  next.collisionPersistence = steps;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setWorldExtent(S extent) {
  Settings<S> next = state_.settings;
  next.worldExtent = extent;
  setSettings(next);
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
  Settings<S> next = state_.settings;
  next.contactPushSpeed = speed;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setContactMargin(S margin) {
  Settings<S> next = state_.settings;
  next.contactMargin = margin;
  setSettings(next);
}

template <Scalar S>
void Space<S>::setBounceThreshold(S speed) {
  Settings<S> next = state_.settings;
  next.bounceThreshold = speed;
  setSettings(next);
}

// Bodies.

template <Scalar S>
void Space<S>::checkNew(const Body<S>& body) const {
  requireUnlocked();
  require<Fault::DuplicateBody>(!body.id().valid() || body.owner_ != impl_->serial);
  require<Fault::AttachedBody>(!body.id().valid());
  require<Fault::IllegalBody>(within(body.worldCenter(), worldExtent()), "Body's position is invalid.");
}

/// Makes a body just stored its own.
template <Scalar S>
void Space<S>::attach(BodyId id) {
  Body<S>& kept = state_.bodies.valueAt(id.index);
  kept.id_ = id;
  kept.owner_ = impl_->serial;
  ensureCache();
  impl_->growBodies(state_.bodies.slots());
}

template <Scalar S>
BodyId Space<S>::add(const Body<S>& body) {
  checkNew(body);
  const BodyId id = state_.bodies.insert(body);
  attach(id);
  return id;
}

template <Scalar S>
BodyId Space<S>::add(const Body<S>& body, BodyId id) {
  checkNew(body);
  state_.bodies.insertAt(id, body);
  attach(id);
  return id;
}

template <Scalar S>
BodyId Space<S>::setStaticBody(const Body<S>& body) {
  requireUnlocked();
  require<Fault::AttachedStaticBody>(firstShape(staticBody()) == Impl::kNone);
  require<Fault::IllegalBody>(body.type() == BodyType::staticBody, "The body is not static.");

  const BodyId before = state_.staticBody;
  state_.staticBody = add(body);
  remove(before);
  return state_.staticBody;
}

template <Scalar S>
void Space<S>::remove(BodyId id) {
  requireUnlocked();
  require<Fault::BodyNotFound>(contains(id));
  require<Fault::MainStaticBody>(id != state_.staticBody);
  require<Fault::BodyHasShapes>(firstShape(id) == Impl::kNone);

  eraseBody(id);
}

template <Scalar S>
void Space<S>::eraseBody(BodyId id) {
  state_.bodies.erase(id);
  impl_->poses[id.index] = {};
}

template <Scalar S>
void Space<S>::removeWithShapes(BodyId id) {
  requireUnlocked();
  require<Fault::BodyNotFound>(contains(id));
  require<Fault::MainStaticBody>(id != state_.staticBody);
  LockGuard guard(*this);
  while (firstShape(id) != Impl::kNone) eraseShape(state_.shapes.idAt(firstShape(id)));
  eraseBody(id);
  guard.finish();
}

template <Scalar S>
Body<S>& Space<S>::body(BodyId id) {
  Body<S>& found = state_.bodies.template at<Fault::BodyNotFound>(id);
  impl_->touch(id.index);
  return found;
}

template <Scalar S>
const Body<S>& Space<S>::body(BodyId id) const {
  return state_.bodies.template at<Fault::BodyNotFound>(id);
}

template <Scalar S>
void Space<S>::setType(BodyId id, BodyType type) {
  requireUnlocked();
  Body<S>& kept = body(id);
  require<Fault::MainStaticBody>(id != state_.staticBody || type == BodyType::staticBody,
                                 "The designated static body of a space stays static.");
  if (type == kept.type()) return;
  Body<S> changed = kept.detached();
  changed.setType(type);
  for (std::uint32_t i = firstShape(id); i != Impl::kNone; i = nextShape(i)) {
    checkShape(state_.shapes.valueAt(i), changed);
  }
  if (changed.isDynamic() && changed.mass() == S(0)) {
    const MassProperties<S> mass = massOfShapes(id, Impl::kNone, nullptr);
    if (mass.mass > S(0)) changed.setMassProperties(mass);
  }

  changed.id_ = kept.id_;
  changed.owner_ = kept.owner_;
  kept = changed;
}

// Shapes.

template <Scalar S>
void Space<S>::checkShape(const Shape<S>& shape, const Body<S>& body) const {
  const S limit = body.type() == BodyType::staticBody ? S(kMaxExtent) : S(kMaxDynamicExtent);
  require<Fault::SizeOutOfRange>(shape.extent() <= limit,
                                 "A shape of a body that moves reaches farther than 2^8 m from its origin.");
}

/// What the shapes of a body weigh together, with `by`, unless it is null, in place of the one in the slot
/// `replaced`, if there is one. By rising slot, so that it does not matter which came first.
template <Scalar S>
MassProperties<S> Space<S>::massOfShapes(BodyId id, std::uint32_t replaced, const Shape<S>* by) const {
  // The shapes' own sums first, then the parallel axes, all at full range: no Fixed intermediate can
  // overflow or lose a small shape beside a large one.
  struct Part {
    Scaled<S> mass, x, y, unitMoment;
  };
  Scaled<S> mass{}, x{}, y{}, moment{};
  const auto eachPart = [&](auto&& visit) {
    const auto visitShape = [&](const Shape<S>& shape) {
      const ShapeMassInfo<S>& info = shape.massInfo();
      if (info.mass > S(0)) {
        visit(
            Part{toScaled(info.mass), toScaled(info.centroid.x), toScaled(info.centroid.y), info.unitMoment});
      }
    };
    const Shape<S>* waiting = by;
    for (std::uint32_t i = firstShape(id); i != Impl::kNone; i = nextShape(i)) {
      if (waiting != nullptr && i >= replaced) {
        visitShape(*waiting);
        waiting = nullptr;
      }
      if (i != replaced) visitShape(state_.shapes.valueAt(i));
    }
    if (waiting != nullptr) visitShape(*waiting);
  };
  // One lonely shape keeps its numbers exactly.
  eachPart([&](const Part& part) {
    const Scaled<S> sum = mass + part.mass;
    const Scaled<S> dx = part.x - x;
    const Scaled<S> dy = part.y - y;
    moment = moment + part.mass * part.unitMoment;
    if (mass > Scaled<S>{}) {
      moment = moment + (dx * dx + dy * dy) * (mass * part.mass / sum);
      x = x + dx * (part.mass / sum);
      y = y + dy * (part.mass / sum);
    } else {
      x = part.x;
      y = part.y;
    }
    mass = sum;
  });
  return {saturated<S>(mass), moment, {toScalar<S>(x), toScalar<S>(y)}};
}

/// Whether any shape of a body has mass, with `by` in place of one of them as in massOfShapes.
template <Scalar S>
bool Space<S>::anyShapeWeighs(BodyId id, std::uint32_t replaced, const Shape<S>* by) const {
  if (by != nullptr && by->mass() > S(0)) return true;
  for (std::uint32_t i = firstShape(id); i != Impl::kNone; i = nextShape(i)) {
    if (i != replaced && state_.shapes.valueAt(i).mass() > S(0)) return true;
  }
  return false;
}

/// Makes a body weigh what its shapes do, after a change of those that have mass. One that is not dynamic
/// has no use for a mass, whose parts may be beyond what a dynamic one may have: it is summed when it
/// becomes dynamic.
template <Scalar S>
void Space<S>::takeMass(BodyId id, std::uint32_t replaced, const Shape<S>* by) {
  Body<S>& holder = state_.bodies.valueAt(id.index);
  if (holder.isDynamic()) {
    holder.setMassProperties(massOfShapes(id, replaced, by));
  } else if (anyShapeWeighs(id, replaced, by)) {
    holder.forgetMass();
  } else {
    holder.setMassProperties({});
  }
}

template <Scalar S>
ShapeId Space<S>::add(const Shape<S>& shape) {
  const ShapeId id = state_.shapes.nextId();
  insert(shape, id);
  return id;
}

template <Scalar S>
ShapeId Space<S>::add(const Shape<S>& shape, ShapeId id) {
  requireUnlocked();
  state_.shapes.checkGiven(id);
  insert(shape, id);
  return id;
}

/// @pre the id can be given to a new shape
template <Scalar S>
void Space<S>::insert(const Shape<S>& shape, ShapeId id) {
  requireUnlocked();
  require<Fault::DuplicateShape>(!shape.id().valid() || shape.owner() != impl_->serial);
  require<Fault::AttachedShape>(!shape.id().valid());
  const Body<S>& holder = state_.bodies.template at<Fault::BodyNotFound>(shape.body());
  require<Fault::DegenerateShape>(shape.wellFormed());
  checkShape(shape, holder);
  ensureCache();
  const BodyId bodyId = shape.body();
  if (shape.mass() > S(0)) takeMass(bodyId, id.index, &shape);

  impl_->shapesHashKnown = false;
  state_.shapes.store(id, shape);
  Shape<S>& kept = state_.shapes.valueAt(id.index);
  kept.attach(id, impl_->serial);
  impl_->growShapes(state_.shapes.slots());
  impl_->linkShape(bodyId.index, id.index);
  impl_->prepareShape(id.index, kept);
  // The next step or query places all shapes of the body.
  impl_->poses[bodyId.index].known = false;
  impl_->touch(bodyId.index);
}

template <Scalar S>
void Space<S>::remove(ShapeId id) {
  requireUnlocked();
  require<Fault::ShapeNotFound>(contains(id));

  LockGuard guard(*this);
  eraseShape(id);
  guard.finish();
}

template <Scalar S>
void Space<S>::eraseShape(ShapeId id) {
  ensureCache();
  const BodyId bodyId = state_.shapes.valueAt(id.index).body();
  dropPairs(bodyId, id);

  if (state_.shapes.valueAt(id.index).mass() > S(0)) takeMass(bodyId, id.index, nullptr);
  impl_->dropBox(id.index);
  impl_->unlinkShape(bodyId.index, id.index);
  impl_->shapesHashKnown = false;
  state_.shapes.erase(id);
  impl_->touch(bodyId.index);
}

template <Scalar S>
const Shape<S>& Space<S>::shape(ShapeId id) const {
  return state_.shapes.template at<Fault::ShapeNotFound>(id);
}

template <Scalar S>
void Space<S>::replace(ShapeId id, const Shape<S>& shape) {
  Shape<S>& kept = state_.shapes.template at<Fault::ShapeNotFound>(id);
  Shape<S> next = shape;
  next.attach(id, impl_->serial);
  next.setBody(kept.body());
  const std::span<const Vector<S>> before = kept.vertices(), after = next.vertices();
  const bool sameGeometry = next.type() == kept.type() && next.radius() == kept.radius() &&
                            std::equal(before.begin(), before.end(), after.begin(), after.end());
  // Where a shape without mass has its centroid is nothing to its body.
  const bool weighs = next.mass() > S(0) || kept.mass() > S(0);
  const bool sameMass = !weighs || next.massInfo() == kept.massInfo();
  if (!sameGeometry || !sameMass) {
    requireUnlocked();
    require<Fault::DegenerateShape>(next.wellFormed());
    checkShape(next, state_.bodies.valueAt(kept.body().index));
    ensureCache();
    if (!sameMass) takeMass(kept.body(), id.index, &next);
    impl_->touch(kept.body().index);
  }

  impl_->shapesHashKnown = false;
  impl_->surfacesKnown = false;
  kept = next;
  ensureCache();
  impl_->takeTraits(id.index, kept);
  if (!sameGeometry) {
    forgetManifolds(id);
    impl_->prepareShape(id.index, kept);
    impl_->poses[kept.body().index].known = false;
  }
}

/// The next step collides anew what touches a shape.
template <Scalar S>
void Space<S>::forgetManifolds(ShapeId id) {
  for (const std::uint32_t index : threadOf(state_.shapes.valueAt(id.index).body())) {
    Pair<S>& pair = state_.pairs[index];
    if (pair.a == id || pair.b == id) pair.manifold = Manifold::unknown;
  }
}

template <Scalar S>
void Space<S>::accumulateMassFromShapes(BodyId id) {
  require<Fault::BodyNotFound>(contains(id));
  impl_->touch(id.index);
  takeMass(id, Impl::kNone, nullptr);
}

template <Scalar S>
std::uint32_t Space<S>::firstShape(BodyId id) const {
  require<Fault::BodyNotFound>(contains(id));
  ensureCache();
  return impl_->firstShape[id.index];
}

template <Scalar S>
std::uint32_t Space<S>::nextShape(std::uint32_t index) const {
  return impl_->nextShape[index];
}

template <Scalar S>
BB<S> Space<S>::boundingBox(ShapeId id) {
  require<Fault::ShapeNotFound>(contains(id));
  refreshTouched();
  return impl_->placed[id.index].box;
}

template <Scalar S>
void Space<S>::reindexStatic() {
  require<Fault::SpaceLocked>(locked_ == 0, kReindexLocked);
  refreshTouched();
}

template <Scalar S>
void Space<S>::reindexShape(ShapeId id) {
  require<Fault::SpaceLocked>(locked_ == 0, kReindexLocked);
  require<Fault::ShapeNotFound>(contains(id));
  refreshTouched();
}

template <Scalar S>
void Space<S>::reindexShapesForBody(BodyId id) {
  require<Fault::SpaceLocked>(locked_ == 0, kReindexLocked);
  require<Fault::BodyNotFound>(contains(id));
  refreshTouched();
}

// Locking and callbacks.

template <Scalar S>
void Space<S>::unlock(bool runPostStep) {
  require<Fault::SpaceLockUnderflow>(locked_ > 0);
  --locked_;
  if (!runPostStep || locked_ > 0 || impl_->runningPostStep) return;
  impl_->runPostStep(*this);
}

template <Scalar S>
void Space<S>::Impl::runPostStep(Space& space) {
  // After a callback that throws the later ones wait for the next time.
  struct Running {
    Impl& impl;
    std::size_t done = 0;
    explicit Running(Impl& of) : impl(of) { impl.runningPostStep = true; }
    ~Running() {
      impl.postStep.erase(impl.postStep.begin(), impl.postStep.begin() + static_cast<std::ptrdiff_t>(done));
      impl.runningPostStep = false;
    }
  } running(*this);
  // A callback may add callbacks: they run in the same go.
  while (running.done < postStep.size()) {
    const PostStep callback = postStep[running.done];
    postStep[running.done++].function = nullptr;
    callback.function(space, callback.key, callback.data);
  }
}

template <Scalar S>
bool Space<S>::addPostStepCallback(PostStepFunc function, std::uint64_t key, void* data) {
  require<Fault::ValueOutOfRange>(function != nullptr);
  for (const typename Impl::PostStep& waiting : impl_->postStep) {
    if (waiting.function != nullptr && waiting.key == key) return false;
  }
  impl_->postStep.push_back({function, key, data});
  if (locked_ == 0 && !impl_->runningPostStep) {
    lock();
    unlock(true);
  }
  return true;
}

template <Scalar S>
void Space<S>::registerHandler(CallbackNumber number, const CollisionHandler<S>& handler) {
  requireUnlocked();
  require<Fault::ValueOutOfRange>(number != 0);
  Impl::set(impl_->handlers, typename Impl::RegisteredHandler{number, handler});
}

template <Scalar S>
void Space<S>::registerPositionFunc(CallbackNumber number, PositionFunc function, void* data) {
  requireUnlocked();
  require<Fault::ValueOutOfRange>(number != 0 && function != nullptr);
  Impl::set(impl_->positionFuncs, {number, function, data});
}

template <Scalar S>
void Space<S>::registerVelocityFunc(CallbackNumber number, VelocityFunc function, void* data) {
  requireUnlocked();
  require<Fault::ValueOutOfRange>(number != 0 && function != nullptr);
  Impl::set(impl_->velocityFuncs, {number, function, data});
}

template <Scalar S>
void Space<S>::bind(const HandlerBinding& binding) {
  requireUnlocked();
  require<Fault::MissingCallback>(Impl::find(impl_->handlers, binding.number) != nullptr);
  const auto key = [](const HandlerBinding& b) { return std::tuple(b.kind, b.typeA, b.typeB); };
  auto& all = state_.handlers;
  const auto place = std::lower_bound(all.begin(), all.end(), binding,
                                      [&](const auto& a, const auto& b) { return key(a) < key(b); });
  if (place != all.end() && key(*place) == key(binding)) {
    *place = binding;
  } else {
    all.insert(place, binding);
  }
}

template <Scalar S>
void Space<S>::addCollisionHandler(CollisionType typeA, CollisionType typeB, CallbackNumber number) {
  bind({typeA, typeB, number, HandlerBinding::Kind::pair});
}

template <Scalar S>
void Space<S>::addWildcardHandler(CollisionType type, CallbackNumber number) {
  bind({type, kWildcardCollisionType, number, HandlerBinding::Kind::wildcard});
}

template <Scalar S>
void Space<S>::addDefaultCollisionHandler(CallbackNumber number) {
  bind({kWildcardCollisionType, kWildcardCollisionType, number, HandlerBinding::Kind::fallback});
}

template <Scalar S>
void Space<S>::setStageObserver(StageObserver observer, void* data) {
  impl_->observer = observer;
  impl_->observerData = data;
}

template <Scalar S>
void Space<S>::setMaxPairs(std::uint32_t pairs) {
  requireUnlocked();
  require<Fault::ValueOutOfRange>(pairs <= kMostPairs);
  impl_->maxPairs = pairs;
}

template <Scalar S>
std::uint32_t Space<S>::maxPairs() const {
  return impl_->maxPairs;
}

// Who computes.

template <Scalar S>
void Space<S>::setWorkers(TaskRunner* runner, Sharing sharing) {
  requireUnlocked();
  // Checked numbers note their high-water marks in one table, and report by exception.
  constexpr bool kAlone = requires { requires S::kChecks; };
  impl_->runner = runner;
  impl_->crew.set(kAlone ? nullptr : runner, sharing);
}

template <Scalar S>
TaskRunner* Space<S>::workers() const {
  return impl_->runner;
}

template <Scalar S>
void Space<S>::setKernel(KernelTarget target) {
  requireUnlocked();
  require<Fault::ValueOutOfRange>(target <= KernelTarget::simd128);
  if (!isAvailable(target)) {
    remarks_.raise(Remark::OtherKernel,
                   "This build or this processor does not have that kernel: the next best one is taken. No "
                   "result differs.");
  }
  forceKernel(nextBestKernel(target));
}

template <Scalar S>
void Space<S>::forceKernel(KernelTarget target) {
  requireUnlocked();
  require<Fault::KernelUnavailable>(isAvailable(target));
  impl_->kernel = nextBestKernel(target);
  impl_->soft.solvers.setKernel(impl_->kernel);
}

template <Scalar S>
KernelTarget Space<S>::kernel() const {
  return impl_->kernel;
}

// Saving.

template <Scalar S>
void Space<S>::save(SavedSpace<S>& into) const {
  requireUnlocked();
  into.state_ = state_;
  if (into.cache_ == nullptr) into.cache_ = new SpaceCache<S>;
  into.cache_->copyFrom(*impl_);
}

template <Scalar S>
SavedSpace<S> Space<S>::save() const {
  SavedSpace<S> saved;
  save(saved);
  return saved;
}

template <Scalar S>
void Space<S>::restore(const SavedSpace<S>& saved) {
  adopt(saved.state_);
  if (saved.cache_ != nullptr) impl_->copyFrom(*saved.cache_);
}

template <Scalar S>
void Space<S>::adopt(const WorldState<S>& state) {
  checkAdoptable(state);
  state_ = state;
  takeOver();
}

template <Scalar S>
void Space<S>::adopt(WorldState<S>&& state) {
  checkAdoptable(state);
  state_ = std::move(state);
  takeOver();
}

template <Scalar S>
void Space<S>::checkAdoptable(const WorldState<S>& state) const {
  requireUnlocked();
  require<Fault::ForeignWorld>(state.bodies.contains(state.staticBody), "Nothing was saved there.");
  for (const HandlerBinding& binding : state.handlers) {
    require<Fault::MissingCallback>(Impl::find(impl_->handlers, binding.number) != nullptr);
  }
  state.bodies.each([&](BodyId, const Body<S>& body) { requireCallbacks(body); });
}

/// Makes a state that came from elsewhere this Space's own.
template <Scalar S>
void Space<S>::takeOver() {
  state_.bodies.each([&](BodyId id, Body<S>& body) {
    body.id_ = id;
    body.owner_ = impl_->serial;
  });
  state_.shapes.each([&](ShapeId id, Shape<S>& shape) { shape.attach(id, impl_->serial); });
  impl_->shapesHashKnown = false;
  rangeEvents_.clear();
  dropCache();
}

template <Scalar S>
void Space<S>::requireCallbacks(const Body<S>& body) const {
  require<Fault::MissingCallback>(body.positionFunc() == 0 ||
                                  Impl::find(impl_->positionFuncs, body.positionFunc()) != nullptr);
  require<Fault::MissingCallback>(body.velocityFunc() == 0 ||
                                  Impl::find(impl_->velocityFuncs, body.velocityFunc()) != nullptr);
}

template <Scalar S>
void Space<S>::dropCache() {
  requireUnlocked();
  impl_->cached = false;
  impl_->threadsKnown = false;
}

// Hashes.

template <Scalar S>
std::uint64_t Space<S>::hash() const {
  if (!impl_->shapesHashKnown) {
    impl_->shapesHash = hashOfShapes(state_.shapes);
    impl_->shapesHashKnown = true;
  }
  return hashOfWorld(state_, impl_->shapesHash);
}

template <Scalar S>
std::uint64_t Space<S>::hash(BodyId id) const {
  return hashOf(body(id));
}

template <Scalar S>
std::uint64_t Space<S>::hash(ShapeId id) const {
  return hashOf(shape(id));
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;

namespace {
[[gnu::used]] void (*const filesOfSpace[])() = {file_of::spaceCache, file_of::spaceHandlers,
                                                file_of::spaceQuery, file_of::spaceSoftStep,
                                                file_of::spaceStep};
}  // namespace

}  // namespace samestep
