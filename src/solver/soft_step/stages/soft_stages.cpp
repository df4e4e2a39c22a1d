// SPDX-License-Identifier: MIT
#include "solver/soft_step/stages/soft_stages.h"

#include <bit>

#include "base/require_ieee.h"
#include "contacts/stages/resist_rolling.h"
#include "dynamics/body_access.h"
#include "dynamics/stages/integrate.h"

namespace samestep {

namespace {

/// The power of two metres that nothing of a body is beyond, seen from its centre of mass.
template <Scalar S>
int radiusBits(const Derived<S>& derived, std::uint32_t index, const Body<S>& body) {
  S most = S(0);
  for (std::uint32_t i = derived.firstShape[index]; i != Derived<S>::kNone; i = derived.nextShape[i]) {
    const CircleAround<S>& shape = derived.around[i];
    const Vector<S> aside = shape.center - body.centerOfMass();
    most = max(most, shape.radius + (abs(aside.x) + abs(aside.y)));
  }
  return most == S(0) ? 0 : static_cast<int>(std::bit_width(raw::magnitude(most.raw()) - 1)) - 32;
}

/// Number of pairs ahead that pairs and bodies are fetched.
constexpr std::uint32_t kAhead = 8;

}  // namespace

template <Scalar S>
void SoftStages<S>::prepare(StepContext<S>& step) {
  const Settings<S>& settings = step.state.settings;
  const S substep = step.dt / S(settings.substeps);
  const S perSubstep = reciprocal(max(substep, ratio<S>(1, 1 << 14)));
  // Stiffer, a pile of boxes no longer comes to rest.
  const S hertz = min(settings.contactHertz, perSubstep * ratio<S>(1, 6));
  soft_.settings = {{makeSoftness(hertz, settings.contactDamping, substep),
                     makeSoftness(S(2) * hertz, settings.contactDamping, substep)},
                    substep,
                    perSubstep,
                    settings.contactPushSpeed,
                    settings.substeps};
  findGroups(step);
  findJoints(step);
  takeBodies(step);
  for (JointBody<S>& body : soft_.joints.bodies) body.solver = solverIndex_[body.slot];
  // 32 bits hold no joints.
  soft_.solvers.begin(settings.precision == ContactPrecision::fast && soft_.joints.empty());
  takePairs(step);
}

/// Sorts the pairs to be solved into groups that share no body, and marks their bodies.
template <Scalar S>
void SoftStages<S>::findGroups(StepContext<S>& step) {
  const Derived<S>& derived = step.derived;
  const std::vector<Pair<S>>& pairs = step.state.pairs;
  groups_.clear(step.state.bodies.slots());
  solvedPairs_.clear();
  unmoved_.clear();
  solverIndex_.assign(step.state.bodies.slots(), kNone);
  soft_.mostKept = S(0);
  const bool fast = FixedNumber<S> && step.state.settings.precision == ContactPrecision::fast;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const Pair<S>& pair = pairs[i];
    if (pair.solved == 0) continue;
    const ShapeTraits<S>&shapeA = derived.traits[pair.a.index], &shapeB = derived.traits[pair.b.index];
    if (shapeA.resists || shapeB.resists) [[unlikely]]
      ResistRolling<S>::act(step, pair);
    const std::uint32_t a = shapeA.body, b = shapeB.body;
    solvedPairs_.push_back({i, a, b, shapeA.round, shapeB.round});
    for (int k = 0; fast && k < pair.count; ++k) {
      soft_.mostKept =
          max(soft_.mostKept, max(pair.contacts[k].normalSpeed, abs(pair.contacts[k].tangentSpeed)));
    }
    // The type a body was placed with is the body's own, and nearer in memory.
    const auto moves = [&](std::uint32_t body) {
      const bool does = derived.poses[body].type == BodyType::dynamicBody;
      if (!does && solverIndex_[body] == kNone) unmoved_.push_back(body);
      solverIndex_[body] = 0;
      return does;
    };
    const bool movesA = moves(a), movesB = moves(b);
    groups_.add(a, movesA, b, movesB, pair.count == 1);
  }
  groups_.sort(groupOrder_);
}

/// Takes the joints, and marks their bodies.
template <Scalar S>
void SoftStages<S>::findJoints(const StepContext<S>& step) {
  const SoftSettings<S>& settings = soft_.settings;
  soft_.joints.begin({&step.state.bodies, &step.state.joints},
                     {settings.substep, settings.perSubstep, settings.substeps});
  for (const JointBody<S>& body : soft_.joints.bodies) solverIndex_[body.slot] = 0;
}

template <Scalar S>
SoftFrame<S> SoftStages<S>::frameOf(const Body<S>& body, std::uint32_t index, int radiusBits) const {
  return {
      body.worldCenter(), body.centerOfMass(), body.rotation(), body.isDynamic() ? body.mass() : S(0), index,
      radiusBits};
}

/// Makes the solver's bodies, by rising slot, so that what was added together is near in memory: the first
/// stands for all that never move, and those that touch nothing make their substeps by themselves.
template <Scalar S>
void SoftStages<S>::takeBodies(StepContext<S>& step) {
  auto& bodies = step.state.bodies;
  const S damping = step.state.settings.damping, substep = soft_.settings.substep;
  const S keptInSubstep = damping == S(1) ? S(1) : pow(damping, substep);
  const S keptInStep = damping == S(1) ? S(1) : pow(damping, step.dt);
  soft_.clear();
  soft_.frames.resize(bodies.slots());
  takeStill(step);
  for (const std::uint32_t i : step.derived.active) {
    Body<S>& body = bodies.valueAt(i);
    SoftStart<S> start;
    S pull[3]{};
    if (body.velocityFunc() != 0) [[unlikely]] {
      Integrate<S>::callVelocityFunc(step, i, keptInStep);
    } else if (body.isDynamic()) {
      BodyAccess<S>::damp(body, step.dt);
      const auto motion = BodyAccess<S>::acceleration(body, step.state.settings.gravity);
      pull[0] = motion.velocity.x;
      pull[1] = motion.velocity.y;
      pull[2] = motion.angularVelocity;
      for (int k = 0; k < 3; ++k) start.push[k] = pull[k] * substep;
      start.kept = keptInSubstep;
    }
    BodyAccess<S>::clearForces(body);
    takeBody(step, i, start, pull);
  }
}

/// Takes what contacts meet and nothing moves in this step.
template <Scalar S>
void SoftStages<S>::takeStill(const StepContext<S>& step) {
  for (const std::uint32_t slot : unmoved_) {
    const Body<S>& body = step.state.bodies.valueAt(slot);
    const bool still = body.type() == BodyType::staticBody || body.activity() != Activity::awake;
    if (still) soft_.frames[slot] = frameOf(body, 0, kAnyRadiusBits);
  }
}

/// @param start  says already what pushes it
/// @param pull   its acceleration
template <Scalar S>
void SoftStages<S>::takeBody(const StepContext<S>& step, std::uint32_t slot, SoftStart<S>& start,
                             const S (&pull)[3]) {
  const Body<S>& body = step.state.bodies.valueAt(slot);
  std::uint32_t& index = solverIndex_[slot];
  start.velocity[0] = body.velocity().x;
  start.velocity[1] = body.velocity().y;
  start.velocity[2] = body.angularVelocity();
  if (index == kNone) {
    index = kFree | static_cast<std::uint32_t>(soft_.free.size());
    soft_.addFree(start, pull, step.dt);
    return;
  }
  start.momentPerMass = body.momentPerMass();
  start.mass = body.isDynamic() ? body.mass() : S(0);
  if constexpr (FixedNumber<S>) start.radiusBits = radiusBits(step.derived, slot, body);
  index = soft_.add(start);
  soft_.frames[slot] = frameOf(body, index, start.radiusBits);
}

/// Lays out the blocks and has them filled by the first solver that holds all numbers.
template <Scalar S>
void SoftStages<S>::takePairs(StepContext<S>& step) {
  const auto take = [&](auto& solver) {
    layOutBlocks(std::remove_reference_t<decltype(solver)>::Numbers::kLanes);
    return solver.begin(soft_.settings, soft_.starts, soft_.groups, soft_.mostKept, step.wiring.budget) &&
           fillBlocks(step, solver);
  };
  while (!soft_.solvers.with(take)) soft_.solvers.fallBack();
}

template <Scalar S>
void SoftStages<S>::layOutBlocks(std::uint32_t lanes) {
  std::uint32_t blocks = 0;
  soft_.groups.clear();
  for (std::uint32_t group = 0; group < ContactGroups::kGroups; ++group) {
    // The pairs of the last group may share bodies.
    const bool inOrder = group == ContactGroups::kGroups - 1;
    const std::uint32_t pairs = groups_.size(group);
    const std::uint32_t end = blocks + (inOrder ? pairs : (pairs + lanes - 1) / lanes);
    if (pairs > 0) soft_.groups.push_back({blocks, end, inOrder});
    blocks = end;
  }
}

/// The lot between groups scatters what is asked for.
template <Scalar S>
inline void SoftStages<S>::fetchAhead(const std::vector<Pair<S>>& pairs, std::uint32_t place) const {
  if (place + kAhead >= groupOrder_.size()) return;
  const SolvedPair& next = solvedPairs_[groupOrder_[place + kAhead]];
  const auto* pair = reinterpret_cast<const char*>(&pairs[next.pair]);
  for (std::uint32_t line = 0; line < sizeof(Pair<S>); line += 64) __builtin_prefetch(pair + line);
  __builtin_prefetch(&soft_.frames[next.a]);
  __builtin_prefetch(&soft_.frames[next.b]);
}

/// A group may hold nearly all pairs.
template <class Step, class Fill>
static void fillInOrder(Step& step, std::uint32_t blocks, Fill& fill) {
  for (std::uint32_t begin = 0; begin < blocks;) {
    const std::uint32_t end = min(begin + Budget::kPairsAtOnce, blocks);
    fill(begin, end);
    begin = end;
    if (step.wiring.budget.spend(0)) return;
  }
}

/// Puts the pairs into blocks, group by group.
/// @return false where a number does not fit
template <Scalar S>
template <class Solver>
bool SoftStages<S>::fillBlocks(StepContext<S>& step, Solver& solver) {
  Finding misfit, bounces, strikes, pushes;
  std::vector<Pair<S>>& pairs = step.state.pairs;
  const S bounceThreshold = step.state.settings.bounceThreshold;
  const auto fillBlock = [&](std::uint32_t block, std::uint32_t begin, std::uint32_t end) {
    const auto count = static_cast<int>(end - begin);
    typename Solver::Taken taken;
    solver.openBlock(block, count, taken);
    for (std::uint32_t i = begin; i < end; ++i) {
      fetchAhead(pairs, i);
      const SolvedPair& solved = solvedPairs_[groupOrder_[i]];
      pairs[solved.pair].solvedTurn = soft_.frames[solved.b].rotation;
      misfit.note(!solver.addPair(block, static_cast<int>(i - begin), pairs[solved.pair], solved.pair,
                                  soft_.frames[solved.a], soft_.frames[solved.b], solved.roundA,
                                  solved.roundB, taken));
    }
    misfit.note(!solver.closeBlock(block, count, bounceThreshold, taken));
    bounces.note(solver.bounces(block));
    strikes.note(solver.strikes(block));
    pushes.note(solver.pushes(block));
  };
  step.team.during(step.team.helpsWith(solvedPairs_.size(), StepContext<S>::kFewPairs), [&] {
    std::uint32_t first = 0;
    std::uint32_t group = 0;
    for (const BlockGroup& blockGroup : soft_.groups) {
      while (groups_.size(group) == 0) ++group;
      const std::uint32_t count = groups_.size(group++);
      const std::uint32_t lanes = blockGroup.inOrder ? 1 : Solver::Numbers::kLanes;
      const std::uint32_t start = blockGroup.begin;
      const auto fill = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
          const std::uint32_t from = first + i * lanes;
          fillBlock(start + i, from, min(from + lanes, first + count));
        }
      };
      if (blockGroup.inOrder) {
        fillInOrder(step, blockGroup.end - start, fill);
      } else {
        step.team.each(blockGroup.end - start, kBlockGrain<typename Solver::Numbers>, fill);
      }
      if (step.wiring.budget.spend(Budget::kPerPair * count)) return;
      first += count;
    }
  });
  step.wiring.budget.endWhereAsked();
  soft_.bounces = static_cast<bool>(bounces);
  soft_.strikes = static_cast<bool>(strikes);
  soft_.pushes = static_cast<bool>(pushes);
  return !static_cast<bool>(misfit);
}

template <Scalar S>
void SoftStages<S>::solve(StepContext<S>& step) {
  Crew& team = step.team;
  const auto run = [&](auto& solver) {
    bool solved = false;
    const bool together = team.helpsWith(solvedPairs_.size(), StepContext<S>::kFewPairs);
    team.during(together, [&] {
      solved = solver.run(soft_.strikes, soft_.pushes, soft_.joints, team, step.wiring.budget);
    });
    step.wiring.budget.endWhereAsked();
    if (!solved) return false;
    // Bounces are a stage by themselves, for they take memory.
    if (soft_.bounces)
      solver.bounce(step.state.pairs, step.state.settings.bounceThreshold, soft_.restitution);
    team.during(together, [&] { solver.store(step.state.pairs, team); });
    if (!soft_.joints.empty()) soft_.joints.store(step.state.joints);
    return true;
  };
  while (!soft_.solvers.with(run)) {
    soft_.solvers.fallBack();
    takePairs(step);
  }
  const bool fast = step.state.settings.precision == ContactPrecision::fast &&
                    !(soft_.groups.empty() && soft_.joints.empty());
  if (fast && !soft_.solvers.isFast()) ++step.events.accurateInstead;
}

template <Scalar S>
void SoftStages<S>::finish(StepContext<S>& step) {
  const auto count = static_cast<std::uint32_t>(step.derived.active.size());
  // Position functions are called in order, and see the bodies before them moved, those after them not.
  const bool together =
      step.wiring.positionFuncs.empty() && step.team.helpsWith(count, StepContext<S>::kFewBodies);
  step.team.during(together, [&] {
    step.team.each(count, StepContext<S>::kBodyGrain,
                   [&](std::uint32_t begin, std::uint32_t end) { finish(step, begin, end); });
  });
}

template <Scalar S>
void SoftStages<S>::finish(StepContext<S>& step, std::uint32_t begin, std::uint32_t end) {
  auto& bodies = step.state.bodies;
  std::vector<std::uint8_t>& held = step.events.held;
  soft_.solvers.with([&](const auto& solver) {
    for (std::uint32_t number = begin; number < end; ++number) {
      const std::uint32_t i = step.derived.active[number];
      Body<S>& body = bodies.valueAt(i);
      const std::uint32_t index = solverIndex_[i];
      if (step.events.fast.watched) step.events.fast.noteStart(i, body);
      const SoftMotion<S> motion = (index & kFree) != 0 ? soft_.free[index & ~kFree] : solver.motion(index);
      if (body.isDynamic()) {
        // The substeps hold velocities, too.
        held[i] |= motion.held;
        held[i] |=
            BodyAccess<S>::holdVelocity(body, {{motion.velocity[0], motion.velocity[1]}, motion.velocity[2]});
      }
      if (body.positionFunc() != 0) [[unlikely]] {
        Integrate<S>::callPositionFunc(step, i);
      } else {
        held[i] |= BodyAccess<S>::holdMoved(body, {motion.moved[0], motion.moved[1]}, motion.moved[2],
                                            step.state.settings.worldExtent);
      }
      if (step.events.fast.watched) Integrate<S>::noteFast(step, i, body);
    }
  });
}

#define SAMESTEP_EACH_SCALAR template class SoftStages<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
