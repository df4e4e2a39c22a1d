// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import type { Core, Vec2 } from './core.js';
import type { BodyId, ShapeId } from './id.js';
import type { World } from './world.js';

/** Where two shapes touch. */
export interface ContactPoint {
  /** On the surface of the first, m. */
  pointA: Vec2;
  /** On the surface of the second, m. */
  pointB: Vec2;
  /** Along the normal; negative where they overlap. */
  distance: number;
}
/** Two touching shapes. */
export interface ContactState {
  shapeA: ShapeId;
  shapeB: ShapeId;
  bodyA: BodyId;
  bodyB: BodyId;
  /** From the first to the second. */
  normal: Vec2;
  points: ContactPoint[];
  friction: number;
  restitution: number;
  surfaceVelocity: Vec2;
  /** Of the last step on B, N s. */
  totalImpulse: Vec2;
  first: boolean;
  removal: boolean;
  ignored: boolean;
}

/** Reads a contact from memory. */
export function readContact(core: Core, at: number): ContactState {
  const place = abi.contact_state;
  const touch = at + place.touch;
  const flag = (field: number) => core.i32[(at + field) >> 2] === 1;
  return {
    shapeA: core.id(at + place.shape_a),
    shapeB: core.id(at + place.shape_b),
    bodyA: core.id(at + place.body_a),
    bodyB: core.id(at + place.body_b),
    normal: core.vec2(touch),
    points: Array.from({ length: core.i32[(touch + abi.touch.count) >> 2]! }, (_, i) => ({
      pointA: core.vec2(touch + abi.touch.point_a + 16 * i),
      pointB: core.vec2(touch + abi.touch.point_b + 16 * i),
      distance: core.f64[(touch + abi.touch.distance + 8 * i) >> 3]!,
    })),
    friction: core.f64[(at + place.friction) >> 3]!,
    restitution: core.f64[(at + place.restitution) >> 3]!,
    surfaceVelocity: core.vec2(at + place.surface_velocity),
    totalImpulse: core.vec2(at + place.total_impulse),
    first: flag(place.first),
    removal: flag(place.removal),
    ignored: flag(place.ignored),
  };
}

/** What a collision handler does. begin and preSolve answer false for shapes that shall not collide: for as long as
 * they touch, or for this step. What would add or remove objects is refused, and belongs into World.afterStep. */
export interface ContactHandler {
  begin?(contact: Contact): boolean | void;
  preSolve?(contact: Contact): boolean | void;
  postSolve?(contact: Contact): void;
  separate?(contact: Contact): void;
}

/** A contact as a handler sees it; it lives for the call only. */
export class Contact {
  constructor(
    readonly world: World,
    readonly pointer: number,
  ) {}
  #check(status: number): void {
    this.world.core.check(status, this.world.pointer);
  }
  get state(): ContactState {
    const { core } = this.world;
    return core.withStack(abi.contact_state.size_of, (at) => {
      this.#check(core.call.samestep_contact_get(this.pointer, at));
      return readContact(core, at);
    });
  }
  /** For this step only. */
  setFriction(value: number): void {
    this.#check(this.world.core.call.samestep_contact_set_friction(this.pointer, value));
  }
  /** For this step only. */
  setRestitution(value: number): void {
    this.#check(this.world.core.call.samestep_contact_set_restitution(this.pointer, value));
  }
  /** Of the surface of B against A, m/s, for this step only. */
  setSurfaceVelocity({ x, y }: Vec2): void {
    this.#check(this.world.core.call.samestep_contact_set_surface_velocity(this.pointer, x, y));
  }
  /** Lets the shapes pass through each other until they separate. */
  ignore(): void {
    this.#check(this.world.core.call.samestep_contact_ignore(this.pointer));
  }
}
