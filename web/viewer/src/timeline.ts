// SPDX-License-Identifier: MIT
// The ticks of recordings on a line: keyframes, commands, what is proven, where they part.

export interface Marks {
  ticks: number;
  tick: number;
  provenTicks: number;
  keyframes: readonly number[];
  commands: readonly number[];
  wrongTick: number | undefined;
  difference: number | undefined;
}

export class Timeline {
  readonly #canvas: HTMLCanvasElement;
  #ticks = 1;
  constructor(canvas: HTMLCanvasElement, seek: (tick: number) => void) {
    this.#canvas = canvas;
    const scrub = (event: PointerEvent) =>
      seek(Math.round((Math.min(Math.max(event.offsetX / canvas.clientWidth, 0), 1)) * this.#ticks));
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      scrub(event);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons !== 0) scrub(event);
    });
  }
  draw(marks: Marks): void {
    const canvas = this.#canvas;
    const { clientWidth: width, clientHeight: height } = canvas;
    const ratio = devicePixelRatio;
    this.#ticks = Math.max(marks.ticks, 1);
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    canvas.setAttribute('aria-valuemax', String(marks.ticks));
    canvas.setAttribute('aria-valuenow', String(marks.tick));
    const context = canvas.getContext('2d')!;
    context.scale(ratio, ratio);
    const style = getComputedStyle(document.documentElement);
    const color = (name: string) => style.getPropertyValue(name);
    const x = (tick: number) => (tick / this.#ticks) * width;
    const bar = (name: string, from: number, to: number, top: number, high: number) => {
      context.fillStyle = color(name);
      context.fillRect(x(from), top, Math.max(x(to) - x(from), 1), high);
    };
    bar('--line', 0, marks.ticks, 16, 8);
    bar('--good', 0, marks.provenTicks, 16, 8);
    // A column of pixels is drawn once, however many commands are in it.
    const columns = new Set(marks.commands.map((tick) => Math.round(x(tick))));
    context.fillStyle = color('--dim');
    for (const column of columns) context.fillRect(column, 2, 1, 10);
    for (const tick of marks.keyframes) bar('--dim', tick, tick, 26, 5);
    for (const tick of [marks.wrongTick, marks.difference]) {
      if (tick !== undefined) bar('--bad', tick, tick, 0, height);
    }
    context.fillStyle = color('--text');
    context.fillRect(x(marks.tick) - 1, 12, 3, 16);
    context.font = '12px ui-monospace, monospace';
    context.textAlign = 'center';
    const words = `${marks.tick} / ${marks.ticks}`;
    context.fillText(words, Math.min(Math.max(x(marks.tick), 40), width - 40), height - 3);
  }
}
