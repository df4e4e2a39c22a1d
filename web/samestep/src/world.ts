// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import { Body } from './body.js';
import { Contact, type ContactHandler, type ContactState, readContact } from './contact.js';
import { type Core, hexOf, type Vec2 } from './core.js';
import {
  type BodyDef, type Filter, readSettings, type Settings, withFilter, writeBody, writeSettings,
} from './definitions.js';
import { SamestepError } from './error.js';
import { type BodyId, high, low, type ShapeId } from './id.js';
import { type Command, Recorder, withCommand } from './recording.js';
import { Session, type SessionDef } from './session.js';
import { Joint, type JointDef, type JointId } from './joint.js';
import { Shape } from './shape.js';

export type Scalar = 'fixed' | 'double';

/** What a new world is to be. */
export interface WorldDef extends Settings {
  /** Of a core that has both; else the core's. */
  scalar?: Scalar;
  /** How many pairs of shapes near each other it may hold. */
  maxPairs?: number;
}
/** How large a world from outside may be. */
export interface Limits {
  bodies?: number;
  shapes?: number;
  pairs?: number;
  bytes?: number;
}

/** Two shapes that began or ceased to touch. */
export interface ContactEvent {
  shapeA: ShapeId;
  shapeB: ShapeId;
  bodyA: BodyId;
  bodyB: BodyId;
  sensor: boolean;
  /** Of an end that a call between steps brought about: the shapes may be gone. */
  removal: boolean;
}
/** Two shapes that struck each other. */
export interface ImpactEvent {
  shapeA: ShapeId;
  shapeB: ShapeId;
  bodyA: BodyId;
  bodyB: BodyId;
  point: Vec2;
  normal: Vec2;
  /** m/s */
  speed: number;
  /** N s */
  impulse: number;
}
/** What the last step listed, by rising ids. */
export interface Events {
  tick: number;
  begins: ContactEvent[];
  ends: ContactEvent[];
  impacts: ImpactEvent[];
}
/** All poses, in the memory of the engine until the next call of writePoses. */
export interface Poses {
  /** x, y, cosine and sine of each body. */
  values: Float32Array;
  /** The ids of the bodies, in the same order. */
  ids: Float64Array;
}

/** Runs an action with limits in memory, or with 0 for none. */
export function withLimits<T>(core: Core, limits: Limits | undefined, action: (at: number) => T): T {
  if (limits === undefined) return action(0);
  const place = abi.limits;
  return core.withStack(place.size_of, (at) => {
    core.call.samestep_limits_init(at);
    if (limits.bodies !== undefined) core.u32[(at + place.bodies) >> 2] = limits.bodies;
    if (limits.shapes !== undefined) core.u32[(at + place.shapes) >> 2] = limits.shapes;
    if (limits.pairs !== undefined) core.u32[(at + place.pairs) >> 2] = limits.pairs;
    if (limits.bytes !== undefined) core.setWide(at + place.bytes, limits.bytes);
    return action(at);
  });
}

/** A place to keep a world in memory, for rollback. */
export class Slot {
  #pointer: number;
  constructor(readonly core: Core, scalar: number) {
    this.#pointer = core.withStack(4, (at) => {
      core.check(core.call.samestep_slot_create(scalar, at));
      return core.u32[at >> 2]!;
    });
  }
  get pointer(): number {
    if (this.#pointer === 0) throw new SamestepError('DISPOSED', 'The slot has been disposed of.');
    return this.#pointer;
  }
  dispose(): void {
    this.core.call.samestep_slot_destroy(this.#pointer);
    this.#pointer = 0;
  }
  [Symbol.dispose](): void {
    this.dispose();
  }
}

/** Bodies, shapes and their collisions, stepped in equal steps. */
export class World {
  #pointer: number;
  #listing = false;
  readonly #keys: number[] = [];

  /** Made by Engine.createWorld. */
  constructor(
    readonly core: Core,
    pointer: number,
    /** Whether dispose() ends it; the world of a player or session ends with that. */
    readonly owned: boolean,
  ) {
    this.#pointer = pointer;
  }
  static create(core: Core, def: WorldDef, scalar: number): World {
    const place = abi.world_def;
    return core.withStack(place.size_of + 16, (at) => {
      core.call.samestep_world_def_init(at);
      core.i32[(at + place.scalar) >> 2] = scalar;
      if (def.maxPairs !== undefined) core.u32[(at + place.max_pairs) >> 2] = def.maxPairs;
      writeSettings(core, at + place.settings, def);
      const made = at + place.size_of;
      core.check(core.call.samestep_world_create(at, made));
      return new World(core, core.u32[made >> 2]!, true);
    });
  }

  /** Its address in the memory of the engine. */
  get pointer(): number {
    if (this.#pointer === 0) throw new SamestepError('DISPOSED', 'The world has been disposed of.');
    return this.#pointer;
  }
  get #call(): abi.Exports {
    return this.core.call;
  }
  #check(status: number): void {
    this.core.check(status, this.#pointer);
  }
  #get<T>(bytes: number, get: (at: number) => number, pick: (at: number) => T): T {
    return this.core.withStack(bytes, (at) => {
      this.#check(get(at));
      return pick(at);
    });
  }

  /** Gives its memory back; a world in use by a recorder or session is refused. */
  dispose(): void {
    if (this.#pointer === 0) return;
    if (this.owned) this.#check(this.#call.samestep_world_destroy(this.#pointer));
    this.#pointer = 0;
    for (const key of this.#keys) this.core.drop(key);
  }
  [Symbol.dispose](): void {
    this.dispose();
  }

  // Steps and settings.

  /** Makes one step of 1/rate seconds. */
  step(rate = 60): void {
    this.#check(this.#call.samestep_world_step_at(this.pointer, rate));
  }
  /** Steps made so far. */
  get tick(): number {
    return this.#get(8, (at) => this.#call.samestep_world_get_tick(this.pointer, at), (at) => this.core.wide(at));
  }
  get scalar(): Scalar {
    return this.#get(4, (at) => this.#call.samestep_world_get_scalar(this.pointer, at),
      (at) => (this.core.i32[at >> 2] === abi.constants.FIXED ? 'fixed' : 'double'));
  }
  get settings(): Required<Settings> {
    return this.#get(abi.settings.size_of, (at) => this.#call.samestep_world_get_settings(this.pointer, at),
      (at) => readSettings(this.core, at));
  }
  /** Changes the settings that are given, all or none. */
  configure(settings: Settings): void {
    this.core.withStack(abi.settings.size_of, (at) => {
      this.#check(this.#call.samestep_world_get_settings(this.pointer, at));
      writeSettings(this.core, at, settings);
      this.#check(this.#call.samestep_world_set_settings(this.pointer, at));
    });
  }
  /** Whether it is whole: a change that found no memory may leave it midway, until a world is brought in. */
  get usable(): boolean {
    return this.#get(4, (at) => this.#call.samestep_world_is_usable(this.pointer, at),
      (at) => this.core.i32[at >> 2] === 1);
  }

  // Bodies and shapes.

  addBody(def: BodyDef = {}): Body {
    const size = abi.body_def.size_of;
    return this.#get(size + 8, (at) => {
      writeBody(this.core, at, def);
      return this.#call.samestep_body_create(this.pointer, at, at + size);
    }, (at) => new Body(this, this.core.id(at + size)));
  }
  /** The body of an id, whether it is there or not. */
  body(id: BodyId): Body {
    return new Body(this, id);
  }
  shape(id: ShapeId): Shape {
    return new Shape(this, id);
  }
  addJoint(def: JointDef): Joint {
    return Joint.create(this, def);
  }
  joint(id: JointId): Joint {
    return new Joint(this, id);
  }
  get jointCount(): number {
    return this.#get(4, (at) => this.#call.samestep_world_get_joint_count(this.pointer, at),
      (at) => this.core.u32[at >> 2]!);
  }
  /** The body for what never moves, always there. */
  get staticBody(): Body {
    return this.#get(8, (at) => this.#call.samestep_world_get_static_body(this.pointer, at),
      (at) => new Body(this, this.core.id(at)));
  }
  get bodyCount(): number {
    return this.#get(4, (at) => this.#call.samestep_world_get_body_count(this.pointer, at),
      (at) => this.core.u32[at >> 2]!);
  }
  get shapeCount(): number {
    return this.#get(4, (at) => this.#call.samestep_world_get_shape_count(this.pointer, at),
      (at) => this.core.u32[at >> 2]!);
  }
  /** All poses for drawing, without an object for each. The views last until the next call, or until memory grows:
   * ask anew in each frame. */
  writePoses(): Poses {
    return this.#get(16, (at) => this.#call.samestep_web_write_poses(this.pointer, at, at + 4, at + 8), (at) => {
      const [values, ids, count] = this.core.u32.subarray(at >> 2, (at >> 2) + 3) as unknown as [number, number, number];
      return {
        values: new Float32Array(this.core.buffer, values, 4 * count),
        ids: new Float64Array(this.core.buffer, ids, count),
      };
    });
  }

  // Queries.

  /** The shapes within a distance of a point. */
  queryPoint({ x, y }: Vec2, distance = 0, filter?: Filter) {
    return withFilter(this.core, filter, (about) => this.#list(
      (at) => this.#call.samestep_query_point(this.pointer, x, y, distance, about, at, at + 4), 48, (at) => ({
        shape: this.core.id(at),
        /** The nearest point of its surface. */
        point: this.core.vec2(at + abi.point_hit.point),
        /** From there; negative inside. */
        distance: this.core.f64[(at + abi.point_hit.distance) >> 3]!,
        gradient: this.core.vec2(at + abi.point_hit.gradient),
      })));
  }
  /** The shapes that a circle touches on its way; of radius 0: a ray with an end. */
  querySegment(from: Vec2, to: Vec2, radius = 0, filter?: Filter) {
    return withFilter(this.core, filter, (about) => this.#list(
      (at) => this.#call.samestep_query_segment(
        this.pointer, from.x, from.y, to.x, to.y, radius, about, at, at + 4), 48, (at) => ({
        shape: this.core.id(at),
        point: this.core.vec2(at + abi.segment_hit.point),
        normal: this.core.vec2(at + abi.segment_hit.normal),
        /** How far along the way, 0 to 1. */
        alpha: this.core.f64[(at + abi.segment_hit.alpha) >> 3]!,
      })));
  }
  /** The ids of shapes whose boxes overlap a box. */
  queryBox(box: { left: number; bottom: number; right: number; top: number }, filter?: Filter): ShapeId[] {
    return withFilter(this.core, filter, (about) => this.#list(
      (at) => this.#call.samestep_query_box(
        this.pointer, box.left, box.bottom, box.right, box.top, about, at, at + 4), 8, (at) => this.core.id(at)));
  }
  #list<T>(get: (at: number) => number, size: number, pick: (at: number) => T): T[] {
    return this.#get(8, get, (at) => {
      const [first, count] = [this.core.u32[at >> 2]!, this.core.u32[(at + 4) >> 2]!];
      return Array.from({ length: count }, (_, i) => pick(first + size * i));
    });
  }

  // Contacts, events and handlers.

  /** All touching pairs of shapes, or those of one body. */
  contacts(body: BodyId = 0): ContactState[] {
    return this.#list(
      (at) => this.#call.samestep_world_get_contacts(this.pointer, low(body), high(body), at, at + 4),
      abi.contact_state.size_of, (at) => readContact(this.core, at));
  }
  /** Says which events each further step lists. */
  listEvents(which: { contacts?: boolean; impacts?: boolean; slowestImpact?: number }): void {
    const { contacts = false, impacts = false, slowestImpact = 0 } = which;
    this.#check(this.#call.samestep_world_list_events(this.pointer, Number(contacts), Number(impacts), slowestImpact));
    this.#listing = contacts || impacts;
  }
  /** What the last step listed. */
  get events(): Events {
    if (!this.#listing) return { tick: 0, begins: [], ends: [], impacts: [] };
    const { core } = this;
    const place = abi.events;
    return this.#get(place.size_of, (at) => this.#call.samestep_world_get_events(this.pointer, at), (at) => {
      const list = <T>(array: number, count: number, size: number, pick: (at: number) => T): T[] => {
        const first = core.u32[(at + array) >> 2]!;
        return Array.from({ length: core.u32[(at + count) >> 2]! }, (_, i) => pick(first + size * i));
      };
      const touched = (event: number) => this.#contactEvent(event);
      return {
        tick: core.wide(at + place.tick),
        begins: list(place.begins, place.begin_count, abi.contact_event.size_of, touched),
        ends: list(place.ends, place.end_count, abi.contact_event.size_of, touched),
        impacts: list(place.impacts, place.impact_count, abi.impact_event.size_of, (event) => this.#impact(event)),
      };
    });
  }
  #pair(at: number) {
    const place = abi.contact_event;
    return {
      shapeA: this.core.id(at + place.shape_a),
      shapeB: this.core.id(at + place.shape_b),
      bodyA: this.core.id(at + place.body_a),
      bodyB: this.core.id(at + place.body_b),
    };
  }
  #contactEvent(at: number): ContactEvent {
    const place = abi.contact_event;
    const flag = (field: number) => this.core.i32[(at + field) >> 2] === 1;
    return { ...this.#pair(at), sensor: flag(place.sensor), removal: flag(place.removal) };
  }
  #impact(at: number): ImpactEvent {
    const place = abi.impact_event;
    return {
      ...this.#pair(at),
      point: this.core.vec2(at + place.point),
      normal: this.core.vec2(at + place.normal),
      speed: this.core.f64[(at + place.speed) >> 3]!,
      impulse: this.core.f64[(at + place.impulse) >> 3]!,
    };
  }

  /** Registers a collision handler under a number other than 0; which types it is for is state. */
  registerHandler(number: number, handler: ContactHandler): void {
    const { core } = this;
    const phases = [handler.begin, handler.preSolve, handler.postSolve, handler.separate];
    const key = this.#keep({
      contact: (phase, contact) => {
        const answer = phases[phase]!.call(handler, new Contact(this, contact));
        return answer === false ? 0 : 1;
      },
    });
    core.withStack(abi.handler.size_of, (at) => {
      const functions = this.#call.samestep_web_functions() >> 2;
      phases.forEach((phase, i) => {
        core.u32[(at >> 2) + i] = phase === undefined ? 0 : core.u32[functions + i]!;
      });
      core.u32[(at + abi.handler.data) >> 2] = key;
      this.#check(this.#call.samestep_world_register_handler(this.pointer, number, at));
    });
  }
  /** For shapes of two types; type 0 stands for every type that no handler names together with the other. */
  addHandler(typeA: number, typeB: number, number: number): void {
    this.#check(this.#call.samestep_world_add_handler(this.pointer, typeA, typeB, number));
  }
  addWildcardHandler(type: number, number: number): void {
    this.#check(this.#call.samestep_world_add_wildcard_handler(this.pointer, type, number));
  }
  addDefaultHandler(number: number): void {
    this.#check(this.#call.samestep_world_add_default_handler(this.pointer, number));
  }
  /** Registers a function that moves bodies in place of their velocities. */
  registerPositionFunction(number: number, move: (body: Body, seconds: number) => void): void {
    const key = this.#keep({ position: (_, body, seconds) => move(new Body(this, body), seconds) });
    this.#check(this.#call.samestep_world_register_position_function(
      this.pointer, number, functionAt(this.core, Place.position), key));
  }
  /** Registers a function that changes velocities in place of gravity, force and torque. */
  registerVelocityFunction(
    number: number, change: (body: Body, gravity: Vec2, damping: number, seconds: number) => void,
  ): void {
    const key = this.#keep({
      velocity: (_, body, gravity, damping, seconds) => change(new Body(this, body), gravity, damping, seconds),
    });
    this.#check(this.#call.samestep_world_register_velocity_function(
      this.pointer, number, functionAt(this.core, Place.velocity), key));
  }
  /** Has a function run after the step or query under way, or at once; once for each key until then. */
  afterStep(key: number, action: () => void): boolean {
    const { core } = this;
    const own = core.keep({
      postStep: () => {
        core.drop(own);
        action();
      },
    });
    return this.#get(4, (at) => this.#call.samestep_world_add_post_step(
      this.pointer, functionAt(core, Place.postStep), key >>> 0, 0, own, at), (at) => {
      const added = core.i32[at >> 2] === 1;
      if (!added) core.drop(own);
      return added;
    });
  }
  #keep(callbacks: Parameters<Core['keep']>[0]): number {
    const key = this.core.keep(callbacks);
    this.#keys.push(key);
    return key;
  }

  // State.

  /** The hash of the state in 16 hexadecimal digits, the same on every machine. */
  get hash(): string {
    const [lowHalf, highHalf] = this.hashHalves();
    return hexOf(lowHalf, highHalf);
  }
  /** Its low and its high half, for each tick: no text and no BigInt is made. */
  hashHalves(): [number, number] {
    return this.#get(8, (at) => this.#call.samestep_world_get_hash(this.pointer, at),
      (at) => [this.core.u32[at >> 2]!, this.core.u32[(at + 4) >> 2]!]);
  }
  /** Copies the world into a slot. */
  save(slot: Slot): void {
    this.#check(this.#call.samestep_world_save(this.pointer, slot.pointer));
  }
  /** Brings back a saved world, as often as wanted. */
  restore(slot: Slot): void {
    this.#check(this.#call.samestep_world_restore(this.pointer, slot.pointer));
  }
  /** The world as bytes that every platform reads. */
  snapshot(): Uint8Array {
    return this.core.written(
      (bytes, room, size) => this.#call.samestep_world_write_snapshot(this.pointer, bytes, room, size), this.pointer);
  }
  /** Brings in a snapshot in place of the world. Bytes may be anything: they are refused, or make a sound world. */
  readSnapshot(bytes: Uint8Array, options: { anyRevision?: boolean; limits?: Limits } = {}): void {
    this.core.withBytes(bytes, (at, size) => withLimits(this.core, options.limits, (limits) => this.#check(
      this.#call.samestep_world_read_snapshot(this.pointer, at, size, Number(options.anyRevision ?? false), limits))));
  }
  /** The fields in which another world differs, a line each; "" for equal worlds. */
  difference(other: World, most = 20): string {
    return this.core.writtenText((text, room, size) =>
      this.#call.samestep_world_write_difference(this.pointer, other.pointer, most, text, room, size), this.pointer);
  }

  // Commands, recordings and sessions.

  /** Applies a command as a whole or not at all; the id of a spawned body, else 0. */
  apply(command: Command): BodyId {
    return withCommand(this.core, command, (at, body) => {
      this.#check(this.#call.samestep_world_apply(this.pointer, at, body));
      return this.core.id(body);
    });
  }
  /** Sets the function that applies the game's own inputs: all of the bytes, or nothing and throws. */
  setInputFunction(apply: (bytes: Uint8Array) => void): void {
    const key = this.#keep({
      input: (_, bytes) => {
        apply(bytes);
        return 0;
      },
    });
    this.#check(this.#call.samestep_world_set_input_function(
      this.pointer, functionAt(this.core, Place.input), key));
  }
  /** Begins to record it. Commands and steps must go through the recorder from now on. */
  record(rate = 60): Recorder {
    return new Recorder(this, rate);
  }
  /** Begins a networked match in which the session steps this world. */
  startSession(def: SessionDef): Session {
    return new Session(this, def);
  }
}

/** The places of functions that wasm calls back by, in the bridge's table. */
export enum Place {
  position = 5,
  velocity,
  postStep,
  input,
  connect,
  progress,
  applyInputs,
  send,
  receive,
  saveOwn,
  loadOwn,
  hashOwn,
}
export function functionAt(core: Core, place: Place): number {
  return core.u32[(core.call.samestep_web_functions() >> 2) + place]!;
}
