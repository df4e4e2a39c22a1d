// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <samestep/arbiter.h>
#include <samestep/body.h>
#include <samestep/collision.h>
#include <samestep/error.h>
#include <samestep/events.h>
#include <samestep/id.h>
#include <samestep/interrupt.h>
#include <samestep/joint.h>
#include <samestep/kernel.h>
#include <samestep/query.h>
#include <samestep/query_view.h>
#include <samestep/remark.h>
#include <samestep/saved_world.h>
#include <samestep/settings.h>
#include <samestep/shape.h>
#include <samestep/state.h>
#include <samestep/workers.h>

namespace samestep {

template <Scalar S>
struct SpaceParts;
template <Scalar S>
struct StepContext;

/// A world: bodies, shapes and their collisions, stepped in equal steps. MIS section 6.
///
/// Bodies and shapes are added by value and named by ids. What is iterated or reported comes in the order of
/// ids. While a step or a query runs the Space is locked: what would add, remove or replace objects throws
/// SpaceLocked; addPostStepCallback defers it.
///
/// A call that throws has changed nothing, but where an exception ended a change midway: no memory left
/// within a step, an exception out of a callback, an Interrupt. The world is then not usable: what reads or
/// changes it throws LeftMidway until restore, adopt or loadSnapshot has brought in a whole one. Never is
/// there a wrong hash.
template <Scalar S>
class Space {
 public:
  using PositionFunc = BodyPositionFunc<S>;
  using VelocityFunc = BodyVelocityFunc<S>;
  using PostStepFunc = void (*)(Space& space, std::uint64_t key, void* data);
  using StageObserver = StageObserverFunc<S>;

  /// An empty world with one static body. MIS: spaceNew, spaceInit
  Space();
  ~Space();
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;

  // Settings.

  const Settings<S>& settings() const { return state_.settings; }
  /// MIS: spaceGetIterations
  int iterations() const { return state_.settings.iterations; }
  /// MIS: spaceGetGravity
  const Vector<S>& gravity() const { return state_.settings.gravity; }
  S damping() const { return state_.settings.damping; }
  /// MIS: spaceGetCollisionSlop
  S collisionSlop() const { return state_.settings.collisionSlop; }
  /// MIS: spaceGetCollisionBias
  S collisionBias() const { return state_.settings.collisionBias; }
  /// MIS: spaceGetCollisionPersistence
  std::uint32_t collisionPersistence() const { return state_.settings.collisionPersistence; }
  S worldExtent() const { return state_.settings.worldExtent; }
  S sleepTimeThreshold() const { return state_.settings.sleepTimeThreshold; }
  S idleSpeedThreshold() const { return state_.settings.idleSpeedThreshold; }
  /// Seconds of the last step, 0 before the first. MIS: spaceGetCurrentTimeStep
  S currentTimeStep() const { return state_.timeStep; }
  /// Steps made so far.
  std::uint64_t stamp() const { return state_.stamp; }

  /// @throws InvalidIter outside [1, 1000]
  /// MIS: spaceSetIterations
  void setIterations(int iterations);
  /// @throws ValueOutOfRange
  /// MIS: spaceSetGravity
  void setGravity(const Vector<S>& gravity);
  /// @throws ValueOutOfRange outside [0, 1]
  void setDamping(S damping);
  /// @throws ValueOutOfRange outside [0, 2^8]
  /// MIS: spaceSetCollisionSlop
  void setCollisionSlop(S slop);
  /// @throws ValueOutOfRange outside [0, 1]
  /// MIS: spaceSetCollisionBias
  void setCollisionBias(S bias);
  /// MIS: spaceSetCollisionPersistence
  void setCollisionPersistence(std::uint32_t steps);
  /// @throws ValueOutOfRange outside (0, 2^20]
  void setWorldExtent(S extent);
  /// Forgets the bias velocities of all bodies, if it is another one.
  /// @throws ValueOutOfRange for a value that names no solver
  void setSolver(SolverKind kind);
  /// @throws ValueOutOfRange for a value that names no precision
  void setPrecision(ContactPrecision precision);
  /// Has steps stop bodies that go far where they meet something, or not: see docs/continuous.md. Off at
  /// first.
  void setContinuous(bool continuous);
  /// @throws InvalidIter outside [1, 100]
  void setSubsteps(int substeps);
  /// @param hertz    cycles per second, in [0, 1000]; 0: hard contacts that do not push overlaps apart
  /// @param damping  in [0, 100]
  /// @throws ValueOutOfRange
  void setContactSoftness(S hertz, S damping);
  /// @throws ValueOutOfRange outside [0, 2^10]
  void setContactPushSpeed(S speed);
  /// @throws ValueOutOfRange outside [0, 1]
  void setContactMargin(S margin);
  /// @throws ValueOutOfRange outside [0, 2^10]
  void setBounceThreshold(S speed);
  /// Lets islands sleep that have been at rest for so long; 0: none. See docs/sleeping.md. Another value of
  /// any setting wakes all.
  /// @throws ValueOutOfRange outside [0, 2^10]
  void setSleepTimeThreshold(S seconds);
  /// @throws ValueOutOfRange outside [0, 2^10]
  void setIdleSpeedThreshold(S speed);
  /// All of them at once, checked as by the setters.
  /// @throws as they do, and nothing is changed
  void setSettings(const Settings<S>& settings);

  // Bodies and shapes.

  /// The body for things that never move, always there. MIS: spaceGetStaticBody
  BodyId staticBody() const { return state_.staticBody; }
  /// Replaces it by a copy of a free static body.
  /// @throws SpaceLocked; AttachedStaticBody while the old one has shapes or joints; IllegalBody if it is not
  /// static;
  ///         DuplicateBody, AttachedBody
  /// MIS: spaceSetStaticBody
  BodyId setStaticBody(const Body<S>& body);

  /// Takes in a copy.
  /// @throws DuplicateBody, AttachedBody, SpaceLocked; IllegalBody outside the world extent
  /// MIS: spaceAddBody
  BodyId add(const Body<S>& body);
  /// Adds a body under an id of the caller's choice. Worlds whose objects all have given ids are the same,
  /// bit by bit, whatever the order in which objects came and went; see docs/determinism.md.
  /// @param id  its index below 2^16, better near 0: a world takes room for all indices up to its highest;
  /// its
  ///            generation odd and higher than any its slot has had, 1 for the first
  /// @throws as add; IndexOutOfBounds, IllegalId
  BodyId add(const Body<S>& body, BodyId id);
  /// Takes in a copy, on the body the shape names. Whenever a shape with mass is added, removed or replaced,
  /// mass, moment and centre of mass of its body become those of all its shapes with mass together, in place
  /// of any that were set by hand, and 0 after the last; shapes without mass change nothing. The centre may
  /// move by that: each point of the body keeps its velocity, see Body::setCenterOfMass. Of a body that is
  /// not dynamic all of that shows when it becomes dynamic.
  /// @throws DuplicateShape, AttachedShape, BodyNotFound, IllegalBody, SizeOutOfRange, SpaceLocked
  /// MIS: spaceAddShape, bodyAddShape
  ShapeId add(const Shape<S>& shape);
  /// Adds a shape under an id of the caller's choice, as for bodies.
  /// @throws as add; IndexOutOfBounds, IllegalId
  ShapeId add(const Shape<S>& shape, ShapeId id);
  /// Its joints go with it.
  /// @throws BodyNotFound, MainStaticBody, BodyHasShapes, SpaceLocked
  /// MIS: spaceRemoveBody
  void remove(BodyId id);
  /// Calls separate for what it touches; of mass see add.
  /// @throws ShapeNotFound, SpaceLocked
  /// MIS: spaceRemoveShape, bodyRemoveShape
  void remove(ShapeId id);
  /// A body with all its shapes, in one go: separate is called for what they touch by rising ids, before any
  /// of them is gone and while the body weighs what it did. Linear in its shapes and in all pairs.
  /// @throws as the two
  void removeWithShapes(BodyId id);

  // Joints.

  /// Takes in a copy, which keeps nothing of where it came from. Bodies of any type may be joined; a joint of
  /// two that nothing moves does nothing. Where the bodies stand apart they are drawn together from the next
  /// step on.
  /// @throws BodyNotFound; IllegalJoint for a number out of its range, see Joint, or one body twice;
  ///         SpaceLocked
  JointId add(const Joint<S>& joint);
  /// Takes in a joint under an id of the caller's choice, as for bodies.
  /// @throws as add; IndexOutOfBounds, IllegalId
  JointId add(const Joint<S>& joint, JointId id);
  /// @throws JointNotFound, SpaceLocked
  void remove(JointId id);
  bool contains(JointId id) const { return state_.joints.contains(id); }
  /// The next add, remove, restore or step ends it.
  /// @throws JointNotFound
  const Joint<S>& joint(JointId id) const;
  /// Replaces a joint, all or nothing, also its bodies; it keeps its id and, of the same kind, its impulses.
  /// @throws JointNotFound, and as add
  void replace(JointId id, const Joint<S>& joint);
  /// Changes a joint: `change(id, [](Joint<S>& joint) { joint.motorSpeed = speed; })`. All or nothing.
  template <class Change>
  void change(JointId id, Change&& apply) {
    Joint<S> copy = joint(id);
    apply(copy);
    replace(id, copy);
  }
  std::uint32_t jointCount() const { return state_.joints.size(); }
  /// Calls visit(JointId, const Joint<S>&) for each joint by rising id.
  template <class Visit>
  void eachJoint(Visit&& visit) const {
    requireUsable();
    state_.joints.each([&](JointId id, const Joint<S>& joint) { visit(id, joint); });
  }
  /// Visits the joints of one body. Looks at all joints.
  /// @throws BodyNotFound
  template <class Visit>
  void eachJoint(BodyId of, Visit&& visit) const {
    body(of);
    state_.joints.each([&](JointId id, const Joint<S>& joint) {
      if (joint.bodyA == of || joint.bodyB == of) visit(id, joint);
    });
  }
  /// Calls visit(BodyId) for each body that joints connect with this one, directly or through others, by
  /// rising id, the body itself left out. What nothing moves connects nothing beyond itself.
  /// @throws BodyNotFound
  template <class Visit>
  void eachConnected(BodyId of, Visit&& visit) const {
    for (const BodyId id : connectedTo(of)) visit(id);
  }

  /// MIS: spaceContainsBody
  bool contains(BodyId id) const { return state_.bodies.contains(id); }
  /// MIS: spaceContainsShape
  bool contains(ShapeId id) const { return state_.shapes.contains(id); }

  /// A short-lived reference: the next add, remove, restore or step ends it.
  /// @throws BodyNotFound
  Body<S>& body(BodyId id);
  const Body<S>& body(BodyId id) const;
  /// @throws ShapeNotFound
  const Shape<S>& shape(ShapeId id) const;
  /// Replaces a shape, all or nothing; it keeps its id and body. Of mass see add.
  /// @throws ShapeNotFound, IllegalBody, SizeOutOfRange, SpaceLocked for a change of geometry or mass
  void replace(ShapeId id, const Shape<S>& shape);
  /// Changes a shape: `change(id, [](Shape<S>& shape) { shape.setFriction(f); })`. All or nothing.
  template <class Change>
  void change(ShapeId id, Change&& apply) {
    Shape<S> copy = shape(id);
    apply(copy);
    replace(id, copy);
  }
  /// Changes the type and forgets the bias velocities. A body that becomes dynamic has the mass it had when
  /// it was so last, unless shapes with mass came, went or changed since: those count as if it had been
  /// dynamic all along. The same type again changes nothing. Where two static bodies touch that did when one
  /// of them moved, nothing is called while they touch; separate is, once, when they no longer do.
  /// @throws SpaceLocked, BodyNotFound; MainStaticBody for the designated static body; SizeOutOfRange or
  ///         IllegalBody where its shapes are too large or too heavy for a body that moves
  /// MIS: bodySetType
  void setType(BodyId id, BodyType type);
  /// Sets mass, moment and centre of mass of a body to those of its shapes that have mass, 0 without any; of
  /// one that is not dynamic it shows when it becomes so.
  /// @throws BodyNotFound, IllegalBody
  /// MIS: bodyAccumulateMassFromShapes
  void accumulateMassFromShapes(BodyId id);

  std::uint32_t bodyCount() const { return state_.bodies.size(); }
  std::uint32_t shapeCount() const { return state_.shapes.size(); }

  /// Calls visit(const Body<S>&) for each body by rising id. Locks the Space. MIS: spaceEachBody
  template <class Visit>
  void eachBody(Visit&& visit) {
    requireUsable();
    LockGuard guard(*this);
    std::as_const(state_.bodies).each([&](BodyId, const Body<S>& body) { visit(body); });
    guard.finish();
  }
  template <class Visit>
  void eachBody(Visit&& visit) const {
    requireUsable();
    state_.bodies.each([&](BodyId, const Body<S>& body) { visit(body); });
  }
  /// Calls visit(const Shape<S>&) for each shape by rising id. Locks the Space. MIS: spaceEachShape
  template <class Visit>
  void eachShape(Visit&& visit) {
    requireUsable();
    LockGuard guard(*this);
    std::as_const(state_.shapes).each([&](ShapeId, const Shape<S>& shape) { visit(shape); });
    guard.finish();
  }
  template <class Visit>
  void eachShape(Visit&& visit) const {
    requireUsable();
    state_.shapes.each([&](ShapeId, const Shape<S>& shape) { visit(shape); });
  }
  /// Calls visit(const Shape<S>&) for each shape of a body by rising id.
  /// @throws BodyNotFound
  /// MIS: bodyEachShape
  template <class Visit>
  void eachShape(BodyId id, Visit&& visit) const {
    for (std::uint32_t index = firstShape(id); index != ShapeId::kNoIndex; index = nextShape(index)) {
      visit(state_.shapes.valueAt(index));
    }
  }
  /// Calls visit(Arbiter<S>&) for each touching pair of shapes, by rising ids. Locks the Space.
  template <class Visit>
  void eachArbiter(Visit&& visit) {
    visitArbiters(
        nullptr,
        [](Arbiter<S>& arbiter, void* to) { (*static_cast<std::remove_reference_t<Visit>*>(to))(arbiter); },
        const_cast<void*>(static_cast<const void*>(&visit)));
  }
  /// Visits the arbiters of one body, which is each arbiter's A or B as its ids say. O(its pairs) after the
  /// first call of a step.
  /// @throws BodyNotFound
  /// MIS: bodyEachArbiter, arbiterNext, arbiterThreadForBody
  template <class Visit>
  void eachArbiter(BodyId id, Visit&& visit) {
    visitArbiters(
        &id,
        [](Arbiter<S>& arbiter, void* to) { (*static_cast<std::remove_reference_t<Visit>*>(to))(arbiter); },
        const_cast<void*>(static_cast<const void*>(&visit)));
  }

  // Collision handlers. Functions are wiring, registered under a number; the binding of collision types to a
  // number is state, saved and hashed.

  /// Registers functions under a number other than 0, or changes them.
  /// @throws SpaceLocked; ValueOutOfRange for 0 or a null position or velocity function
  void registerHandler(CallbackNumber number, const CollisionHandler<S>& handler);
  void registerPositionFunc(CallbackNumber number, PositionFunc function, void* data = nullptr);
  void registerVelocityFunc(CallbackNumber number, VelocityFunc function, void* data = nullptr);

  /// Adds a handler for shapes of these two types, A and B in this order. kWildcardCollisionType as one of
  /// them stands for every type that no handler names together with the other; as both, for shapes without a
  /// type of their own. Where two such handlers fit, that of the shape with the lower id is called. Who is
  /// called follows from the types of that moment: of shapes whose types change while they touch, begin may
  /// go to one handler and separate to another.
  /// @throws MissingCallback, SpaceLocked
  /// MIS: spaceAddCollisionHandler
  void addCollisionHandler(CollisionType typeA, CollisionType typeB, CallbackNumber number);
  /// Adds a handler for shapes of this type, as A, with any other, where no handler of the pair takes over.
  /// @throws MissingCallback, SpaceLocked
  /// MIS: spaceAddWildcardHandler
  void addWildcardHandler(CollisionType type, CallbackNumber number);
  /// Adds the handler for pairs without one of their own; in place of the wildcards.
  /// @throws MissingCallback, SpaceLocked
  /// MIS: spaceAddDefaultCollisionHandler
  void addDefaultCollisionHandler(CallbackNumber number);

  /// Calls the wildcard handler of one of the shapes, for a handler that wants to pass a call on.
  /// MIS: arbiterCallWildcardBeginA
  bool callWildcardBeginA(Arbiter<S>& arbiter);
  /// MIS: arbiterCallWildcardBeginB
  bool callWildcardBeginB(Arbiter<S>& arbiter);
  /// MIS: arbiterCallWildcardPreSolveA
  bool callWildcardPreSolveA(Arbiter<S>& arbiter);
  /// MIS: arbiterCallWildcardPreSolveB
  bool callWildcardPreSolveB(Arbiter<S>& arbiter);
  /// MIS: arbiterCallWildcardPostSolveA
  void callWildcardPostSolveA(Arbiter<S>& arbiter);
  /// MIS: arbiterCallWildcardPostSolveB
  void callWildcardPostSolveB(Arbiter<S>& arbiter);
  /// MIS: arbiterCallWildcardSeparateA
  void callWildcardSeparateA(Arbiter<S>& arbiter);
  /// MIS: arbiterCallWildcardSeparateB
  void callWildcardSeparateB(Arbiter<S>& arbiter);

  /// Runs after the step or query that is under way, or at once if there is none; once per key until then:
  /// false if the key is waiting already. Callbacks run in the order they were added. When one throws, the
  /// later ones run after the next step or query. Those that wait when another world is restored, loaded or
  /// adopted, and those added within a step that is refused, are dropped: what they meant to do is gone.
  /// @throws ValueOutOfRange for a null function
  bool addPostStepCallback(PostStepFunc function, std::uint64_t key, void* data = nullptr);

  // Stepping.

  /// One step of dt seconds, in [0, 1]. 0 does nothing at all: no callback, no event, no push, no stamp; what
  /// overlaps newly is told by the next step that takes time.
  /// @throws Interrupted, and what callbacks throw: the world is then left midway, see the class; LeftMidway;
  ///         SpaceLocked; ValueOutOfRange for dt; IllegalBody for a dynamic body without mass or moment;
  ///         MissingCallback for a number without function; UnsoundArithmetic for double in another mode of
  ///         the processor; TooManyPairs, when position functions have run but before anything in the world
  ///         changes
  /// MIS: spaceStep
  void step(S dt);

  /// True while a step, query or visit is under way. MIS: spaceIsLocked
  bool isLocked() const { return locked_ > 0; }
  /// MIS: spaceLock
  void lock() { ++locked_; }
  /// The last unlock runs the post-step callbacks if `runPostStep`.
  /// @throws SpaceLockUnderflow
  /// MIS: spaceUnlock
  void unlock(bool runPostStep);

  /// Values that were clamped during the last step, by body id.
  std::span<const RangeEvent> rangeEvents() const;
  /// Sets which contacts the Space lists from the next step on. Wiring: no saved world carries it, and no
  /// result depends on it.
  /// @throws SpaceLocked; ValueOutOfRange for a slowest impact outside [0, 2^11]
  void setEventListing(const EventListing<S>& listing);
  const EventListing<S>& eventListing() const;
  /// Contact events of the last step: the same whatever the number of workers and, of objects with given ids,
  /// the order in which they came. It lives until the next step, or until a world is brought in, which leaves
  /// nothing listed. A step that is refused leaves it as it is.
  ContactEvents<S> contactEvents() const;
  /// Joints that broke in the last step and joints whose limits began to hold, by rising id; listed as
  /// contact events are.
  std::span<const JointEvent<S>> jointEvents() const;
  /// Iteration limits reached and the like.
  const CollisionStats& collisionStats() const;
  /// Number of steps that were to be fast but had numbers that do not fit, and were made accurately: see
  /// ContactPrecision. The same on every machine.
  std::uint64_t accurateInstead() const;
  /// Sets the function that is called after each stage of a step; nullptr for none, which costs nothing.
  void setStageObserver(StageObserver observer, void* data = nullptr);

  /// Limits the pairs of shapes near each other that the Space may hold, at most kMostPairs; kDefaultMaxPairs
  /// until called. What a step needs besides grows with them, and n shapes in one place are n^2 / 2 pairs:
  /// this is what bounds the memory and the time of a step of a world that somebody else made. Of shapes
  /// whose boxes are near each other, be they of one body or filtered out, there may be eight times as many
  /// pairs. Wiring: no saved world carries it, and no result depends on it but the refusal, which depends on
  /// nothing else than the world, so that of peers with the same limit none goes on alone.
  /// @throws SpaceLocked; ValueOutOfRange
  void setMaxPairs(std::uint32_t pairs);
  std::uint32_t maxPairs() const;

  /// Sets the function that is asked whether a call shall end: between the stages of a step, within them
  /// every few thousand pairs, objects or calls of handlers, after each pass of a solver, and while a body of
  /// many shapes goes. A step that ends so leaves the world midway, see the class. With workers it may be
  /// asked on one of theirs. No saved world carries it, and no result depends on it.
  void setInterrupt(const Interrupt& interrupt);
  /// Work done by this Space so far, in units that take from 2 to 25 ns on the machine of
  /// docs/performance.md. It follows from the calls alone, whoever computes.
  std::uint64_t work() const;
  /// Calls that go beyond so much, as work() counts, end as if they were interrupted: unlike a clock, in the
  /// same place everywhere. Without limit until called.
  void setMaxWork(std::uint64_t work);

  // Workers and kernel are wiring, like functions: no result depends on them, and no saved world carries
  // them.

  /// Steps with the help of a runner's workers, which must outlive the Space or the next call; null for none,
  /// which costs nothing. Whatever is ordered stays on the stepping thread: callbacks, what they see, sums.
  /// The soft step uses them, sequential impulses hardly do.
  /// @throws SpaceLocked
  void setWorkers(TaskRunner* runner, Sharing sharing = Sharing::whenWorth);
  TaskRunner* workers() const;
  /// The kernel that the soft step solves contacts with. Of one that is not available the next best is taken,
  /// and remarked on. Until called, the best one.
  /// @throws SpaceLocked; ValueOutOfRange for a value that names no kernel
  void setKernel(KernelTarget target);
  /// Takes a kernel for tests: never another one.
  /// @throws SpaceLocked; KernelUnavailable
  void forceKernel(KernelTarget target);
  /// The one in use.
  KernelTarget kernel() const;
  /// Diagnostics: the function that is told what the Space points out.
  Remarks& remarks();
  const Remarks& remarks() const;

  /// Moves the trees after a static body was moved by hand. The step does it by itself.
  /// @throws SpaceLocked
  /// MIS: spaceReindexStatic
  void reindexStatic();
  /// @throws ShapeNotFound, SpaceLocked
  /// MIS: spaceReindexShape
  void reindexShape(ShapeId id);
  /// @throws BodyNotFound, SpaceLocked
  /// MIS: spaceReindexShapesForBody
  void reindexShapesForBody(BodyId id);
  /// Forgets what touches a body, or only the given shape of it, as if it never had; separate is called.
  /// @throws BodyNotFound, ShapeNotFound, SpaceLocked
  /// MIS: spaceFilterArbiters
  void filterArbiters(BodyId body, ShapeId shape = {});

  // Queries.

  /// Questions about the world as it is now: casts, overlaps, distances. The view changes nothing and may be
  /// asked by several threads at once, until the world is changed by whatever call. Within a step it sees the
  /// poses as the queries below do.
  /// @throws LeftMidway
  QueryView<S> queries();

  // Queries, answered by rising shape id. A shape is considered if its filter and the query's accept each
  // other. They see the poses as they are now; within a step, as the step found (before it moved bodies) or
  // made them, not what callbacks have moved since.

  /// The shapes within `distance` metres of a point; sensors included.
  void pointQuery(const Vector<S>& point, S distance, const ShapeFilter& filter,
                  std::vector<PointHit<S>>& hits);
  /// The shapes that a segment of a radius touches, at its ends and in passing; in which it begins they are
  /// hit at alpha 0, see segmentQuery in samestep/shape.h.
  void segmentQuery(const Vector<S>& start, const Vector<S>& end, S radius, const ShapeFilter& filter,
                    std::vector<SegmentHit<S>>& hits);
  /// The shapes whose boxes overlap a box.
  void boxQuery(const BB<S>& box, const ShapeFilter& filter, std::vector<ShapeId>& hits);
  /// The box around a shape at its body's pose. MIS: shapeCacheBB, shapeGetBB
  BB<S> boundingBox(ShapeId id);

  // State.

  /// XXH3-64 over the canonical little-endian encoding of the state, in which the shapes stand as the XXH3-64
  /// of theirs. The same on every machine.
  std::uint64_t hash() const;
  std::uint64_t hash(BodyId id) const;
  std::uint64_t hash(ShapeId id) const;
  std::uint64_t hash(JointId id) const;
  /// @throws LeftMidway
  const WorldState<S>& state() const {
    requireUsable();
    return state_;
  }
  /// True if the world is whole: see the class.
  bool isUsable() const { return !leftMidway_; }
  /// Says that an exception ended a change of several calls midway.
  void leaveMidway() { leftMidway_ = true; }

  /// Copies the world into memory; callbacks waiting and functions registered are not part of it.
  /// @throws SpaceLocked
  void save(SavedSpace<S>& into) const;
  SavedSpace<S> save() const;
  /// Brings back a saved world, as often as wanted, also one of another Space. It continues exactly as the
  /// original did, under the ids of the original: those of the world there was are refused from here on, if
  /// it was that of another Space. What came to be after the world was saved has never been; its ids are
  /// given out again, so who has kept one must drop it: see worldsBroughtIn.
  /// Results of the last step come only with the next one: until then the impulses that visits see are 0 and
  /// the materials those of the shapes, as after loadSnapshot.
  /// @throws SpaceLocked; ForeignWorld where nothing was saved; MissingCallback if this Space lacks a number
  ///         the world uses
  void restore(const SavedSpace<S>& saved);
  /// Brings in a whole state, as save does; the caller answers for it being one that a Space can have.
  /// @throws SpaceLocked, ForeignWorld, MissingCallback
  void adopt(const WorldState<S>& state);
  void adopt(WorldState<S>&& state);
  /// Number of times another world was brought in, by restore, adopt or loadSnapshot. Who keeps ids, or
  /// anything else that follows from the world, beside it compares this: where it has changed, they are to be
  /// found anew. No state: peers that restored differently often have other counts.
  std::uint64_t worldsBroughtIn() const;
  /// Forgets everything that can be computed again. Changes no result.
  /// @throws SpaceLocked
  void dropCache();

 private:
  /// Locks while it lives. finish() also runs the post-step callbacks; without it, as when a visitor throws,
  /// they wait for the next unlock.
  class LockGuard {
   public:
    explicit LockGuard(Space& space) : space_(&space) { space.lock(); }
    ~LockGuard() {
      if (space_ != nullptr) --space_->locked_;
    }
    LockGuard(const LockGuard&) = delete;
    LockGuard& operator=(const LockGuard&) = delete;
    void finish() {
      Space* space = space_;
      space_ = nullptr;
      space->unlock(true);
    }

   private:
    Space* space_;
  };

  void requireUsable() const { require<Fault::LeftMidway>(!leftMidway_); }
  void requireUnlocked() const;
  /// Brings in a world whole, or leaves this one midway.
  /// @param theirs  whose ids those of that world are, or 0
  template <class Bring>
  void bringIn(std::uint32_t theirs, Bring&& bring);
  /// Makes the ids of this world those of the Space of a number; see Id::space.
  void giveIds(std::uint32_t space);
  StepContext<S> contextOf(S dt = S(0));
  std::vector<BodyId> connectedTo(BodyId of) const;
  std::uint32_t firstShape(BodyId id) const;
  std::uint32_t nextShape(std::uint32_t index) const;
  /// Calls visit(arbiter, data) for each touching pair, or for those of one body. Locks the Space.
  void visitArbiters(const BodyId* of, void (*visit)(Arbiter<S>&, void*), void* data);

  WorldState<S> state_;
  SpaceParts<S>* parts_;
  std::int32_t locked_ = 0;
  bool leftMidway_ = false;
};

#define SAMESTEP_EACH_SCALAR extern template class Space<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
