// Recordings and sessions of the installed package.
import assert from 'node:assert/strict';
import test from 'node:test';
import { dataChannelTransport, id, init } from 'samestep';

const engine = await init();
const room = () => {
  const world = engine.createWorld({ gravity: { x: 0, y: -10 } });
  world.staticBody.addShape({ kind: 'segment', id: id(1), a: { x: -20, y: 0 }, b: { x: 20, y: 0 }, friction: 0.5 });
  for (const n of [1, 2]) {
    world.addBody({ id: id(n), position: { x: 3 * n, y: 1 } })
      .addShape({ kind: 'box', id: id(n + 1), width: 1, height: 1, density: 1, friction: 0.5 });
  }
  return world;
};

/** A recording of 60 ticks with commands of several kinds. */
function record() {
  const world = room();
  const recorder = world.record(60);
  for (let tick = 0; tick < 60; ++tick) {
    if (tick === 5) recorder.apply({ kind: 'impulse', body: id(1), impulse: { x: 2, y: 3 } });
    if (tick === 9) {
      const spawned = recorder.apply({
        kind: 'spawn', body: { id: id(7), position: { x: 0, y: 6 } },
        shapes: [{ kind: 'circle', id: id(7), radius: 0.5, density: 1 },
          { kind: 'polygon', id: id(8), vertices: [{ x: 0, y: 0 }, { x: 1, y: 0 }, { x: 0, y: 1 }], density: 1 }],
      });
      assert.equal(spawned, id(7));
    }
    if (tick === 40) recorder.apply({ kind: 'remove', body: id(2) });
    recorder.step();
  }
  const bytes = recorder.finish();
  assert.throws(() => world.dispose(), { code: 'IN_USE' });
  recorder.dispose();
  const hash = world.hash;
  world.dispose();
  return { bytes, hash };
}

test('a recording is verified, and one with a changed byte is not', () => {
  const { bytes, hash } = record();
  const verdict = engine.verify(bytes, { expected: { rate: 60, ticks: 60, scalar: 'fixed' } });
  assert.deepEqual([verdict.matches, verdict.ticks, verdict.computedHash], [true, 60, hash]);
  assert.equal(engine.verify(bytes, { expected: { rate: 50 } }).unexpected, 'the time step');
  assert.equal(engine.verify(bytes, { progress: (done) => done < 5 }).stopped, true);
  assert.throws(() => engine.verify(bytes, { progress() { throw new RangeError('mine'); } }), /mine/);
  const changed = bytes.slice();
  changed[bytes.length >> 1] ^= 1;
  assert.throws(() => engine.verify(changed), { code: 'MALFORMED_BYTES' });
  assert.throws(() => engine.verify(bytes, { limits: { bytes: 100 } }), { code: 'MALFORMED_BYTES' });
});

test('a player goes forth and back to the recorded hashes', () => {
  const { bytes, hash } = record();
  const player = engine.openRecording(bytes);
  assert.deepEqual([player.ticks, player.scalar, player.whole], [60, 'fixed', true]);
  assert.equal(player.hashes.length, 2 * 61);
  assert.equal(player.hashAt(60), hash);
  player.seek(60);
  assert.deepEqual([player.world.hash, player.state.trust], [hash, 'proven']);
  assert.equal(player.step(), false);
  player.seek(10);
  assert.deepEqual([player.world.tick, player.world.hash], [10, player.hashAt(10)]);
  assert.deepEqual(player.commands.map(({ tick, kind, body }) => [tick, kind, body]),
    [[5, 'impulse', id(1)], [9, 'spawn', id(7)], [40, 'remove', id(2)]]);
  assert.match(player.describeCommand(0), /impulse: body 1/);
  assert.throws(() => player.describeCommand(3), { code: 'INDEX_OUT_OF_BOUNDS' });
  assert.throws(() => player.seek(61), { code: 'VALUE_OUT_OF_RANGE' });
  player.dispose();
});

test('inputs of the game are recorded as its own bytes', () => {
  const world = room();
  const push = (target, [force]) => target.body(id(1)).applyImpulse({ x: force, y: 0 });
  world.setInputFunction((bytes) => push(world, bytes));
  const recorder = world.record(60);
  recorder.apply({ kind: 'input', bytes: Uint8Array.of(3) });
  recorder.step();
  const bytes = recorder.finish();
  recorder.dispose();
  assert.throws(() => engine.verify(bytes), { code: 'MISSING_CALLBACK' });
  assert.equal(engine.verify(bytes, { wiring: { applyInput: push } }).matches, true);
});

/** Two queues between two peers, of which every seventh datagram is lost and each one is late. */
function lossyPair() {
  let now = 0;
  let sent = 0;
  const queues = [[], []];
  const transport = (seat) => ({
    send(to, bytes) {
      if (++sent % 7 !== 0) queues[to].push({ from: seat, bytes, at: now + 40 + (sent % 5) * 9 });
    },
    receive() {
      const index = queues[seat].findIndex((datagram) => datagram.at <= now);
      return index < 0 ? undefined : queues[seat].splice(index, 1)[0];
    },
  });
  return { transports: [transport(0), transport(1)], tickTo: (time) => { now = time; } };
}

/** The session of a seat in the match of the tests. */
function startSeat(world, localSeat, transport, more = {}) {
  return world.startSession({
    transport, localSeat, maxHeldBytes: 1, hashInterval: 20, dropAfter: 1000,
    applyInputs(of, _tick, players) {
      players.forEach(({ held, present }, seat) => {
        if (present && held.length === 1) of.body(id(seat + 1)).applyImpulse({ x: held[0] - 1, y: 0 });
      });
    },
    ...more,
  });
}

/** Plays so many frames; `each` may meddle with the worlds. */
function playMatch(frames, each = () => {}) {
  const net = lossyPair();
  const worlds = [room(), room()];
  const sessions = worlds.map((world, seat) => startSeat(world, seat, net.transports[seat]));
  const events = [];
  for (let frame = 0; frame < frames; ++frame) {
    net.tickTo(frame * 17);
    each(frame, worlds);
    sessions.forEach((session, seat) => {
      session.frame(frame * 17, Uint8Array.of((frame >> (3 + seat)) % 3));
      for (let event = session.nextEvent(); event !== undefined; event = session.nextEvent()) events.push({ seat, ...event });
    });
  }
  return { worlds, sessions, events };
}

test('two peers over a lossy network roll back and stay the same', () => {
  const { sessions, events } = playMatch(600);
  const [a, b] = sessions.map((session) => session.state);
  assert.equal(events.some((event) => event.kind === 'desync'), false);
  assert.ok(a.tick > 400 && b.tick > 400, `${a.tick} and ${b.tick}`);
  assert.ok(a.rollbacks + b.rollbacks > 10);
  assert.equal(a.badPackets + b.badPackets, 0);
  sessions.forEach((session) => {
    session.leave();
    session.dispose();
  });
});

test('a world that was changed behind the session is found and named', () => {
  const { sessions, events } = playMatch(400, (frame, worlds) => {
    if (frame === 200) worlds[1].body(id(2)).angularVelocity = 1;
  });
  assert.ok(events.some((event) => event.kind === 'desync'));
  assert.match(sessions[0].desync + sessions[1].desync, /body 2/);
});

test('a player whose machine went down joins the match that goes on', () => {
  const net = lossyPair();
  const frame = (session, number) => session.frame(number * 17, Uint8Array.of((number >> 4) % 3));
  const stays = startSeat(room(), 0, net.transports[0]);
  let other = startSeat(room(), 1, net.transports[1]);
  const seen = [];
  for (let number = 0; number < 900; ++number) {
    net.tickTo(number * 17);
    if (number === 200) other.dispose();
    if (number === 400) other = startSeat(room(), 1, net.transports[1], { joins: true });
    frame(stays, number);
    if (number < 200 || number >= 400) frame(other, number);
    for (const session of number < 200 || number >= 400 ? [stays, other] : [stays]) {
      for (let event = session.nextEvent(); event !== undefined; event = session.nextEvent()) seen.push(event.kind);
    }
  }
  assert.ok(seen.includes('dropped') && seen.includes('joined'), seen.join());
  assert.equal(seen.includes('desync'), false);
  assert.ok(other.state.tick > 600, `${other.state.tick}`);
});

test('a data channel carries datagrams', () => {
  const channel = Object.assign(new EventTarget(), { readyState: 'open', sent: [], send(bytes) { this.sent.push(bytes); } });
  const transport = dataChannelTransport(new Map([[1, channel]]));
  transport.send(1, Uint8Array.of(1, 2));
  transport.send(2, Uint8Array.of(3));
  assert.deepEqual(channel.sent, [Uint8Array.of(1, 2)]);
  const message = Object.assign(new Event('message'), { data: Uint8Array.of(9).buffer });
  channel.dispatchEvent(message);
  assert.deepEqual(transport.receive(), { from: 1, bytes: Uint8Array.of(9) });
  assert.equal(transport.receive(), undefined);
});
