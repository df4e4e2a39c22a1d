// SPDX-License-Identifier: MIT
// The game that both peers play: two discs and some crates in a room. It goes by the world and the inputs alone.
import { type Engine, id, type PlayerInput, type World } from 'samestep';

export const LEFT = 1;
export const RIGHT = 2;
export const JUMP = 4;
export const WIDTH = 16;
export const HEIGHT = 10;
export const CRATE = 0.7;
export const RADIUS = 0.6;

/** Players have the ids 1 and 2, crates those from 10 on. */
export const player = (seat: number): number => id(1 + seat);

export function createRoom(engine: Engine, crates: number): World {
  const world = engine.createWorld({ gravity: { x: 0, y: -10 } });
  const corners = [[0, 0], [WIDTH, 0], [WIDTH, 2 * HEIGHT], [0, 2 * HEIGHT]] as const;
  corners.forEach(([x, y], i) => {
    const [toX, toY] = corners[(i + 1) % 4]!;
    world.staticBody.addShape({
      kind: 'segment', id: id(1 + i), a: { x, y }, b: { x: toX, y: toY }, radius: 0.1, friction: 0.7,
    });
  });
  for (const seat of [0, 1]) {
    world.addBody({ id: player(seat), position: { x: seat === 0 ? 2 : WIDTH - 2, y: 1 } })
      .addShape({ kind: 'circle', id: id(5 + seat), radius: RADIUS, density: 2, friction: 0.9 });
  }
  const across = 8;
  for (let n = 0; n < crates; ++n) {
    const [column, row] = [n % across, Math.floor(n / across)];
    world.addBody({ id: id(10 + n), position: { x: 5 + column * 0.75, y: 0.5 + row * 0.75 } })
      .addShape({ kind: 'box', id: id(10 + n), width: CRATE, height: CRATE, density: 1, friction: 0.6 });
  }
  return world;
}

export function applyInputs(world: World, players: readonly PlayerInput[]): void {
  players.forEach(({ held, present }, seat) => {
    const keys = held[0] ?? 0;
    if (!present || keys === 0) return;
    const body = world.body(player(seat));
    const { position, velocity, mass } = body.state;
    const way = Number((keys & RIGHT) !== 0) - Number((keys & LEFT) !== 0);
    if (way !== 0 && Math.abs(velocity.x) < 9) body.applyImpulse({ x: way * mass * 0.5, y: 0 });
    const stands = world.querySegment(position, { x: position.x, y: position.y - RADIUS - 0.1 })
      .some((hit) => world.shape(hit.shape).state.body !== body.id);
    if ((keys & JUMP) !== 0 && stands && velocity.y < 1) body.applyImpulse({ x: 0, y: mass * 6 });
  });
}
