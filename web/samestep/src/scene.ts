// SPDX-License-Identifier: MIT
import type { Contact, ContactHandler } from './contact.js';
import type { Vec2 } from './core.js';
import type { BodyDef, BodyType, Settings, ShapeDef, Surface } from './definitions.js';
import type { Engine } from './engine.js';
import type { BodyId } from './id.js';
import type { Command, Recorder } from './recording.js';
import type { Scalar, World } from './world.js';

type Pair = [number, number];
type SceneShape = Surface & {
  circle?: number;
  offset?: Pair;
  box?: Pair;
  segment?: [Pair, Pair];
  neighbors?: [Pair, Pair];
  polygon?: Pair[];
  hull?: Pair[];
  radius?: number;
  surfaceVelocity?: Pair;
};
interface SceneBody {
  name?: string;
  type?: BodyType;
  rotates?: boolean;
  position?: Pair;
  velocity?: Pair;
  angle?: number;
  angularVelocity?: number;
  mass?: number;
  moment?: number;
  userData?: number;
  maySleep?: boolean;
  shapes?: SceneShape[];
  grid?: { rows?: number; columns?: number; across?: Pair; up?: Pair };
  csv?: string;
}
interface SceneEvent {
  tick: number;
  do: string;
  body: string | SceneBody;
  value?: Pair | number;
  arm?: Pair;
}
/** A scene as the files of examples/scenes have it. Those that name other files cannot be played here. */
export interface SceneFile {
  stepsPerSecond?: number;
  settings?: Omit<Settings, 'gravity' | 'solver'> & { gravity?: Pair; solver?: string };
  handlers?: { do: string; types?: Pair; type?: number }[];
  bodies: SceneBody[];
  events?: SceneEvent[];
  inputs?: unknown;
}

const vec = ([x, y]: Pair): Vec2 => ({ x, y });

function shapeOf(from: SceneShape): ShapeDef {
  const { circle, offset, box, segment, neighbors, polygon, hull, surfaceVelocity, radius = 0, ...rest } = from;
  const surface: Surface = { ...rest, ...(surfaceVelocity && { surfaceVelocity: vec(surfaceVelocity) }) };
  if (circle !== undefined) return { ...surface, kind: 'circle', radius: circle, ...(offset && { center: vec(offset) }) };
  if (box !== undefined) return { ...surface, kind: 'box', width: box[0], height: box[1], radius };
  if (segment !== undefined) {
    const [a, b] = segment.map(vec) as [Vec2, Vec2];
    const beyond = neighbors && { previous: vec(neighbors[0]), next: vec(neighbors[1]) };
    return { ...surface, kind: 'segment', a, b, radius, ...beyond };
  }
  const vertices = (polygon ?? hull ?? []).map(vec);
  return { ...surface, kind: 'polygon', vertices, radius, exact: polygon !== undefined };
}

function bodyOf(from: SceneBody, position: Vec2): BodyDef {
  const { name: _, shapes: _shapes, grid: _grid, csv: _csv, velocity, ...rest } = from;
  return { ...rest, position, ...(velocity && { velocity: vec(velocity) }) };
}

/** The handlers that scenes ask for by name, under the numbers that recordings know them by. */
function namedHandlers(world: World): Record<string, [number, ContactHandler]> {
  const bodyB = (contact: Contact) => world.body(contact.state.bodyB);
  return {
    ignore: [1, { begin: () => false }],
    'one-way': [2, {
      preSolve(contact) {
        if (contact.state.normal.y < 0) contact.ignore();
        return contact.state.normal.y >= 0;
      },
    }],
    'bounce-pad': [3, { preSolve: (contact) => contact.setRestitution(1) }],
    count: [4, {
      begin({ state }) {
        for (const id of [state.bodyA, state.bodyB]) world.body(id).userData += 1n;
      },
    }],
    'separate-kick': [5, {
      separate(contact) {
        const body = bodyB(contact);
        if (body.type !== 'dynamic') return;
        const { x, y } = body.velocity;
        body.velocity = { x, y: Math.min(y + 1, 1024) };
      },
    }],
    conveyor: [6, {
      preSolve(contact) {
        const { normal } = contact.state;
        contact.setSurfaceVelocity({ x: -normal.y * 3, y: normal.x * 3 });
      },
    }],
    'remove-b': [7, {
      begin(contact) {
        const body = bodyB(contact);
        if (body.id === world.staticBody.id) return;
        world.afterStep(body.id % 2 ** 32, () => {
          if (body.exists) body.remove();
        });
      },
    }],
    slippery: [8, { preSolve: (contact) => contact.setFriction(0) }],
  };
}

/** A scene under way. */
export class Scene {
  readonly world: World;
  readonly rate: number;
  readonly #names = new Map<string, BodyId>();
  readonly #events: SceneEvent[];

  constructor(engine: Engine, file: SceneFile, scalar?: Scalar) {
    if (file.inputs !== undefined || file.bodies.some((body) => body.csv !== undefined)) {
      throw new Error('This scene names other files, which cannot be read here');
    }
    this.rate = file.stepsPerSecond ?? 60;
    const { gravity, solver, ...settings } = file.settings ?? {};
    this.world = engine.createWorld({
      ...settings,
      ...(scalar && { scalar }),
      ...(gravity && { gravity: vec(gravity) }),
      ...(solver && { solver: solver === 'soft step' ? 'soft-step' : 'sequential-impulses' }),
    });
    const named = namedHandlers(this.world);
    for (const entry of file.handlers ?? []) this.#addHandler(entry, named);
    for (const body of file.bodies) this.#addBodies(body);
    this.#events = [...(file.events ?? [])].sort((a, b) => a.tick - b.tick);
  }

  #addHandler(entry: { do: string; types?: Pair; type?: number }, named: ReturnType<typeof namedHandlers>): void {
    const found = named[entry.do];
    if (found === undefined) throw new Error(`There is no handler of the name ${entry.do}`);
    const [number, handler] = found;
    this.world.registerHandler(number, handler);
    if (entry.types !== undefined) this.world.addHandler(...entry.types, number);
    else if (entry.type !== undefined) this.world.addWildcardHandler(entry.type, number);
    else this.world.addDefaultHandler(number);
  }

  #addBodies(body: SceneBody): void {
    const { rows = 1, columns = 1, across = [0, 0], up = [0, 0] } = body.grid ?? {};
    for (let row = 0; row < rows; ++row) {
      for (let column = 0; column < columns; ++column) {
        const at = (axis: 0 | 1) => this.#moved((body.position ?? [0, 0])[axis], across[axis], column, up[axis], row);
        const made = this.world.apply(this.#spawn(body, { x: at(0), y: at(1) }));
        const number = body.grid === undefined ? '' : `.${row * columns + column}`;
        if (body.name !== undefined) this.#names.set(body.name + number, made);
      }
    }
  }
  #spawn(body: SceneBody, position: Vec2): Command {
    return { kind: 'spawn', body: bodyOf(body, position), shapes: (body.shapes ?? []).map(shapeOf) };
  }
  /** Computed as the world computes: a Fixed one in units of 2^-32. */
  #moved(origin: number, across: number, column: number, up: number, row: number): number {
    if (this.world.scalar === 'double') return origin + across * column + up * row;
    const raw = (x: number) => Math.round(x * 2 ** 32);
    return (raw(origin) + raw(across) * column + raw(up) * row) / 2 ** 32;
  }

  /** Does what is due and makes a step, by way of a recorder of its world where there is one. */
  step(recorder?: Recorder): void {
    const by = recorder ?? this.world;
    while (this.#events.length > 0 && this.#events[0]!.tick <= this.world.tick + 1) {
      const event = this.#events.shift()!;
      const command = this.#command(event);
      if (command === undefined) continue;
      const made = by.apply(command);
      if (typeof event.body !== 'string' && event.body.name !== undefined) this.#names.set(event.body.name, made);
    }
    if (recorder === undefined) this.world.step(this.rate);
    else recorder.step();
  }
  #command(event: SceneEvent): Command | undefined {
    if (typeof event.body !== 'string') return this.#spawn(event.body, vec(event.body.position ?? [0, 0]));
    const body = this.#names.get(event.body);
    if (body === undefined || !this.world.body(body).exists) return undefined;
    const pair: Pair = Array.isArray(event.value) ? event.value : [event.value ?? 0, 0];
    const value = vec(pair);
    const arm = vec(event.arm ?? [0, 0]);
    switch (event.do) {
      case 'impulse': return { kind: 'impulse', body, impulse: value, arm };
      case 'force': return { kind: 'force', body, force: value, arm };
      case 'velocity': return { kind: 'velocity', body, velocity: value };
      case 'angularVelocity': return { kind: 'angularVelocity', body, angularVelocity: pair[0] };
      case 'position': return { kind: 'position', body, position: value };
      case 'angle': return { kind: 'angle', body, angle: pair[0] };
      case 'remove': return { kind: 'remove', body };
      default: throw new Error(`A scene can do no ${event.do}`);
    }
  }
}

/** Plays a scene for some steps and records it. */
export function recordScene(engine: Engine, file: SceneFile, ticks: number, scalar?: Scalar): Uint8Array {
  const scene = new Scene(engine, file, scalar);
  const recorder = scene.world.record(scene.rate);
  try {
    for (let tick = 0; tick < ticks; ++tick) scene.step(recorder);
    return recorder.finish();
  } finally {
    recorder.dispose();
    scene.world.dispose();
  }
}
