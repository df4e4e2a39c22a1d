// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"
#include "solver/restitution/restitution.h"
#include "solver/sequential_impulse/sequential_impulse.h"

namespace samestep {

/// Blows of elastic contacts in sequential impulses. Passes over one contact after the other come only near
/// what a body with several contacts does, and may add energy; so a blow is solved at once, with all that
/// contacts connect with it, before the forces of the step. The passes then hold each contact at the speed
/// that the blow left it, as they hold a single one at the speed of its bounce.
template <Scalar S>
class ImpulseBlows {
 public:
  /// Solves the blows of a step, and changes the velocities of the bodies of the world.
  /// @param slots  the slots of the solver's bodies
  void strike(StepContext<S>& step, const std::vector<std::uint32_t>& slots, ImpulseSolver<S>& solver);
  /// True if there was one in this step.
  bool struck() const { return !restitution_.points.empty(); }
  /// Notes the energies after the forces of the step, which bodies may keep.
  void allow(const StepContext<S>& step, const ImpulseSolver<S>& solver);
  /// Notes what the passes begin with.
  void begin(const ImpulseSolver<S>& solver);
  /// Checks the energies that the passes made. Where they made some of holding contacts at speeds, all is as
  /// at the beginning again, and these contacts are held at none.
  /// @return whether the passes are to be made again
  bool takeBack(const StepContext<S>& step, ImpulseSolver<S>& solver);

 private:
  bool find(const StepContext<S>& step, const ImpulseSolver<S>& solver);
  void take(const StepContext<S>& step, const ImpulseSolver<S>& solver);
  void give(StepContext<S>& step, ImpulseSolver<S>& solver);
  std::uint32_t groupOf(std::uint32_t body);
  std::uint32_t groupOf(const ImpulseRow<S>& row);
  void addEnergy(const StepContext<S>& step, std::uint32_t body, const S (&velocity)[3],
                 std::vector<Scaled<S>>& energies);
  void sumEnergies(const StepContext<S>& step, const ImpulseSolver<S>& solver);

  const std::vector<std::uint32_t>* slots_ = nullptr;
  Restitution<S> restitution_;
  // Each of the solver's bodies is in a group of those that contacts connect, and a group may be struck.
  std::vector<std::uint32_t> group_;
  std::vector<std::uint8_t> struck_;
  // Energies of the groups times two, J: what they may have after the passes, and what they have.
  std::vector<Scaled<S>> allowed_, energies_;
  ImpulseSolver<S> begin_;
};

#define SAMESTEP_EACH_SCALAR extern template class ImpulseBlows<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
