// Runs FOLDER/runner.js, built by Emscripten, and gives it the files of the present folder that the arguments
// name: node run_emscripten.mjs FOLDER ARGUMENT...
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const [folder, ...programArguments] = process.argv.slice(2);
const makeRunner = createRequire(import.meta.url)(`${folder}/runner.js`);
const runner = await makeRunner({ print: (line) => process.stdout.write(`${line}\n`) });
for (const name of programArguments.filter((argument) => existsSync(argument))) {
  runner.FS.writeFile(name, readFileSync(name));
}
process.exitCode = runner.callMain(programArguments);
