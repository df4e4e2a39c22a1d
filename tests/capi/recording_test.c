/* SPDX-License-Identifier: MIT */
/* Commands, recordings and their verification. */
#include <stdlib.h>
#include <string.h>

#include "check.h"

/* The game's own input: a byte is an impulse for the first body; more than one byte means nothing. */
static samestep_status on_input(samestep_world* world, const uint8_t* bytes, size_t size, void* data) {
  ++*(int*)data;
  if (size != 1) return SAMESTEP_VALUE_OUT_OF_RANGE;
  return samestep_body_apply_impulse(world, samestep_make_id(2, 1), bytes[0], 0, 0, 0);
}

static void connect(samestep_world* world, void* data) {
  (void)data;
  check_status(samestep_world_destroy(world), SAMESTEP_IN_USE, "a world of a replay", __LINE__);
}

static void play(samestep_recorder* recorder, samestep_body_id* spawned) {
  samestep_command command;
  samestep_command_init(&command);
  command.kind = SAMESTEP_APPLY_IMPULSE;
  command.body = samestep_make_id(2, 1);
  command.value.x = 1;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_OK, "impulse", __LINE__);
  check_status(samestep_recorder_step(recorder, NULL), SAMESTEP_OK, "step", __LINE__);
  samestep_body_def body;
  samestep_body_def_init(&body);
  body.position.y = 9;
  samestep_shape_def shapes[2];
  samestep_shape_def_init(&shapes[0]);
  shapes[0].density = 1;
  shapes[1] = shapes[0];
  shapes[1].kind = SAMESTEP_CIRCLE;
  shapes[1].radius = 1;
  command.kind = SAMESTEP_SPAWN;
  command.spawned = &body;
  command.shapes = shapes;
  command.shape_count = 2;
  check_status(samestep_recorder_apply(recorder, &command, spawned), SAMESTEP_OK, "spawn", __LINE__);
  check(*spawned != 0, "a spawned body has an id", __LINE__);
  const uint8_t input = 3;
  command.kind = SAMESTEP_USER_INPUT;
  command.bytes = &input;
  command.byte_count = 1;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_OK, "input", __LINE__);
  const uint8_t inputs[2] = {1, 2};
  command.bytes = inputs;
  command.byte_count = 2;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_VALUE_OUT_OF_RANGE, "input",
               __LINE__);
  for (int i = 0; i < 20; ++i) {
    check_status(samestep_recorder_step(recorder, NULL), SAMESTEP_OK, "step", __LINE__);
  }
}

static void refuse(samestep_world* world, samestep_recorder* recorder) {
  const uint64_t before = hash_of(world);
  samestep_command command;
  samestep_command_init(&command);
  command.kind = SAMESTEP_SET_VELOCITY;
  command.body = UINT64_MAX;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_BODY_NOT_FOUND, "nothing",
               __LINE__);
  check_status(samestep_world_apply(world, &command, NULL), SAMESTEP_BODY_NOT_FOUND, "nothing", __LINE__);
  command.kind = 99;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_UNKNOWN_VALUE, "kind", __LINE__);
  command.kind = SAMESTEP_SPAWN;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_NULL_ARGUMENT, "spawn", __LINE__);
  command.version = 2;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_WRONG_VERSION, "version",
               __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_IN_USE, "a world that is recorded", __LINE__);
  check_equal(hash_of(world), before, "refused commands change nothing", __LINE__);
}

static int32_t stop_after_five(uint64_t done, uint64_t total, void* data) {
  (void)data;
  check(total == 21, "steps in all", __LINE__);
  return done < 5;
}

static void verify_with_options(const uint8_t* bytes, size_t size, const samestep_wiring* wiring,
                                int32_t scalar) {
  samestep_verify_result result;
  samestep_verify_options options;
  samestep_verify_options_init(&options);
  options.expected = SAMESTEP_EXPECT_RATE | SAMESTEP_EXPECT_SCALAR | SAMESTEP_EXPECT_TICKS;
  options.scalar = scalar;
  options.ticks = 21;
  check_status(samestep_verify(bytes, size, wiring, &options, &result), SAMESTEP_OK, "verify", __LINE__);
  check(result.matches == 1, "what was expected", __LINE__);
  options.rate = 64;
  check_status(samestep_verify(bytes, size, wiring, &options, &result), SAMESTEP_OK, "verify", __LINE__);
  check(result.matches == 0 && strcmp(result.unexpected, "the time step") == 0, "another rate", __LINE__);
  samestep_verify_options_init(&options);
  options.commands = ~(1u << SAMESTEP_SPAWN);
  check_status(samestep_verify(bytes, size, wiring, &options, &result), SAMESTEP_OK, "verify", __LINE__);
  check(result.matches == 0 && strcmp(result.unexpected, "a command: spawn") == 0, "no spawning", __LINE__);
  samestep_verify_options_init(&options);
  options.progress = stop_after_five;
  check_status(samestep_verify(bytes, size, wiring, &options, &result), SAMESTEP_OK, "verify", __LINE__);
  check(result.stopped == 1, "stopped", __LINE__);
  options.version = 0;
  check_status(samestep_verify(bytes, size, wiring, &options, &result), SAMESTEP_WRONG_VERSION, "version",
               __LINE__);
}

/* What a player lists of the recording that `play` makes. */
static void check_lists(samestep_player* player, uint64_t last_hash) {
  const uint64_t* hashes = NULL;
  const uint64_t* keyframes = NULL;
  const samestep_player_command* commands = NULL;
  size_t count = 0;
  check_status(samestep_player_get_hashes(player, &hashes, &count), SAMESTEP_OK, "hashes", __LINE__);
  check(count == 22, "a hash for the first world and after each step", __LINE__);
  check_equal(hashes[21], last_hash, "the last hash", __LINE__);
  check_status(samestep_player_get_keyframes(player, &keyframes, &count), SAMESTEP_OK, "worlds", __LINE__);
  check(count >= 1 && keyframes[0] == 0, "the first world is one of those kept", __LINE__);
  check_status(samestep_player_get_commands(player, &commands, &count), SAMESTEP_OK, "commands", __LINE__);
  check(count == 3, "three commands", __LINE__);
  check(commands[0].kind == SAMESTEP_APPLY_IMPULSE && commands[0].tick == 0, "the impulse", __LINE__);
  check_equal(commands[0].body, samestep_make_id(2, 1), "its body", __LINE__);
  check(commands[1].kind == SAMESTEP_SPAWN && commands[1].tick == 1, "the spawned body", __LINE__);
  check(commands[2].kind == SAMESTEP_USER_INPUT && commands[2].body == 0, "the input", __LINE__);
  char text[400];
  size_t size = 0;
  check_status(samestep_player_write_command(player, 0, text, sizeof text, &size), SAMESTEP_OK, "words",
               __LINE__);
  check(strncmp(text, "impulse: body 2", 15) == 0 && strlen(text) + 1 == size, "the impulse in words",
        __LINE__);
  check_status(samestep_player_write_command(player, 3, NULL, 0, &size), SAMESTEP_INDEX_OUT_OF_BOUNDS, "none",
               __LINE__);
}

/* Plays a recording forth and back. */
static void check_player(const uint8_t* bytes, size_t size, const samestep_wiring* wiring,
                         uint64_t last_hash) {
  samestep_player* player = NULL;
  check_status(samestep_player_create(bytes, size - 1, wiring, NULL, &player), SAMESTEP_OK, "cut", __LINE__);
  samestep_player_info info;
  check_status(samestep_player_get_info(player, &info), SAMESTEP_OK, "info", __LINE__);
  check(info.whole == 0, "it is known to be cut", __LINE__);
  samestep_player_destroy(player);
  check_status(samestep_player_create(bytes, 3, wiring, NULL, &player), SAMESTEP_MALFORMED_BYTES, "3 bytes",
               __LINE__);
  check_status(samestep_player_create(bytes, size, wiring, NULL, &player), SAMESTEP_OK, "player", __LINE__);
  check_status(samestep_player_get_info(player, &info), SAMESTEP_OK, "info", __LINE__);
  check(info.whole == 1 && info.ticks == 21, "the whole recording", __LINE__);
  samestep_world* world = NULL;
  check_status(samestep_player_get_world(player, &world), SAMESTEP_OK, "world", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_IN_USE, "the player's world", __LINE__);
  int32_t made = 1;
  while (made == 1) check_status(samestep_player_step(player, &made), SAMESTEP_OK, "step", __LINE__);
  check_equal(hash_of(world), last_hash, "the hash at the end", __LINE__);
  check_status(samestep_player_seek(player, 7), SAMESTEP_OK, "seek", __LINE__);
  samestep_player_state state;
  check_status(samestep_player_get_state(player, &state), SAMESTEP_OK, "state", __LINE__);
  check(state.tick == 7 && state.proven_ticks == 21 && state.wrong == 0, "where it stands", __LINE__);
  check(state.trust == SAMESTEP_PROVEN, "it is proven", __LINE__);
  check_equal(hash_of(world), state.recorded_hash, "the hash after a step", __LINE__);
  check_status(samestep_player_seek(player, 22), SAMESTEP_VALUE_OUT_OF_RANGE, "beyond the end", __LINE__);
  check_lists(player, last_hash);
  samestep_player_destroy(player);
  samestep_player_destroy(NULL);
  check_status(samestep_player_step(NULL, &made), SAMESTEP_NULL_ARGUMENT, "no player", __LINE__);
}

static void test_match(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  int inputs = 0;
  add_box(world, SAMESTEP_STATIC, 0, 0, NULL);
  add_box(world, SAMESTEP_DYNAMIC, 0, 1, NULL);
  check_status(samestep_world_set_input_function(world, on_input, &inputs), SAMESTEP_OK, "input", __LINE__);
  samestep_recorder* recorder = NULL;
  check_status(samestep_recorder_create(world, 0, &recorder), SAMESTEP_VALUE_OUT_OF_RANGE, "rate", __LINE__);
  check_status(samestep_recorder_create(world, 60, &recorder), SAMESTEP_OK, "recorder", __LINE__);
  check_status(samestep_recorder_set_checking(recorder, 1), SAMESTEP_OK, "checking", __LINE__);
  check_status(samestep_recorder_set_rewind_ticks(recorder, 1u << 20), SAMESTEP_VALUE_OUT_OF_RANGE, "rewind",
               __LINE__);
  samestep_body_id spawned = 0;
  play(recorder, &spawned);
  refuse(world, recorder);
  const uint8_t* bytes = NULL;
  size_t size = 0;
  check_status(samestep_recorder_finish(recorder, &bytes, &size), SAMESTEP_OK, "finish", __LINE__);

  samestep_verify_result result;
  const samestep_wiring wiring = {connect, on_input, &inputs};
  check_status(samestep_verify(bytes, size, &wiring, NULL, &result), SAMESTEP_OK, "verify", __LINE__);
  check(result.matches == 1 && result.ticks == 21 && result.unexpected[0] == '\0', "it matches", __LINE__);
  check_equal(result.computed_hash, hash_of(world), "the last hash", __LINE__);
  verify_with_options(bytes, size, &wiring, scalar);
  check_player(bytes, size, &wiring, hash_of(world));
  check_status(samestep_verify(bytes, size, NULL, NULL, &result), SAMESTEP_MISSING_CALLBACK, "no input",
               __LINE__);
  uint8_t* changed = malloc(size);
  if (changed == NULL) abort();
  memcpy(changed, bytes, size);
  changed[size / 2] ^= 1;
  check_status(samestep_verify(changed, size, &wiring, NULL, &result), SAMESTEP_MALFORMED_BYTES, "a bit",
               __LINE__);
  check_status(samestep_verify(bytes, size - 1, &wiring, NULL, &result), SAMESTEP_MALFORMED_BYTES, "cut",
               __LINE__);
  free(changed);
  samestep_recorder_destroy(recorder);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "destroy", __LINE__);
}

/* Ends the recorder whose command calls it, and asks it for more. */
static samestep_status end_recorder(samestep_world* world, const uint8_t* bytes, size_t size, void* data) {
  samestep_recorder* recorder = data;
  (void)bytes, (void)size;
  check_status(samestep_recorder_step(recorder, NULL), SAMESTEP_SPACE_LOCKED, "from within", __LINE__);
  samestep_recorder_destroy(recorder);
  check_status(samestep_world_destroy(world), SAMESTEP_IN_USE, "until it returns", __LINE__);
  return SAMESTEP_OK;
}

/* A recorder that a function of its own command ends lives until the command has been made. */
static void test_end_from_within(int32_t scalar) {
  samestep_world* world = make_world(scalar);
  samestep_recorder* recorder = NULL;
  check_status(samestep_recorder_create(world, 60, &recorder), SAMESTEP_OK, "recorder", __LINE__);
  check_status(samestep_world_set_input_function(world, end_recorder, recorder), SAMESTEP_OK, "input",
               __LINE__);
  samestep_command command;
  samestep_command_init(&command);
  command.kind = SAMESTEP_USER_INPUT;
  check_status(samestep_recorder_apply(recorder, &command, NULL), SAMESTEP_OK, "apply", __LINE__);
  check_status(samestep_world_destroy(world), SAMESTEP_OK, "it has ended", __LINE__);
}

void test_recording(void) {
  begin("recording");
  int32_t built[2];
  const int count = scalars(built);
  for (int i = 0; i < count; ++i) {
    test_match(built[i]);
    test_end_from_within(built[i]);
  }
  samestep_recorder_destroy(NULL);
}
