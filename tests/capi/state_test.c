/* SPDX-License-Identifier: MIT */
/* What is read back, saved, restored, written and compared. */
#include <stdlib.h>
#include <string.h>

#include "check.h"

static samestep_world* make_pile(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  add_box(world, SAMESTEP_STATIC, 0, 0, NULL);
  for (int i = 0; i < 8; ++i) add_box(world, SAMESTEP_DYNAMIC, 0.125 * i, 1.0 + i, NULL);
  return world;
}

static void test_slots(int32_t scalar) {
  samestep_world* world = make_pile(scalar);
  samestep_slot* slot = NULL;
  check_status(samestep_slot_create(scalar, &slot), SAMESTEP_OK, "slot", __LINE__);
  check_status(samestep_world_restore(world, slot), SAMESTEP_FOREIGN_WORLD, "an empty slot", __LINE__);
  steps(world, 10);
  check_status(samestep_world_save(world, slot), SAMESTEP_OK, "save", __LINE__);
  const uint64_t saved = hash_of(world);
  steps(world, 10);
  const uint64_t later = hash_of(world);
  check_status(samestep_world_restore(world, slot), SAMESTEP_OK, "restore", __LINE__);
  check_equal(hash_of(world), saved, "a restored world", __LINE__);
  steps(world, 10);
  check_equal(hash_of(world), later, "goes on as before", __LINE__);
  uint64_t tick = 0;
  uint64_t bytes = 0;
  check_status(samestep_slot_get_tick(slot, &tick), SAMESTEP_OK, "tick", __LINE__);
  check_status(samestep_slot_get_bytes(slot, &bytes), SAMESTEP_OK, "bytes", __LINE__);
  check(tick == 10 && bytes > 0, "a slot knows its tick", __LINE__);
  samestep_slot* other = NULL;
  const int32_t other_scalar = scalar == SAMESTEP_FIXED ? SAMESTEP_DOUBLE : SAMESTEP_FIXED;
  if (samestep_scalar_built(other_scalar)) {
    check_status(samestep_slot_create(other_scalar, &other), SAMESTEP_OK, "slot", __LINE__);
    check_status(samestep_world_save(world, other), SAMESTEP_WRONG_SCALAR, "save", __LINE__);
    check_status(samestep_world_restore(world, other), SAMESTEP_WRONG_SCALAR, "restore", __LINE__);
    samestep_slot_destroy(other);
  }
  check_status(samestep_slot_create(3, &other), SAMESTEP_UNKNOWN_VALUE, "scalar", __LINE__);
  samestep_slot_destroy(slot);
  samestep_slot_destroy(NULL);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_snapshots(int32_t scalar) {
  samestep_world* world = make_pile(scalar);
  samestep_world* copy = make_world(scalar);
  steps(world, 10);
  size_t size = 0;
  check_status(samestep_world_write_snapshot(world, NULL, 0, &size), SAMESTEP_OK, "size", __LINE__);
  check(size > 0, "a snapshot has bytes", __LINE__);
  uint8_t* bytes = malloc(size);
  if (bytes == NULL) abort();
  memset(bytes, 7, size);
  size_t again = 0;
  check_status(samestep_world_write_snapshot(world, bytes, size - 1, &again), SAMESTEP_BUFFER_TOO_SMALL,
               "room", __LINE__);
  check(again == size && bytes[0] == 7, "a small buffer is left alone, and told the size", __LINE__);
  check_status(samestep_world_write_snapshot(world, NULL, size, &again), SAMESTEP_NULL_ARGUMENT, "null",
               __LINE__);
  check_status(samestep_world_write_snapshot(world, bytes, size, &again), SAMESTEP_OK, "write", __LINE__);
  samestep_snapshot_info info;
  check_status(samestep_snapshot_get_info(bytes, size, &info), SAMESTEP_OK, "info", __LINE__);
  check(info.scalar == scalar && info.size == size && info.revision == samestep_simulation_revision(),
        "what its first bytes say", __LINE__);
  check_status(samestep_world_read_snapshot(copy, bytes, size, 0, NULL), SAMESTEP_OK, "read", __LINE__);
  check_equal(hash_of(copy), hash_of(world), "a snapshot is the world", __LINE__);
  steps(world, 10);
  steps(copy, 10);
  check_equal(hash_of(copy), hash_of(world), "and goes on as it", __LINE__);

  const uint64_t before = hash_of(copy);
  for (size_t i = 0; i < size; i += 1 + size / 200) {
    check(samestep_world_read_snapshot(copy, bytes, i, 0, NULL) != SAMESTEP_OK, "what is cut off is refused",
          __LINE__);
  }
  check_status(samestep_world_read_snapshot(copy, NULL, 4, 0, NULL), SAMESTEP_NULL_ARGUMENT, "null",
               __LINE__);
  samestep_limits limits;
  samestep_limits_init(&limits);
  limits.bodies = 3;
  check_status(samestep_world_read_snapshot(copy, bytes, size, 0, &limits), SAMESTEP_MALFORMED_BYTES,
               "limits", __LINE__);
  check_equal(hash_of(copy), before, "refused snapshots change nothing", __LINE__);
  free(bytes);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
  check_status(samestep_world_destroy(copy), SAMESTEP_OK, "destroy", __LINE__);
}

/* The first question comes before anything has changed. */
static int32_t at_second(void* data) { return ++*(int*)data > 1 ? 1 : 0; }

static void test_interrupts(int32_t scalar) {
  samestep_world* world = make_pile(scalar);
  samestep_slot* slot = NULL;
  check_status(samestep_slot_create(scalar, &slot), SAMESTEP_OK, "slot", __LINE__);
  check_status(samestep_world_save(world, slot), SAMESTEP_OK, "save", __LINE__);
  int asked = 0;
  int32_t usable = 1;
  uint64_t hash = 0;
  check_status(samestep_world_set_interrupt(world, at_second, &asked), SAMESTEP_OK, "interrupt", __LINE__);
  check_status(samestep_world_step_at(world, 60), SAMESTEP_INTERRUPTED, "step", __LINE__);
  check(asked == 2, "it is asked", __LINE__);
  check_status(samestep_world_is_usable(world, &usable), SAMESTEP_OK, "usable", __LINE__);
  check(usable == 0, "the world is left midway", __LINE__);
  check_status(samestep_world_get_hash(world, &hash), SAMESTEP_LEFT_MIDWAY, "hash", __LINE__);
  check_status(samestep_world_set_interrupt(world, NULL, NULL), SAMESTEP_OK, "interrupt", __LINE__);
  check_status(samestep_world_restore(world, slot), SAMESTEP_OK, "restore", __LINE__);
  steps(world, 3);
  uint64_t work = 0;
  check_status(samestep_world_get_work(world, &work), SAMESTEP_OK, "work", __LINE__);
  check_status(samestep_world_set_max_work(world, work), SAMESTEP_OK, "work", __LINE__);
  check_status(samestep_world_step_at(world, 60), SAMESTEP_INTERRUPTED, "step", __LINE__);
  samestep_slot_destroy(slot);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_difference(int32_t scalar) {
  samestep_world* a = make_pile(scalar);
  samestep_world* b = make_pile(scalar);
  char text[4096];
  size_t size = 0;
  check_status(samestep_world_write_difference(a, b, 10, text, sizeof text, &size), SAMESTEP_OK, "same",
               __LINE__);
  check(size == 1 && text[0] == '\0', "equal worlds differ in nothing", __LINE__);
  check_status(samestep_body_set_velocity(b, samestep_make_id(3, 1), 1, 0), SAMESTEP_OK, "velocity",
               __LINE__);
  check_status(samestep_world_write_difference(a, b, 10, NULL, 0, &size), SAMESTEP_OK, "size", __LINE__);
  check_status(samestep_world_write_difference(a, b, 10, text, size - 1, &size), SAMESTEP_BUFFER_TOO_SMALL,
               "room", __LINE__);
  check_status(samestep_world_write_difference(a, b, 10, text, size, &size), SAMESTEP_OK, "text", __LINE__);
  check(strncmp(text, "body 3: velocity.x: 0 ", 22) == 0, "the field is named", __LINE__);
  check(strlen(text) + 1 == size, "the size is that of the text", __LINE__);
  check_status(samestep_world_write_difference(a, NULL, 10, text, size, &size), SAMESTEP_NULL_ARGUMENT,
               "null", __LINE__);
  check_status(samestep_world_destroy(a), SAMESTEP_OK, "destroy", __LINE__);
  check_status(samestep_world_destroy(b), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_sleep(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_shape_id shape = 0;
  const samestep_body_id body = add_box(world, SAMESTEP_DYNAMIC, 1, 2, &shape);
  samestep_settings settings;
  samestep_body_state state;
  check_status(samestep_world_get_settings(world, &settings), SAMESTEP_OK, "settings", __LINE__);
  check(settings.sleep_time_threshold == 0, "nothing sleeps at first", __LINE__);
  settings.gravity.y = 0;
  settings.sleep_time_threshold = 8;
  check_status(samestep_world_set_settings(world, &settings), SAMESTEP_OK, "settings", __LINE__);
  check_status(samestep_body_sleep(world, body), SAMESTEP_OK, "sleep", __LINE__);
  check_status(samestep_world_step(world, 0.015625), SAMESTEP_OK, "step", __LINE__);
  check_status(samestep_body_get(world, body, &state), SAMESTEP_OK, "get", __LINE__);
  check(state.sleeps == 1 && state.may_sleep == 1, "it sleeps", __LINE__);
  check_status(samestep_body_activate(world, body), SAMESTEP_OK, "activate", __LINE__);
  check_status(samestep_body_set_may_sleep(world, body, 0), SAMESTEP_OK, "may not", __LINE__);
  check_status(samestep_body_sleep(world, body), SAMESTEP_OK, "sleep", __LINE__);
  check_status(samestep_world_step(world, 0.015625), SAMESTEP_OK, "step", __LINE__);
  check_status(samestep_body_get(world, body, &state), SAMESTEP_OK, "get", __LINE__);
  check(state.sleeps == 0 && state.may_sleep == 0, "it does not", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_bodies(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_shape_id shape = 0;
  const samestep_body_id body = add_box(world, SAMESTEP_DYNAMIC, 1, 2, &shape);
  samestep_body_state state;
  check_status(samestep_body_set_velocity(world, body, 3, -4), SAMESTEP_OK, "velocity", __LINE__);
  check_status(samestep_body_set_user_data(world, body, 99), SAMESTEP_OK, "data", __LINE__);
  check_status(samestep_body_set_bullet(world, body, 1), SAMESTEP_OK, "bullet", __LINE__);
  check_status(samestep_body_apply_force(world, body, 1, 0, 1, 3), SAMESTEP_OK, "force", __LINE__);
  check_status(samestep_body_get(world, body, &state), SAMESTEP_OK, "get", __LINE__);
  check(state.id == body && state.user_data == 99 && state.bullet == 1 && state.type == SAMESTEP_DYNAMIC,
        "what it is", __LINE__);
  check(state.position.x == 1 && state.position.y == 2 && state.velocity.y == -4, "where it is", __LINE__);
  check(state.mass == 1 && state.force.x == 1 && state.torque == -1, "what acts on it", __LINE__);
  check(state.kinetic_energy == 12.5, "what energy it has", __LINE__);
  int64_t raw[2] = {0, 0};
  check_status(samestep_body_get_raw(world, body, SAMESTEP_RAW_VELOCITY, raw), SAMESTEP_OK, "raw", __LINE__);
  if (scalar == SAMESTEP_FIXED) check(raw[0] == INT64_C(3) << 32, "in units of 2^-32", __LINE__);
  raw[0] += 1;
  check_status(samestep_body_set_raw(world, body, SAMESTEP_RAW_VELOCITY, raw), SAMESTEP_OK, "raw", __LINE__);
  int64_t again[2] = {0, 0};
  check_status(samestep_body_get_raw(world, body, SAMESTEP_RAW_VELOCITY, again), SAMESTEP_OK, "raw",
               __LINE__);
  check(again[0] == raw[0] && again[1] == raw[1], "to the last bit", __LINE__);
  check_status(samestep_body_set_raw(world, body, SAMESTEP_RAW_ROTATION, raw), SAMESTEP_UNKNOWN_VALUE,
               "rotation", __LINE__);
  check_status(samestep_body_get_raw(world, body, 11, raw), SAMESTEP_UNKNOWN_VALUE, "quantity", __LINE__);
  double number = 0;
  check_status(samestep_number_to_raw(world, -1.5, &raw[0]), SAMESTEP_OK, "to raw", __LINE__);
  check_status(samestep_number_from_raw(world, raw[0], &number), SAMESTEP_OK, "from raw", __LINE__);
  check(number == -1.5, "numbers go to bits and back", __LINE__);
  const samestep_pose* poses = NULL;
  size_t count = 0;
  check_status(samestep_world_get_poses(world, &poses, &count), SAMESTEP_OK, "poses", __LINE__);
  check(count == 2 && poses[1].id == body && poses[1].position.y == 2 && poses[1].rotation.x == 1, "poses",
        __LINE__);
  samestep_vec2 point;
  check_status(samestep_body_to_local(world, body, 1, 3, &point), SAMESTEP_OK, "to local", __LINE__);
  check(point.x == 0 && point.y == 1, "in its coordinates", __LINE__);
  const samestep_shape_id* shapes = NULL;
  check_status(samestep_body_get_shapes(world, body, &shapes, &count), SAMESTEP_OK, "shapes", __LINE__);
  check(count == 1 && shapes[0] == shape, "its shapes", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_shapes(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_shape_id shape = 0;
  const samestep_body_id body = add_box(world, SAMESTEP_DYNAMIC, 0, 0, &shape);
  samestep_shape_state state;
  check_status(samestep_shape_get(world, shape, &state), SAMESTEP_OK, "get", __LINE__);
  check(state.body == body && state.kind == SAMESTEP_POLYGON && state.mass == 1 && state.area == 1, "a box",
        __LINE__);
  const samestep_vec2* vertices = NULL;
  size_t count = 0;
  check_status(samestep_shape_get_vertices(world, shape, &vertices, &count), SAMESTEP_OK, "vertices",
               __LINE__);
  check(count == 4 && vertices[0].x == 0.5 && vertices[0].y == -0.5, "from its bottom right corner",
        __LINE__);
  samestep_shape_def def;
  samestep_shape_def_init(&def);
  def.kind = SAMESTEP_SEGMENT;
  def.a.x = -1;
  def.b.x = 1;
  def.radius = 0.25;
  def.has_neighbors = 1;
  def.previous.x = -2;
  def.next.x = 2;
  check_status(samestep_shape_replace(world, shape, &def), SAMESTEP_OK, "replace", __LINE__);
  check_status(samestep_shape_get_vertices(world, shape, &vertices, &count), SAMESTEP_OK, "vertices",
               __LINE__);
  check(count == 2 && vertices[1].x == 1, "the ends of a segment", __LINE__);
  const samestep_vec2 corners[5] = {{0, 0}, {1, 0}, {0.5, 0.5}, {1, 1}, {0, 1}};
  def.kind = SAMESTEP_POLYGON;
  def.radius = 0;
  def.vertices = corners;
  def.vertex_count = 5;
  def.density = 2;
  check_status(samestep_shape_replace(world, shape, &def), SAMESTEP_OK, "replace", __LINE__);
  check_status(samestep_shape_get(world, shape, &state), SAMESTEP_OK, "get", __LINE__);
  check(state.mass == 2 && state.center_of_mass.x == 0.5 && state.id == shape, "the hull of points",
        __LINE__);
  samestep_body_state of;
  check_status(samestep_body_get(world, body, &of), SAMESTEP_OK, "body", __LINE__);
  check(of.mass == 2 && of.center_of_mass.y == 0.5, "the body follows its shapes", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

/* Objects with given ids make the same world in whatever order they come. */
static uint64_t given(int32_t scalar, int backwards) {
  samestep_world* world = make_world(scalar);
  for (uint32_t i = 0; i < 6; ++i) {
    const uint32_t index = backwards ? 6 - i : 1 + i;
    samestep_body_def body_def;
    samestep_body_def_init(&body_def);
    body_def.id = samestep_make_id(index, 1);
    body_def.type = index == 1 ? SAMESTEP_STATIC : SAMESTEP_DYNAMIC;
    body_def.position.y = index;
    samestep_body_id body = 0;
    check_status(samestep_body_create(world, &body_def, &body), SAMESTEP_OK, "body", __LINE__);
    check(body == body_def.id, "the id is the one given", __LINE__);
    samestep_shape_def def;
    samestep_shape_def_init(&def);
    def.id = samestep_make_id(index, 1);
    def.density = index == 1 ? 0 : 1;
    samestep_shape_id shape = 0;
    check_status(samestep_shape_create(world, body, &def, &shape), SAMESTEP_OK, "shape", __LINE__);
  }
  steps(world, 30);
  const uint64_t hash = hash_of(world);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
  return hash;
}

static void test_fingerprint(int32_t scalar) {
  uint64_t one = 0;
  uint64_t two = 0;
  check_status(samestep_fingerprint(scalar, &one), SAMESTEP_OK, "fingerprint", __LINE__);
  check_status(samestep_fingerprint(scalar, &two), SAMESTEP_OK, "fingerprint", __LINE__);
  check(one == two && one != 0, "the same again", __LINE__);
  check_status(samestep_fingerprint(0, &one), SAMESTEP_UNKNOWN_VALUE, "fingerprint", __LINE__);
  check(samestep_c_version() == SAMESTEP_C_VERSION, "the header is that of the library", __LINE__);
}

void test_state(void) {
  begin("state");
  int32_t built[2];
  const int count = scalars(built);
  for (int i = 0; i < count; ++i) {
    test_slots(built[i]);
    test_snapshots(built[i]);
    test_interrupts(built[i]);
    test_difference(built[i]);
    test_bodies(built[i]);
    test_sleep(built[i]);
    test_shapes(built[i]);
    check_equal(given(built[i], 1), given(built[i], 0), "given ids", __LINE__);
    test_fingerprint(built[i]);
  }
}
