// SPDX-License-Identifier: MIT
// Worlds: their making and end, settings, steps, workers and hooks.
#include <samestep/fingerprint.h>
#include <samestep/version.h>

#include "base/require_ieee.h"
#include "definitions.h"

namespace samestep::c {
namespace {

template <Scalar S>
void setWorkers(WorldOf<S>& world, std::unique_ptr<TaskRunner> runner) {
  world.space.setWorkers(runner.get());
  world.runner = std::move(runner);
}

/// A pool of as many threads as asked for; null for the calling thread alone.
std::unique_ptr<TaskRunner> poolOf(std::int32_t workers, Remarks& remarks) {
  require<Fault::ValueOutOfRange>(workers >= 1 && workers <= WorkerPool::kMostWorkers,
                                  "Workers are 1 to 64.");
  if (workers == 1) return nullptr;
  return std::make_unique<WorkerPool>(workers, &remarks);
}

template <Scalar S>
samestep_world* create(const samestep_world_def& def) {
  const Settings<S> settings = toSettings<S>(def.settings);
  auto world = std::make_unique<WorldOf<S>>();
  world->space.setSettings(settings);
  world->space.setMaxPairs(def.max_pairs);
  setWorkers(*world, poolOf(def.workers, world->space.remarks()));
  return world.release();
}

void logOf(Remark, const char* text, void* context) {
  const auto& world = *static_cast<const samestep_world*>(context);
  world.log(text, world.logData);
}

bool isWanted(void* data) {
  const auto& world = *static_cast<const samestep_world*>(data);
  return world.interrupt(world.interruptData) != 0;
}

template <Scalar S>
void step(WorldOf<S>& world, S seconds) {
  world.space.step(seconds);
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

uint32_t samestep_c_version(void) { return SAMESTEP_C_VERSION; }
const char* samestep_version(void) { return samestep::version().data(); }
uint32_t samestep_simulation_revision(void) { return samestep::kSimulationRevision; }

int32_t samestep_scalar_built(int32_t scalar) {
#ifdef SAMESTEP_FIXED_ONLY
  return scalar == SAMESTEP_FIXED ? 1 : 0;
#elif defined(SAMESTEP_C_DOUBLE_ONLY)
  return scalar == SAMESTEP_DOUBLE ? 1 : 0;
#else
  return scalar == SAMESTEP_FIXED || scalar == SAMESTEP_DOUBLE ? 1 : 0;
#endif
}

samestep_status samestep_fingerprint(int32_t scalar, uint64_t* fingerprint) {
  return callFree([&] {
    at(fingerprint);
    forScalar(scalar, [&](auto number) { *fingerprint = samestep::fingerprint<decltype(number)>(); });
  });
}

uint64_t samestep_make_id(uint32_t index, uint32_t generation) { return uint64_t{generation} << 32 | index; }

samestep_status samestep_world_create(const samestep_world_def* def, samestep_world** world) {
  return callFree([&] {
    at(world);
    current(def);
    forScalar(def->scalar, [&](auto number) { *world = create<decltype(number)>(*def); });
  });
}

samestep_status samestep_world_destroy(samestep_world* world) {
  if (world == nullptr) return SAMESTEP_OK;
  const samestep_status status = call(world, [&](auto& of) {
    requireOr(of.destroyable && of.users == 0, SAMESTEP_IN_USE);
    samestep::require<samestep::Fault::SpaceLocked>(!of.space.isLocked() && of.callbacks == 0);
  });
  if (status == SAMESTEP_OK) delete world;
  return status;
}

samestep_status samestep_world_get_scalar(const samestep_world* world, int32_t* scalar) {
  return call(world, [&](auto& of) { at(scalar) = static_cast<int32_t>(of.scalar); });
}

samestep_status samestep_world_get_settings(const samestep_world* world, samestep_settings* settings) {
  return call(world, [&](auto& of) { at(settings) = toC(of.space.settings()); });
}

samestep_status samestep_world_set_settings(samestep_world* world, const samestep_settings* settings) {
  return call(world, [&]<class World>(World& of) {
    of.space.setSettings(toSettings<typename World::Number>(current(settings)));
  });
}

samestep_status samestep_world_set_gravity(samestep_world* world, double x, double y) {
  return call(world,
              [&]<class World>(World& of) { of.space.setGravity(vector<typename World::Number>(x, y)); });
}

samestep_status samestep_world_step(samestep_world* world, double seconds) {
  return call(world, [&]<class World>(World& of) { step(of, number<typename World::Number>(seconds)); });
}

samestep_status samestep_world_step_at(samestep_world* world, uint32_t rate) {
  return call(world, [&]<class World>(World& of) { step(of, timeStepOf<typename World::Number>(rate)); });
}

samestep_status samestep_world_get_tick(const samestep_world* world, uint64_t* tick) {
  return call(world, [&](auto& of) { at(tick) = of.space.stamp(); });
}

samestep_status samestep_world_is_locked(const samestep_world* world, int32_t* locked) {
  return call(world, [&](auto& of) { at(locked) = of.space.isLocked() ? 1 : 0; });
}

samestep_status samestep_world_is_usable(const samestep_world* world, int32_t* usable) {
  return call(world, [&](auto& of) { at(usable) = of.space.isUsable() ? 1 : 0; });
}

samestep_status samestep_world_set_interrupt(samestep_world* world, samestep_interrupt interrupt,
                                             void* data) {
  return call(world, [&](auto& of) {
    of.interrupt = interrupt;
    of.interruptData = data;
    samestep::Interrupt asked;
    if (interrupt != nullptr) asked = {isWanted, static_cast<samestep_world*>(&of)};
    of.space.setInterrupt(asked);
  });
}

samestep_status samestep_world_get_work(const samestep_world* world, uint64_t* work) {
  return call(world, [&](auto& of) { at(work) = of.space.work(); });
}

samestep_status samestep_world_set_max_work(samestep_world* world, uint64_t work) {
  return call(world, [&](auto& of) { of.space.setMaxWork(work); });
}

samestep_status samestep_world_get_body_count(const samestep_world* world, uint32_t* count) {
  return call(world, [&](auto& of) { at(count) = of.space.bodyCount(); });
}

samestep_status samestep_world_get_shape_count(const samestep_world* world, uint32_t* count) {
  return call(world, [&](auto& of) { at(count) = of.space.shapeCount(); });
}

samestep_status samestep_world_set_workers(samestep_world* world, int32_t workers) {
  return call(world, [&](auto& of) {
    samestep::require<samestep::Fault::SpaceLocked>(!of.space.isLocked());
    setWorkers(of, poolOf(workers, of.space.remarks()));
  });
}

samestep_status samestep_world_set_task_runner(samestep_world* world, int32_t workers, samestep_run_tasks run,
                                               void* data) {
  return call(world, [&](auto& of) {
    if (run == nullptr) return setWorkers(of, nullptr);
    samestep::require<samestep::Fault::ValueOutOfRange>(
        workers >= 1 && workers <= samestep::WorkerPool::kMostWorkers, "Workers are 1 to 64.");
    setWorkers(of, std::make_unique<RunnerOfCaller>(workers, run, data));
  });
}

samestep_status samestep_world_set_max_pairs(samestep_world* world, uint32_t pairs) {
  return call(world, [&](auto& of) { of.space.setMaxPairs(pairs); });
}

samestep_status samestep_world_set_log(samestep_world* world, samestep_log log, void* data) {
  return call(world, [&](auto& of) {
    of.log = log;
    of.logData = data;
    samestep::Remarks& remarks = of.space.remarks();
    remarks.hook = log == nullptr ? nullptr : logOf;
    remarks.context = static_cast<samestep_world*>(&of);
  });
}

samestep_status samestep_world_set_failure_hook(samestep_world* world, samestep_failure failure, void* data) {
  return call(world, [&](auto& of) {
    of.failure = failure;
    of.failureData = data;
  });
}

}  // extern "C"
