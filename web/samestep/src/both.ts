// SPDX-License-Identifier: MIT
import { type Engine, type InitOptions, load } from './engine.js';
export * from './api.js';

/** Loads the engine with both scalars. */
export const init = (options?: InitOptions): Promise<Engine> =>
  load({
    simd: () => new URL('./both-simd.wasm', import.meta.url),
    plain: () => new URL('./both.wasm', import.meta.url),
  }, options);
