// SPDX-License-Identifier: MIT
import { type Engine, type InitOptions, load } from './engine.js';
import { wasm } from './inline-wasm.js';
export * from './api.js';

const bytes = (): Uint8Array<ArrayBuffer> => Uint8Array.from(atob(wasm), (character) => character.charCodeAt(0));

/** Loads the engine, Fixed and without SIMD, out of the script itself: no further file is fetched. */
export const init = (options?: InitOptions): Promise<Engine> => load({ simd: bytes, plain: bytes }, options);
