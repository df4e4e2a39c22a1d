// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import { type Core, hexOf, type Vec2 } from './core.js';
import { type BodyDef, type ShapeDef, sizeOfShape, writeBody, writeShape } from './definitions.js';
import { SamestepError } from './error.js';
import { type BodyId, fromHalves } from './id.js';
import { type JointDef, type JointId, writeJoint } from './joint.js';
import { functionAt, type Limits, Place, type Scalar, withLimits, World } from './world.js';

/** What a player or the game does to a world between two steps. */
export type Command =
  /** N s at `arm` from the centre of mass, in world axes. */
  | { kind: 'impulse'; body: BodyId; impulse: Vec2; arm?: Vec2 }
  /** N at `arm`, during the next step. */
  | { kind: 'force'; body: BodyId; force: Vec2; arm?: Vec2 }
  | { kind: 'velocity'; body: BodyId; velocity: Vec2 }
  | { kind: 'angularVelocity'; body: BodyId; angularVelocity: number }
  | { kind: 'position'; body: BodyId; position: Vec2 }
  | { kind: 'angle'; body: BodyId; angle: number }
  | { kind: 'spawn'; body: BodyDef; shapes: readonly ShapeDef[] }
  | { kind: 'remove'; body: BodyId }
  /** Bytes that only the game understands. */
  | { kind: 'input'; bytes: Uint8Array }
  | { kind: 'join'; joined: JointDef }
  /** The joint becomes what is said. */
  | { kind: 'adjust'; joint: JointId; joined: JointDef }
  | { kind: 'unjoin'; joint: JointId };
export const commandKinds: readonly Command['kind'][] = [
  'impulse', 'force', 'velocity', 'angularVelocity', 'position', 'angle', 'spawn', 'remove', 'input',
  'join', 'adjust', 'unjoin',
];

/** Runs an action with a command in memory, and room for the id of a spawned body. */
export function withCommand<T>(core: Core, command: Command, action: (at: number, body: number) => T): T {
  const place = abi.command;
  const shapes = command.kind === 'spawn' ? command.shapes : [];
  const joined = 'joined' in command ? command.joined : undefined;
  const tail = command.kind === 'input' ? command.bytes.length : joined === undefined ? 0 : abi.joint_def.size_of;
  const shapesAt = place.size_of + 8 + abi.body_def.size_of;
  const verticesAt = shapesAt + shapes.length * abi.shape_def.size_of;
  const size = shapesAt + shapes.reduce((sum, shape) => sum + sizeOfShape(shape), 0);
  return core.withMemory(size + tail, (at) => {
    core.call.samestep_command_init(at);
    core.i32[(at + place.kind) >> 2] = commandKinds.indexOf(command.kind);
    if (command.kind === 'spawn') {
      const body = at + place.size_of + 8;
      writeBody(core, body, command.body);
      core.u32[(at + place.spawned) >> 2] = body;
      core.u32[(at + place.shapes) >> 2] = at + shapesAt;
      core.u32[(at + place.shape_count) >> 2] = shapes.length;
      let vertices = at + verticesAt;
      shapes.forEach((shape, i) => {
        writeShape(core, at + shapesAt + i * abi.shape_def.size_of, shape, vertices);
        vertices += sizeOfShape(shape) - abi.shape_def.size_of;
      });
    } else if (command.kind === 'input') {
      core.u8.set(command.bytes, at + size);
      core.u32[(at + place.bytes) >> 2] = at + size;
      core.u32[(at + place.byte_count) >> 2] = command.bytes.length;
    } else if ('body' in command) {
      core.setId(at + place.body, command.body);
      writeValue(core, at, command);
    }
    if ('joint' in command) core.setId(at + place.joint, command.joint);
    if (joined !== undefined) {
      writeJoint(core, at + size, joined);
      core.u32[(at + place.joined) >> 2] = at + size;
    }
    return action(at, at + place.size_of);
  });
}

function writeValue(core: Core, at: number, command: Exclude<Command, { kind: 'spawn' | 'input' | 'join' | 'adjust' | 'unjoin' }>): void {
  const value = at + abi.command.value;
  switch (command.kind) {
    case 'impulse':
    case 'force':
      core.setVec2(value, command.kind === 'impulse' ? command.impulse : command.force);
      core.setVec2(at + abi.command.arm, command.arm);
      break;
    case 'velocity':
      core.setVec2(value, command.velocity);
      break;
    case 'position':
      core.setVec2(value, command.position);
      break;
    case 'angularVelocity':
      core.f64[value >> 3] = command.angularVelocity;
      break;
    case 'angle':
      core.f64[value >> 3] = command.angle;
      break;
    case 'remove':
  }
}

/** A recording being made of a world, which must go through it from now on. */
export class Recorder {
  #pointer: number;
  constructor(
    readonly world: World,
    rate: number,
  ) {
    const { core, pointer } = world;
    this.#pointer = core.withStack(4, (at) => {
      core.check(core.call.samestep_recorder_create(pointer, rate, at), pointer);
      return core.u32[at >> 2]!;
    });
  }
  #at(): number {
    if (this.#pointer === 0) throw new SamestepError('DISPOSED', 'The recorder has been disposed of.');
    return this.#pointer;
  }
  /** As World.apply. */
  apply(command: Command): BodyId {
    const { core, pointer } = this.world;
    return withCommand(core, command, (at, body) => {
      core.check(core.call.samestep_recorder_apply(this.#at(), at, body), pointer);
      return core.id(body);
    });
  }
  /** Makes a step and records it. */
  step(): void {
    const { core, pointer } = this.world;
    core.check(core.call.samestep_recorder_step(this.#at(), 0), pointer);
  }
  /** How many of the last steps can be taken back by World.restore; 240 at first. */
  setRewindTicks(ticks: number): void {
    const { core, pointer } = this.world;
    core.check(core.call.samestep_recorder_set_rewind_ticks(this.#at(), ticks), pointer);
  }
  /** Whether it looks for changes that were not recorded, for the price of a hash each. */
  setChecking(checking: boolean): void {
    const { core, pointer } = this.world;
    core.check(core.call.samestep_recorder_set_checking(this.#at(), Number(checking)), pointer);
  }
  /** Ends the recording after its last step; its bytes. */
  finish(): Uint8Array {
    const { core, pointer } = this.world;
    return core.withStack(8, (at) => {
      core.check(core.call.samestep_recorder_finish(this.#at(), at, at + 4), pointer);
      const [bytes, size] = [core.u32[at >> 2]!, core.u32[(at + 4) >> 2]!];
      return core.u8.slice(bytes, bytes + size);
    });
  }
  dispose(): void {
    this.world.core.call.samestep_recorder_destroy(this.#pointer);
    this.#pointer = 0;
  }
  [Symbol.dispose](): void {
    this.dispose();
  }
}

/** What a recorded world needs beside its bytes. Left out, the named handlers of scenes are registered. */
export interface Wiring {
  /** Registers functions with a world in which a recording is to be played. */
  connect?(world: World): void;
  /** Applies the game's own input, all of it, or throws. */
  applyInput?(world: World, bytes: Uint8Array): void;
}
/** Writes a wiring; the number under which it is called back, 0 for none. */
function writeWiring(core: Core, at: number, wiring: Wiring | undefined): number {
  if (wiring === undefined) return 0;
  const key = core.keep({
    connect: (world) => wiring.connect?.(new World(core, world, false)),
    input: (world, bytes) => {
      wiring.applyInput?.(new World(core, world, false), bytes);
      return 0;
    },
  });
  core.u32[(at + abi.wiring.connect) >> 2] = functionAt(core, Place.connect);
  core.u32[(at + abi.wiring.apply_input) >> 2] = wiring.applyInput === undefined ? 0 : functionAt(core, Place.input);
  core.u32[(at + abi.wiring.data) >> 2] = key;
  return key;
}

/** How a recording is verified. */
export interface VerifyOptions {
  wiring?: Wiring;
  limits?: Limits;
  /** What must hold, beside the hash of every step. */
  expected?: { rate?: number; ticks?: number; scalar?: Scalar; firstTick?: number };
  /** Called after each step; false stops. */
  progress?(done: number, total: number): boolean | void;
}
/** What replaying a recording showed. */
export interface Verdict {
  matches: boolean;
  stopped: boolean;
  ticks: number;
  /** The first step after which the hash is another one; 0: before the first. */
  firstWrongTick: number;
  recordedHash: string;
  computedHash: string;
  /** What of the expectations does not hold; "" for none. */
  unexpected: string;
}

/** Replays a recording and compares the hash of every step. */
export function verify(core: Core, bytes: Uint8Array, options: VerifyOptions): Verdict {
  const own = abi.verify_options;
  const result = own.size_of;
  const wiring = result + abi.verify_result.size_of;
  const keys: number[] = [];
  return core.withBytes(bytes, (recording, size) => core.withMemory(wiring + abi.wiring.size_of, (at) => {
    writeVerifyOptions(core, at, options, keys);
    const wired = writeWiring(core, at + wiring, options.wiring);
    keys.push(wired);
    try {
      core.check(core.call.samestep_verify(recording, size, wired === 0 ? 0 : at + wiring, at, at + result));
      return readVerdict(core, at + result);
    } finally {
      keys.forEach((key) => core.drop(key));
    }
  }));
}

function writeVerifyOptions(core: Core, at: number, options: VerifyOptions, keys: number[]): void {
  const own = abi.verify_options;
  core.call.samestep_verify_options_init(at);
  const { expected = {}, progress, limits } = options;
  if (limits !== undefined) {
    withLimits(core, limits, (from) => core.u8.copyWithin(at + own.limits, from, from + abi.limits.size_of));
  }
  let bits = 0;
  if (expected.rate !== undefined) {
    bits |= abi.constants.EXPECT_RATE;
    core.u32[(at + own.rate) >> 2] = expected.rate;
  }
  if (expected.ticks !== undefined) {
    bits |= abi.constants.EXPECT_TICKS;
    core.setWide(at + own.ticks, expected.ticks);
  }
  if (expected.firstTick !== undefined) {
    bits |= abi.constants.EXPECT_FIRST_TICK;
    core.setWide(at + own.first_tick, expected.firstTick);
  }
  if (expected.scalar !== undefined) {
    bits |= abi.constants.EXPECT_SCALAR;
    core.i32[(at + own.scalar) >> 2] = expected.scalar === 'fixed' ? abi.constants.FIXED : abi.constants.DOUBLE;
  }
  core.u32[(at + own.expected) >> 2] = bits;
  if (progress === undefined) return;
  const key = core.keep({ progress: (done, total) => (progress(done, total) === false ? 0 : 1) });
  keys.push(key);
  core.u32[(at + own.progress) >> 2] = functionAt(core, Place.progress);
  core.u32[(at + own.progress_data) >> 2] = key;
}

function readVerdict(core: Core, at: number): Verdict {
  const place = abi.verify_result;
  return {
    matches: core.i32[(at + place.matches) >> 2] === 1,
    stopped: core.i32[(at + place.stopped) >> 2] === 1,
    ticks: core.wide(at + place.ticks),
    firstWrongTick: core.wide(at + place.first_wrong_tick),
    recordedHash: core.hex(at + place.recorded_hash),
    computedHash: core.hex(at + place.computed_hash),
    unexpected: core.text(at + place.unexpected),
  };
}

/** A command of a recording. */
export interface PlayedCommand {
  /** Steps made before it. */
  tick: number;
  /** 0 where its kind names none. */
  body: BodyId;
  kind: Command['kind'];
}
/** Where a player stands. */
export interface PlayerState {
  tick: number;
  recordedHash: string;
  /** So many steps from the start are proven. */
  provenTicks: number;
  /** The first step found whose world is not the one recorded. */
  wrongTick: number | undefined;
  trust: 'proven' | 'claimed' | 'refuted';
}

/** A recording being played, forth and back. */
export class Player {
  #pointer: number;
  readonly #key: number;
  /** The world as it is now, to be read and never changed; it ends with the player. */
  readonly world: World;
  /** Steps in the recording. */
  readonly ticks: number;
  readonly scalar: Scalar;
  /** Of a step. */
  readonly seconds: number;
  /** Of the simulation of the build that recorded it. */
  readonly revision: number;
  /** false of one that was cut; it is played as far as it goes. */
  readonly whole: boolean;

  /** Made by Engine.openRecording. */
  constructor(
    readonly core: Core,
    bytes: Uint8Array,
    options: { wiring?: Wiring; limits?: Limits } = {},
  ) {
    const place = abi.player_info;
    [this.#pointer, this.#key] = core.withBytes(bytes, (recording, size) =>
      withLimits(core, options.limits, (limits) => core.withStack(16, (at) => {
        const key = writeWiring(core, at + 4, options.wiring);
        try {
          core.check(core.call.samestep_player_create(recording, size, key === 0 ? 0 : at + 4, limits, at));
        } catch (error) {
          core.drop(key);
          throw error;
        }
        return [core.u32[at >> 2]!, key];
      })));
    const at = core.call.malloc(place.size_of);
    core.check(core.call.samestep_player_get_info(this.#pointer, at));
    this.ticks = core.wide(at + place.ticks);
    this.scalar = core.i32[(at + place.scalar) >> 2] === abi.constants.FIXED ? 'fixed' : 'double';
    this.seconds = core.f64[(at + place.seconds) >> 3]!;
    this.revision = core.u32[(at + place.revision) >> 2]!;
    this.whole = core.i32[(at + place.whole) >> 2] === 1;
    core.check(core.call.samestep_player_get_world(this.#pointer, at));
    this.world = new World(core, core.u32[at >> 2]!, false);
    core.call.free(at);
  }
  #at(): number {
    if (this.#pointer === 0) throw new SamestepError('DISPOSED', 'The player has been disposed of.');
    return this.#pointer;
  }
  /** Makes the next step; false at the end. */
  step(): boolean {
    return this.core.withStack(4, (made) => {
      this.core.check(this.core.call.samestep_player_step(this.#at(), made));
      return this.core.i32[made >> 2] === 1;
    });
  }
  /** Goes to the world after a step, by way of the last keyframe before it. */
  seek(tick: number): void {
    const [lowHalf, highHalf] = [tick % 2 ** 32, Math.floor(tick / 2 ** 32)];
    this.core.check(this.core.call.samestep_player_seek(this.#at(), lowHalf, highHalf));
  }
  get state(): PlayerState {
    const { core } = this;
    const place = abi.player_state;
    return core.withStack(place.size_of, (at) => {
      core.check(core.call.samestep_player_get_state(this.#at(), at));
      return {
        tick: core.wide(at + place.tick),
        recordedHash: core.hex(at + place.recorded_hash),
        provenTicks: core.wide(at + place.proven_ticks),
        wrongTick: core.i32[(at + place.wrong) >> 2] === 1 ? core.wide(at + place.wrong_tick) : undefined,
        trust: (['proven', 'claimed', 'refuted'] as const)[core.i32[(at + place.trust) >> 2]!]!,
      };
    });
  }
  #array(get: (at: number) => number): [number, number] {
    return this.core.withStack(8, (at) => {
      this.core.check(get(at));
      return [this.core.u32[at >> 2]!, this.core.u32[(at + 4) >> 2]!];
    });
  }
  /** The recorded hashes, of the first world and after each step: two numbers each, the low half first. */
  get hashes(): Uint32Array {
    const [first, count] = this.#array((at) => this.core.call.samestep_player_get_hashes(this.#at(), at, at + 4));
    return this.core.u32.slice(first >> 2, (first >> 2) + 2 * count);
  }
  /** The recorded hash after a step, or of the first world. */
  hashAt(tick: number): string {
    const [first] = this.#array((at) => this.core.call.samestep_player_get_hashes(this.#at(), at, at + 4));
    return hexOf(this.core.u32[(first >> 2) + 2 * tick]!, this.core.u32[(first >> 2) + 2 * tick + 1]!);
  }
  /** The steps after which whole worlds stand in the recording. */
  get keyframes(): number[] {
    const [first, count] = this.#array((at) => this.core.call.samestep_player_get_keyframes(this.#at(), at, at + 4));
    return Array.from({ length: count }, (_, i) => this.core.wide(first + 8 * i));
  }
  /** All commands, in their order. */
  get commands(): PlayedCommand[] {
    const { core } = this;
    const place = abi.player_command;
    const [first, count] = this.#array((at) => core.call.samestep_player_get_commands(this.#at(), at, at + 4));
    return Array.from({ length: count }, (_, i) => {
      const at = (first + place.size_of * i) >> 2;
      const { u32 } = core;
      return {
        tick: u32[at]! + u32[at + 1]! * 2 ** 32,
        // An id that a stranger's bytes name may be none.
        body: u32[at + 2]! < 2 ** 20 ? fromHalves(u32[at + 2]!, u32[at + 3]!) : 0,
        kind: commandKinds[u32[at + 4]!]!,
      };
    });
  }
  /** A command in words, by its place among all of them. */
  describeCommand(index: number): string {
    return this.core.writtenText((text, room, size) =>
      this.core.call.samestep_player_write_command(this.#at(), index, text, room, size));
  }
  dispose(): void {
    this.world.dispose();
    this.core.call.samestep_player_destroy(this.#pointer);
    this.#pointer = 0;
    this.core.drop(this.#key);
  }
  [Symbol.dispose](): void {
    this.dispose();
  }
}
