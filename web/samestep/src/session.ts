// SPDX-License-Identifier: MIT
import * as abi from './abi.js';
import type { Core } from './core.js';
import { SamestepError } from './error.js';
import { functionAt, Place, type World } from './world.js';

/** What one player does in one tick. */
export interface PlayerInput {
  /** What is held, as buttons: predicted while the true input is on its way. */
  held: Uint8Array;
  /** What happens once: never predicted, lost or applied twice. */
  commands: Uint8Array;
  /** false before the player has joined, and after it has left. */
  present: boolean;
}
/** Carries datagrams of at most 1200 bytes between peers; neither function waits, and what is lost is sent again. */
export interface Transport {
  send(to: number, bytes: Uint8Array): void;
  receive(): { from: number; bytes: Uint8Array } | undefined;
}
/** What a game keeps beside its world, as scores and timers. */
export interface OwnState {
  save(slot: number): void;
  load(slot: number): void;
  /** Two halves of 32 bits. */
  hash(): readonly [number, number];
}

/** What a session is to be. Times are in milliseconds. */
export interface SessionDef {
  transport: Transport;
  /** Does to the world what the players do in a tick; by the world and the inputs alone. */
  applyInputs(world: World, tick: number, players: PlayerInput[]): void;
  own?: OwnState;
  /** Seats taken at the start, 2 to 16; 2 at first. */
  players?: number;
  /** The most seats, the same for all peers; as many as `players` where left out. */
  maxPlayers?: number;
  /** Takes the local seat in a match that is under way. The world is to be as the others' was at the start. */
  joins?: boolean;
  localSeat: number;
  /** Where the transport finds each seat; the seats themselves where left out. */
  addresses?: readonly number[];
  match?: number;
  rate?: number;
  /** Steps made ahead of the last certain one, 0 (lockstep) to 16. */
  window?: number;
  inputDelay?: number;
  runAhead?: number;
  maxHeldBytes?: number;
  maxCommandBytes?: number;
  hashInterval?: number;
  resendAfter?: number;
  interruptedAfter?: number;
  dropAfter?: number;
  endAfter?: number;
  goneAfter?: number;
  pausedAtMost?: number;
}

export type Frame = 'advanced' | 'waiting' | 'paused' | 'idle';
const frames: readonly Frame[] = ['advanced', 'waiting', 'paused', 'idle'];

/** How a session stands. */
export interface SessionState {
  state: 'connecting' | 'running' | 'ended' | 'joining';
  endReason: 'none' | 'left' | 'refused' | 'dropped' | 'minority' | 'diverged' | 'notAdmitted';
  /** Steps made. */
  tick: number;
  /** Steps whose inputs are all known. */
  confirmed: number;
  /** Bit by seat. */
  present: number;
  /** How long a frame should last, in thousandths of the usual. */
  frameLength: number;
  /** Made, repeated ones included. */
  steps: number;
  rollbacks: number;
  waited: number;
  sentBytes: number;
  sentPackets: number;
  badPackets: number;
  /** Rollback, in steps. */
  deepest: number;
}
/** Something that the game may want to show. */
export interface SessionEvent {
  kind: (typeof eventKinds)[number];
  /** 255: none. */
  seat: number;
  detail: number;
  tick: number;
  localHash: string;
  remoteHash: string;
}
const eventKinds = [
  'started', 'refused', 'interrupted', 'resumed', 'paused', 'unpaused', 'left', 'dropped', 'desync', 'located', 'over',
  'joined', 'lied',
] as const;

const endReasons = ['none', 'left', 'refused', 'dropped', 'minority', 'diverged', 'notAdmitted'] as const;

const NUMBERS = {
  players: 'players',
  maxPlayers: 'max_players',
  localSeat: 'local_seat',
  match: 'match',
  rate: 'rate',
  window: 'window',
  inputDelay: 'input_delay',
  runAhead: 'run_ahead',
  maxHeldBytes: 'max_held_bytes',
  maxCommandBytes: 'max_command_bytes',
  hashInterval: 'hash_interval',
} as const;
const TIMES = {
  resendAfter: 'resend_after',
  interruptedAfter: 'interrupted_after',
  dropAfter: 'drop_after',
  endAfter: 'end_after',
  goneAfter: 'gone_after',
  pausedAtMost: 'paused_at_most',
} as const;

/** A networked match: each peer steps its own world, and only inputs travel. */
export class Session {
  #pointer: number;
  readonly #key: number;

  /** Made by World.startSession. */
  constructor(
    readonly world: World,
    def: SessionDef,
  ) {
    const { core, pointer } = world;
    this.#key = core.keep({
      applyInputs: (_, tick, players, count) => def.applyInputs(world, tick, readInputs(core, players, count)),
      send: (to, bytes) => def.transport.send(to, bytes),
      receive: () => def.transport.receive(),
      saveOwn: (slot) => def.own?.save(slot),
      loadOwn: (slot) => def.own?.load(slot),
      hashOwn: () => def.own?.hash() ?? [0, 0],
    });
    try {
      this.#pointer = core.withStack(abi.session_def.size_of + 8, (at) => {
        writeDef(core, at, def, this.#key);
        const made = at + abi.session_def.size_of;
        core.check(core.call.samestep_session_create(pointer, at, made), pointer);
        return core.u32[made >> 2]!;
      });
    } catch (error) {
      core.drop(this.#key);
      throw error;
    }
  }
  get #core(): Core {
    return this.world.core;
  }
  #at(): number {
    if (this.#pointer === 0) throw new SamestepError('DISPOSED', 'The session has been disposed of.');
    return this.#pointer;
  }
  #check(status: number): void {
    this.#core.check(status, this.world.pointer);
  }

  /** Takes in what has arrived, takes back what was predicted wrongly, and makes a step if it may. `now` is in
   * milliseconds, as performance.now(); `held` is what the local player holds. */
  frame(now: number, held: Uint8Array = new Uint8Array()): Frame {
    const [lowHalf, highHalf] = microseconds(now);
    return this.#core.withStack(8 + held.length, (at) => {
      this.#core.u8.set(held, at + 8);
      this.#check(this.#core.call.samestep_session_frame(this.#at(), lowHalf, highHalf, at + 8, held.length, at));
      return frames[this.#core.i32[at >> 2]!]!;
    });
  }
  /** Only talks to the others. */
  poll(now: number): void {
    this.#check(this.#core.call.samestep_session_poll(this.#at(), ...microseconds(now)));
  }
  /** Queues a command of the local player; false where too many wait. */
  command(bytes: Uint8Array): boolean {
    return this.#core.withStack(8 + bytes.length, (at) => {
      this.#core.u8.set(bytes, at + 8);
      this.#check(this.#core.call.samestep_session_command(this.#at(), at + 8, bytes.length, at));
      return this.#core.i32[at >> 2] === 1;
    });
  }
  /** Leaves the match with the next input; poll until its state is 'ended'. */
  leave(): void {
    this.#check(this.#core.call.samestep_session_leave(this.#at()));
  }
  pause(paused: boolean): void {
    this.#check(this.#core.call.samestep_session_pause(this.#at(), Number(paused)));
  }
  setInputDelay(ticks: number): void {
    this.#check(this.#core.call.samestep_session_set_input_delay(this.#at(), ticks));
  }
  setWindow(ticks: number): void {
    this.#check(this.#core.call.samestep_session_set_window(this.#at(), ticks));
  }
  get state(): SessionState {
    const core = this.#core;
    const place = abi.session_state;
    return core.withStack(place.size_of, (at) => {
      this.#check(core.call.samestep_session_get_state(this.#at(), at));
      const number = (field: number) => core.u32[(at + field) >> 2]!;
      return {
        state: (['connecting', 'running', 'ended', 'joining'] as const)[number(place.state)]!,
        endReason: endReasons[number(place.end_reason)]!,
        tick: number(place.tick),
        confirmed: number(place.confirmed),
        present: number(place.present),
        frameLength: number(place.frame_length),
        steps: core.wide(at + place.steps),
        rollbacks: core.wide(at + place.rollbacks),
        waited: core.wide(at + place.waited),
        sentBytes: core.wide(at + place.sent_bytes),
        sentPackets: core.wide(at + place.sent_packets),
        badPackets: core.wide(at + place.bad_packets),
        deepest: number(place.deepest),
      };
    });
  }
  /** Takes the oldest event. */
  nextEvent(): SessionEvent | undefined {
    const core = this.#core;
    const place = abi.session_event;
    return core.withStack(place.size_of + 8, (at) => {
      const taken = at + place.size_of;
      this.#check(core.call.samestep_session_next_event(this.#at(), at, taken));
      if (core.i32[taken >> 2] === 0) return undefined;
      const number = (field: number) => core.u32[(at + field) >> 2]!;
      return {
        kind: eventKinds[number(place.kind)]!,
        seat: number(place.seat),
        detail: number(place.detail),
        tick: number(place.tick),
        localHash: core.hex(at + place.local_hash),
        remoteHash: core.hex(at + place.remote_hash),
      };
    });
  }
  /** What was found out about a desync, in a line; "" where there was none. */
  get desync(): string {
    return this.#core.writtenText((text, room, size) =>
      this.#core.call.samestep_session_write_desync(this.#at(), text, room, size), this.world.pointer);
  }
  dispose(): void {
    this.#core.call.samestep_session_destroy(this.#pointer);
    this.#pointer = 0;
    this.#core.drop(this.#key);
  }
  [Symbol.dispose](): void {
    this.dispose();
  }
}

function microseconds(now: number): [number, number] {
  const whole = Math.floor(now * 1000);
  return [whole % 2 ** 32, Math.floor(whole / 2 ** 32)];
}

function writeDef(core: Core, at: number, def: SessionDef, key: number): void {
  const place = abi.session_def;
  core.call.samestep_session_def_init(at);
  const set = (field: number, value: number | undefined) => {
    if (value !== undefined) core.u32[(at + field) >> 2] = value;
  };
  for (const [name, field] of Object.entries(NUMBERS) as [keyof typeof NUMBERS, keyof typeof place][]) {
    set(place[field], def[name]);
  }
  for (const [name, field] of Object.entries(TIMES) as [keyof typeof TIMES, keyof typeof place][]) {
    const time = def[name];
    set(place[field], time === undefined ? undefined : time * 1000);
  }
  for (let seat = 0; seat < 16; ++seat) core.setWide(at + place.addresses + 8 * seat, def.addresses?.[seat] ?? seat);
  set(place.joins, Number(def.joins ?? false));
  set(place.apply_inputs, functionAt(core, Place.applyInputs));
  set(place.data, key);
  set(place.send, functionAt(core, Place.send));
  set(place.receive, functionAt(core, Place.receive));
  set(place.transport_data, key);
  if (def.own === undefined) return;
  [Place.saveOwn, Place.loadOwn, Place.hashOwn].forEach((own, i) => set(place.own + 4 * i, functionAt(core, own)));
  set(place.own + 12, key);
}

function readInputs(core: Core, players: number, count: number): PlayerInput[] {
  const place = abi.player_input;
  return Array.from({ length: count }, (_, i) => {
    const at = (players + place.size_of * i) >> 2;
    const [held, commands, heldSize, commandSize, present] = core.u32.slice(at, at + 5) as unknown as
      [number, number, number, number, number];
    return {
      held: core.u8.slice(held, held + heldSize),
      commands: core.u8.slice(commands, commands + commandSize),
      present: present === 1,
    };
  });
}

/** A transport over WebRTC data channels, one for each seat but one's own. Open them with
 * { ordered: false, maxRetransmits: 0 }: the session sends again what is lost. */
export function dataChannelTransport(channels: ReadonlyMap<number, RTCDataChannel>): Transport {
  const arrived: { from: number; bytes: Uint8Array }[] = [];
  for (const [seat, channel] of channels) {
    channel.binaryType = 'arraybuffer';
    channel.addEventListener('message', ({ data }: MessageEvent<unknown>) => {
      if (!(data instanceof ArrayBuffer) || arrived.length >= 1024) return;
      arrived.push({ from: seat, bytes: new Uint8Array(data) });
    });
  }
  return {
    send(to, bytes) {
      const channel = channels.get(to);
      if (channel?.readyState === 'open') channel.send(bytes as Uint8Array<ArrayBuffer>);
    },
    receive: () => arrived.shift(),
  };
}
