/* SPDX-License-Identifier: MIT */
/* The golden scene "example", built through the C interface, gives the hashes that were written down for it.
 */
#include <inttypes.h>
#include <stdio.h>

#include "check.h"

static void add(samestep_world* world, const samestep_body_def* body_def,
                const samestep_shape_def* shape_def) {
  samestep_body_id body = 0;
  samestep_shape_id shape = 0;
  check_status(samestep_body_create(world, body_def, &body), SAMESTEP_OK, "body", __LINE__);
  check_status(samestep_shape_create(world, body, shape_def, &shape), SAMESTEP_OK, "shape", __LINE__);
}

static void add_ground(samestep_world* world) {
  samestep_body_def body;
  samestep_body_def_init(&body);
  body.type = SAMESTEP_STATIC;
  samestep_shape_def shape;
  samestep_shape_def_init(&shape);
  shape.kind = SAMESTEP_SEGMENT;
  shape.a.x = -10000;
  shape.b.x = 10000;
  shape.radius = 10;
  shape.friction = 0.7;
  add(world, &body, &shape);
}

static void add_ball(samestep_world* world, samestep_vec2 place, samestep_vec2 velocity, double radius,
                     double friction) {
  samestep_body_def body;
  samestep_body_def_init(&body);
  body.position = place;
  body.velocity = velocity;
  samestep_shape_def shape;
  samestep_shape_def_init(&shape);
  shape.kind = SAMESTEP_CIRCLE;
  shape.radius = radius;
  shape.mass = 10;
  shape.friction = friction;
  add(world, &body, &shape);
}

static samestep_world* make_example(int32_t scalar) {
  samestep_world_def def;
  samestep_world_def_init(&def);
  def.scalar = scalar;
  def.settings.solver = SAMESTEP_SEQUENTIAL_IMPULSES;
  def.settings.gravity.y = -9.8125;
  samestep_world* world = NULL;
  check_status(samestep_world_create(&def, &world), SAMESTEP_OK, "world", __LINE__);
  add_ground(world);
  add_ball(world, (samestep_vec2){-45, 45}, (samestep_vec2){10, -9.8125}, 10, 0.2);
  add_ball(world, (samestep_vec2){45, 45}, (samestep_vec2){10, -9.8125}, 15, 0.5);
  add_ball(world, (samestep_vec2){0, 90}, (samestep_vec2){20, 0}, 5, 0.5);
  return world;
}

static void compare(int32_t scalar, FILE* golden) {
  samestep_world* world = make_example(scalar);
  uint64_t tick = 0;
  uint64_t expected = 0;
  int ticks = 0;
  while (fscanf(golden, "%" SCNu64 " %" SCNx64, &tick, &expected) == 2) {
    check_status(samestep_world_step_at(world, 64), SAMESTEP_OK, "step", __LINE__);
    check_equal(hash_of(world), expected, "hash of the scene example", __LINE__);
    ++ticks;
    if (failures() != 0) break;
  }
  check(ticks == 600 || failures() != 0, "600 ticks were compared", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

void test_golden(void) {
  begin("golden");
  int32_t built[2];
  const int count = scalars(built);
  for (int i = 0; i < count; ++i) {
    FILE* golden = fopen(built[i] == SAMESTEP_FIXED ? SAMESTEP_GOLDEN "/example.fixed.txt"
                                                    : SAMESTEP_GOLDEN "/example.double.txt",
                         "r");
    check(golden != NULL, "the golden file is there", __LINE__);
    if (golden == NULL) continue;
    compare(built[i], golden);
    fclose(golden);
  }
}
