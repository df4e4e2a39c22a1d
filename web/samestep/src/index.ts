// SPDX-License-Identifier: MIT
import { type Engine, type InitOptions, load } from './engine.js';
export * from './api.js';

/** Loads the engine with worlds of fixed. */
export const init = (options?: InitOptions): Promise<Engine> =>
  load({
    simd: () => new URL('./fixed-simd.wasm', import.meta.url),
    plain: () => new URL('./fixed.wasm', import.meta.url),
  }, options);
