/* SPDX-License-Identifier: MIT */
/* What is refused: with which status, and that it leaves everything as it was. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check.h"

/* A world in which something touches, and ids of what is there and of what is gone. */
typedef struct fixture {
  samestep_world* world;
  samestep_body_id body;
  samestep_body_id ground;
  samestep_body_id gone;
  samestep_shape_id shape;
  samestep_shape_id gone_shape;
  uint64_t hash;
} fixture;

static fixture make_fixture(int32_t scalar) {
  fixture made;
  made.world = make_world(scalar);
  made.ground = add_box(made.world, SAMESTEP_STATIC, 0, 0, NULL);
  made.body = add_box(made.world, SAMESTEP_DYNAMIC, 0.25, 1.0, &made.shape);
  made.gone = add_box(made.world, SAMESTEP_DYNAMIC, 5, 5, &made.gone_shape);
  check_status(samestep_body_destroy(made.world, made.gone), SAMESTEP_OK, "destroy", __LINE__);
  /* The slots of what is gone are used again. */
  add_box(made.world, SAMESTEP_DYNAMIC, -9, 5, NULL);
  steps(made.world, 5);
  made.hash = hash_of(made.world);
  return made;
}

static void refused(const fixture* on, samestep_status found, samestep_status wanted, const char* about,
                    int line) {
  check_status(found, wanted, about, line);
  check_equal(hash_of(on->world), on->hash, about, line);
  check(strlen(samestep_last_message(on->world)) > 0, "a refused call has a message", line);
}

static void test_null(const fixture* on) {
  samestep_body_state state;
  uint64_t number = 7;
  samestep_world* none = NULL;
  check_status(samestep_world_create(NULL, &none), SAMESTEP_NULL_ARGUMENT, "no definition", __LINE__);
  check(none == NULL, "a refused creation gives nothing", __LINE__);
  check_status(samestep_world_step(NULL, 0.5), SAMESTEP_NULL_ARGUMENT, "no world", __LINE__);
  check(strcmp(samestep_last_message(NULL), "A pointer that must point at something is null.") == 0,
        "calls for no world have messages", __LINE__);
  check_status(samestep_world_destroy(NULL), SAMESTEP_OK, "destroying nothing", __LINE__);
  check_status(samestep_body_get(NULL, on->body, &state), SAMESTEP_NULL_ARGUMENT, "no world", __LINE__);
  refused(on, samestep_body_get(on->world, on->body, NULL), SAMESTEP_NULL_ARGUMENT, "no result", __LINE__);
  refused(on, samestep_world_get_hash(on->world, NULL), SAMESTEP_NULL_ARGUMENT, "no result", __LINE__);
  refused(on, samestep_body_create(on->world, NULL, &number), SAMESTEP_NULL_ARGUMENT, "no definition",
          __LINE__);
  refused(on, samestep_query_box(on->world, 0, 0, 1, 1, NULL, NULL, NULL), SAMESTEP_NULL_ARGUMENT, "no hits",
          __LINE__);
  refused(on, samestep_world_register_handler(on->world, 1, NULL), SAMESTEP_NULL_ARGUMENT, "no handler",
          __LINE__);
  refused(on, samestep_world_add_post_step(on->world, NULL, 1, NULL, NULL), SAMESTEP_NULL_ARGUMENT,
          "no function", __LINE__);
  refused(on, samestep_world_save(on->world, NULL), SAMESTEP_NULL_ARGUMENT, "no slot", __LINE__);
  check_status(samestep_contact_ignore(NULL), SAMESTEP_NULL_ARGUMENT, "no contact", __LINE__);
  check_status(samestep_recorder_step(NULL, &number), SAMESTEP_NULL_ARGUMENT, "no recorder", __LINE__);
  check(number == 7, "a refused call leaves its result alone", __LINE__);
}

static void test_stale(const fixture* on) {
  samestep_world* world = on->world;
  samestep_body_state body;
  samestep_shape_state shape;
  samestep_vec2 place;
  int32_t exists = 1;
  int64_t raw[2] = {0, 0};
  const samestep_shape_id* shapes;
  size_t count;
  const samestep_body_id bodies[] = {0, on->gone, UINT64_MAX, samestep_make_id(999, 1)};
  for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; ++i) {
    const samestep_body_id id = bodies[i];
    refused(on, samestep_body_get(world, id, &body), SAMESTEP_BODY_NOT_FOUND, "get", __LINE__);
    refused(on, samestep_body_set_velocity(world, id, 1, 0), SAMESTEP_BODY_NOT_FOUND, "velocity", __LINE__);
    refused(on, samestep_body_set_type(world, id, SAMESTEP_STATIC), SAMESTEP_BODY_NOT_FOUND, "type",
            __LINE__);
    refused(on, samestep_body_apply_impulse(world, id, 1, 0, 0, 0), SAMESTEP_BODY_NOT_FOUND, "push",
            __LINE__);
    refused(on, samestep_body_to_world(world, id, 0, 0, &place), SAMESTEP_BODY_NOT_FOUND, "to world",
            __LINE__);
    refused(on, samestep_body_set_raw(world, id, SAMESTEP_RAW_POSITION, raw), SAMESTEP_BODY_NOT_FOUND, "raw",
            __LINE__);
    refused(on, samestep_body_get_shapes(world, id, &shapes, &count), SAMESTEP_BODY_NOT_FOUND, "shapes",
            __LINE__);
    refused(on, samestep_body_destroy(world, id), SAMESTEP_BODY_NOT_FOUND, "destroy", __LINE__);
    check_status(samestep_body_exists(world, id, &exists), SAMESTEP_OK, "exists", __LINE__);
    check(exists == 0, "what is gone does not exist", __LINE__);
  }
  const samestep_shape_id gone[] = {0, on->gone_shape, UINT64_MAX};
  for (size_t i = 0; i < sizeof gone / sizeof gone[0]; ++i) {
    refused(on, samestep_shape_get(world, gone[i], &shape), SAMESTEP_SHAPE_NOT_FOUND, "get", __LINE__);
    refused(on, samestep_shape_set_friction(world, gone[i], 1), SAMESTEP_SHAPE_NOT_FOUND, "friction",
            __LINE__);
    refused(on, samestep_shape_destroy(world, gone[i]), SAMESTEP_SHAPE_NOT_FOUND, "destroy", __LINE__);
  }
  samestep_shape_def def;
  samestep_shape_def_init(&def);
  samestep_shape_id made = 7;
  refused(on, samestep_shape_create(world, on->gone, &def, &made), SAMESTEP_BODY_NOT_FOUND,
          "shape of nothing", __LINE__);
  check(made == 7, "a refused call leaves its result alone", __LINE__);
}

static void test_numbers(const fixture* on) {
  samestep_world* world = on->world;
  const samestep_body_id body = on->body;
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (size_t i = 0; i < 3; ++i) {
    const double x = bad[i];
    const samestep_status wanted = SAMESTEP_VALUE_OUT_OF_RANGE;
    refused(on, samestep_world_step(world, x), wanted, "step", __LINE__);
    refused(on, samestep_world_set_gravity(world, x, 0), wanted, "gravity", __LINE__);
    refused(on, samestep_body_set_position(world, body, 0, x), wanted, "position", __LINE__);
    refused(on, samestep_body_set_angle(world, body, x), wanted, "angle", __LINE__);
    refused(on, samestep_body_set_velocity(world, body, x, 0), wanted, "velocity", __LINE__);
    refused(on, samestep_body_apply_impulse(world, body, x, 0, 0, 0), wanted, "impulse", __LINE__);
    refused(on, samestep_body_apply_force(world, body, 0, 0, 0, x), wanted, "force", __LINE__);
    refused(on, samestep_shape_set_friction(world, on->shape, x), wanted, "friction", __LINE__);
    refused(on, samestep_shape_set_density(world, on->shape, x), wanted, "density", __LINE__);
    const samestep_segment_hit* hits;
    size_t count;
    refused(on, samestep_query_segment(world, x, 0, 1, 1, 0, NULL, &hits, &count), wanted, "query", __LINE__);
    int64_t raw = 0;
    refused(on, samestep_number_to_raw(world, x, &raw), wanted, "raw", __LINE__);
  }
  refused(on, samestep_body_set_mass(world, body, NAN), SAMESTEP_NAN_MASS, "mass", __LINE__);
  refused(on, samestep_body_set_mass(world, body, INFINITY), SAMESTEP_INFINITE_MASS, "mass", __LINE__);
  refused(on, samestep_body_set_mass(world, body, -1), SAMESTEP_NEGATIVE_MASS, "mass", __LINE__);
  refused(on, samestep_body_set_mass(world, body, 1e7), SAMESTEP_MASS_OUT_OF_RANGE, "mass", __LINE__);
  refused(on, samestep_body_set_mass(world, on->ground, 1), SAMESTEP_STATIC_BODY_MASS, "mass", __LINE__);
  refused(on, samestep_body_set_moment(world, body, NAN), SAMESTEP_NAN_MOMENT, "moment", __LINE__);
  refused(on, samestep_body_set_moment(world, body, -INFINITY), SAMESTEP_NEGATIVE_MOMENT, "moment", __LINE__);
  refused(on, samestep_body_set_position(world, body, 1e300, 0), SAMESTEP_ILLEGAL_BODY, "far away", __LINE__);
  refused(on, samestep_body_set_velocity(world, body, 1025, 0), SAMESTEP_ILLEGAL_BODY, "too fast", __LINE__);
  refused(on, samestep_body_set_velocity(world, on->ground, 1, 0), SAMESTEP_ILLEGAL_BODY, "static", __LINE__);
  refused(on, samestep_shape_set_friction(world, on->shape, -1), SAMESTEP_NEGATIVE_FRICTION, "friction",
          __LINE__);
  refused(on, samestep_world_step(world, 2), SAMESTEP_VALUE_OUT_OF_RANGE, "long step", __LINE__);
  refused(on, samestep_world_step_at(world, 0), SAMESTEP_VALUE_OUT_OF_RANGE, "no rate", __LINE__);
  refused(on, samestep_world_set_workers(world, 0), SAMESTEP_VALUE_OUT_OF_RANGE, "no workers", __LINE__);
  refused(on, samestep_world_set_workers(world, 65), SAMESTEP_VALUE_OUT_OF_RANGE, "workers", __LINE__);
  refused(on, samestep_world_set_max_pairs(world, (1u << 28) + 1), SAMESTEP_VALUE_OUT_OF_RANGE, "pairs",
          __LINE__);
}

static void test_definitions(const fixture* on) {
  samestep_world* world = on->world;
  samestep_body_id body = 0;
  samestep_shape_id shape = 0;
  samestep_body_def body_def;
  samestep_body_def_init(&body_def);
  body_def.version = SAMESTEP_C_VERSION + 1;
  refused(on, samestep_body_create(world, &body_def, &body), SAMESTEP_WRONG_VERSION, "version", __LINE__);
  samestep_body_def_init(&body_def);
  body_def.type = 3;
  refused(on, samestep_body_create(world, &body_def, &body), SAMESTEP_UNKNOWN_VALUE, "type", __LINE__);
  samestep_body_def_init(&body_def);
  body_def.velocity.x = 2000;
  refused(on, samestep_body_create(world, &body_def, &body), SAMESTEP_ILLEGAL_BODY, "velocity", __LINE__);
  samestep_body_def_init(&body_def);
  body_def.rotates = 0;
  body_def.moment = 1;
  refused(on, samestep_body_create(world, &body_def, &body), SAMESTEP_MOMENT_OUT_OF_RANGE, "moment",
          __LINE__);
  samestep_body_def_init(&body_def);
  body_def.id = on->gone;
  refused(on, samestep_body_create(world, &body_def, &body), SAMESTEP_ILLEGAL_ID, "used id", __LINE__);
  body_def.id = samestep_make_id(1u << 16, 1);
  refused(on, samestep_body_create(world, &body_def, &body), SAMESTEP_INDEX_OUT_OF_BOUNDS, "large id",
          __LINE__);

  samestep_shape_def def;
  samestep_shape_def_init(&def);
  def.version = 0;
  refused(on, samestep_shape_create(world, on->body, &def, &shape), SAMESTEP_WRONG_VERSION, "version",
          __LINE__);
  samestep_shape_def_init(&def);
  def.kind = 5;
  refused(on, samestep_shape_create(world, on->body, &def, &shape), SAMESTEP_UNKNOWN_VALUE, "kind", __LINE__);
  samestep_shape_def_init(&def);
  def.kind = SAMESTEP_POLYGON;
  def.vertex_count = 3;
  refused(on, samestep_shape_create(world, on->body, &def, &shape), SAMESTEP_NULL_ARGUMENT, "vertices",
          __LINE__);
  const samestep_vec2 line[3] = {{0, 0}, {1, 1}, {2, 2}};
  def.vertices = line;
  refused(on, samestep_shape_create(world, on->body, &def, &shape), SAMESTEP_DEGENERATE_SHAPE, "line",
          __LINE__);
  def.vertex_count = 0;
  refused(on, samestep_shape_create(world, on->body, &def, &shape), SAMESTEP_DEGENERATE_SHAPE, "none",
          __LINE__);
  samestep_shape_def_init(&def);
  def.radius = -1;
  refused(on, samestep_shape_replace(world, on->shape, &def), SAMESTEP_NEGATIVE_RADIUS, "radius", __LINE__);
  check(body == 0 && shape == 0, "refused calls leave their results alone", __LINE__);

  samestep_settings settings;
  check_status(samestep_world_get_settings(world, &settings), SAMESTEP_OK, "settings", __LINE__);
  settings.iterations = 0;
  settings.substeps = 8;
  refused(on, samestep_world_set_settings(world, &settings), SAMESTEP_INVALID_ITER, "iterations", __LINE__);
  settings.iterations = 10;
  settings.solver = 2;
  refused(on, samestep_world_set_settings(world, &settings), SAMESTEP_UNKNOWN_VALUE, "solver", __LINE__);
  settings.version = 9;
  refused(on, samestep_world_set_settings(world, &settings), SAMESTEP_WRONG_VERSION, "version", __LINE__);
  refused(on, samestep_body_set_type(world, on->body, -1), SAMESTEP_UNKNOWN_VALUE, "type", __LINE__);
  samestep_body_id static_body = 0;
  check_status(samestep_world_get_static_body(world, &static_body), SAMESTEP_OK, "static body", __LINE__);
  refused(on, samestep_body_destroy(world, static_body), SAMESTEP_MAIN_STATIC_BODY, "static body", __LINE__);
}

static int32_t told = 0;
static char told_message[128];
static void on_failure(samestep_status status, const char* message, void* data) {
  *(int32_t*)data += 1;
  told = status;
  snprintf(told_message, sizeof told_message, "%s", message);
}

static void test_hook(const fixture* on) {
  int32_t count = 0;
  check_status(samestep_world_set_failure_hook(on->world, on_failure, &count), SAMESTEP_OK, "hook", __LINE__);
  check_status(samestep_body_set_mass(on->world, on->body, -1), SAMESTEP_NEGATIVE_MASS, "mass", __LINE__);
  check(count == 1 && told == SAMESTEP_NEGATIVE_MASS, "the hook is told once", __LINE__);
  check(strcmp(told_message, samestep_last_message(on->world)) == 0, "with the message", __LINE__);
  check_status(samestep_world_set_failure_hook(on->world, NULL, NULL), SAMESTEP_OK, "no hook", __LINE__);
  check_status(samestep_body_set_mass(on->world, on->body, -1), SAMESTEP_NEGATIVE_MASS, "mass", __LINE__);
  check(count == 1, "the hook is gone", __LINE__);
}

static void test_names(void) {
  int named = 0;
  for (samestep_status status = -1000; status < 1000; ++status) {
    const char* name = samestep_status_name(status);
    check(strlen(samestep_status_message(status)) > 0 || status == SAMESTEP_OK, "a status has a sentence",
          __LINE__);
    if (strcmp(name, "UNKNOWN") != 0) ++named;
  }
  check(strcmp(samestep_status_name(SAMESTEP_TOO_MANY_PAIRS), "TOO_MANY_PAIRS") == 0, "the last name",
        __LINE__);
  check(strcmp(samestep_status_name(SAMESTEP_OK), "OK") == 0, "the first name", __LINE__);
  check(named == 11 + SAMESTEP_ILLEGAL_JOINT - SAMESTEP_ATTACHED_BODY + 1, "all others are unknown",
        __LINE__);
}

static void test_creation(void) {
  samestep_world_def def;
  samestep_world* world = NULL;
  samestep_world_def_init(&def);
  def.version = 0;
  check_status(samestep_world_create(&def, &world), SAMESTEP_WRONG_VERSION, "version", __LINE__);
  samestep_world_def_init(&def);
  def.settings.version = 0;
  check_status(samestep_world_create(&def, &world), SAMESTEP_WRONG_VERSION, "version", __LINE__);
  samestep_world_def_init(&def);
  def.scalar = 0;
  check_status(samestep_world_create(&def, &world), SAMESTEP_UNKNOWN_VALUE, "scalar", __LINE__);
  samestep_world_def_init(&def);
  def.settings.substeps = 101;
  check_status(samestep_world_create(&def, &world), SAMESTEP_INVALID_ITER, "substeps", __LINE__);
  samestep_world_def_init(&def);
  def.workers = 0;
  check_status(samestep_world_create(&def, &world), SAMESTEP_VALUE_OUT_OF_RANGE, "workers", __LINE__);
  samestep_world_def_init(&def);
  def.settings.damping = NAN;
  check_status(samestep_world_create(&def, &world), SAMESTEP_VALUE_OUT_OF_RANGE, "damping", __LINE__);
  check(world == NULL, "a refused creation gives nothing", __LINE__);
  if (!samestep_scalar_built(SAMESTEP_DOUBLE)) {
    samestep_world_def_init(&def);
    def.scalar = SAMESTEP_DOUBLE;
    check_status(samestep_world_create(&def, &world), SAMESTEP_SCALAR_NOT_BUILT, "double", __LINE__);
  }
}

void test_errors(void) {
  begin("errors");
  test_names();
  test_creation();
  int32_t built[2];
  const int count = scalars(built);
  for (int i = 0; i < count; ++i) {
    const fixture on = make_fixture(built[i]);
    test_null(&on);
    test_stale(&on);
    test_numbers(&on);
    test_definitions(&on);
    test_hook(&on);
    steps(on.world, 5);
    check_status(samestep_world_destroy(on.world), SAMESTEP_OK, "destroy", __LINE__);
  }
}
