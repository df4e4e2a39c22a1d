// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import { hexOf, type Vec2 } from './core.js';
import { bodyTypes, type BodyType, type ShapeDef, withShape } from './definitions.js';
import { type BodyId, high, low } from './id.js';
import { Joint } from './joint.js';
import { Shape } from './shape.js';
import type { World } from './world.js';

/** Where a body is and how it moves. */
export interface BodyState {
  id: BodyId;
  type: BodyType;
  rotates: boolean;
  /** Steps leave it alone until something happens to it. */
  sleeps: boolean;
  maySleep: boolean;
  /** Of the origin, m. */
  position: Vec2;
  /** Cosine and sine of the angle. */
  rotation: Vec2;
  angle: number;
  centerOfMass: Vec2;
  worldCenter: Vec2;
  /** Of the centre of mass, m/s. */
  velocity: Vec2;
  angularVelocity: number;
  force: Vec2;
  torque: number;
  mass: number;
  moment: number;
  kineticEnergy: number;
}

/** A body of a world, by its id: any number of these may name the same one. */
export class Body {
  readonly #low: number;
  readonly #high: number;
  constructor(
    readonly world: World,
    readonly id: BodyId,
  ) {
    this.#low = low(id);
    this.#high = high(id);
  }

  #read<T>(pick: (at: number) => T): T {
    const { core, pointer } = this.world;
    return core.withStack(abi.body_state.size_of, (at) => {
      core.check(core.call.samestep_body_get(pointer, this.#low, this.#high, at), pointer);
      return pick(at);
    });
  }
  #vec2(field: number): Vec2 {
    return this.#read((at) => this.world.core.vec2(at + field));
  }
  #number(field: number): number {
    return this.#read((at) => this.world.core.f64[(at + field) >> 3]!);
  }
  #check(status: number): void {
    this.world.core.check(status, this.world.pointer);
  }
  get #call(): abi.Exports {
    return this.world.core.call;
  }

  /** Whether the world has it. */
  get exists(): boolean {
    const { core, pointer } = this.world;
    return core.withStack(4, (at) => {
      core.check(core.call.samestep_body_exists(pointer, this.#low, this.#high, at), pointer);
      return core.i32[at >> 2] === 1;
    });
  }
  /** All of it at once. */
  get state(): BodyState {
    const { core } = this.world;
    const place = abi.body_state;
    return this.#read((at) => {
      const number = (field: number) => core.f64[(at + field) >> 3]!;
      const vec2 = (field: number) => core.vec2(at + field);
      return {
        id: this.id,
        type: bodyTypes[core.i32[(at + place.type) >> 2]!]!,
        rotates: core.i32[(at + place.rotates) >> 2] === 1,
        sleeps: core.i32[(at + place.sleeps) >> 2] === 1,
        maySleep: core.i32[(at + place.may_sleep) >> 2] === 1,
        position: vec2(place.position),
        rotation: vec2(place.rotation),
        angle: number(place.angle),
        centerOfMass: vec2(place.center_of_mass),
        worldCenter: vec2(place.world_center),
        velocity: vec2(place.velocity),
        angularVelocity: number(place.angular_velocity),
        force: vec2(place.force),
        torque: number(place.torque),
        mass: number(place.mass),
        moment: number(place.moment),
        kineticEnergy: number(place.kinetic_energy),
      };
    });
  }

  get position(): Vec2 {
    return this.#vec2(abi.body_state.position);
  }
  set position({ x, y }: Vec2) {
    this.#check(this.#call.samestep_body_set_position(this.world.pointer, this.#low, this.#high, x, y));
  }
  get angle(): number {
    return this.#number(abi.body_state.angle);
  }
  set angle(angle: number) {
    this.#check(this.#call.samestep_body_set_angle(this.world.pointer, this.#low, this.#high, angle));
  }
  get velocity(): Vec2 {
    return this.#vec2(abi.body_state.velocity);
  }
  set velocity({ x, y }: Vec2) {
    this.#check(this.#call.samestep_body_set_velocity(this.world.pointer, this.#low, this.#high, x, y));
  }
  get angularVelocity(): number {
    return this.#number(abi.body_state.angular_velocity);
  }
  set angularVelocity(value: number) {
    this.#check(this.#call.samestep_body_set_angular_velocity(this.world.pointer, this.#low, this.#high, value));
  }
  get force(): Vec2 {
    return this.#vec2(abi.body_state.force);
  }
  set force({ x, y }: Vec2) {
    this.#check(this.#call.samestep_body_set_force(this.world.pointer, this.#low, this.#high, x, y));
  }
  get torque(): number {
    return this.#number(abi.body_state.torque);
  }
  set torque(value: number) {
    this.#check(this.#call.samestep_body_set_torque(this.world.pointer, this.#low, this.#high, value));
  }
  get mass(): number {
    return this.#number(abi.body_state.mass);
  }
  set mass(value: number) {
    this.#check(this.#call.samestep_body_set_mass(this.world.pointer, this.#low, this.#high, value));
  }
  get moment(): number {
    return this.#number(abi.body_state.moment);
  }
  set moment(value: number) {
    this.#check(this.#call.samestep_body_set_moment(this.world.pointer, this.#low, this.#high, value));
  }
  get type(): BodyType {
    return bodyTypes[this.#read((at) => this.world.core.i32[(at + abi.body_state.type) >> 2]!)]!;
  }
  set type(type: BodyType) {
    this.#check(this.#call.samestep_body_set_type(this.world.pointer, this.#low, this.#high, bodyTypes.indexOf(type)));
  }
  /** Any 64 bits of the game's; hashed and saved. */
  get userData(): bigint {
    return this.#read((at) => this.world.core.big(at + abi.body_state.user_data));
  }
  set userData(value: number | bigint) {
    const bits = BigInt(value);
    const [lowHalf, highHalf] = [Number(bits & 0xffffffffn), Number((bits >> 32n) & 0xffffffffn)];
    this.#check(this.#call.samestep_body_set_user_data(this.world.pointer, this.#low, this.#high, lowHalf, highHalf));
  }
  /** Whether steps leave it alone until something happens to it. */
  get sleeps(): boolean {
    return this.#read((at) => this.world.core.i32[(at + abi.body_state.sleeps) >> 2] === 1);
  }
  /** Wakes it, with its island as the next step begins. */
  activate(): void {
    this.#check(this.#call.samestep_body_activate(this.world.pointer, this.#low, this.#high));
  }
  /** Spares it the wait: it sleeps as soon as its island is at rest. */
  sleep(): void {
    this.#check(this.#call.samestep_body_sleep(this.world.pointer, this.#low, this.#high));
  }
  /** Whether it may ever sleep, and with it what touches it. */
  setMaySleep(may: boolean): void {
    this.#check(this.#call.samestep_body_set_may_sleep(this.world.pointer, this.#low, this.#high, Number(may)));
  }
  /** In the coordinates of the body, m. */
  setCenterOfMass({ x, y }: Vec2): void {
    this.#check(this.#call.samestep_body_set_center_of_mass(this.world.pointer, this.#low, this.#high, x, y));
  }
  /** The numbers of the functions that move it and change its velocity; 0: the engine's own. */
  setFunctions(position: number, velocity: number): void {
    this.#check(this.#call.samestep_body_set_functions(this.world.pointer, this.#low, this.#high, position, velocity));
  }

  /** N s at a point of the world. */
  applyImpulse(impulse: Vec2, point: Vec2 = this.#vec2(abi.body_state.world_center)): void {
    this.#check(this.#call.samestep_body_apply_impulse(
      this.world.pointer, this.#low, this.#high, impulse.x, impulse.y, point.x, point.y));
  }
  /** N at a point of the world, in the next step. */
  applyForce(force: Vec2, point: Vec2 = this.#vec2(abi.body_state.world_center)): void {
    this.#check(this.#call.samestep_body_apply_force(
      this.world.pointer, this.#low, this.#high, force.x, force.y, point.x, point.y));
  }
  /** What the engine does where it has no position function of the game's. */
  updatePosition(seconds: number): void {
    this.#check(this.#call.samestep_body_update_position(this.world.pointer, this.#low, this.#high, seconds));
  }
  /** The same of velocity functions. */
  updateVelocity(gravity: Vec2, damping: number, seconds: number): void {
    this.#check(this.#call.samestep_body_update_velocity(
      this.world.pointer, this.#low, this.#high, gravity.x, gravity.y, damping, seconds));
  }
  /** From the coordinates of the body to those of the world. */
  toWorld({ x, y }: Vec2): Vec2 {
    return this.#mapped((at) => this.#call.samestep_body_to_world(this.world.pointer, this.#low, this.#high, x, y, at));
  }
  /** From the coordinates of the world to those of the body. */
  toLocal({ x, y }: Vec2): Vec2 {
    return this.#mapped((at) => this.#call.samestep_body_to_local(this.world.pointer, this.#low, this.#high, x, y, at));
  }
  /** The velocity of its material at a point of the world, m/s. */
  velocityAt({ x, y }: Vec2): Vec2 {
    return this.#mapped((at) =>
      this.#call.samestep_body_get_velocity_at(this.world.pointer, this.#low, this.#high, x, y, at));
  }
  #mapped(map: (at: number) => number): Vec2 {
    return this.world.core.withStack(16, (at) => {
      this.#check(map(at));
      return this.world.core.vec2(at);
    });
  }

  /** Adds a shape; mass, moment and centre of mass become those of its shapes with mass. */
  addShape(def: ShapeDef): Shape {
    const { core, pointer } = this.world;
    return core.withStack(8, (made) => {
      withShape(core, def, (at) => this.#check(
        this.#call.samestep_shape_create(pointer, this.#low, this.#high, at, made)));
      return new Shape(this.world, core.id(made));
    });
  }
  /** Its shapes, by rising id. */
  get shapes(): Shape[] {
    const { core, pointer } = this.world;
    return core.withStack(8, (at) => {
      this.#check(this.#call.samestep_body_get_shapes(pointer, this.#low, this.#high, at, at + 4));
      const [first, count] = [core.u32[at >> 2]!, core.u32[(at + 4) >> 2]!];
      return Array.from({ length: count }, (_, i) => new Shape(this.world, core.id(first + 8 * i)));
    });
  }
  /** Its joints, by rising id. */
  get joints(): Joint[] {
    const { core, pointer } = this.world;
    return core.withStack(8, (at) => {
      this.#check(this.#call.samestep_body_get_joints(pointer, this.#low, this.#high, at, at + 4));
      const [first, count] = [core.u32[at >> 2]!, core.u32[(at + 4) >> 2]!];
      return Array.from({ length: count }, (_, i) => new Joint(this.world, core.id(first + 8 * i)));
    });
  }
  /** Its own hash, to find where two worlds differ. */
  get hash(): string {
    const { core, pointer } = this.world;
    return core.withStack(8, (at) => {
      this.#check(this.#call.samestep_body_get_hash(pointer, this.#low, this.#high, at));
      return hexOf(core.u32[at >> 2]!, core.u32[(at + 4) >> 2]!);
    });
  }
  /** Takes it and its shapes away. */
  remove(): void {
    this.#check(this.#call.samestep_body_destroy(this.world.pointer, this.#low, this.#high));
  }
}
