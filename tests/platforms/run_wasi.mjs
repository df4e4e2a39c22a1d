// Runs FOLDER/runner under WASI, in the present folder: node run_wasi.mjs FOLDER ARGUMENT...
import { readFile } from 'node:fs/promises';
import { WASI } from 'node:wasi';

const [folder, ...programArguments] = process.argv.slice(2);
const wasi = new WASI({
  version: 'preview1',
  args: ['runner', ...programArguments],
  preopens: { '.': '.' },
  returnOnExit: true,
});
const module = await WebAssembly.compile(await readFile(`${folder}/runner`));
const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasi.wasiImport });
process.exitCode = wasi.start(instance);
