// The viewer in Chromium: recordings made by the package, bytes that are none, two recordings that part.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { mkdtempSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import test from 'node:test';
import { id, init } from 'samestep';
import { recordScene } from 'samestep/scene';
import { open } from './browser.mjs';

const site = `${process.env.SAMESTEP_SITES}/viewer`;
const scenes = new URL('../../examples/scenes/', import.meta.url);
const folder = mkdtempSync(`${tmpdir()}/samestep-viewer-`);
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const engine = await init();

/** Writes a recording; answers its path. */
function write(name, bytes) {
  writeFileSync(`${folder}/${name}`, bytes);
  return `${folder}/${name}`;
}
/** A stack, and a box beside it that is pushed at tick 30. */
function stack(push) {
  const world = engine.createWorld({ gravity: { x: 0, y: -10 } });
  world.staticBody.addShape({ kind: 'segment', id: id(1), a: { x: -20, y: 0 }, b: { x: 20, y: 0 }, friction: 0.5 });
  for (let n = 2; n < 12; ++n) {
    world.addBody({ id: id(n), position: n === 7 ? { x: 5, y: 0.5 } : { x: 0, y: n < 7 ? n - 1.5 : n - 2.5 } })
      .addShape({ kind: 'box', id: id(n), width: 1, height: 1, density: 1, friction: 0.5 });
  }
  const recorder = world.record(60);
  for (let tick = 0; tick < 300; ++tick) {
    if (tick === 30) recorder.apply({ kind: 'impulse', body: id(7), impulse: { x: push, y: 0 } });
    recorder.step();
  }
  const bytes = recorder.finish();
  recorder.dispose();
  world.dispose();
  return bytes;
}

async function openViewer(options) {
  const opened = await open(site, options);
  await opened.page.waitForSelector('html[data-ready]', { timeout: 60000 });
  return opened;
}
const load = async (page, ...files) => {
  const before = await page.locator('.pane').count();
  await page.setInputFiles('#files', files);
  await page.waitForFunction((count) => document.querySelectorAll('.pane').length === count, before + files.length);
};
const tick = (page) => page.locator('#timeline').getAttribute('aria-valuenow').then(Number);
const tickIs = (page, wanted) => page.waitForFunction(
  (value) => document.getElementById('timeline').getAttribute('aria-valuenow') === String(value), wanted,
  { timeout: 120000 });

test('a recording is played, scrubbed and proven', async () => {
  const { page, errors, end } = await openViewer();
  await load(page, write('stack', stack(2)));
  await tickIs(page, 0);
  await page.keyboard.press('ArrowRight');
  await tickIs(page, 1);
  await page.selectOption('#speed', '16');
  await page.click('#play');
  await tickIs(page, 300);
  assert.match(await page.textContent('.words'), /proven/);
  const line = await page.locator('#timeline').boundingBox();
  await page.mouse.click(line.x + line.width / 2, line.y + 20);
  assert.ok(Math.abs((await tick(page)) - 150) <= 2);
  await page.keyboard.press('Home');
  await tickIs(page, 0);
  for (let i = 0; i < 30; ++i) await page.keyboard.press('ArrowRight');
  await tickIs(page, 30);
  await page.click('#about summary');
  await page.waitForFunction(() => /impulse: body 7/.test(document.getElementById('commands').textContent));
  for (const layer of ['contacts', 'velocities', 'ids', 'follow']) await page.check(`#${layer}`);
  await page.mouse.wheel(0, 100);
  await page.waitForTimeout(200);
  assert.deepEqual(errors, []);
  await end();
});

test('two recordings part where their commands do, and the body is named', async () => {
  const { page, errors, end } = await openViewer();
  await load(page, write('a', stack(2)), write('b', stack(2.5)));
  await page.click('#difference');
  await tickIs(page, 31);
  assert.match(await page.textContent('#found'), /After step 31: body 7/);
  assert.deepEqual(errors, []);
  await end();
});

test('a scene is played and recorded', async () => {
  const { page, end } = await openViewer();
  await load(page, new URL('example.json', scenes).pathname);
  await page.keyboard.press('End');
  await tickIs(page, 600);
  const file = JSON.parse(readFileSync(new URL('example.json', scenes), 'utf8'));
  const player = engine.openRecording(recordScene(engine, file, 600));
  assert.match(await page.textContent('.words'), new RegExp(player.hashAt(600)));
  await end();
});

test('bytes that are no recording are refused in words, and what is open stays', async () => {
  const { page, errors, end } = await openViewer();
  await load(page, write('good', stack(1)));
  const whole = stack(3);
  const changed = whole.slice();
  changed[whole.length >> 1] ^= 4;
  for (const [name, bytes] of [['empty', new Uint8Array()], ['noise', crypto.getRandomValues(new Uint8Array(5000))],
    ['changed', changed], ['json', Buffer.from('{"bodies": 7}')]]) {
    await page.setInputFiles('#files', write(name, bytes));
    await page.waitForFunction((start) => document.getElementById('message').textContent.startsWith(start), `${name}: `);
    assert.equal(await page.locator('.pane').count(), 1);
  }
  await page.keyboard.press('End');
  await tickIs(page, 300);
  assert.deepEqual(errors, []);
  await end();
});

test('nothing is wider than a telephone, light or dark, and all is accessible', async () => {
  for (const colorScheme of ['light', 'dark']) {
    const { page, end } = await openViewer({ width: 360, height: 640, colorScheme, bypassCSP: true, hasTouch: true });
    await load(page, write('a', stack(2)), write('b', stack(2.5)));
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
    await page.tap('#step');
    await tickIs(page, 1);
    await page.addScriptTag({ content: axe });
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map(({ id: rule, nodes }) => `${rule}: ${nodes[0].html}`), []);
    await end();
  }
});
