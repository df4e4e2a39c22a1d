// The installed package, bundled by what games use, plays to the same hash in Chromium as in Node.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import test from 'node:test';
import { open } from './browser.mjs';

const project = process.env.SAMESTEP_PROJECT;
const tools = new URL('../node_modules/.bin/', import.meta.url).pathname;

const game = (entry) => `
import { id, init } from '${entry}';
export async function play() {
  const engine = await init();
  const world = engine.createWorld({ gravity: { x: 0, y: -10 } });
  world.staticBody.addShape({ kind: 'segment', id: id(1), a: { x: -20, y: 0 }, b: { x: 20, y: 0 }, friction: 0.5 });
  for (let n = 1; n < 40; ++n) {
    world.addBody({ id: id(n), position: { x: (n % 5) * 0.9, y: 1 + n }, angle: n / 7 })
      .addShape({ kind: 'box', id: id(n + 1), width: 1, height: 0.8, density: 1, friction: 0.5 });
  }
  for (let tick = 0; tick < 240; ++tick) world.step(60);
  return world.hash;
}`;
const html = `<!doctype html><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'self'; script-src 'self' 'wasm-unsafe-eval'">
<link rel="icon" href="data:,"><script type="module" src="./main.js"></script>`;

/** Writes a game of its own with an entry of the package. */
function writeGame(name, entry, main) {
  const folder = `${project}/${name}`;
  mkdirSync(folder, { recursive: true });
  writeFileSync(`${folder}/game.js`, game(entry));
  writeFileSync(`${folder}/index.html`, html);
  writeFileSync(`${folder}/main.js`, main);
  return folder;
}
const MAIN = "import { play } from './game.js';\nplay().then((hash) => (document.title = hash));\n";

async function titleOf(folder) {
  const { page, errors, end } = await open(folder);
  try {
    await page.waitForFunction(() => /^[0-9a-f]{16}$/.test(document.title), undefined, { timeout: 60000 });
    assert.deepEqual(errors.filter((error) => !error.includes('favicon')), []);
    return await page.title();
  } finally {
    await end();
  }
}
function inNode(folder) {
  const script = "import { play } from './game.js'; console.log(await play());";
  return execFileSync(process.execPath, ['--input-type=module', '-e', script], { cwd: folder, encoding: 'utf8' }).trim();
}

test('Vite', async () => {
  const folder = writeGame('vite', 'samestep', MAIN);
  execFileSync(`${tools}vite`, ['build', folder, '--base', './', '--logLevel', 'warn']);
  assert.equal(await titleOf(`${folder}/dist`), inNode(folder));
});

test('Vite, in a Worker', async () => {
  const folder = writeGame('vite-worker', 'samestep/double', `
const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
worker.addEventListener('message', ({ data }) => (document.title = data));\n`);
  writeFileSync(`${folder}/worker.js`, "import { play } from './game.js';\nplay().then((hash) => postMessage(hash));\n");
  writeFileSync(`${folder}/vite.config.js`, "export default { worker: { format: 'es' } };\n");
  execFileSync(`${tools}vite`, ['build', folder, '--base', './', '--logLevel', 'warn']);
  assert.equal(await titleOf(`${folder}/dist`), inNode(folder));
});

test('esbuild, with the engine inside the script', async () => {
  const folder = writeGame('esbuild', 'samestep/inline', MAIN);
  mkdirSync(`${folder}/dist`, { recursive: true });
  execFileSync(`${tools}esbuild`, [`${folder}/main.js`, '--bundle', '--format=esm', '--log-level=warning',
    `--outfile=${folder}/dist/main.js`]);
  writeFileSync(`${folder}/dist/index.html`, html);
  assert.equal(await titleOf(`${folder}/dist`), inNode(folder));
});

test('no bundler: the files of the package as they are', async () => {
  const folder = writeGame('plain', '/node_modules/samestep/dist/index.js', MAIN);
  const { page, end } = await open(project, { path: 'plain/' });
  await page.waitForFunction(() => /^[0-9a-f]{16}$/.test(document.title), undefined, { timeout: 60000 });
  writeFileSync(`${folder}/game.js`, game('samestep'));
  assert.equal(await page.title(), inNode(folder));
  await end();
});
