// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <samestep/c/samestep.h>
#include <samestep/space.h>

#include "numbers.h"

/// World as the C interface keeps it, whatever it computes with.
struct samestep_world {
  explicit samestep_world(samestep::ScalarKind kind) : scalar(kind) {}
  samestep_world(const samestep_world&) = delete;
  samestep_world& operator=(const samestep_world&) = delete;
  virtual ~samestep_world() = default;

  const samestep::ScalarKind scalar;
  /// True for a world of the caller, false for one that lives for a replay.
  bool destroyable = true;
  /// Recorders and sessions, which must end before it.
  std::int32_t users = 0;
  /// Functions of the caller's that are under way while the Space is not locked.
  std::int32_t callbacks = 0;
  samestep_failure failure = nullptr;
  void* failureData = nullptr;
  samestep_interrupt interrupt = nullptr;
  void* interruptData = nullptr;
  samestep_log log = nullptr;
  void* logData = nullptr;
  /// A sentence is copied here, for an exception takes its own with it.
  mutable char message[256] = "";
};

namespace samestep::c {

/// Notes that a function of the caller's is under way.
class InCallback {
 public:
  explicit InCallback(samestep_world& world) : world_(world) { ++world_.callbacks; }
  ~InCallback() { --world_.callbacks; }
  InCallback(const InCallback&) = delete;
  InCallback& operator=(const InCallback&) = delete;

 private:
  samestep_world& world_;
};

/// A game's job system behind the two numbers and the function that C knows of it.
class RunnerOfCaller final : public TaskRunner {
 public:
  RunnerOfCaller(int workers, samestep_run_tasks function, void* data)
      : workers_(workers), function_(function), data_(data) {}
  int workers() const override { return workers_; }
  void run(int tasks, void (*task)(int, void*), void* data) override { function_(data_, tasks, task, data); }

 private:
  int workers_;
  samestep_run_tasks function_;
  void* data_;
};

/// A world of one scalar: a Space, what stands between its functions and those of the caller, and the arrays
/// that were given out.
template <Scalar S>
struct WorldOf : samestep_world {
  using Number = S;

  /// A world of its own.
  WorldOf() : samestep_world(ScalarTraits<S>::kKind), owned(std::make_unique<Space<S>>()), space(*owned) {}
  /// One over a Space of somebody else, which it must not outlive.
  explicit WorldOf(Space<S>& other) : samestep_world(ScalarTraits<S>::kKind), space(other) {
    destroyable = false;
  }

  struct HandlerRecord {
    WorldOf* world;
    samestep_handler functions;
  };
  struct PositionRecord {
    WorldOf* world;
    samestep_position_function function;
    void* data;
  };
  struct VelocityRecord {
    WorldOf* world;
    samestep_velocity_function function;
    void* data;
  };
  struct PostStepRecord {
    samestep_post_step function;
    void* data;
  };

  // Before the Space, which holds pointers to them.
  std::unique_ptr<TaskRunner> runner;
  std::map<CallbackNumber, std::unique_ptr<HandlerRecord>> handlers;
  std::map<CallbackNumber, std::unique_ptr<PositionRecord>> positionFunctions;
  std::map<CallbackNumber, std::unique_ptr<VelocityRecord>> velocityFunctions;
  std::map<std::uint64_t, PostStepRecord> postStep;
  samestep_input_function input = nullptr;
  void* inputData = nullptr;

  std::unique_ptr<Space<S>> owned;
  Space<S>& space;

  // These were given out, and what they were made of.
  std::vector<samestep_pose> poses;
  std::vector<samestep_shape_id> bodyShapes;
  std::vector<samestep_vec2> vertices;
  std::vector<samestep_contact_state> contacts;
  std::vector<PointHit<S>> pointsFound;
  std::vector<SegmentHit<S>> segmentsFound;
  std::vector<NearHit<S>> nearFound;
  std::vector<ShapeId> shapesFound;
  std::vector<samestep_point_hit> pointHits;
  std::vector<samestep_segment_hit> segmentHits;
  std::vector<samestep_shape_id> boxHits;
  std::vector<samestep_contact_event> begins;
  std::vector<samestep_contact_event> ends;
  std::vector<samestep_impact_event> impacts;
  std::vector<samestep_joint_id> joints;
  std::vector<samestep_body_id> connected;
  std::vector<samestep_joint_event> jointEvents;
};

}  // namespace samestep::c
