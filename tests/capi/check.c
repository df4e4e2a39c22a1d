/* SPDX-License-Identifier: MIT */
#include "check.h"

#include <inttypes.h>
#include <stdio.h>

static int failed = 0;
static const char* current = "";

void check(int holds, const char* claim, int line) {
  if (holds) return;
  ++failed;
  printf("%s, line %d: not so: %s\n", current, line, claim);
}

void check_status(samestep_status found, samestep_status wanted, const char* about, int line) {
  if (found == wanted) return;
  ++failed;
  printf("%s, line %d: %s: %s instead of %s\n", current, line, about, samestep_status_name(found),
         samestep_status_name(wanted));
}

void check_equal(uint64_t found, uint64_t wanted, const char* about, int line) {
  if (found == wanted) return;
  ++failed;
  printf("%s, line %d: %s: %016" PRIx64 " instead of %016" PRIx64 "\n", current, line, about, found, wanted);
}

int failures(void) { return failed; }
void begin(const char* name) {
  current = name;
  printf("%s\n", name);
}

int scalars(int32_t found[2]) {
  int count = 0;
  for (int32_t scalar = SAMESTEP_FIXED; scalar <= SAMESTEP_DOUBLE; ++scalar) {
    if (samestep_scalar_built(scalar)) found[count++] = scalar;
  }
  return count;
}

samestep_world* make_world(int32_t scalar) {
  samestep_world_def def;
  samestep_world_def_init(&def);
  def.scalar = scalar;
  def.settings.gravity.y = -10;
  samestep_world* world = NULL;
  check_status(samestep_world_create(&def, &world), SAMESTEP_OK, "a world is made", __LINE__);
  return world;
}

uint64_t hash_of(const samestep_world* world) {
  uint64_t hash = 0;
  check_status(samestep_world_get_hash(world, &hash), SAMESTEP_OK, "hash", __LINE__);
  return hash;
}

samestep_body_id add_box(samestep_world* world, int32_t type, double x, double y, samestep_shape_id* shape) {
  samestep_body_def body_def;
  samestep_body_def_init(&body_def);
  body_def.type = type;
  body_def.position.x = x;
  body_def.position.y = y;
  samestep_body_id body = 0;
  check_status(samestep_body_create(world, &body_def, &body), SAMESTEP_OK, "a body is added", __LINE__);
  samestep_shape_def shape_def;
  samestep_shape_def_init(&shape_def);
  shape_def.friction = 0.5;
  if (type == SAMESTEP_DYNAMIC) shape_def.density = 1;
  samestep_shape_id made = 0;
  check_status(samestep_shape_create(world, body, &shape_def, &made), SAMESTEP_OK, "a shape is added",
               __LINE__);
  if (shape != NULL) *shape = made;
  return body;
}

void steps(samestep_world* world, int count) {
  for (int i = 0; i < count; ++i) {
    check_status(samestep_world_step_at(world, 60), SAMESTEP_OK, "a step is made", __LINE__);
  }
}
