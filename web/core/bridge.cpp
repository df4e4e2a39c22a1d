// SPDX-License-Identifier: MIT
// What JavaScript needs beside the C interface: functions of C that call those of JavaScript, by a number
// that takes the place of `data`, and poses as drawing wants them.
#include <samestep/c/samestep.h>

#include <vector>

#define FROM_JAVASCRIPT(name) __attribute__((import_module("samestep"), import_name(name)))

extern "C" {

FROM_JAVASCRIPT("contact")
int32_t js_contact(int32_t phase, samestep_contact* contact, samestep_world* world, void* key);
FROM_JAVASCRIPT("position") void js_position(samestep_world*, samestep_body_id, double seconds, void* key);
FROM_JAVASCRIPT("velocity")
void js_velocity(samestep_world*, samestep_body_id, double x, double y, double damping, double seconds,
                 void* key);
FROM_JAVASCRIPT("post_step") void js_post_step(samestep_world*, void* key);
FROM_JAVASCRIPT("input") samestep_status js_input(samestep_world*, const uint8_t*, size_t, void* key);
FROM_JAVASCRIPT("connect") void js_connect(samestep_world*, void* key);
FROM_JAVASCRIPT("progress") int32_t js_progress(double done, double total, void* key);
FROM_JAVASCRIPT("apply_inputs")
void js_apply_inputs(samestep_world*, uint32_t tick, const samestep_player_input*, uint32_t count, void* key);
FROM_JAVASCRIPT("send") void js_send(double to, const uint8_t*, size_t, void* key);
FROM_JAVASCRIPT("receive") uint32_t js_receive(double* from, uint8_t* into, size_t room, void* key);
FROM_JAVASCRIPT("own_save") void js_own_save(uint32_t slot, void* key);
FROM_JAVASCRIPT("own_load") void js_own_load(uint32_t slot, void* key);
FROM_JAVASCRIPT("own_hash") void js_own_hash(uint64_t* hash, void* key);

}  // extern "C"

namespace {

template <int kPhase>
int32_t ask(samestep_contact* contact, samestep_world* world, void* key) {
  return js_contact(kPhase, contact, world, key);
}
template <int kPhase>
void tell(samestep_contact* contact, samestep_world* world, void* key) {
  js_contact(kPhase, contact, world, key);
}
void postStep(samestep_world* world, uint64_t, void* key) { js_post_step(world, key); }
int32_t progress(uint64_t done, uint64_t total, void* key) {
  return js_progress(static_cast<double>(done), static_cast<double>(total), key);
}
void send(uint64_t to, const uint8_t* bytes, size_t size, void* key) {
  js_send(static_cast<double>(to), bytes, size, key);
}
uint32_t receive(uint64_t* from, uint8_t* into, size_t room, void* key) {
  double sender = 0;
  const uint32_t size = js_receive(&sender, into, room, key);
  *from = static_cast<uint64_t>(sender);
  return size;
}
uint64_t ownHash(void* key) {
  uint64_t hash = 0;
  js_own_hash(&hash, key);
  return hash;
}

/// All that a structure of the C interface may be given; JavaScript copies the pointers by their places.
struct Functions {
  samestep_handler handler{ask<SAMESTEP_BEGIN>, ask<SAMESTEP_PRE_SOLVE>, tell<SAMESTEP_POST_SOLVE>,
                           tell<SAMESTEP_SEPARATE>, nullptr};
  samestep_position_function position = js_position;
  samestep_velocity_function velocity = js_velocity;
  samestep_post_step postStep = ::postStep;
  samestep_input_function input = js_input;
  void (*connect)(samestep_world*, void*) = js_connect;
  int32_t (*progress)(uint64_t, uint64_t, void*) = ::progress;
  samestep_apply_inputs applyInputs = js_apply_inputs;
  samestep_send send = ::send;
  samestep_receive receive = ::receive;
  samestep_own_state own{js_own_save, js_own_load, ownHash, nullptr};
};
const Functions functions;

/// The poses written last, of any world.
std::vector<float> poseValues;
std::vector<double> poseIds;

}  // namespace

extern "C" {

const Functions* samestep_web_functions() { return &functions; }

/// An id as one number that a double holds: the generation above twenty bits of index.
static double numberOf(uint64_t id) { return static_cast<double>((id >> 32) << 20 | (id & 0xfffffu)); }

/// x, y, cosine and sine of each body, and its id, by rising id.
samestep_status samestep_web_write_poses(samestep_world* world, const float** values, const double** ids,
                                         uint32_t* count) {
  const samestep_pose* poses = nullptr;
  size_t size = 0;
  const samestep_status status = samestep_world_get_poses(world, &poses, &size);
  if (status != SAMESTEP_OK) return status;
  try {
    poseValues.resize(4 * size);
    poseIds.resize(size);
  } catch (const std::bad_alloc&) {
    return SAMESTEP_OUT_OF_MEMORY;
  }
  for (size_t i = 0; i < size; ++i) {
    const double pose[4] = {poses[i].position.x, poses[i].position.y, poses[i].rotation.x,
                            poses[i].rotation.y};
    for (size_t k = 0; k < 4; ++k) poseValues[4 * i + k] = static_cast<float>(pose[k]);
    poseIds[i] = numberOf(poses[i].id);
  }
  *values = poseValues.data();
  *ids = poseIds.data();
  *count = static_cast<uint32_t>(size);
  return SAMESTEP_OK;
}

}  // extern "C"
