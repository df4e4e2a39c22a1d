// What a game in TypeScript may write, and what it may not: checked, never run.
import { type BodyState, id, init, SamestepError, type SessionDef, type World } from 'samestep';
import { init as initBoth } from 'samestep/both';

const engine = await init({ maxMemory: 64 });
const world: World = engine.createWorld({ gravity: { x: 0, y: -10 }, substeps: 8 });
const body = world.addBody({ id: id(1), type: 'kinematic' });
body.addShape({ kind: 'box', width: 1, height: 2, friction: 0.5 });
const state: BodyState = body.state;
const height: number = state.position.y;
const poses: Float32Array = world.writePoses().values;
const bytes: Uint8Array = world.snapshot();
const session: Pick<SessionDef, 'localSeat'> = { localSeat: 0 };
try {
  world.apply({ kind: 'impulse', body: body.id, impulse: { x: 1, y: 0 } });
} catch (error) {
  if (error instanceof SamestepError && error.code === 'BODY_NOT_FOUND') console.log(error.message);
}
(await initBoth()).createWorld({ scalar: 'double' });
// @ts-expect-error A circle has a radius.
body.addShape({ kind: 'circle' });
// @ts-expect-error There is no such type of body.
world.addBody({ type: 'floating' });
// @ts-expect-error There is no such reason.
new SamestepError('NO_SUCH_CODE', '');
console.log(height, poses, bytes, session);
