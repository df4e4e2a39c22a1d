// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import type { Core, Vec2 } from './core.js';
import type { BodyId, ShapeId } from './id.js';

/** How a world is simulated; what is left out is as the engine has it. docs/c.md of the engine tells ranges. */
export interface Settings {
  /** 'soft-step' at first. */
  solver?: 'soft-step' | 'sequential-impulses';
  /** 'accurate' at first; 'fast' computes contacts of a Fixed world in integers of 32 bits. */
  precision?: 'accurate' | 'fast';
  iterations?: number;
  substeps?: number;
  collisionPersistence?: number;
  /** m/s^2; 0 at first. */
  gravity?: Vec2;
  damping?: number;
  collisionSlop?: number;
  collisionBias?: number;
  contactHertz?: number;
  contactDamping?: number;
  contactPushSpeed?: number;
  contactMargin?: number;
  bounceThreshold?: number;
  worldExtent?: number;
  /** Rest after which islands sleep, s; 0 at first: none does. */
  sleepTimeThreshold?: number;
  /** Bodies that are no faster are at rest, m/s. */
  idleSpeedThreshold?: number;
}

export type BodyType = 'dynamic' | 'kinematic' | 'static';
export const bodyTypes: readonly BodyType[] = ['dynamic', 'kinematic', 'static'];

/** What a new body is to be: dynamic and at rest at the origin where nothing else is said. */
export interface BodyDef {
  /** The game's own, made by id(): the world is then the same whatever the order of creation. Left out, the world
   * gives one. */
  id?: BodyId;
  type?: BodyType;
  /** false: no impulse turns it. */
  rotates?: boolean;
  userData?: number | bigint;
  /** Of its origin, m. */
  position?: Vec2;
  /** rad */
  angle?: number;
  /** Of its centre of mass, m/s. */
  velocity?: Vec2;
  /** rad/s */
  angularVelocity?: number;
  /** kg; left out: of its shapes. */
  mass?: number;
  /** kg m^2; left out: of its shapes. */
  moment?: number;
  positionFunction?: number;
  velocityFunction?: number;
}

/** What shapes of every kind have. */
export interface Surface {
  /** As of BodyDef. */
  id?: ShapeId;
  userData?: number | bigint;
  /** kg; adds nothing to the body where neither it nor a density is given. */
  mass?: number;
  /** kg/m^2 */
  density?: number;
  /** Coulomb's coefficient; that of a contact is the product of two. */
  friction?: number;
  /** 0: no bounce; that of a contact is the product of two. */
  elasticity?: number;
  surfaceVelocity?: Vec2;
  collisionType?: number;
  /** Shapes of the same group other than 0 do not touch. */
  group?: number;
  /** Shapes touch if the category of each has a bit of the mask of the other. */
  category?: number;
  mask?: number;
  /** Reports contacts and pushes nothing. */
  sensor?: boolean;
}
/** A shape by its kind, in the coordinates of its body, m. */
export type ShapeDef = Surface &
  (
    | { kind: 'circle'; radius: number; center?: Vec2 }
    | { kind: 'segment'; a: Vec2; b: Vec2; radius?: number; previous?: Vec2; next?: Vec2 }
    | { kind: 'box'; width: number; height: number; radius?: number }
    | { kind: 'polygon'; vertices: readonly Vec2[]; radius?: number; exact?: boolean }
  );

/** Which shapes a query asks about. */
export interface Filter {
  group?: number;
  category?: number;
  mask?: number;
}

const SETTING_NUMBERS = {
  damping: 'damping',
  collisionSlop: 'collision_slop',
  collisionBias: 'collision_bias',
  contactHertz: 'contact_hertz',
  contactDamping: 'contact_damping',
  contactPushSpeed: 'contact_push_speed',
  contactMargin: 'contact_margin',
  bounceThreshold: 'bounce_threshold',
  worldExtent: 'world_extent',
  sleepTimeThreshold: 'sleep_time_threshold',
  idleSpeedThreshold: 'idle_speed_threshold',
} as const;

/** Writes what is given over settings that stand in memory. */
export function writeSettings(core: Core, at: number, from: Settings): void {
  const place = abi.settings;
  const whole = (field: number, value: number | undefined) => {
    if (value !== undefined) core.i32[(at + field) >> 2] = value;
  };
  if (from.solver !== undefined) whole(place.solver, from.solver === 'soft-step' ? 1 : 0);
  if (from.precision !== undefined) whole(place.precision, from.precision === 'fast' ? 1 : 0);
  whole(place.iterations, from.iterations);
  whole(place.substeps, from.substeps);
  whole(place.collision_persistence, from.collisionPersistence);
  core.setVec2(at + place.gravity, from.gravity);
  for (const [name, field] of Object.entries(SETTING_NUMBERS) as [keyof typeof SETTING_NUMBERS, keyof typeof place][]) {
    const value = from[name];
    if (value !== undefined) core.f64[(at + place[field]) >> 3] = value;
  }
}

export function readSettings(core: Core, at: number): Required<Settings> {
  const place = abi.settings;
  const numbers = Object.fromEntries(
    Object.entries(SETTING_NUMBERS).map(([name, field]) => [name, core.f64[(at + place[field]) >> 3]!]),
  ) as Record<keyof typeof SETTING_NUMBERS, number>;
  return {
    ...numbers,
    solver: core.i32[(at + place.solver) >> 2] === 1 ? 'soft-step' : 'sequential-impulses',
    precision: core.i32[(at + place.precision) >> 2] === 1 ? 'fast' : 'accurate',
    iterations: core.i32[(at + place.iterations) >> 2]!,
    substeps: core.i32[(at + place.substeps) >> 2]!,
    collisionPersistence: core.u32[(at + place.collision_persistence) >> 2]!,
    gravity: core.vec2(at + place.gravity),
  };
}

/** Writes the definition of a body. */
export function writeBody(core: Core, at: number, from: BodyDef): void {
  const place = abi.body_def;
  core.call.samestep_body_def_init(at);
  const { i32, u32, f64 } = core;
  if (from.type !== undefined) i32[(at + place.type) >> 2] = bodyTypes.indexOf(from.type);
  if (from.rotates === false) i32[(at + place.rotates) >> 2] = 0;
  if (from.id !== undefined) core.setId(at + place.id, from.id);
  if (from.userData !== undefined) core.setBig(at + place.user_data, BigInt(from.userData));
  core.setVec2(at + place.position, from.position);
  core.setVec2(at + place.velocity, from.velocity);
  f64[(at + place.angle) >> 3] = from.angle ?? 0;
  f64[(at + place.angular_velocity) >> 3] = from.angularVelocity ?? 0;
  f64[(at + place.mass) >> 3] = from.mass ?? 0;
  f64[(at + place.moment) >> 3] = from.moment ?? 0;
  u32[(at + place.position_function) >> 2] = from.positionFunction ?? 0;
  u32[(at + place.velocity_function) >> 2] = from.velocityFunction ?? 0;
}

/** Bytes that the definition of a shape takes, its vertices included. */
export function sizeOfShape(def: ShapeDef): number {
  return abi.shape_def.size_of + (def.kind === 'polygon' ? def.vertices.length * abi.vec2.size_of : 0);
}

/** Writes the definition of a shape, and its vertices at `vertices`. */
export function writeShape(core: Core, at: number, from: ShapeDef, vertices = at + abi.shape_def.size_of): void {
  const place = abi.shape_def;
  core.call.samestep_shape_def_init(at);
  const { f64, u32, i32 } = core;
  if (from.id !== undefined) core.setId(at + place.id, from.id);
  if (from.userData !== undefined) core.setBig(at + place.user_data, BigInt(from.userData));
  const number = (field: number, value: number | undefined) => {
    if (value !== undefined) f64[(at + field) >> 3] = value;
  };
  number(place.mass, from.mass);
  number(place.density, from.density);
  number(place.friction, from.friction);
  number(place.elasticity, from.elasticity);
  number(place.radius, from.radius);
  core.setVec2(at + place.surface_velocity, from.surfaceVelocity);
  u32[(at + place.collision_type) >> 2] = from.collisionType ?? 0;
  u32[(at + place.group) >> 2] = from.group ?? 0;
  if (from.category !== undefined) u32[(at + place.category) >> 2] = from.category;
  if (from.mask !== undefined) u32[(at + place.mask) >> 2] = from.mask;
  i32[(at + place.sensor) >> 2] = from.sensor === true ? 1 : 0;
  writeGeometry(core, at, from, vertices);
}

function writeGeometry(core: Core, at: number, from: ShapeDef, vertices: number): void {
  const place = abi.shape_def;
  const { CIRCLE, SEGMENT, BOX, POLYGON, EXACT_POLYGON } = abi.constants;
  const { i32, u32, f64 } = core;
  const kind = (value: number) => {
    i32[(at + place.kind) >> 2] = value;
  };
  switch (from.kind) {
    case 'circle':
      kind(CIRCLE);
      core.setVec2(at + place.a, from.center);
      break;
    case 'segment':
      kind(SEGMENT);
      core.setVec2(at + place.a, from.a);
      core.setVec2(at + place.b, from.b);
      if (from.previous === undefined && from.next === undefined) break;
      core.setVec2(at + place.previous, from.previous ?? from.a);
      core.setVec2(at + place.next, from.next ?? from.b);
      i32[(at + place.has_neighbors) >> 2] = 1;
      break;
    case 'box':
      kind(BOX);
      f64[(at + place.width) >> 3] = from.width;
      f64[(at + place.height) >> 3] = from.height;
      break;
    case 'polygon':
      kind(from.exact === true ? EXACT_POLYGON : POLYGON);
      from.vertices.forEach((vertex, i) => core.setVec2(vertices + i * abi.vec2.size_of, vertex));
      u32[(at + place.vertices) >> 2] = vertices;
      u32[(at + place.vertex_count) >> 2] = from.vertices.length;
      break;
    default:
      kind(-1);
  }
}

/** Runs an action with a definition of a shape in memory. */
export function withShape<T>(core: Core, def: ShapeDef, action: (at: number) => T): T {
  return core.withMemory(sizeOfShape(def), (at) => {
    writeShape(core, at, def);
    return action(at);
  });
}

/** Runs an action with a filter in memory, or with 0 for none. */
export function withFilter<T>(core: Core, filter: Filter | undefined, action: (at: number) => T): T {
  if (filter === undefined) return action(0);
  return core.withStack(abi.filter.size_of, (at) => {
    core.u32.set([filter.group ?? 0, filter.category ?? 0xffffffff, filter.mask ?? 0xffffffff, 0], at >> 2);
    return action(at);
  });
}
