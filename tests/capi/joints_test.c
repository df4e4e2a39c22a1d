/* SPDX-License-Identifier: MIT */
/* Joints: what comes, changes and goes, what is refused, what is told, and as commands. */
#include <math.h>
#include <string.h>

#include "check.h"

static samestep_joint_def door_of(samestep_world* world, samestep_body_id leaf) {
  samestep_joint_def def;
  samestep_joint_def_init(&def);
  check_status(samestep_world_get_static_body(world, &def.body_a), SAMESTEP_OK, "static body", __LINE__);
  def.body_b = leaf;
  def.anchor_b.x = -0.5;
  def.user_data = 9;
  return def;
}

static void test_life(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  const samestep_body_id leaf = add_box(world, SAMESTEP_DYNAMIC, 0.5, 0, NULL);
  samestep_joint_def def = door_of(world, leaf);
  samestep_joint_id joint = 0;
  check_status(samestep_joint_create(world, &def, &joint), SAMESTEP_OK, "create", __LINE__);
  uint32_t count = 0;
  check_status(samestep_world_get_joint_count(world, &count), SAMESTEP_OK, "count", __LINE__);
  check_equal(count, 1, "one joint", __LINE__);
  def.motor = 1;
  def.motor_speed = 2;
  def.motor_max = 100;
  check_status(samestep_joint_replace(world, joint, &def), SAMESTEP_OK, "replace", __LINE__);
  samestep_joint_def found;
  check_status(samestep_joint_get(world, joint, &found), SAMESTEP_OK, "get", __LINE__);
  check(found.motor_max == 100 && found.user_data == 9 && found.id == joint, "it is what it was made",
        __LINE__);
  steps(world, 60);
  samestep_joint_state state;
  check_status(samestep_joint_get_state(world, joint, &state), SAMESTEP_OK, "state", __LINE__);
  check(fabs(state.force.y) > 1, "it holds", __LINE__);
  const samestep_joint_id* joints = NULL;
  const samestep_body_id* bodies = NULL;
  size_t listed = 0;
  check_status(samestep_body_get_joints(world, leaf, &joints, &listed), SAMESTEP_OK, "joints", __LINE__);
  check(listed == 1 && joints[0] == joint, "the joints of the body", __LINE__);
  check_status(samestep_body_get_connected(world, leaf, &bodies, &listed), SAMESTEP_OK, "connected",
               __LINE__);
  check(listed == 1 && bodies[0] == def.body_a, "the bodies that it is joined with", __LINE__);
  check_status(samestep_joint_destroy(world, joint), SAMESTEP_OK, "destroy", __LINE__);
  int32_t exists = 1;
  check_status(samestep_joint_exists(world, joint, &exists), SAMESTEP_OK, "exists", __LINE__);
  check_equal((uint64_t)exists, 0, "it is gone", __LINE__);
  check_status(samestep_joint_get_state(world, joint, &state), SAMESTEP_JOINT_NOT_FOUND, "state", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_refusals(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  const samestep_body_id leaf = add_box(world, SAMESTEP_DYNAMIC, 0.5, 0, NULL);
  const uint64_t before = hash_of(world);
  samestep_joint_id joint = 0;
  samestep_joint_def def = door_of(world, leaf);
  def.lower = 1;
  check_status(samestep_joint_create(world, &def, &joint), SAMESTEP_ILLEGAL_JOINT, "limits", __LINE__);
  def = door_of(world, leaf);
  def.kind = 8;
  check_status(samestep_joint_create(world, &def, &joint), SAMESTEP_UNKNOWN_VALUE, "kind", __LINE__);
  def = door_of(world, leaf);
  def.rest = NAN;
  check_status(samestep_joint_create(world, &def, &joint), SAMESTEP_VALUE_OUT_OF_RANGE, "NaN", __LINE__);
  def = door_of(world, leaf);
  def.body_a = leaf;
  check_status(samestep_joint_create(world, &def, &joint), SAMESTEP_ILLEGAL_JOINT, "one body", __LINE__);
  def.body_a = samestep_make_id(77, 1);
  check_status(samestep_joint_create(world, &def, &joint), SAMESTEP_BODY_NOT_FOUND, "no body", __LINE__);
  def.version = 0;
  check_status(samestep_joint_create(world, &def, &joint), SAMESTEP_WRONG_VERSION, "version", __LINE__);
  check_equal(hash_of(world), before, "nothing has changed", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_events_and_commands(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  const samestep_body_id leaf = add_box(world, SAMESTEP_DYNAMIC, 0.5, 0, NULL);
  check_status(samestep_world_list_joint_events(world, 1), SAMESTEP_OK, "list", __LINE__);
  samestep_joint_def def = door_of(world, leaf);
  samestep_command command;
  samestep_command_init(&command);
  command.kind = SAMESTEP_JOIN;
  command.joined = &def;
  def.id = samestep_make_id(5, 1);
  check_status(samestep_world_apply(world, &command, NULL), SAMESTEP_OK, "join", __LINE__);
  command.kind = SAMESTEP_ADJUST;
  command.joint = def.id;
  def.break_force = 1;
  check_status(samestep_world_apply(world, &command, NULL), SAMESTEP_OK, "adjust", __LINE__);
  steps(world, 1);
  const samestep_joint_event* events = NULL;
  size_t count = 0;
  check_status(samestep_world_get_joint_events(world, &events, &count), SAMESTEP_OK, "events", __LINE__);
  check(count == 1 && events[0].joint == def.id && events[0].change == SAMESTEP_JOINT_BROKE, "it broke",
        __LINE__);
  check(count == 1 && events[0].user_data == 9 && events[0].force.y > 1, "as it was told", __LINE__);
  command.kind = SAMESTEP_UNJOIN;
  check_status(samestep_world_apply(world, &command, NULL), SAMESTEP_JOINT_NOT_FOUND, "unjoin", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

void test_joints(void) {
  begin("joints");
  int32_t built[2];
  const int count = scalars(built);
  for (int i = 0; i < count; ++i) {
    test_life(built[i]);
    test_refusals(built[i]);
    test_events_and_commands(built[i]);
  }
}
