// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/kernel.h>

#include <memory>
#include <string>
#include <vector>

#include "peer_scene.h"

namespace samestep::bench {

/// Motion of a body: its origin in m, its angle in rad, the velocity of its centre of mass in m/s, its
/// angular velocity in rad/s.
struct Motion {
  double x, y, angle, vx, vy, w;
};

/// A scene running in one engine.
class World {
 public:
  virtual ~World() = default;
  /// One step of 1/60 s.
  virtual void step() = 0;
  /// Motions of all bodies, in the order of the scene.
  virtual std::vector<Motion> motions() const = 0;
};

/// Choice of how Samestep solves contacts.
struct SolverChoice {
  bool soft = false;
  bool fast = false;  ///< The soft step at fast precision.
  int count = 10;     ///< Substeps of the soft step, or iterations of the sequential impulses.
  int workers = 1;    ///< Threads.
  KernelTarget kernel = KernelTarget::best;
};

std::unique_ptr<World> makeDouble(const PeerScene& scene, SolverChoice solver);
std::unique_ptr<World> makeFixed(const PeerScene& scene, SolverChoice solver);
std::unique_ptr<World> makeChipmunk(const PeerScene& scene, int iterations);
std::unique_ptr<World> makeBox2d(const PeerScene& scene);

/// The scene in the engine of that name: `chipmunk` (10 iterations; `chipmunkN` for N), `box2d24` (8 velocity
/// and 3 position iterations), `samestep-double-impulsesN`, `samestep-double-softN` (N substeps), and the
/// same with `fixed`; these also with `xN` for N workers, and with `-KERNEL` for one kernel.
/// Null if there is no such engine, or if this machine has no such kernel.
std::unique_ptr<World> makeWorld(const std::string& engine, const PeerScene& scene);

}  // namespace samestep::bench
