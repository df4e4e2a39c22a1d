// The page of two peers in Chromium.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import test from 'node:test';
import { open } from './browser.mjs';

const site = `${process.env.SAMESTEP_SITES}/page`;
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const SOAK_SECONDS = Number(process.env.SAMESTEP_SOAK ?? 10);

const agreed = (page, count) => page.waitForFunction(
  (wanted) => document.querySelectorAll('#list .same').length >= wanted, count, { timeout: 60000 });
const set = (page, name, value) => page.locator(`#${name}`).evaluate((input, to) => {
  input.value = to;
  input.dispatchEvent(new Event('input'));
}, String(value));
const number = async (page, seat, name) =>
  Number((await page.textContent(`#state${seat}`)).match(new RegExp(`${name} (\\d+)`))[1]);

test('peers agree under loss, roll back, and their memory does not grow', async () => {
  const { page, errors, end } = await open(site);
  await set(page, 'loss', 20);
  await set(page, 'jitter', 60);
  await agreed(page, 5);
  const memory = await number(page, 0, 'memory');
  const from = await number(page, 0, 'tick');
  await page.waitForTimeout(SOAK_SECONDS * 1000);
  assert.ok((await number(page, 0, 'tick')) > from);
  assert.ok((await number(page, 0, 'rollbacks')) > 0);
  assert.equal(await number(page, 0, 'memory'), memory);
  assert.equal(await page.locator('#list .other').count(), 0);
  assert.equal(await page.textContent('#verdict'), '');
  assert.deepEqual(errors, []);
  await end();
});

test('a flipped bit is found, and the body and its field are named', async () => {
  const { page, errors, end } = await open(site);
  await agreed(page, 3);
  await page.click('#flip');
  await page.waitForFunction(() => /located.*body \d+, \w+/.test(document.getElementById('verdict').textContent),
    undefined, { timeout: 60000 });
  assert.ok((await page.locator('#list .other').count()) > 0);
  await page.click('#anew');
  await agreed(page, 3);
  assert.equal(await page.textContent('#verdict'), '');
  assert.deepEqual(errors, []);
  await end();
});

test('a peer whose Worker has ended is dropped, and joins the match that goes on', async () => {
  const { page, errors, end } = await open(site);
  await agreed(page, 3);
  await page.click('#kill');
  await page.waitForFunction(() => /A: dropped/.test(document.getElementById('verdict').textContent),
    undefined, { timeout: 60000 });
  await page.waitForTimeout(1000);
  const before = await number(page, 0, 'tick');
  await page.click('#kill');
  await page.waitForFunction(() => /joined/.test(document.getElementById('verdict').textContent), undefined,
    { timeout: 60000 });
  await page.locator('#list').evaluate((list) => list.replaceChildren());
  await agreed(page, 3);
  assert.ok((await number(page, 1, 'tick')) > before);
  assert.equal(await page.locator('#list .other').count(), 0);
  assert.deepEqual(errors, []);
  await end();
});

test('keys move a player on both sides', async () => {
  const { page, end } = await open(site);
  await agreed(page, 3);
  await page.keyboard.down('KeyD');
  await agreed(page, 10);
  await page.keyboard.up('KeyD');
  assert.equal(await page.locator('#list .other').count(), 0);
  await end();
});

test('nothing is wider than a telephone, light or dark, and all is accessible', async () => {
  for (const colorScheme of ['light', 'dark']) {
    const { page, end } = await open(site, { width: 360, height: 640, colorScheme, bypassCSP: true, hasTouch: true });
    await agreed(page, 3);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
    await page.addScriptTag({ content: axe });
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), []);
    await end();
  }
});
