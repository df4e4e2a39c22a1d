// SPDX-License-Identifier: MIT
// Two peers in two Workers, and the network between them.
import { init } from 'samestep';
import { CRATE, HEIGHT, JUMP, LEFT, RADIUS, RIGHT, WIDTH } from './game.js';
import type { FromPeer, ToPeer } from './messages.js';

const byId = <T extends HTMLElement>(name: string): T => document.getElementById(name) as T;
const slider = (name: string): number => Number(byId<HTMLInputElement>(name).value);
const { module } = await init();

/** What players want to know; that a slow network was silent for a while is not of it. */
const TOLD = /^(refused|left|dropped|desync|located|over|joined|lied|\w*Error)/;

type Frame = Extract<FromPeer, { kind: 'frame' }>;
interface Peer {
  worker: Worker;
  frame: Frame | undefined;
  /** Where bodies were shown before a rollback corrected them, and until when that is shown. */
  ghosts: Float32Array | undefined;
  ghostsUntil: number;
}

const END = "End B's Worker";
const JOIN = 'B joins again';
let crates = 0;
let peers: Peer[] = [];
let hashes = new Map<number, [string?, string?]>();
let timers = new Set<ReturnType<typeof setTimeout>>();

function tell(seat: number, message: ToPeer, transfer: Transferable[] = []): void {
  peers[seat]?.worker.postMessage(message, transfer);
}
/** Carries a datagram as slowly and badly as the sliders say. */
function carry(from: number, to: number, bytes: Uint8Array): void {
  if (Math.random() * 100 < slider('loss')) return;
  const timer = setTimeout(() => {
    timers.delete(timer);
    tell(to, { kind: 'datagram', from, bytes }, [bytes.buffer]);
  }, slider('delay') + Math.random() * slider('jitter'));
  timers.add(timer);
}

function noteHash(seat: number, tick: number, hash: string): void {
  const both = hashes.get(tick) ?? [];
  both[seat] = hash;
  hashes.set(tick, both);
  if (both[0] === undefined || both[1] === undefined) return;
  const item = document.createElement('li');
  const same = both[0] === both[1];
  item.className = same ? 'same' : 'other';
  item.textContent = `${String(tick).padStart(6)} ${both[0]}${same ? ' =' : ` ≠ ${both[1]}`}`;
  const list = byId('list');
  list.prepend(item);
  while (list.children.length > 16) list.lastElementChild!.remove();
  for (const old of hashes.keys()) if (old < tick - 600) hashes.delete(old);
}

function hear(seat: number, message: FromPeer): void {
  const peer = peers[seat]!;
  switch (message.kind) {
    case 'datagram':
      carry(seat, message.to, message.bytes);
      break;
    case 'hash':
      noteHash(seat, message.tick, message.hash);
      break;
    case 'said':
      if (TOLD.test(message.text)) byId('verdict').textContent = `${'AB'[seat]}: ${message.text}`;
      break;
    case 'frame':
      if (peer.frame !== undefined && message.state.rollbacks > peer.frame.state.rollbacks) {
        peer.ghosts = peer.frame.poses;
        peer.ghostsUntil = performance.now() + 150;
      }
      peer.frame = message;
  }
}

function startPeer(seat: number): Peer {
  const worker = new Worker(new URL('./peer.ts', import.meta.url), { type: 'module' });
  worker.addEventListener('message', ({ data }: MessageEvent<FromPeer>) => {
    if (peers[seat]?.worker === worker) hear(seat, data);
  });
  worker.addEventListener('error', (event) => (byId('verdict').textContent = `${'AB'[seat]}: ${event.message}`));
  return { worker, frame: undefined, ghosts: undefined, ghostsUntil: 0 };
}
/** Ends B's Worker, or has a new one take its seat in the match that A plays on. */
function endOrJoin(): void {
  const button = byId('kill');
  const gone = button.textContent === JOIN;
  button.textContent = gone ? END : JOIN;
  peers[1]!.worker.terminate();
  if (!gone) return;
  byId('verdict').textContent = '';
  peers[1] = startPeer(1);
  tell(1, { kind: 'begin', seat: 1, crates, joins: true, module });
}

function begin(): void {
  for (const peer of peers) peer.worker.terminate();
  for (const timer of timers) clearTimeout(timer);
  timers = new Set();
  hashes = new Map();
  byId('list').replaceChildren();
  byId('verdict').textContent = '';
  byId('kill').textContent = END;
  crates = slider('crates');
  peers = [0, 1].map(startPeer);
  peers.forEach((_, seat) => tell(seat, { kind: 'begin', seat, crates, joins: false, module }));
}

const COLORS = ['#2f7fd6', '#e0812f'];
function drawBodies(context: CanvasRenderingContext2D, poses: Float32Array, ghost: string | undefined): void {
  for (let i = 0; i < poses.length; i += 4) {
    const [index, x, y, angle] = poses.subarray(i, i + 4) as unknown as [number, number, number, number];
    if (index === 0) continue;
    context.save();
    context.translate(x, y);
    context.rotate(angle);
    context.beginPath();
    if (index <= 2) {
      context.arc(0, 0, RADIUS, 0, 2 * Math.PI);
      context.lineTo(0, 0);
    } else context.rect(-CRATE / 2, -CRATE / 2, CRATE, CRATE);
    if (ghost === undefined) {
      context.fillStyle = index <= 2 ? COLORS[index - 1]! : `hsl(${(index * 47) % 360} 30% 58%)`;
      context.fill();
    }
    context.strokeStyle = ghost ?? 'rgb(0 0 0 / 40%)';
    context.stroke();
    context.restore();
  }
}

function draw(seat: number, now: number): void {
  const { frame, ghosts, ghostsUntil } = peers[seat]!;
  if (frame === undefined) return;
  const canvas = byId<HTMLCanvasElement>(`canvas${seat}`);
  const scale = (canvas.clientWidth / WIDTH) * devicePixelRatio;
  canvas.width = canvas.clientWidth * devicePixelRatio;
  canvas.height = canvas.clientHeight * devicePixelRatio;
  const context = canvas.getContext('2d')!;
  context.setTransform(scale, 0, 0, -scale, 0, HEIGHT * scale);
  context.lineWidth = 1.5 / scale;
  drawBodies(context, frame.poses, undefined);
  const ghost = getComputedStyle(document.documentElement).getPropertyValue('--ghost');
  if (ghosts !== undefined && now < ghostsUntil) drawBodies(context, ghosts, ghost);
  const { state, took, memory } = frame;
  byId(`state${seat}`).textContent =
    `tick ${state.tick}, certain ${state.confirmed}, ahead ${Math.max(0, state.tick - state.confirmed)}\n` +
    `rollbacks ${state.rollbacks}, deepest ${state.deepest} steps, waited ${state.waited}\n` +
    `frame ${took.toFixed(1)} ms, sent ${(state.sentBytes / 1000).toFixed(0)} kB, memory ${(memory / 2 ** 20).toFixed(0)} MiB` +
    (state.state === 'running' ? '' : `\n${state.state}${state.endReason === 'none' ? '' : `: ${state.endReason}`}`);
}
function frame(now: number): void {
  peers.forEach((_, seat) => draw(seat, now));
  requestAnimationFrame(frame);
}

const keys: Record<string, [number, number]> = {
  KeyA: [0, LEFT], KeyD: [0, RIGHT], KeyW: [0, JUMP],
  ArrowLeft: [1, LEFT], ArrowRight: [1, RIGHT], ArrowUp: [1, JUMP],
};
const pressed = [0, 0];
function press(seat: number, bit: number, down: boolean): void {
  pressed[seat] = down ? pressed[seat]! | bit : pressed[seat]! & ~bit;
  tell(seat, { kind: 'held', keys: pressed[seat]! });
}
for (const [name, down] of [['keydown', true], ['keyup', false]] as const) {
  window.addEventListener(name, (event) => {
    const key = keys[event.code];
    if (key === undefined || (event.target as HTMLElement).matches('input, select')) return;
    event.preventDefault();
    press(...key, down);
  });
}
for (const button of document.querySelectorAll<HTMLButtonElement>('.pad button')) {
  const [seat, bit] = [Number(button.dataset['seat']), Number(button.dataset['bit'])];
  button.setAttribute('aria-label', `${'AB'[seat]}: ${{ 1: 'left', 2: 'right', 4: 'jump' }[bit]}`);
  for (const [name, down] of [['pointerdown', true], ['pointerup', false], ['pointerleave', false]] as const) {
    button.addEventListener(name, () => press(seat, bit, down));
  }
}
for (const input of document.querySelectorAll<HTMLInputElement>('input[type=range]')) {
  const show = () => (input.parentElement!.querySelector('output')!.textContent = input.value);
  input.addEventListener('input', show);
  show();
}
byId('flip').addEventListener('click', () => tell(1, { kind: 'flip' }));
byId('kill').addEventListener('click', endOrJoin);
byId('anew').addEventListener('click', begin);
byId('crates').addEventListener('change', begin);
begin();
requestAnimationFrame(frame);
