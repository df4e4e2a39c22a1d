// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import type { Vec2 } from './core.js';
import { type ShapeDef, withShape } from './definitions.js';
import { type BodyId, high, low, type ShapeId } from './id.js';
import type { World } from './world.js';

/** What a shape is. */
export interface ShapeState {
  id: ShapeId;
  body: BodyId;
  kind: 'circle' | 'segment' | 'polygon';
  sensor: boolean;
  radius: number;
  mass: number;
  density: number;
  area: number;
  centerOfMass: Vec2;
  friction: number;
  elasticity: number;
  surfaceVelocity: Vec2;
  collisionType: number;
  group: number;
  category: number;
  mask: number;
}

/** A shape of a world, by its id. */
export class Shape {
  readonly #low: number;
  readonly #high: number;
  constructor(
    readonly world: World,
    readonly id: ShapeId,
  ) {
    this.#low = low(id);
    this.#high = high(id);
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
      this.#check(core.call.samestep_shape_exists(pointer, this.#low, this.#high, at));
      return core.i32[at >> 2] === 1;
    });
  }
  /** All of it but its vertices. */
  get state(): ShapeState {
    const { core, pointer } = this.world;
    const place = abi.shape_state;
    return core.withStack(place.size_of, (at) => {
      this.#check(core.call.samestep_shape_get(pointer, this.#low, this.#high, at));
      const number = (field: number) => core.f64[(at + field) >> 3]!;
      const whole = (field: number) => core.u32[(at + field) >> 2]!;
      return {
        id: this.id,
        body: core.id(at + place.body),
        kind: (['circle', 'segment', 'polygon'] as const)[whole(place.kind)]!,
        sensor: whole(place.sensor) === 1,
        radius: number(place.radius),
        mass: number(place.mass),
        density: number(place.density),
        area: number(place.area),
        centerOfMass: core.vec2(at + place.center_of_mass),
        friction: number(place.friction),
        elasticity: number(place.elasticity),
        surfaceVelocity: core.vec2(at + place.surface_velocity),
        collisionType: whole(place.collision_type),
        group: whole(place.group),
        category: whole(place.category),
        mask: whole(place.mask),
      };
    });
  }
  /** In the coordinates of its body: of a circle the centre, of a segment its ends, of a polygon its corners,
   * counter-clockwise. */
  get vertices(): Vec2[] {
    const { core, pointer } = this.world;
    return core.withStack(8, (at) => {
      this.#check(core.call.samestep_shape_get_vertices(pointer, this.#low, this.#high, at, at + 4));
      const [first, count] = [core.u32[at >> 2]!, core.u32[(at + 4) >> 2]!];
      return Array.from({ length: count }, (_, i) => core.vec2(first + 16 * i));
    });
  }
  /** Makes it what the definition says; it keeps its id and body. */
  replace(def: ShapeDef): void {
    withShape(this.world.core, def, (at) => this.#check(
      this.#call.samestep_shape_replace(this.world.pointer, this.#low, this.#high, at)));
  }
  setFriction(value: number): void {
    this.#check(this.#call.samestep_shape_set_friction(this.world.pointer, this.#low, this.#high, value));
  }
  setElasticity(value: number): void {
    this.#check(this.#call.samestep_shape_set_elasticity(this.world.pointer, this.#low, this.#high, value));
  }
  /** kg/m^2 */
  setDensity(value: number): void {
    this.#check(this.#call.samestep_shape_set_density(this.world.pointer, this.#low, this.#high, value));
  }
  /** kg */
  setMass(value: number): void {
    this.#check(this.#call.samestep_shape_set_mass(this.world.pointer, this.#low, this.#high, value));
  }
  /** m/s */
  setSurfaceVelocity({ x, y }: Vec2): void {
    this.#check(this.#call.samestep_shape_set_surface_velocity(this.world.pointer, this.#low, this.#high, x, y));
  }
  setFilter(group: number, category: number, mask: number): void {
    this.#check(this.#call.samestep_shape_set_filter(
      this.world.pointer, this.#low, this.#high, group, category, mask));
  }
  setCollisionType(type: number): void {
    this.#check(this.#call.samestep_shape_set_collision_type(this.world.pointer, this.#low, this.#high, type));
  }
  setSensor(sensor: boolean): void {
    this.#check(this.#call.samestep_shape_set_sensor(this.world.pointer, this.#low, this.#high, sensor ? 1 : 0));
  }
  /** Takes it away. */
  remove(): void {
    this.#check(this.#call.samestep_shape_destroy(this.world.pointer, this.#low, this.#high));
  }
}
