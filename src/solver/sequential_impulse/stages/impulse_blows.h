// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "context/step_context.h"
#include "solver/restitution/restitution.h"
#include "solver/sequential_impulse/sequential_impulse.h"

namespace samestep {

/// Blows of elastic contacts in sequential impulses. Passes over one contact after the other, as the MIS has
/// them, come only near what a body with several contacts does, and may add energy. Where they did, the step
/// of the bodies that contacts connect is taken back and their blow solved at once, before the forces of the
/// step; the passes then hold each contact at the speed that the blow left it, as they hold a single one at
/// the speed of its bounce.
template <Scalar S>
class ImpulseBlows {
 public:
  /// Notes the velocities before the forces of the step, if an elastic contact is struck in it.
  /// @param slots  the slots of the solver's bodies, which stay where they are until the end of the step
  void watch(const StepContext<S>& step, const std::vector<std::uint32_t>& slots,
             const ImpulseSolver<S>& solver);
  bool isWatched() const { return watched_; }
  /// Notes what the passes begin with, and which energies groups may have after them.
  void begin(const StepContext<S>& step, const ImpulseSolver<S>& solver);
  /// Solves the blows of the groups whose energy grew; the solver is then as it began, but for them.
  /// @return whether there is any, so that the passes are to be made again
  bool strike(StepContext<S>& step, ImpulseSolver<S>& solver);
  /// Notes what the passes after a blow begin with.
  void keep(const ImpulseSolver<S>& solver) { begin_ = solver; }
  /// Checks the energies that the passes after a blow made. Where they made some of holding contacts at
  /// speeds, all is as was kept again, and these contacts are held at none.
  /// @return whether the passes are to be made again
  bool takeBack(const StepContext<S>& step, ImpulseSolver<S>& solver);

 private:
  void find(const StepContext<S>& step, const ImpulseSolver<S>& solver);
  void take(const StepContext<S>& step, const ImpulseSolver<S>& solver);
  void give(ImpulseSolver<S>& solver);
  bool grew(std::uint32_t group) const;
  std::uint32_t groupOf(std::uint32_t body);
  std::uint32_t groupOf(const ImpulseRow<S>& row);
  void addEnergy(const StepContext<S>& step, std::uint32_t body, const S (&velocity)[3],
                 std::vector<Scaled<S>>& energies);
  void sumEnergies(const StepContext<S>& step, const ImpulseSolver<S>& solver);
  bool isDriven(const StepContext<S>& step, const ImpulseRow<S>& row) const;

  /// Velocity of a body before the forces of the step.
  struct Before {
    S velocity[3]{};
  };

  const std::vector<std::uint32_t>* slots_ = nullptr;
  bool watched_ = false;
  std::vector<Before> before_;
  Restitution<S> restitution_;
  // Each of the solver's bodies is in a group of those that contacts connect. A group is struck if energy
  // that grows in it is the doing of an elastic contact: none that moves by itself or is a belt drives it.
  std::vector<std::uint32_t> group_;
  std::vector<std::uint8_t> struck_;
  // Energies of the groups times two, J: what they may have after the passes, and what they have.
  std::vector<Scaled<S>> allowed_, energies_;
  ImpulseSolver<S> begin_;
};

#define SAMESTEP_EACH_SCALAR extern template class ImpulseBlows<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
