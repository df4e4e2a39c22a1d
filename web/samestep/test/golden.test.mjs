// Plays scenes to the hashes of the golden files, which native builds gave, with each core of the installed package.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import test from 'node:test';
import { init } from 'samestep';
import { init as initBoth } from 'samestep/both';
import { init as initDouble } from 'samestep/double';
import { init as initInline } from 'samestep/inline';
import { Scene } from 'samestep/scene';

const TICKS = Number(process.env.SAMESTEP_TICKS ?? 120);
const root = process.env.SAMESTEP_SOURCE;
const files = readdirSync(`${root}/examples/scenes`).filter((name) => name.endsWith('.json'));
const plain = (name) => readFileSync(fileURLToPath(new URL(`./${name}.wasm`, import.meta.resolve('samestep'))));

/** How many scenes played to their hashes. */
function playAll(engine, scalar) {
  let played = 0;
  for (const file of files) {
    const golden = `${root}/tests/golden/${file.slice(0, -5)}.${scalar}.txt`;
    const description = JSON.parse(readFileSync(`${root}/examples/scenes/${file}`, 'utf8'));
    if (!existsSync(golden) || 'inputs' in description || description.bodies.some((body) => 'csv' in body)) continue;
    const scene = new Scene(engine, description, scalar);
    for (const line of readFileSync(golden, 'utf8').trim().split('\n').slice(0, TICKS)) {
      const [tick, hash] = line.split(/\s+/);
      scene.step();
      assert.equal(scene.world.hash, hash, `${file}, ${scalar}, after step ${tick}`);
    }
    scene.world.dispose();
    ++played;
  }
  return played;
}

const cores = [
  ['fixed', init, undefined, 'fixed'], ['fixed without SIMD', init, 'fixed', 'fixed'],
  ['inline', initInline, undefined, 'fixed'], ['double', initDouble, undefined, 'double'],
  ['double without SIMD', initDouble, 'double', 'double'], ['both', initBoth, undefined, 'double'],
];
for (const [name, start, file, scalar] of cores) {
  test(`scenes have the hashes of native builds: ${name}`, async () => {
    const engine = await start(file === undefined ? {} : { wasm: plain(file) });
    assert.ok(playAll(engine, scalar) >= 10);
  });
}
