/* SPDX-License-Identifier: MIT */
/* Queries, collision handlers, functions of bodies and of the end of a step. */
#include <string.h>

#include "check.h"

typedef struct counts {
  int begun;
  int pre_solved;
  int post_solved;
  int separated;
  int removals;
  samestep_status locked;
  samestep_status bad_friction;
  samestep_shape_id shape_a;
  samestep_contact_state seen;
} counts;

static int32_t on_begin(samestep_contact* contact, samestep_world* world, void* data) {
  counts* seen = data;
  ++seen->begun;
  check_status(samestep_contact_get(contact, &seen->seen), SAMESTEP_OK, "contact", __LINE__);
  seen->shape_a = seen->seen.shape_a;
  samestep_body_id body = 0;
  samestep_body_def def;
  samestep_body_def_init(&def);
  seen->locked = samestep_body_create(world, &def, &body);
  return 1;
}

static int32_t on_pre_solve(samestep_contact* contact, samestep_world* world, void* data) {
  counts* seen = data;
  ++seen->pre_solved;
  int32_t locked = 0;
  check_status(samestep_world_is_locked(world, &locked), SAMESTEP_OK, "locked", __LINE__);
  check(locked == 1, "the world is locked", __LINE__);
  seen->bad_friction = samestep_contact_set_friction(contact, -1);
  check_status(samestep_contact_set_friction(contact, 0), SAMESTEP_OK, "friction", __LINE__);
  int32_t answer = 7;
  check_status(samestep_contact_call_wildcard(contact, SAMESTEP_PRE_SOLVE, 1, &answer), SAMESTEP_OK,
               "wildcard", __LINE__);
  check(answer == 1, "without a wildcard handler the answer is 1", __LINE__);
  check_status(samestep_contact_call_wildcard(contact, 4, 0, &answer), SAMESTEP_UNKNOWN_VALUE, "phase",
               __LINE__);
  samestep_contact_state state;
  check_status(samestep_contact_get(contact, &state), SAMESTEP_OK, "contact", __LINE__);
  check_status(samestep_contact_set_touch(contact, &state.touch), SAMESTEP_OK, "touch", __LINE__);
  state.touch.count = 3;
  check_status(samestep_contact_set_touch(contact, &state.touch), SAMESTEP_IMMUTABLE_NUM_CONTACTS, "touch",
               __LINE__);
  return 1;
}

static void on_post_solve(samestep_contact* contact, samestep_world* world, void* data) {
  counts* seen = data;
  ++seen->post_solved;
  (void)world;
  check_status(samestep_contact_get(contact, &seen->seen), SAMESTEP_OK, "contact", __LINE__);
}

static void on_separate(samestep_contact* contact, samestep_world* world, void* data) {
  counts* seen = data;
  ++seen->separated;
  (void)world;
  samestep_contact_state state;
  check_status(samestep_contact_get(contact, &state), SAMESTEP_OK, "contact", __LINE__);
  seen->removals += state.removal;
}

static void test_handlers(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_shape_id ground_shape = 0;
  samestep_shape_id box_shape = 0;
  add_box(world, SAMESTEP_STATIC, 0, 0, &ground_shape);
  const samestep_body_id box = add_box(world, SAMESTEP_DYNAMIC, 0, 1.125, &box_shape);
  check_status(samestep_shape_set_collision_type(world, ground_shape, 2), SAMESTEP_OK, "type", __LINE__);
  check_status(samestep_shape_set_collision_type(world, box_shape, 1), SAMESTEP_OK, "type", __LINE__);
  counts seen = {0};
  const samestep_handler handler = {on_begin, on_pre_solve, on_post_solve, on_separate, &seen};
  check_status(samestep_world_add_handler(world, 1, 2, 5), SAMESTEP_MISSING_CALLBACK, "not there", __LINE__);
  check_status(samestep_world_register_handler(world, 0, &handler), SAMESTEP_VALUE_OUT_OF_RANGE, "0",
               __LINE__);
  check_status(samestep_world_register_handler(world, 5, &handler), SAMESTEP_OK, "register", __LINE__);
  check_status(samestep_world_add_handler(world, 1, 2, 5), SAMESTEP_OK, "add", __LINE__);
  steps(world, 30);
  check(seen.begun == 1, "begin is called once", __LINE__);
  check(seen.pre_solved > 1 && seen.post_solved > 1, "and the others in each step", __LINE__);
  check(seen.locked == SAMESTEP_SPACE_LOCKED, "a handler adds no bodies", __LINE__);
  check(seen.bad_friction == SAMESTEP_NEGATIVE_FRICTION, "a contact refuses", __LINE__);
  check(seen.shape_a == box_shape, "A has the first type", __LINE__);
  check(seen.seen.friction == 0, "friction of the step", __LINE__);
  check(seen.seen.touch.count == 2 && seen.seen.touch.normal.y < -0.99, "a box lies on two points", __LINE__);
  check(seen.seen.total_impulse.y < 0, "the impulse is that on B", __LINE__);

  const samestep_contact_state* contacts = NULL;
  size_t count = 0;
  check_status(samestep_world_get_contacts(world, 0, &contacts, &count), SAMESTEP_OK, "contacts", __LINE__);
  check(count == 1 && contacts[0].shape_a == ground_shape, "one pair touches, the lower id first", __LINE__);
  check_status(samestep_world_get_contacts(world, box, &contacts, &count), SAMESTEP_OK, "contacts", __LINE__);
  check(count == 1, "it is the box's", __LINE__);
  check_status(samestep_world_get_contacts(world, UINT64_MAX, &contacts, &count), SAMESTEP_BODY_NOT_FOUND,
               "contacts of nothing", __LINE__);
  check_status(samestep_body_set_position(world, box, 0, 0.875), SAMESTEP_OK, "position", __LINE__);
  samestep_touch touch;
  check_status(samestep_query_shapes(world, ground_shape, box_shape, &touch), SAMESTEP_OK, "touch", __LINE__);
  check(touch.count == 2 && touch.normal.y == 1, "the shapes touch outside of a step", __LINE__);

  check_status(samestep_body_destroy(world, box), SAMESTEP_OK, "destroy", __LINE__);
  check(seen.separated == 1 && seen.removals == 1, "a removal separates", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_events(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_shape_id ground = 0;
  samestep_shape_id box = 0;
  add_box(world, SAMESTEP_STATIC, 0, 0, &ground);
  const samestep_body_id body = add_box(world, SAMESTEP_DYNAMIC, 0, 2, &box);
  samestep_events events;
  check_status(samestep_world_list_events(world, 1, 1, -1), SAMESTEP_VALUE_OUT_OF_RANGE, "speed", __LINE__);
  check_status(samestep_world_list_events(world, 1, 1, 1), SAMESTEP_OK, "list", __LINE__);
  int begins = 0;
  int impacts = 0;
  for (int tick = 0; tick < 60; ++tick) {
    steps(world, 1);
    check_status(samestep_world_get_events(world, &events), SAMESTEP_OK, "events", __LINE__);
    check(events.tick == (uint64_t)tick + 1, "events of this tick", __LINE__);
    begins += (int)events.begin_count;
    for (uint32_t i = 0; i < events.impact_count; ++i, ++impacts) {
      const samestep_impact_event* hit = &events.impacts[i];
      check(hit->shape_a == ground && hit->shape_b == box, "the lower id first", __LINE__);
      check(hit->normal.y > 0.99 && hit->speed > 3 && hit->impulse > 3, "it fell a metre", __LINE__);
    }
  }
  check(begins == 1 && impacts == 1, "it lands once", __LINE__);
  check_status(samestep_body_destroy(world, body), SAMESTEP_OK, "destroy", __LINE__);
  steps(world, 1);
  check_status(samestep_world_get_events(world, &events), SAMESTEP_OK, "events", __LINE__);
  check(events.end_count == 1 && events.ends[0].removal == 1 && events.ends[0].body_b == body, "and goes",
        __LINE__);
  check_status(samestep_world_get_events(world, NULL), SAMESTEP_NULL_ARGUMENT, "null", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void move_by_hand(samestep_world* world, samestep_body_id body, double seconds, void* data) {
  ++*(int*)data;
  samestep_body_state state;
  check_status(samestep_body_get(world, body, &state), SAMESTEP_OK, "get", __LINE__);
  check(seconds > 0, "time goes on", __LINE__);
  check_status(samestep_body_set_position(world, body, state.position.x + 0.125, state.position.y),
               SAMESTEP_OK, "position", __LINE__);
}

static void as_engine(samestep_world* world, samestep_body_id body, double gravity_x, double gravity_y,
                      double damping, double seconds, void* data) {
  ++*(int*)data;
  check_status(samestep_body_update_velocity(world, body, gravity_x, gravity_y, damping, seconds),
               SAMESTEP_OK, "velocity", __LINE__);
}

static void test_functions(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_settings settings;
  check_status(samestep_world_get_settings(world, &settings), SAMESTEP_OK, "settings", __LINE__);
  settings.solver = SAMESTEP_SEQUENTIAL_IMPULSES;
  check_status(samestep_world_set_settings(world, &settings), SAMESTEP_OK, "settings", __LINE__);
  const samestep_body_id box = add_box(world, SAMESTEP_DYNAMIC, 0, 0, NULL);
  int moved = 0;
  int accelerated = 0;
  check_status(samestep_body_set_functions(world, box, 3, 4), SAMESTEP_OK, "functions", __LINE__);
  check_status(samestep_world_step_at(world, 60), SAMESTEP_MISSING_CALLBACK, "missing", __LINE__);
  check_status(samestep_world_register_position_function(world, 3, move_by_hand, &moved), SAMESTEP_OK,
               "register", __LINE__);
  check_status(samestep_world_register_velocity_function(world, 4, as_engine, &accelerated), SAMESTEP_OK,
               "register", __LINE__);
  check_status(samestep_world_register_velocity_function(world, 5, NULL, NULL), SAMESTEP_NULL_ARGUMENT,
               "null", __LINE__);
  steps(world, 8);
  samestep_body_state state;
  check_status(samestep_body_get(world, box, &state), SAMESTEP_OK, "get", __LINE__);
  check(moved == 8 && state.position.x == 1.0, "a position function moves the body", __LINE__);
  check(accelerated == 8 && state.velocity.y < -1.3, "a velocity function accelerates it", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

typedef struct remembered {
  uint64_t keys[4];
  int count;
} remembered;

static void remember(samestep_world* world, uint64_t key, void* data) {
  remembered* all = data;
  all->keys[all->count++] = key;
  check_status(samestep_world_destroy(world), SAMESTEP_SPACE_LOCKED, "a world that calls", __LINE__);
  add_box(world, SAMESTEP_DYNAMIC, 10.0 * (double)key, 50, NULL);
}

static int32_t later(samestep_contact* contact, samestep_world* world, void* data) {
  (void)contact;
  int32_t added = 7;
  check_status(samestep_world_add_post_step(world, remember, 2, data, &added), SAMESTEP_OK, "later",
               __LINE__);
  check(added == 1, "a new key is added", __LINE__);
  check_status(samestep_world_add_post_step(world, remember, 1, data, NULL), SAMESTEP_OK, "later", __LINE__);
  check_status(samestep_world_add_post_step(world, remember, 2, data, &added), SAMESTEP_OK, "later",
               __LINE__);
  check(added == 0, "a key that waits is not", __LINE__);
  return 1;
}

static void test_post_step(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  remembered all = {{0}, 0};
  check_status(samestep_world_add_post_step(world, remember, 3, &all, NULL), SAMESTEP_OK, "now", __LINE__);
  check(all.count == 1 && all.keys[0] == 3, "outside of a step it runs at once", __LINE__);
  all.count = 0;
  add_box(world, SAMESTEP_STATIC, 0, 0, NULL);
  add_box(world, SAMESTEP_DYNAMIC, 0, 0.75, NULL);
  const samestep_handler handler = {later, NULL, NULL, NULL, &all};
  check_status(samestep_world_register_handler(world, 5, &handler), SAMESTEP_OK, "register", __LINE__);
  check_status(samestep_world_add_default_handler(world, 5), SAMESTEP_OK, "add", __LINE__);
  steps(world, 2);
  check(all.count == 2 && all.keys[0] == 2 && all.keys[1] == 1, "they run in order, once a key", __LINE__);
  uint32_t bodies = 0;
  check_status(samestep_world_get_body_count(world, &bodies), SAMESTEP_OK, "count", __LINE__);
  check(bodies == 6, "and may add bodies", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_queries(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_shape_id left = 0;
  samestep_shape_id right = 0;
  add_box(world, SAMESTEP_STATIC, -2, 0, &left);
  add_box(world, SAMESTEP_STATIC, 2, 0, &right);
  check_status(samestep_shape_set_filter(world, left, 0, 1, UINT32_MAX), SAMESTEP_OK, "filter", __LINE__);
  check_status(samestep_shape_set_filter(world, right, 0, 2, UINT32_MAX), SAMESTEP_OK, "filter", __LINE__);
  const samestep_segment_hit* along = NULL;
  const samestep_point_hit* near = NULL;
  const samestep_shape_id* within = NULL;
  size_t count = 0;
  check_status(samestep_query_segment(world, -4, 0, 4, 0, 0, NULL, &along, &count), SAMESTEP_OK, "ray",
               __LINE__);
  check(count == 2 && along[0].shape == left && along[0].point.x == -2.5 && along[0].normal.x == -1,
        "a ray hits both", __LINE__);
  const samestep_filter only = {0, UINT32_MAX, 2, 0};
  check_status(samestep_query_segment(world, -4, 0, 4, 0, 0.25, &only, &along, &count), SAMESTEP_OK, "cast",
               __LINE__);
  check(count == 1 && along[0].shape == right, "a filter leaves one", __LINE__);
  check_status(samestep_query_point(world, 2, 1, 0.5, NULL, &near, &count), SAMESTEP_OK, "point", __LINE__);
  check(count == 1 && near[0].shape == right && near[0].distance == 0.5 && near[0].gradient.y == 1,
        "the box is half a metre below", __LINE__);
  check_status(samestep_query_box(world, -5, -1, 5, 1, NULL, &within, &count), SAMESTEP_OK, "box", __LINE__);
  check(count == 2 && within[0] == left && within[1] == right, "both are within, by id", __LINE__);
  check_status(samestep_query_box(world, 5, -1, -5, 1, NULL, &within, &count),
               SAMESTEP_NEGATIVE_HALF_DIMENSIONS, "box", __LINE__);
  check_status(samestep_query_segment(world, 0, 0, 1, 0, -1, NULL, &along, &count), SAMESTEP_NEGATIVE_RADIUS,
               "cast", __LINE__);
  samestep_segment_hit hits[2];
  check_status(samestep_query_cast_ray(world, 4, 0, -4, 0, 0, NULL, hits, 1, &count), SAMESTEP_OK, "ray",
               __LINE__);
  check(count == 2 && hits[0].shape == right && hits[0].point.x == 2.5, "the nearest comes first", __LINE__);
  check_status(samestep_query_cast_ray(world, 4, 0, -4, 0, 0, NULL, NULL, 0, &count), SAMESTEP_OK, "count",
               __LINE__);
  check(count == 2, "all are counted", __LINE__);
  check_status(samestep_query_cast_ray(world, 4, 0, -4, 0, 0, NULL, NULL, 1, &count), SAMESTEP_NULL_ARGUMENT,
               "no room", __LINE__);
  samestep_shape_def ball;
  samestep_shape_def_init(&ball);
  ball.kind = SAMESTEP_CIRCLE;
  ball.radius = 0.5;
  samestep_motion motion;
  memset(&motion, 0, sizeof motion);
  motion.way.x = 8;
  check_status(samestep_query_cast_shape(world, &ball, &motion, NULL, hits, 2, &count), SAMESTEP_OK, "cast",
               __LINE__);
  check(count == 1 && hits[0].shape == right && hits[0].alpha > 0.12 && hits[0].alpha <= 0.125,
        "a ball comes to the box", __LINE__);
  motion.way.x = 1e9;
  check_status(samestep_query_cast_shape(world, &ball, &motion, NULL, hits, 2, &count),
               SAMESTEP_VALUE_OUT_OF_RANGE, "cast", __LINE__);
  samestep_near_hit nearest[2];
  check_status(samestep_query_near(world, &ball, 1, 0, 0, 5, NULL, nearest, 2, &count), SAMESTEP_OK, "near",
               __LINE__);
  check(count == 2 && nearest[0].shape == right && nearest[0].distance == 0 && nearest[1].distance == 2,
        "by distance", __LINE__);
  check_status(samestep_query_distance(world, left, right, nearest), SAMESTEP_OK, "distance", __LINE__);
  check(nearest[0].distance == 3 && nearest[0].normal.x == 1, "three metres", __LINE__);
  samestep_box box;
  check_status(samestep_shape_get_bounding_box(world, left, &box), SAMESTEP_OK, "box", __LINE__);
  check(box.left == -2.5 && box.top == 0.5, "its bounding box", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

static void run_backwards(void* data, int32_t tasks, void (*task)(int32_t, void*), void* task_data) {
  ++*(int*)data;
  for (int32_t i = tasks; i-- > 0;) task(i, task_data);
}

static void on_log(const char* text, void* data) {
  check(strlen(text) > 0, "a remark is a sentence", __LINE__);
  ++*(int*)data;
}

static uint64_t pile(int32_t scalar, int32_t workers, int own) {
  samestep_world* world = make_world(scalar);
  int ran = 0;
  int remarks = 0;
  check_status(samestep_world_set_log(world, on_log, &remarks), SAMESTEP_OK, "log", __LINE__);
  if (own) {
    check_status(samestep_world_set_task_runner(world, workers, run_backwards, &ran), SAMESTEP_OK, "runner",
                 __LINE__);
  } else {
    check_status(samestep_world_set_workers(world, workers), SAMESTEP_OK, "workers", __LINE__);
  }
  add_box(world, SAMESTEP_STATIC, 0, 0, NULL);
  for (int i = 0; i < 600; ++i)
    add_box(world, SAMESTEP_DYNAMIC, 0.75 * (i % 30), 1.0 + 0.75 * (i / 30), NULL);
  steps(world, 5);
  check(!own || ran > 0, "a job system of the game's is asked", __LINE__);
  check(workers < 64 || remarks > 0, "more workers than processors are remarked on", __LINE__);
  const uint64_t hash = hash_of(world);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
  return hash;
}

static void test_workers(int32_t scalar) {
  const uint64_t alone = pile(scalar, 1, 0);
  check_equal(pile(scalar, 2, 0), alone, "two workers", __LINE__);
  check_equal(pile(scalar, 64, 0), alone, "64 workers", __LINE__);
  check_equal(pile(scalar, 3, 1), alone, "a job system", __LINE__);
}

void test_contacts(void) {
  begin("contacts");
  int32_t built[2];
  const int count = scalars(built);
  for (int i = 0; i < count; ++i) {
    test_handlers(built[i]);
    test_events(built[i]);
    test_functions(built[i]);
    test_post_step(built[i]);
    test_queries(built[i]);
    test_workers(built[i]);
  }
}
