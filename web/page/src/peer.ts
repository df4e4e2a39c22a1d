// SPDX-License-Identifier: MIT
// A peer of the match, in a Worker of its own.
import { indexOf, init, type Session, type World } from 'samestep';
import { applyInputs, createRoom, JUMP, LEFT, player, RIGHT } from './game.js';
import type { FromPeer, ToPeer } from './messages.js';

const post = (message: FromPeer, transfer: Transferable[] = []): void => {
  (self as unknown as Worker).postMessage(message, transfer);
};

const arrived: { from: number; bytes: Uint8Array }[] = [];
let held: number | undefined;
let flipAt: number | undefined;

/** What a player does whom nobody moves. */
function bot(seat: number, tick: number): number {
  const time = tick + seat * 37;
  return (Math.floor(time / 70) % 2 === seat ? LEFT : RIGHT) | (time % 90 < 4 ? JUMP : 0);
}

function poses(world: World): Float32Array {
  const { ids, values } = world.writePoses();
  const all = new Float32Array(4 * ids.length);
  ids.forEach((id, i) => {
    const [x, y, cosine, sine] = values.subarray(4 * i, 4 * i + 4) as unknown as [number, number, number, number];
    all.set([indexOf(id), x, y, Math.atan2(sine, cosine)], 4 * i);
  });
  return all;
}

async function begin({ seat, crates, joins, module }: Extract<ToPeer, { kind: 'begin' }>): Promise<void> {
  const engine = await init({ wasm: module });
  const world = createRoom(engine, crates);
  const hashes = new Map<number, string>();
  let told = 0;
  const session: Session = world.startSession({
    localSeat: seat,
    joins,
    maxHeldBytes: 1,
    hashInterval: 30,
    transport: {
      send: (to, bytes) => post({ kind: 'datagram', to, bytes }, [bytes.buffer]),
      receive: () => arrived.shift(),
    },
    applyInputs(of, tick, players) {
      hashes.set(tick, of.hash);
      // The lowest bit of a number of 64: what cosmic rays and mended memory do. It is done again when the tick is.
      if (tick === flipAt) of.body(player(1)).angularVelocity += 2 ** -32;
      applyInputs(of, players);
    },
  });
  const tellHashes = (confirmed: number): void => {
    // Who joins begins at a later tick.
    while (told < confirmed && !hashes.has(told)) ++told;
    for (; told <= confirmed && hashes.has(told); ++told) {
      if (told % 10 === 0) post({ kind: 'hash', tick: told, hash: hashes.get(told)! });
      hashes.delete(told - 32);
    }
  };
  let next = performance.now();
  const frame = (): void => {
    const start = performance.now();
    const { tick } = session.state;
    if (flipAt === -1) flipAt = tick + 20;
    session.frame(start, Uint8Array.of(held ?? bot(seat, tick)));
    const took = performance.now() - start;
    const { state } = session;
    tellHashes(Math.min(state.confirmed, state.tick));
    for (let event = session.nextEvent(); event !== undefined; event = session.nextEvent()) {
      const more = event.kind === 'located' ? `: ${session.desync}` : '';
      post({ kind: 'said', text: `${event.kind} at tick ${event.tick}${more}` });
    }
    const all = poses(world);
    post({ kind: 'frame', poses: all, state, took, memory: engine.core.buffer.byteLength }, [all.buffer]);
    next = Math.max(next + (1000 / 60) * (state.frameLength / 1000), performance.now() - 50);
    setTimeout(frame, Math.max(0, next - performance.now()));
  };
  frame();
}

self.addEventListener('message', ({ data }: MessageEvent<ToPeer>) => {
  switch (data.kind) {
    case 'begin':
      begin(data).catch((error: unknown) => post({ kind: 'said', text: String(error) }));
      break;
    case 'datagram':
      if (arrived.length < 1024) arrived.push(data);
      break;
    case 'held':
      held = data.keys;
      break;
    case 'flip':
      flipAt = -1;
  }
});
