// SPDX-License-Identifier: MIT
import type { Exports } from './abi.js';
import { codeOf, SamestepError } from './error.js';
import { fromHalves, high, low } from './id.js';

/** x and y, in metres unless something else is said. */
export interface Vec2 {
  x: number;
  y: number;
}

/** Functions of the game's under the numbers by which wasm knows them. */
export interface Callbacks {
  contact?(phase: number, contact: number, world: number): number;
  position?(world: number, body: number, seconds: number): void;
  velocity?(world: number, body: number, gravity: Vec2, damping: number, seconds: number): void;
  postStep?(): void;
  input?(world: number, bytes: Uint8Array): number;
  connect?(world: number): void;
  progress?(done: number, total: number): number;
  applyInputs?(world: number, tick: number, players: number, count: number): void;
  send?(to: number, bytes: Uint8Array): void;
  receive?(room: number): { from: number; bytes: Uint8Array } | undefined;
  saveOwn?(slot: number): void;
  loadOwn?(slot: number): void;
  hashOwn?(): readonly [number, number];
}

/** An instance of the engine: its functions, its memory, and what is called back from it. */
export class Core {
  readonly call: Exports;
  readonly #memory: WebAssembly.Memory;
  #buffer!: ArrayBufferLike;
  #u8!: Uint8Array;
  #u32!: Uint32Array;
  #i32!: Int32Array;
  #f64!: Float64Array;
  readonly #decoder = new TextDecoder();
  readonly #callbacks = new Map<number, Callbacks>();
  #nextKey = 1;
  #thrown: { error: unknown } | undefined;

  /** Its memory grows up to so many MiB; what needs more is refused with OUT_OF_MEMORY. */
  constructor(module: WebAssembly.Module, megabytes: number) {
    const pages = Math.min(Math.max(Math.ceil(megabytes * 16), 64), 32768);
    this.#memory = new WebAssembly.Memory({ initial: 64, maximum: pages });
    const instance = new WebAssembly.Instance(module, {
      env: { memory: this.#memory, emscripten_notify_memory_growth: () => {} },
      wasi_snapshot_preview1: {
        proc_exit: () => {
          throw new Error('The engine has ended itself');
        },
      },
      samestep: this.#imports(),
    });
    this.call = instance.exports as unknown as Exports;
    (instance.exports['_initialize'] as () => void)();
  }

  // Views, made anew when the memory has grown.
  #renew(): void {
    const buffer = this.#memory.buffer;
    if (buffer === this.#buffer) return;
    this.#buffer = buffer;
    this.#u8 = new Uint8Array(buffer);
    this.#u32 = new Uint32Array(buffer);
    this.#i32 = new Int32Array(buffer);
    this.#f64 = new Float64Array(buffer);
  }
  get u8(): Uint8Array {
    this.#renew();
    return this.#u8;
  }
  get u32(): Uint32Array {
    this.#renew();
    return this.#u32;
  }
  get i32(): Int32Array {
    this.#renew();
    return this.#i32;
  }
  get f64(): Float64Array {
    this.#renew();
    return this.#f64;
  }
  get buffer(): ArrayBufferLike {
    return this.#memory.buffer;
  }

  /** Runs an action with so many bytes of the stack, which are given back after it. */
  withStack<T>(bytes: number, action: (at: number) => T): T {
    const top = this.call.stackSave();
    try {
      return action(this.call.stackAlloc(bytes));
    } finally {
      this.call.stackRestore(top);
    }
  }
  /** Runs an action with so many bytes of the heap. */
  withMemory<T>(bytes: number, action: (at: number) => T): T {
    const at = this.call.malloc(Math.max(bytes, 1));
    if (at === 0) throw new SamestepError('OUT_OF_MEMORY', `There is no memory left for ${bytes} bytes.`);
    try {
      return action(at);
    } finally {
      this.call.free(at);
    }
  }
  /** Runs an action with a copy of these bytes. */
  withBytes<T>(bytes: Uint8Array, action: (at: number, size: number) => T): T {
    return this.withMemory(bytes.length, (at) => {
      this.u8.set(bytes, at);
      return action(at, bytes.length);
    });
  }

  /** Throws what a status stands for, and what a function of the game's threw on the way. */
  check(status: number, world = 0): void {
    if (this.#thrown !== undefined) {
      const { error } = this.#thrown;
      this.#thrown = undefined;
      throw error;
    }
    if (status === 0) return;
    const said = this.text(this.call.samestep_last_message(world));
    throw new SamestepError(codeOf(status), said === '' ? codeOf(status) : said);
  }

  text(at: number): string {
    const end = this.u8.indexOf(0, at);
    return this.#decoder.decode(this.#u8.subarray(at, end));
  }
  vec2(at: number): Vec2 {
    const f64 = this.f64;
    return { x: f64[at >> 3]!, y: f64[(at >> 3) + 1]! };
  }
  setVec2(at: number, v: Vec2 | undefined): void {
    if (v === undefined) return;
    this.f64[at >> 3] = v.x;
    this.#f64[(at >> 3) + 1] = v.y;
  }
  id(at: number): number {
    return fromHalves(this.u32[at >> 2]!, this.#u32[(at >> 2) + 1]!);
  }
  setId(at: number, id: number): void {
    this.u32[at >> 2] = low(id);
    this.#u32[(at >> 2) + 1] = high(id);
  }
  /** 64 bits as a number: of what stays below 2^53. */
  wide(at: number): number {
    return this.u32[at >> 2]! + this.#u32[(at >> 2) + 1]! * 2 ** 32;
  }
  setWide(at: number, value: number): void {
    this.u32[at >> 2] = value % 2 ** 32;
    this.#u32[(at >> 2) + 1] = Math.floor(value / 2 ** 32);
  }
  hex(at: number): string {
    return hexOf(this.u32[at >> 2]!, this.#u32[(at >> 2) + 1]!);
  }
  setBig(at: number, value: bigint): void {
    this.u32[at >> 2] = Number(value & 0xffffffffn);
    this.#u32[(at >> 2) + 1] = Number((value >> 32n) & 0xffffffffn);
  }
  big(at: number): bigint {
    return (BigInt(this.u32[(at >> 2) + 1]!) << 32n) | BigInt(this.#u32[at >> 2]!);
  }
  /** What a function writes through its last two or three arguments: bytes, room, and how much there is. */
  written(write: (bytes: number, room: number, size: number) => number, world = 0): Uint8Array {
    return this.withStack(8, (size) => {
      this.check(write(0, 0, size), world);
      const room = this.u32[size >> 2]!;
      return this.withMemory(room, (at) => {
        this.check(write(at, room, size), world);
        return this.u8.slice(at, at + this.u32[size >> 2]!);
      });
    });
  }
  /** The same for text, which ends with a 0. */
  writtenText(write: (bytes: number, room: number, size: number) => number, world = 0): string {
    return this.#decoder.decode(this.written(write, world).subarray(0, -1));
  }

  /** The number under which functions are called back. */
  keep(callbacks: Callbacks): number {
    this.#callbacks.set(this.#nextKey, callbacks);
    return this.#nextKey++;
  }
  drop(key: number): void {
    this.#callbacks.delete(key);
  }

  /** Calls a function of the game's. What it throws must not cross wasm, and is thrown when the call ends. */
  #guarded<T>(key: number, otherwise: T, action: (callbacks: Callbacks) => T | undefined): T {
    if (this.#thrown !== undefined) return otherwise;
    try {
      return action(this.#callbacks.get(key)!) ?? otherwise;
    } catch (error) {
      this.#thrown = { error };
      return otherwise;
    }
  }

  #imports(): WebAssembly.ModuleImports {
    const refused = 142; // VALUE_OUT_OF_RANGE
    return {
      contact: (phase: number, contact: number, world: number, key: number) =>
        this.#guarded(key, 1, (of) => of.contact?.(phase, contact, world)),
      position: (world: number, idLow: number, idHigh: number, seconds: number, key: number) =>
        this.#guarded(key, undefined, (of) => of.position?.(world, fromHalves(idLow >>> 0, idHigh >>> 0), seconds)),
      velocity: (world: number, idLow: number, idHigh: number, x: number, y: number, damping: number,
                 seconds: number, key: number) =>
        this.#guarded(key, undefined, (of) =>
          of.velocity?.(world, fromHalves(idLow >>> 0, idHigh >>> 0), { x, y }, damping, seconds)),
      post_step: (_world: number, key: number) => this.#guarded(key, undefined, (of) => of.postStep?.()),
      input: (world: number, at: number, size: number, key: number) =>
        this.#guarded(key, refused, (of) => of.input?.(world, this.u8.slice(at, at + size))),
      connect: (world: number, key: number) => this.#guarded(key, undefined, (of) => of.connect?.(world)),
      progress: (done: number, total: number, key: number) =>
        this.#guarded(key, 0, (of) => of.progress?.(done, total) ?? 1),
      apply_inputs: (world: number, tick: number, players: number, count: number, key: number) =>
        this.#guarded(key, undefined, (of) => of.applyInputs?.(world, tick, players, count)),
      send: (to: number, at: number, size: number, key: number) =>
        this.#guarded(key, undefined, (of) => of.send?.(to, this.u8.slice(at, at + size))),
      receive: (from: number, into: number, room: number, key: number) =>
        this.#guarded(key, 0, (of) => {
          const datagram = of.receive?.(room);
          if (datagram === undefined) return 0;
          this.f64[from >> 3] = datagram.from;
          this.#u8.set(datagram.bytes.subarray(0, room), into);
          return datagram.bytes.length;
        }),
      own_save: (slot: number, key: number) => this.#guarded(key, undefined, (of) => of.saveOwn?.(slot)),
      own_load: (slot: number, key: number) => this.#guarded(key, undefined, (of) => of.loadOwn?.(slot)),
      own_hash: (at: number, key: number) =>
        this.#guarded(key, undefined, (of) => {
          const [lowHalf, highHalf] = of.hashOwn?.() ?? [0, 0];
          this.u32[at >> 2] = lowHalf;
          this.#u32[(at >> 2) + 1] = highHalf;
        }),
    };
  }
}

/** 64 bits in 16 hexadecimal digits. */
export function hexOf(lowHalf: number, highHalf: number): string {
  return (highHalf >>> 0).toString(16).padStart(8, '0') + (lowHalf >>> 0).toString(16).padStart(8, '0');
}
