/* SPDX-License-Identifier: MIT */
/* Two peers play over a network of this file, which delays every datagram. */
#include <string.h>

#include "check.h"

enum { ROOM = 64, DELAY = 3 };

/* What is on its way to one peer. */
typedef struct line {
  uint8_t bytes[ROOM][1200];
  size_t sizes[ROOM];
  int due[ROOM];
  int first;
  int count;
} line;

typedef struct peer {
  samestep_world* world;
  samestep_session* session;
  line* in;
  line* out;
  samestep_body_id box;
  int frame;
  int desyncs;
  int applied;
} peer;

static void send_to(uint64_t to, const uint8_t* bytes, size_t size, void* data) {
  const peer* from = data;
  line* on = from->out;
  (void)to;
  if (on->count == ROOM) return;
  const int at = (on->first + on->count++) % ROOM;
  memcpy(on->bytes[at], bytes, size);
  on->sizes[at] = size;
  on->due[at] = from->frame + DELAY;
}

static uint32_t receive(uint64_t* from, uint8_t* into, size_t room, void* data) {
  const peer* to = data;
  line* on = to->in;
  if (on->count == 0 || on->due[on->first] > to->frame) return 0;
  const int at = on->first;
  on->first = (at + 1) % ROOM;
  --on->count;
  if (on->sizes[at] > room) return 0;
  memcpy(into, on->bytes[at], on->sizes[at]);
  *from = to->in < to->out ? 1 : 0;
  return (uint32_t)on->sizes[at];
}

/* A held button pushes the box; seats push it to either side. */
static void apply_inputs(samestep_world* world, uint32_t tick, const samestep_player_input* players,
                         uint32_t count, void* data) {
  peer* here = data;
  (void)tick;
  ++here->applied;
  check_status(samestep_world_destroy(world), SAMESTEP_IN_USE, "a world of a session", __LINE__);
  for (uint32_t seat = 0; seat < count; ++seat) {
    if (!players[seat].present || players[seat].held_size == 0 || players[seat].held[0] == 0) continue;
    const double push = seat == 0 ? 0.5 : -0.5;
    check_status(samestep_body_apply_impulse(world, here->box, push, 0, 0, 1), SAMESTEP_OK, "push", __LINE__);
  }
}

static void join(peer* here, int32_t scalar, uint32_t seat, line* in, line* out) {
  memset(here, 0, sizeof *here);
  here->in = in;
  here->out = out;
  here->world = make_world(scalar);
  add_box(here->world, SAMESTEP_STATIC, 0, 0, NULL);
  here->box = add_box(here->world, SAMESTEP_DYNAMIC, 0, 1, NULL);
  samestep_session_def def;
  samestep_session_def_init(&def);
  def.local_seat = seat;
  def.addresses[0] = 0;
  def.addresses[1] = 1;
  def.hash_interval = 10;
  def.apply_inputs = apply_inputs;
  def.data = here;
  def.receive = receive;
  def.transport_data = here;
  check_status(samestep_session_create(here->world, &def, &here->session), SAMESTEP_NULL_ARGUMENT, "no send",
               __LINE__);
  def.send = send_to;
  def.window = 300;
  check_status(samestep_session_create(here->world, &def, &here->session), SAMESTEP_VALUE_OUT_OF_RANGE,
               "window", __LINE__);
  def.window = 8;
  def.version = 0;
  check_status(samestep_session_create(here->world, &def, &here->session), SAMESTEP_WRONG_VERSION, "version",
               __LINE__);
  def.version = SAMESTEP_C_VERSION;
  check_status(samestep_session_create(here->world, &def, &here->session), SAMESTEP_OK, "session", __LINE__);
}

static void play(peer* here, uint32_t seat) {
  const uint8_t held = (here->frame / 7 + (int)seat) % 2 == 0;
  const uint64_t now = (uint64_t)here->frame * 16667;
  int32_t frame = -1;
  check_status(samestep_session_frame(here->session, now, &held, 1, &frame), SAMESTEP_OK, "frame", __LINE__);
  check(frame >= SAMESTEP_FRAME_ADVANCED && frame <= SAMESTEP_FRAME_IDLE, "an outcome", __LINE__);
  samestep_session_event event;
  int32_t taken = 1;
  while (taken != 0) {
    check_status(samestep_session_next_event(here->session, &event, &taken), SAMESTEP_OK, "event", __LINE__);
    if (taken != 0 && event.kind == SAMESTEP_SESSION_DESYNC) ++here->desyncs;
  }
  ++here->frame;
}

static void leave(peer* here) {
  check_status(samestep_world_destroy(here->world), SAMESTEP_IN_USE, "a world of a session", __LINE__);
  samestep_session_destroy(here->session);
  check_status(samestep_world_destroy(here->world), SAMESTEP_OK, "destroy", __LINE__);
}

static void test_match(int32_t scalar) {
  static line lines[2];
  memset(lines, 0, sizeof lines);
  peer a;
  peer b;
  join(&a, scalar, 0, &lines[0], &lines[1]);
  join(&b, scalar, 1, &lines[1], &lines[0]);
  for (int i = 0; i < 120; ++i) {
    play(&a, 0);
    play(&b, 1);
  }
  samestep_session_state state;
  check_status(samestep_session_get_state(a.session, &state), SAMESTEP_OK, "state", __LINE__);
  check(state.state == SAMESTEP_SESSION_RUNNING && state.tick > 90 && state.present == 3, "it is played",
        __LINE__);
  check(state.rollbacks > 0 && a.applied > (int)state.tick, "with steps taken back", __LINE__);
  check(a.desyncs == 0 && b.desyncs == 0, "and stays in step", __LINE__);
  int32_t queued = 0;
  const uint8_t bytes[200] = {0};
  check_status(samestep_session_command(a.session, bytes, 4, &queued), SAMESTEP_OK, "command", __LINE__);
  check(queued == 1, "a command waits", __LINE__);
  check_status(samestep_session_command(a.session, bytes, 200, &queued), SAMESTEP_VALUE_OUT_OF_RANGE,
               "command", __LINE__);
  check_status(samestep_session_set_window(a.session, 17), SAMESTEP_VALUE_OUT_OF_RANGE, "window", __LINE__);
  check_status(samestep_session_set_input_delay(a.session, 3), SAMESTEP_OK, "delay", __LINE__);
  /* What is done to one world alone is found out. */
  check_status(samestep_body_set_user_data(b.world, b.box, 1), SAMESTEP_OK, "data", __LINE__);
  for (int i = 0; i < 60; ++i) {
    /* It is done again after each step that was taken back. */
    check_status(samestep_body_set_user_data(b.world, b.box, 1), SAMESTEP_OK, "data", __LINE__);
    play(&a, 0);
    play(&b, 1);
  }
  check(a.desyncs > 0 && b.desyncs > 0, "both hear of it", __LINE__);
  char text[512];
  size_t size = 0;
  check_status(samestep_session_write_desync(a.session, text, sizeof text, &size), SAMESTEP_OK, "text",
               __LINE__);
  check(size > 1 && strlen(text) + 1 == size, "and say so", __LINE__);
  leave(&a);
  leave(&b);
}

void test_session(void) {
  begin("session");
  int32_t built[2];
  const int count = scalars(built);
  for (int i = 0; i < count; ++i) test_match(built[i]);
  check_status(samestep_session_poll(NULL, 0), SAMESTEP_NULL_ARGUMENT, "no session", __LINE__);
  samestep_session_destroy(NULL);
}
