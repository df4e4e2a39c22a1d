// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import type { Core, Vec2 } from './core.js';
import { type BodyId, high, low } from './id.js';
import type { World } from './world.js';

/** The id of a joint, as that of a body. */
export type JointId = number;
export type JointKind = 'revolute' | 'prismatic' | 'distance' | 'weld' | 'wheel' | 'target' | 'gear' | 'ratchet';
const kinds: readonly JointKind[] = ['revolute', 'prismatic', 'distance', 'weld', 'wheel', 'target', 'gear', 'ratchet'];

/** What a joint is to be; docs/joints.md of the engine says which fields count for which kind. Points and the axis are
 * in the coordinates of the body they are on. */
export interface JointDef {
  kind: JointKind;
  bodyA: BodyId;
  bodyB: BodyId;
  /** As of BodyDef. */
  id?: JointId;
  userData?: number | bigint;
  anchorA?: Vec2;
  anchorB?: Vec2;
  /** Of A, a unit vector. */
  axis?: Vec2;
  /** Of a target without a spring, m/s. */
  velocity?: Vec2;
  /** Where the spring rests; of a rod its length, of a ratchet its teeth. */
  rest?: number;
  angle?: number;
  lower?: number;
  upper?: number;
  motorSpeed?: number;
  motorMax?: number;
  hertz?: number;
  damping?: number;
  angularHertz?: number;
  angularDamping?: number;
  maxForce?: number;
  maxTorque?: number;
  breakForce?: number;
  breakTorque?: number;
  ratio?: number;
  limited?: boolean;
  motor?: boolean;
  spring?: boolean;
  collideConnected?: boolean;
}

const VECTORS = { anchorA: 'anchor_a', anchorB: 'anchor_b', axis: 'axis', velocity: 'velocity' } as const;
const NUMBERS = {
  rest: 'rest', angle: 'angle', lower: 'lower', upper: 'upper', motorSpeed: 'motor_speed', motorMax: 'motor_max',
  hertz: 'hertz', damping: 'damping', angularHertz: 'angular_hertz', angularDamping: 'angular_damping',
  maxForce: 'max_force', maxTorque: 'max_torque', breakForce: 'break_force', breakTorque: 'break_torque',
  ratio: 'ratio',
} as const;
const FLAGS = {
  limited: 'limited', motor: 'motor', spring: 'spring', collideConnected: 'collide_connected',
} as const;
const entries = <T extends object>(of: T) => Object.entries(of) as [keyof T, T[keyof T]][];

/** Writes the definition of a joint. */
export function writeJoint(core: Core, at: number, def: JointDef): void {
  const place = abi.joint_def;
  core.call.samestep_joint_def_init(at);
  core.i32[(at + place.kind) >> 2] = kinds.indexOf(def.kind);
  if (def.id !== undefined) core.setId(at + place.id, def.id);
  core.setId(at + place.body_a, def.bodyA);
  core.setId(at + place.body_b, def.bodyB);
  if (def.userData !== undefined) core.setBig(at + place.user_data, BigInt(def.userData));
  for (const [name, field] of entries(VECTORS)) core.setVec2(at + place[field], def[name]);
  for (const [name, field] of entries(NUMBERS)) {
    const value = def[name];
    if (value !== undefined) core.f64[(at + place[field]) >> 3] = value;
  }
  for (const [name, field] of entries(FLAGS)) {
    const value = def[name];
    if (value !== undefined) core.i32[(at + place[field]) >> 2] = Number(value);
  }
}

function readJoint(core: Core, at: number): Required<JointDef> {
  const place = abi.joint_def;
  const all = <T extends Record<string, keyof typeof place>, V>(of: T, read: (field: number) => V) =>
    Object.fromEntries(entries(of).map(([name, field]) => [name, read(at + place[field])])) as Record<keyof T, V>;
  return {
    kind: kinds[core.i32[(at + place.kind) >> 2]!]!,
    id: core.id(at + place.id),
    bodyA: core.id(at + place.body_a),
    bodyB: core.id(at + place.body_b),
    userData: core.big(at + place.user_data),
    ...all(VECTORS, (field) => core.vec2(field)),
    ...all(NUMBERS, (field) => core.f64[field >> 3]!),
    ...all(FLAGS, (field) => core.i32[field >> 2] === 1),
  };
}

/** A joint of a world, by its id. */
export class Joint {
  readonly #low: number;
  readonly #high: number;
  constructor(
    readonly world: World,
    readonly id: JointId,
  ) {
    this.#low = low(id);
    this.#high = high(id);
  }
  /** Made by World.addJoint. */
  static create(world: World, def: JointDef): Joint {
    const { core, pointer } = world;
    const size = abi.joint_def.size_of;
    return core.withStack(size + 8, (at) => {
      writeJoint(core, at, def);
      core.check(core.call.samestep_joint_create(pointer, at, at + size), pointer);
      return new Joint(world, core.id(at + size));
    });
  }
  #withMemory<T>(bytes: number, call: (at: number) => number, pick: (at: number) => T): T {
    const { core, pointer } = this.world;
    return core.withStack(bytes, (at) => {
      core.check(call(at), pointer);
      return pick(at);
    });
  }

  get exists(): boolean {
    const { core, pointer } = this.world;
    return this.#withMemory(4, (at) => core.call.samestep_joint_exists(pointer, this.#low, this.#high, at),
      (at) => core.i32[at >> 2] === 1);
  }
  /** What it is. */
  get definition(): Required<JointDef> {
    const { core, pointer } = this.world;
    return this.#withMemory(abi.joint_def.size_of,
      (at) => core.call.samestep_joint_get(pointer, this.#low, this.#high, at), (at) => readJoint(core, at));
  }
  /** What it did in the last step: force on B, N, and torque, N m. */
  get load(): { force: Vec2; torque: number } {
    const { core, pointer } = this.world;
    const place = abi.joint_state;
    return this.#withMemory(place.size_of,
      (at) => core.call.samestep_joint_get_state(pointer, this.#low, this.#high, at),
      (at) => ({ force: core.vec2(at + place.force), torque: core.f64[(at + place.torque) >> 3]! }));
  }
  /** Makes it what the definition says; it keeps its id. */
  replace(def: JointDef): void {
    const { core, pointer } = this.world;
    this.#withMemory(abi.joint_def.size_of, (at) => {
      writeJoint(core, at, def);
      return core.call.samestep_joint_replace(pointer, this.#low, this.#high, at);
    }, () => undefined);
  }
  /** Takes it away. */
  remove(): void {
    const { core, pointer } = this.world;
    core.check(core.call.samestep_joint_destroy(pointer, this.#low, this.#high), pointer);
  }
}
