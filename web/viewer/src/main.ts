// SPDX-License-Identifier: MIT
// Recordings to look at: one, or two side by side.
import { id, init, type Player } from 'samestep/both';
import { recordScene, type SceneFile } from 'samestep/scene';
import { Timeline } from './timeline.js';
import { View } from './view.js';

const SCENE_TICKS = 600;
/** Milliseconds of each frame for steps. */
const SLICE = 30;
const byId = <T extends HTMLElement>(name: string): T => document.getElementById(name) as T;
const checked = (name: string): boolean => byId<HTMLInputElement>(name).checked;

const engine = await init();

/** A recording with its player and its picture. */
class Pane {
  readonly element = document.createElement('section');
  readonly #words = document.createElement('p');
  private constructor(
    readonly name: string,
    readonly player: Player,
  ) {
    this.element.className = 'pane';
    this.element.setAttribute('aria-label', name);
    this.#words.className = 'words';
    this.element.append(this.#words);
  }
  view!: View;
  static async open(name: string, bytes: Uint8Array): Promise<Pane> {
    const pane = new Pane(name, engine.openRecording(bytes));
    byId('panes').append(pane.element);
    pane.view = await View.create(pane.element);
    pane.element.append(pane.#words);
    pane.view.onPick = (place) => {
      const [nearest] = pane.player.world.queryPoint(place, 0.5).sort((a, b) => a.distance - b.distance);
      mark(nearest === undefined ? 0 : pane.player.world.shape(nearest.shape).state.body);
    };
    return pane;
  }
  draw(): void {
    this.view.draw(this.player.world, {
      contacts: checked('contacts'), velocities: checked('velocities'), ids: checked('ids'),
    });
    const { trust, recordedHash } = this.player.state;
    const hash = this.player.world.hash;
    const spans = [
      [`${this.name}, ${this.player.scalar}, ${Math.round(1 / this.player.seconds)}/s `, ''],
      [`${hash} ${trust}${hash === recordedHash ? '' : `, recorded ${recordedHash}`}`, trust],
    ] as const;
    this.#words.replaceChildren(...spans.map(([text, name]) => {
      const span = document.createElement('span');
      span.className = name;
      span.textContent = text;
      return span;
    }));
  }
  /** Goes to the last step that there is, at most the wanted one. */
  seek(tick: number): void {
    const wanted = Math.min(tick, this.player.ticks);
    const from = this.player.state.tick;
    if (wanted === from + 1) this.player.step();
    else if (wanted !== from) this.player.seek(wanted);
  }
  dispose(): void {
    this.view.dispose();
    this.player.dispose();
    this.element.remove();
  }
}

let panes: Pane[] = [];
let tick = 0;
/** Where to go: step by step from the last keyframe before it, so many in each frame as its time allows. */
let target = 0;
let leftAt = 0;
let playing = false;
let due = 0;
let difference: number | undefined;
let shownCommands = -1;
let dirty = true;

const last = (): number => Math.max(0, ...panes.map((pane) => pane.player.ticks));

function say(text: string, good = false): void {
  byId('message').textContent = text;
  byId('message').className = good ? 'good' : '';
}
/** Does something that may be refused, and says so. */
function attempt(action: () => void): void {
  try {
    action();
  } catch (error) {
    playing = false;
    target = tick;
    say(error instanceof Error ? error.message : String(error));
  }
}
function goTo(wanted: number): void {
  target = Math.min(Math.max(wanted, 0), last());
  leftAt = performance.now();
  advance(SLICE);
}
function nextTick(): number {
  const nearest = panes[0]!.player.keyframes.filter((at) => at <= target).at(-1) ?? 0;
  return target < tick || nearest > tick ? nearest : tick + 1;
}
/** Comes nearer to where to go, for some milliseconds. */
function advance(milliseconds: number): void {
  const end = performance.now() + milliseconds;
  attempt(() => {
    while (tick !== target && performance.now() < end) {
      tick = nextTick();
      for (const pane of panes) pane.seek(tick);
      dirty = true;
    }
  });
}
function play(on: boolean): void {
  playing = on && panes.length > 0;
  if (playing && tick >= last()) goTo(0);
  else target = tick;
  byId('play').textContent = playing ? 'II' : '▶';
  byId('play').setAttribute('aria-label', playing ? 'Pause' : 'Play');
}
function mark(body: number): void {
  for (const pane of panes) pane.view.marked = body;
  dirty = true;
}

/** The first tick whose recorded hashes differ. */
function findDifference([a, b]: [Pane, Pane]): number | undefined {
  const [mine, theirs] = [a.player.hashes, b.player.hashes];
  for (let i = 0; i < Math.min(mine.length, theirs.length); ++i) {
    if (mine[i] !== theirs[i]) return i >> 1;
  }
  return undefined;
}
/** Goes to the first difference, names it and marks its body. */
function showDifference(): void {
  const [a, b] = panes;
  if (a === undefined || b === undefined || difference === undefined) return;
  play(false);
  goTo(difference);
  advance(Infinity);
  attempt(() => {
    const fields = a.player.world.difference(b.player.world, 5).trim();
    byId('found').textContent = `After step ${difference}: ${fields === '' ? 'only the recorded hashes differ' : fields}`;
    const body = fields.match(/body (\d+)/);
    if (body !== null) mark(a.player.world.writePoses().ids.find((of) => of % 2 ** 20 === Number(body[1])) ?? id(0));
  });
}

function closeAll(): void {
  play(false);
  for (const pane of panes) pane.dispose();
  panes = [];
  difference = undefined;
  byId('found').textContent = '';
  byId('controls').hidden = byId('close').hidden = byId('difference').hidden = true;
  byId('hint').hidden = false;
}

async function open(name: string, bytes: Uint8Array): Promise<void> {
  const isScene = bytes[0] === '{'.charCodeAt(0);
  const recording = isScene
    ? recordScene(engine, JSON.parse(new TextDecoder().decode(bytes)) as SceneFile, SCENE_TICKS)
    : bytes;
  if (panes.length === 2) closeAll();
  const pane = await Pane.open(name, recording);
  panes.push(pane);
  byId('hint').hidden = true;
  byId('controls').hidden = byId('close').hidden = false;
  const [a, b] = panes;
  if (a !== undefined && b !== undefined) {
    difference = findDifference([a, b]);
    byId('difference').hidden = difference === undefined;
    byId('found').textContent = difference === undefined
      ? 'Both recordings are the same as far as both go.' : `They part at step ${difference}.`;
  }
  if (panes.length === 1) tick = target = 0;
  attempt(() => pane.seek(tick));
  dirty = true;
}
async function openFiles(files: Iterable<File>): Promise<void> {
  for (const file of files) {
    try {
      await open(file.name, new Uint8Array(await file.arrayBuffer()));
      say('');
    } catch (error) {
      say(`${file.name}: ${error instanceof Error ? error.message : String(error)}`);
    }
  }
}

const timeline = new Timeline(byId('timeline'), (wanted) => {
  play(false);
  goTo(wanted);
});

function listCommands(): void {
  const player = panes[0]?.player;
  if (player === undefined || shownCommands === tick || !byId<HTMLDetailsElement>('about').open) return;
  shownCommands = tick;
  const items = player.commands.flatMap((command, i) => (command.tick === tick ? [i] : [])).slice(0, 50);
  byId('commands').replaceChildren(...items.map((i) => {
    const item = document.createElement('li');
    item.textContent = player.describeCommand(i);
    return item;
  }));
}

let marks: { commands: number[]; keyframes: number[]; of: Player } | undefined;
function drawTimeline(): void {
  const player = panes[0]!.player;
  if (marks?.of !== player) {
    marks = { commands: player.commands.map((command) => command.tick), keyframes: player.keyframes, of: player };
  }
  const { provenTicks, wrongTick } = player.state;
  timeline.draw({ ...marks, ticks: last(), tick, provenTicks, wrongTick, difference });
}

let before = performance.now();
function frame(now: number): void {
  const seconds = Math.min((now - before) / 1000, 0.1);
  before = now;
  if (playing) {
    due += (seconds * Number(byId<HTMLSelectElement>('speed').value)) / panes[0]!.player.seconds;
    const steps = Math.floor(due);
    due -= steps;
    // What this machine cannot keep up with is not caught up.
    target = Math.min(tick + steps, last());
    leftAt = now;
  }
  if (tick !== target) advance(SLICE);
  if (playing) {
    target = tick;
    if (tick >= last()) play(false);
  }
  // On the way to a tick, what is shown stays for a moment.
  if (panes.length > 0 && (tick === target || now - leftAt > 250)) {
    for (const pane of panes) {
      pane.view.following = checked('follow');
      pane.draw();
    }
    if (dirty) drawTimeline();
    dirty = false;
    listCommands();
  }
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);
window.addEventListener('resize', () => (dirty = true));

byId('play').addEventListener('click', () => play(!playing));
byId('start').addEventListener('click', () => goTo(0));
byId('back').addEventListener('click', () => goTo(tick - 1));
byId('step').addEventListener('click', () => goTo(tick + 1));
byId('fit').addEventListener('click', () => panes.forEach((pane) => pane.view.fit(pane.player.world)));
byId('difference').addEventListener('click', showDifference);
byId('close').addEventListener('click', closeAll);
byId<HTMLInputElement>('files').addEventListener('change', ({ target }) =>
  void openFiles((target as HTMLInputElement).files ?? []));
const keys: Record<string, () => void> = {
  ' ': () => play(!playing),
  ArrowLeft: () => goTo(tick - 1),
  ArrowRight: () => goTo(tick + 1),
  PageUp: () => goTo(tick - 60),
  PageDown: () => goTo(tick + 60),
  Home: () => goTo(0),
  End: () => goTo(last()),
  '+': () => panes.forEach((pane) => pane.view.zoom(1.25)),
  '-': () => panes.forEach((pane) => pane.view.zoom(0.8)),
  '0': () => panes.forEach((pane) => pane.view.fit(pane.player.world)),
};
window.addEventListener('keydown', (event) => {
  const target = event.target as HTMLElement;
  if (target.closest('button, select, input, summary') !== null && [' ', 'Enter'].includes(event.key)) return;
  if (target.closest('select') !== null || event.ctrlKey || event.metaKey || event.altKey) return;
  const action = keys[event.key];
  if (action === undefined || panes.length === 0) return;
  event.preventDefault();
  action();
});
const main = byId('panes');
for (const name of ['dragenter', 'dragover'] as const) {
  window.addEventListener(name, (event) => {
    event.preventDefault();
    main.classList.add('over');
  });
}
window.addEventListener('dragleave', () => main.classList.remove('over'));
window.addEventListener('drop', (event) => {
  event.preventDefault();
  main.classList.remove('over');
  void openFiles(event.dataTransfer?.files ?? []);
});
window.addEventListener('error', (event) => say(event.message));
window.addEventListener('unhandledrejection', (event) => say(String(event.reason)));

// `samestep view FILE...` names its files in the address.
for (const name of new URLSearchParams(location.search).getAll('file')) {
  const answer = await fetch(`./recordings/${encodeURIComponent(name)}`);
  if (answer.ok) await open(name, new Uint8Array(await answer.arrayBuffer())).catch((error: unknown) => say(String(error)));
  else say(`${name} cannot be had: ${answer.status}`);
}
document.documentElement.dataset['ready'] = 'true';
