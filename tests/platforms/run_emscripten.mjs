// Runs FOLDER/runner.js, built by Emscripten: node run_emscripten.mjs FOLDER ARGUMENT...
import { createRequire } from 'node:module';

const [folder, ...programArguments] = process.argv.slice(2);
const makeRunner = createRequire(import.meta.url)(`${folder}/runner.js`);
const runner = await makeRunner({ print: (line) => process.stdout.write(`${line}\n`) });
process.exitCode = runner.callMain(programArguments);
