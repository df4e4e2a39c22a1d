// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import { Core } from './core.js';
import { SamestepError } from './error.js';
import type { Limits, WorldDef } from './world.js';
import { type Scalar, Slot, World } from './world.js';
import { Player, type Verdict, verify, type VerifyOptions, type Wiring } from './recording.js';

/** What init may be given. */
export interface InitOptions {
  /** In place of the package's own file: its address, its bytes, a response, or a module made before, as for another
   * Worker. */
  wasm?: string | URL | BufferSource | Response | WebAssembly.Module;
  /** The most memory that the engine takes, in MiB; 2048 at first. */
  maxMemory?: number;
}
/** Where the files of a core are. */
export interface CoreFiles {
  simd: () => URL | BufferSource | Promise<BufferSource>;
  plain: () => URL | BufferSource | Promise<BufferSource>;
}

/** The smallest module with an instruction of 128 bits. */
const SIMD = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

async function bytesAt(url: URL): Promise<BufferSource | Response> {
  const isFile = url.protocol === 'file:';
  if (!isFile) return fetch(url);
  // Node; a bundler for browsers must not look for it.
  const name = 'node:fs/promises';
  const { readFile } = (await import(/* @vite-ignore */ /* webpackIgnore: true */ name)) as
    { readFile(from: URL): Promise<Uint8Array<ArrayBuffer>> };
  return readFile(url);
}

async function compile(from: BufferSource | Response): Promise<WebAssembly.Module> {
  if (from instanceof ArrayBuffer || ArrayBuffer.isView(from)) return WebAssembly.compile(from);
  if (!from.ok) throw new Error(`The engine's file cannot be had: ${from.status} ${from.url}`);
  if (from.headers.get('content-type') === 'application/wasm') return WebAssembly.compileStreaming(from);
  return WebAssembly.compile(await from.arrayBuffer());
}

async function moduleOf(files: CoreFiles, wasm: InitOptions['wasm']): Promise<WebAssembly.Module> {
  if (wasm instanceof WebAssembly.Module) return wasm;
  const chosen = wasm ?? (await (WebAssembly.validate(SIMD) ? files.simd() : files.plain()));
  if (typeof chosen === 'string') return compile(await bytesAt(new URL(chosen, globalThis.location?.href)));
  return compile(chosen instanceof URL ? await bytesAt(chosen) : chosen);
}

/** Loads the engine; each call makes an instance of its own. */
export async function load(files: CoreFiles, { wasm, maxMemory = 2048 }: InitOptions = {}): Promise<Engine> {
  return new Engine(await moduleOf(files, wasm), maxMemory);
}

/** An instance of the engine. All that belongs together must be made by the same one. */
export class Engine {
  readonly core: Core;
  /** What this build computes with; worlds are of the first one unless they say otherwise. */
  readonly scalars: readonly Scalar[];

  constructor(
    /** To make further instances of, as in other Workers: init({ wasm: engine.module }). */
    readonly module: WebAssembly.Module,
    maxMemory: number,
  ) {
    this.core = new Core(module, maxMemory);
    const { call } = this.core;
    const { FIXED, DOUBLE } = abi.constants;
    if (call.samestep_c_version() !== abi.constants.C_VERSION) {
      throw new Error('This is not the wasm file of this version of the package');
    }
    this.scalars = (['fixed', 'double'] as const).filter((_, i) => call.samestep_scalar_built([FIXED, DOUBLE][i]!) === 1);
  }
  #scalar(wanted: Scalar | undefined): number {
    const scalar = wanted ?? this.scalars[0]!;
    if (scalar !== 'fixed' && scalar !== 'double') {
      throw new SamestepError('UNKNOWN_VALUE', `A scalar is 'fixed' or 'double', not '${String(scalar)}'.`);
    }
    return scalar === 'fixed' ? abi.constants.FIXED : abi.constants.DOUBLE;
  }

  get version(): string {
    return this.core.text(this.core.call.samestep_version());
  }
  /** Changes whenever any result of a step changes. */
  get revision(): number {
    return this.core.call.samestep_simulation_revision();
  }
  /** How it computes here: peers that differ would not stay in step. */
  fingerprint(scalar?: Scalar): string {
    return this.core.withStack(8, (at) => {
      this.core.check(this.core.call.samestep_fingerprint(this.#scalar(scalar), at));
      return this.core.hex(at);
    });
  }
  createWorld(def: WorldDef = {}): World {
    return World.create(this.core, def, this.#scalar(def.scalar));
  }
  /** A place to save worlds of a scalar in. */
  createSlot(scalar?: Scalar): Slot {
    return new Slot(this.core, this.#scalar(scalar));
  }
  /** Replays a recording, which may be anything, and compares the hash of every step. */
  verify(bytes: Uint8Array, options: VerifyOptions = {}): Verdict {
    return verify(this.core, bytes, options);
  }
  /** Opens a recording for somebody to look at. */
  openRecording(bytes: Uint8Array, options: { wiring?: Wiring; limits?: Limits } = {}): Player {
    return new Player(this.core, bytes, options);
  }
  /** What the first bytes of a snapshot say. */
  snapshotInfo(bytes: Uint8Array): { format: number; revision: number; scalar: Scalar; size: number } {
    const { core } = this;
    const place = abi.snapshot_info;
    return core.withBytes(bytes, (from, size) => core.withStack(place.size_of, (at) => {
      core.check(core.call.samestep_snapshot_get_info(from, size, at));
      return {
        format: core.u32[(at + place.format) >> 2]!,
        revision: core.u32[(at + place.revision) >> 2]!,
        scalar: core.i32[(at + place.scalar) >> 2] === abi.constants.FIXED ? 'fixed' : 'double',
        size: core.wide(at + place.size),
      };
    }));
  }
}
