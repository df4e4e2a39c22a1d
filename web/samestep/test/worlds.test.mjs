// Worlds of the installed package.
import assert from 'node:assert/strict';
import test from 'node:test';
import { generationOf, id, indexOf, init, SamestepError } from 'samestep';

const engine = await init();
const worldWithBall = (target = engine) => {
  const world = target.createWorld({ gravity: { x: 0, y: -10 } });
  world.staticBody.addShape({ kind: 'segment', id: id(1), a: { x: -20, y: 0 }, b: { x: 20, y: 0 }, friction: 0.5, elasticity: 1 });
  const ball = world.addBody({ id: id(1), position: { x: 0, y: 5 } });
  ball.addShape({ kind: 'circle', id: id(2), radius: 1, density: 1, elasticity: 0.5 });
  return { world, ball };
};
const steps = (world, count) => {
  for (let i = 0; i < count; ++i) world.step(60);
};
const refused = (code) => (error) => error instanceof SamestepError && error.code === code && error.message !== '';

test('a module made before makes another engine of the same fingerprint', async () => {
  const other = await init({ wasm: engine.module });
  assert.equal(other.fingerprint(), engine.fingerprint());
  const [a, b] = [worldWithBall(engine), worldWithBall(other)];
  steps(a.world, 60);
  steps(b.world, 60);
  assert.equal(a.world.hash, b.world.hash);
});

test('ids are whole numbers of an index and a generation', () => {
  assert.deepEqual([indexOf(id(7, 3)), generationOf(id(7, 3))], [7, 3]);
  assert.throws(() => id(65536), RangeError);
  assert.throws(() => id(1, 2), RangeError);
  const { world, ball } = worldWithBall();
  assert.equal(ball.id, id(1));
  assert.equal(world.body(id(1)).exists, true);
  assert.equal(world.body(id(1, 3)).exists, false);
  assert.equal(world.body(5).exists, false);
  world.dispose();
});

test('given ids make a world independent of the order of creation', () => {
  const hashes = [[3, 4, 5], [5, 3, 4]].map((order) => {
    const { world } = worldWithBall();
    for (const n of order) {
      world.addBody({ id: id(n), position: { x: n, y: n } })
        .addShape({ kind: 'box', id: id(n), width: 1, height: 1, density: 2, friction: 0.4 });
    }
    steps(world, 90);
    return world.hash;
  });
  assert.equal(hashes[0], hashes[1]);
});

test('a body is what its definition says, and takes what is set', () => {
  const { world } = worldWithBall();
  const body = world.addBody({
    id: id(9), type: 'kinematic', position: { x: 1, y: 2 }, angle: 0.5, velocity: { x: 3, y: 4 }, angularVelocity: 5,
    userData: 2n ** 63n + 1n,
  });
  const state = body.state;
  assert.deepEqual([state.type, state.position, state.angle, state.velocity, state.angularVelocity],
    ['kinematic', { x: 1, y: 2 }, 0.5, { x: 3, y: 4 }, 5]);
  assert.equal(body.userData, 2n ** 63n + 1n);
  body.position = { x: -1, y: 8 };
  body.velocity = { x: 0, y: 1 };
  body.userData = 12;
  assert.deepEqual([body.position, body.velocity, body.userData], [{ x: -1, y: 8 }, { x: 0, y: 1 }, 12n]);
  assert.deepEqual(body.toLocal(body.toWorld({ x: 0, y: 0 })), { x: 0, y: 0 });
  body.remove();
  assert.equal(body.exists, false);
});

test('shapes of all kinds have their vertices, and replace keeps the id', () => {
  const { world, ball } = worldWithBall();
  const body = world.addBody({ id: id(3) });
  const triangle = [{ x: 0, y: 0 }, { x: 1, y: 0 }, { x: 0, y: 1 }];
  const shape = body.addShape({ kind: 'polygon', id: id(3), vertices: triangle, exact: true, density: 1 });
  assert.deepEqual(shape.vertices, triangle);
  assert.equal(shape.state.kind, 'polygon');
  shape.replace({ kind: 'box', width: 2, height: 2, density: 1 });
  assert.deepEqual([shape.id, shape.vertices.length, body.mass], [id(3), 4, 4]);
  assert.deepEqual(body.shapes.map((of) => of.id), [id(3)]);
  assert.equal(ball.shapes[0].state.radius, 1);
});

test('poses stand in one array, and are made anew when memory grows', () => {
  const { world, ball } = worldWithBall();
  const before = world.writePoses();
  assert.deepEqual([...before.ids], [world.staticBody.id, ball.id]);
  assert.deepEqual([...before.values.slice(4)], [0, 5, 1, 0]);
  const many = engine.createWorld();
  for (let n = 1; before.values.length > 0; ++n) {
    assert.ok(n < 60000, 'memory grows');
    many.addBody({ id: id(n) });
  }
  assert.deepEqual([...world.writePoses().values.slice(4)], [0, 5, 1, 0]);
  many.dispose();
});

test('events list what began to touch, what ceased to, and what struck how hard', () => {
  const { world } = worldWithBall();
  world.listEvents({ contacts: true, impacts: true, slowestImpact: 1 });
  const seen = { begins: 0, ends: 0, fastest: 0 };
  for (let i = 0; i < 240; ++i) {
    world.step(60);
    seen.begins += world.events.begins.length;
    seen.ends += world.events.ends.length;
    for (const impact of world.events.impacts) {
      assert.deepEqual([impact.shapeA, impact.shapeB, impact.bodyB], [id(1), id(2), id(1)]);
      seen.fastest = Math.max(seen.fastest, impact.speed);
    }
  }
  assert.ok(seen.begins >= 2 && seen.ends >= 1, `${seen.begins} and ${seen.ends}`);
  assert.ok(seen.fastest > 8 && seen.fastest < 10, `${seen.fastest}`);
  assert.equal(world.contacts(id(1))[0].points.length, 1);
});

test('queries find shapes by rising id', () => {
  const { world } = worldWithBall();
  const [hit] = world.querySegment({ x: 0, y: 10 }, { x: 0, y: 1 });
  assert.deepEqual([hit.shape, hit.normal], [id(2), { x: 0, y: 1 }]);
  assert.ok(Math.abs(hit.point.y - 6) < 1e-6);
  assert.deepEqual(world.queryPoint({ x: 0, y: 5 }).map((found) => found.shape), [id(2)]);
  assert.deepEqual(world.queryBox({ left: -9, bottom: -1, right: 9, top: 9 }), [id(1), id(2)]);
  assert.deepEqual(world.queryBox({ left: -9, bottom: -1, right: 9, top: 9 }, { mask: 0 }), []);
});

test('handlers change contacts, and what they throw ends the step and leaves all usable', () => {
  const { world, ball } = worldWithBall();
  world.registerHandler(1000, { begin: () => false });
  world.addDefaultHandler(1000);
  steps(world, 90);
  assert.ok(ball.position.y < -1, 'it fell through');
  const { world: second } = worldWithBall();
  second.registerHandler(1000, { begin() { throw new TypeError('mine'); } });
  second.addDefaultHandler(1000);
  assert.throws(() => steps(second, 90), /mine/);
  steps(second, 1);
  const { world: third, ball: ball3 } = worldWithBall();
  third.registerHandler(1001, {
    begin: () => void third.afterStep(1, () => ball3.remove()),
  });
  third.addDefaultHandler(1001);
  steps(third, 90);
  assert.equal(ball3.exists, false);
});

test('joints hold bodies together, break, and are what their definitions say', () => {
  const { world, ball } = worldWithBall();
  const hinge = world.addJoint({
    kind: 'revolute', id: id(1), bodyA: world.staticBody.id, bodyB: ball.id, anchorA: { x: 0, y: 8 }, anchorB: { x: 0, y: 3 },
  });
  assert.deepEqual([hinge.definition.kind, hinge.definition.anchorB, world.jointCount], ['revolute', { x: 0, y: 3 }, 1]);
  steps(world, 60);
  assert.ok(Math.abs(ball.position.y - 5) < 0.1, `${ball.position.y}`);
  assert.ok(hinge.load.force.y > 20, 'it bears the ball');
  assert.deepEqual(ball.joints.map((joint) => joint.id), [id(1)]);
  assert.throws(() => world.joint(id(9)).definition, refused('JOINT_NOT_FOUND'));
  assert.throws(() => world.addJoint({ kind: 'weld', bodyA: ball.id, bodyB: ball.id }), refused('ILLEGAL_JOINT'));
  world.apply({ kind: 'unjoin', joint: id(1) });
  assert.equal(hinge.exists, false);
  world.apply({ kind: 'join', joined: { kind: 'distance', bodyA: world.staticBody.id, bodyB: ball.id, rest: 5 } });
  steps(world, 30);
  assert.equal(world.jointCount, 1);
});

test('functions of the game move bodies', () => {
  const { world, ball } = worldWithBall();
  world.registerVelocityFunction(5, (body, gravity, damping, seconds) =>
    body.updateVelocity({ x: 0, y: -gravity.y }, damping, seconds));
  ball.setFunctions(0, 5);
  steps(world, 30);
  assert.ok(ball.position.y > 5);
});

test('saved worlds and snapshots go on bit by bit', () => {
  const { world } = worldWithBall();
  const slot = engine.createSlot();
  assert.throws(() => world.restore(slot), refused('FOREIGN_WORLD'));
  steps(world, 50);
  world.save(slot);
  const bytes = world.snapshot();
  steps(world, 50);
  const hash = world.hash;
  const [low, high] = world.hashHalves();
  assert.equal(high.toString(16).padStart(8, '0') + low.toString(16).padStart(8, '0'), hash);
  world.restore(slot);
  assert.equal(world.tick, 50);
  const other = engine.createWorld();
  other.readSnapshot(bytes);
  assert.equal(world.difference(other), '');
  steps(world, 50);
  steps(other, 50);
  assert.deepEqual([world.hash, other.hash], [hash, hash]);
  other.body(id(1)).velocity = { x: 1, y: 0 };
  assert.match(world.difference(other), /body 1: velocity\.x/);
  assert.equal(engine.snapshotInfo(bytes).size, bytes.length);
  slot.dispose();
  assert.throws(() => world.save(slot), refused('DISPOSED'));
});

test('settings are set all or none', () => {
  const { world } = worldWithBall();
  world.configure({ iterations: 20, gravity: { x: 1, y: 2 }, solver: 'sequential-impulses' });
  const settings = world.settings;
  assert.deepEqual([settings.iterations, settings.gravity, settings.solver], [20, { x: 1, y: 2 }, 'sequential-impulses']);
  assert.throws(() => world.configure({ damping: 0.5, iterations: 0 }), refused('INVALID_ITER'));
  assert.deepEqual(world.settings, settings);
});

test('bytes from outside are refused in words', () => {
  const { world } = worldWithBall();
  const hash = world.hash;
  for (const bytes of [new Uint8Array(), new Uint8Array(100), crypto.getRandomValues(new Uint8Array(1000))]) {
    assert.throws(() => world.readSnapshot(bytes), refused('MALFORMED_BYTES'));
    assert.throws(() => engine.verify(bytes), refused('MALFORMED_BYTES'));
    assert.throws(() => engine.openRecording(bytes), refused('MALFORMED_BYTES'));
  }
  const cut = world.snapshot().subarray(0, 200);
  assert.throws(() => world.readSnapshot(cut), refused('MALFORMED_BYTES'));
  assert.equal(world.hash, hash);
});

test('a million refusals leave every world usable and take no memory', () => {
  const { world, ball } = worldWithBall();
  const other = worldWithBall();
  steps(other.world, 10);
  const hash = world.hash;
  const nobody = world.body(id(77));
  const kinds = [
    () => (ball.mass = -1), () => nobody.position, () => (nobody.velocity = { x: 0, y: 0 }),
    () => world.addBody({ id: id(1) }), () => ball.addShape({ kind: 'circle', radius: -1 }),
    () => world.readSnapshot(new Uint8Array(8)), () => world.step(0), () => world.queryPoint({ x: NaN, y: 0 }),
  ];
  const size = engine.core.buffer.byteLength;
  Error.stackTraceLimit = 0;
  for (let i = 0; i < 1e6; ++i) {
    try {
      kinds[i % kinds.length]();
    } catch (error) {
      if (error instanceof SamestepError) continue;
      throw error;
    }
    assert.fail(`refusal ${i} was none`);
  }
  Error.stackTraceLimit = 10;
  assert.equal(engine.core.buffer.byteLength, size);
  assert.equal(world.hash, hash);
  steps(world, 10);
  assert.equal(world.hash, other.world.hash);
});

test('an engine out of memory says so, and its worlds go on', async () => {
  const small = await init({ wasm: engine.module, maxMemory: 8 });
  const { world } = worldWithBall(small);
  const { world: twin } = worldWithBall();
  const kept = [];
  const fill = () => {
    for (;;) kept.push(small.createWorld().staticBody);
  };
  assert.throws(fill, refused('OUT_OF_MEMORY'));
  assert.throws(() => small.verify(new Uint8Array(16 << 20)), refused('OUT_OF_MEMORY'));
  for (const body of kept.splice(0, 10)) body.world.dispose();
  steps(world, 60);
  steps(twin, 60);
  assert.equal(world.hash, twin.hash);
});

test('what has been disposed of says so', () => {
  const { world, ball } = worldWithBall();
  world.dispose();
  world.dispose();
  assert.throws(() => world.step(60), refused('DISPOSED'));
  assert.throws(() => ball.position, refused('DISPOSED'));
});
