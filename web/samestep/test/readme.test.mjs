// The example of README, run as it stands, prints what README says.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import test from 'node:test';

test('the example of README prints what README says', () => {
  const readme = readFileSync(fileURLToPath(new URL('../README.md', import.meta.resolve('samestep'))), 'utf8');
  const [, example] = readme.match(/```js\n([^]*?)```/);
  const [, printed] = readme.match(/```\n(height[^]*?)```/);
  assert.ok(example.trim().split('\n').length <= 16);
  writeFileSync('example.mjs', example);
  assert.equal(execFileSync(process.execPath, ['example.mjs'], { encoding: 'utf8' }), printed);
});
