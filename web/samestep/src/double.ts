// SPDX-License-Identifier: MIT
import { type Engine, type InitOptions, load } from './engine.js';
export * from './api.js';

/** Loads the engine with worlds of double. */
export const init = (options?: InitOptions): Promise<Engine> =>
  load({
    simd: () => new URL('./double-simd.wasm', import.meta.url),
    plain: () => new URL('./double.wasm', import.meta.url),
  }, options);
