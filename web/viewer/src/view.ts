// SPDX-License-Identifier: MIT
// A world drawn: bodies by Pixi, what is said of them on a canvas above.
import 'pixi.js/unsafe-eval';
import { Application, Container, Graphics, GraphicsContext } from 'pixi.js';
import { indexOf, type Vec2, type World } from 'samestep';

const COLORS = [0x4c8dd6, 0xd69a3a, 0x5fae5f, 0xb06cc2, 0xd0605e, 0x3aa8a8, 0x8f8fd9, 0xa8923a];
const STATIC = 0x7c8693;
const KINEMATIC = 0x9a6fe0;

/** What is shown beside the bodies. */
export interface Layers {
  contacts: boolean;
  velocities: boolean;
  ids: boolean;
}

export class View {
  readonly #app: Application;
  readonly #scene = new Container();
  readonly #overlay: HTMLCanvasElement;
  readonly #resized: ResizeObserver;
  readonly #bodies = new Map<number, Container>();
  readonly #contexts = new Map<string, GraphicsContext>();
  #scale = 20;
  #center: Vec2 = { x: 0, y: 5 };
  #fitted = false;
  /** The body that is followed or marked; 0 for none. */
  marked = 0;

  private constructor(app: Application, parent: HTMLElement) {
    this.#app = app;
    this.#overlay = document.createElement('canvas');
    this.#overlay.className = 'overlay';
    parent.append(app.canvas, this.#overlay);
    app.stage.addChild(this.#scene);
    this.#listen(app.canvas);
    this.#resized = new ResizeObserver(() => {
      app.renderer.resize(Math.max(parent.clientWidth, 1), Math.max(parent.clientHeight, 1));
    });
    this.#resized.observe(parent);
  }
  static async create(parent: HTMLElement): Promise<View> {
    const app = new Application();
    await app.init({
      width: Math.max(parent.clientWidth, 1), height: Math.max(parent.clientHeight, 1), backgroundAlpha: 0, antialias: true, autoDensity: true, resolution: devicePixelRatio,
      autoStart: false, preference: 'webgl', sharedTicker: false,
    });
    return new View(app, parent);
  }
  dispose(): void {
    this.#resized.disconnect();
    this.#app.destroy({ removeView: true }, { children: true });
    this.#overlay.remove();
  }

  #listen(canvas: HTMLCanvasElement): void {
    const pointers = new Map<number, Vec2>();
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), { x: event.offsetX, y: event.offsetY });
    }, { passive: false });
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    });
    canvas.addEventListener('pointermove', (event) => {
      const before = pointers.get(event.pointerId);
      if (before === undefined) return;
      const now = { x: event.offsetX, y: event.offsetY };
      const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
      if (other !== undefined) {
        const distance = (p: Vec2) => Math.hypot(p.x - other.x, p.y - other.y);
        this.zoom(distance(now) / Math.max(distance(before), 1), other);
      } else {
        this.#center.x -= (now.x - before.x) / this.#scale;
        this.#center.y += (now.y - before.y) / this.#scale;
      }
      pointers.set(event.pointerId, now);
    });
    for (const end of ['pointerup', 'pointercancel'] as const) {
      canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    }
    canvas.addEventListener('click', (event) => this.onPick(this.#toWorld({ x: event.offsetX, y: event.offsetY })));
  }
  /** Called with the place in the world that was clicked. */
  onPick: (place: Vec2) => void = () => {};

  get #size(): Vec2 {
    return { x: this.#app.screen.width, y: this.#app.screen.height };
  }
  #toWorld(at: Vec2): Vec2 {
    const size = this.#size;
    return {
      x: this.#center.x + (at.x - size.x / 2) / this.#scale,
      y: this.#center.y - (at.y - size.y / 2) / this.#scale,
    };
  }
  /** Makes all larger, around a place on the screen. */
  zoom(by: number, around: Vec2 = { x: this.#size.x / 2, y: this.#size.y / 2 }): void {
    const before = this.#toWorld(around);
    this.#scale = Math.min(Math.max(this.#scale * by, 0.05), 2000);
    const after = this.#toWorld(around);
    this.#center.x += before.x - after.x;
    this.#center.y += before.y - after.y;
  }
  pan(x: number, y: number): void {
    this.#center.x += x / this.#scale;
    this.#center.y += y / this.#scale;
  }
  /** Shows all bodies that move. */
  fit(world: World): void {
    const { values, ids } = world.writePoses();
    const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
    const still = world.staticBody.id;
    ids.forEach((id, i) => {
      if (id === still && ids.length > 1) return;
      box.left = Math.min(box.left, values[4 * i]!);
      box.right = Math.max(box.right, values[4 * i]!);
      box.bottom = Math.min(box.bottom, values[4 * i + 1]!);
      box.top = Math.max(box.top, values[4 * i + 1]!);
    });
    this.#center = { x: (box.left + box.right) / 2, y: (box.bottom + box.top) / 2 };
    const size = this.#size;
    this.#scale = Math.min(size.x / (box.right - box.left + 4), size.y / (box.top - box.bottom + 4), 80);
  }

  #contextOf(world: World, id: number): GraphicsContext {
    const body = world.body(id);
    const type = body.type;
    const shapes = body.shapes.map((shape) => ({ vertices: shape.vertices, state: shape.state }));
    const color = type === 'static' ? STATIC : type === 'kinematic' ? KINEMATIC : COLORS[indexOf(id) % COLORS.length]!;
    const key = `${color} ${JSON.stringify(shapes.map(({ vertices, state }) => [vertices, state.radius, state.sensor]))}`;
    let context = this.#contexts.get(key);
    if (context !== undefined) return context;
    context = new GraphicsContext();
    for (const { vertices, state } of shapes) {
      const alpha = state.sensor ? 0.25 : 0.85;
      if (state.kind === 'circle') {
        const [at] = vertices as [Vec2];
        context.circle(at.x, at.y, state.radius).fill({ color, alpha })
          .moveTo(at.x, at.y).lineTo(at.x + state.radius, at.y).stroke({ color: 0xffffff, alpha: 0.7, pixelLine: true });
      } else if (state.kind === 'segment') {
        const [a, b] = vertices as [Vec2, Vec2];
        const line = state.radius > 0 ? { width: 2 * state.radius, cap: 'round' as const } : { pixelLine: true };
        context.moveTo(a.x, a.y).lineTo(b.x, b.y).stroke({ color, ...line });
      } else {
        context.poly(vertices, true).fill({ color, alpha: state.radius > 0 ? 1 : alpha });
        if (state.radius > 0) context.stroke({ color, width: 2 * state.radius, join: 'round' });
        else context.stroke({ color: 0xffffff, alpha: 0.5, pixelLine: true });
      }
    }
    this.#contexts.set(key, context);
    return context;
  }

  /** Shows a world as it is now. */
  draw(world: World, layers: Layers): void {
    if (!this.#fitted) this.fit(world);
    this.#fitted = true;
    const { values, ids } = world.writePoses();
    const places = values.slice();
    const now = ids.slice();
    const seen = new Set(now);
    for (const [id, shown] of this.#bodies) {
      if (seen.has(id)) continue;
      shown.destroy();
      this.#bodies.delete(id);
    }
    const sleeping = world.settings.sleepTimeThreshold > 0;
    now.forEach((id, i) => {
      let shown = this.#bodies.get(id);
      if (shown === undefined) {
        shown = new Graphics(this.#contextOf(world, id));
        this.#scene.addChild(shown);
        this.#bodies.set(id, shown);
      }
      shown.position.set(places[4 * i]!, places[4 * i + 1]!);
      shown.rotation = Math.atan2(places[4 * i + 3]!, places[4 * i + 2]!);
      shown.alpha = sleeping && world.body(id).sleeps ? 0.45 : 1;
    });
    this.#place(now, places);
    this.#app.render();
    this.#drawOverlay(world, layers, now, places);
  }
  #drawJoints(
    world: World, context: CanvasRenderingContext2D, color: string, at: (x: number, y: number) => [number, number],
  ): void {
    for (const id of this.#bodies.keys()) {
      for (const joint of world.body(id).joints) {
        const { bodyA, bodyB, anchorA, anchorB } = joint.definition;
        if (bodyA !== id) continue;
        const [from, to] = [world.body(bodyA).toWorld(anchorA), world.body(bodyB).toWorld(anchorB)];
        line(context, color, ...at(from.x, from.y), ...at(to.x, to.y));
        const [x, y] = at(to.x, to.y);
        context.strokeRect(x - 2.5, y - 2.5, 5, 5);
      }
    }
  }
  /** Follows the marked body, if that is wanted. */
  following = false;
  #place(ids: Float64Array, places: Float32Array): void {
    const followed = this.following ? ids.indexOf(this.marked) : -1;
    if (followed >= 0) this.#center = { x: places[4 * followed]!, y: places[4 * followed + 1]! };
    const size = this.#size;
    this.#scene.scale.set(this.#scale, -this.#scale);
    this.#scene.position.set(size.x / 2 - this.#center.x * this.#scale, size.y / 2 + this.#center.y * this.#scale);
  }
  /** Forgets how bodies look, for another recording or a place far away in it. */
  forget(): void {
    for (const shown of this.#bodies.values()) shown.destroy();
    this.#bodies.clear();
  }

  #drawOverlay(world: World, layers: Layers, ids: Float64Array, places: Float32Array): void {
    const size = this.#size;
    const ratio = devicePixelRatio;
    const canvas = this.#overlay;
    if (canvas.width !== Math.round(size.x * ratio) || canvas.height !== Math.round(size.y * ratio)) {
      canvas.width = Math.round(size.x * ratio);
      canvas.height = Math.round(size.y * ratio);
    }
    const context = canvas.getContext('2d')!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, size.x, size.y);
    const style = getComputedStyle(document.documentElement);
    const [text, good, bad] = ['--text', '--good', '--bad'].map((name) => style.getPropertyValue(name)) as
      [string, string, string];
    const at = (x: number, y: number): [number, number] => [
      size.x / 2 + (x - this.#center.x) * this.#scale, size.y / 2 - (y - this.#center.y) * this.#scale];
    context.font = '11px ui-monospace, monospace';
    context.lineWidth = 1.5;
    ids.forEach((id, i) => {
      const [x, y] = at(places[4 * i]!, places[4 * i + 1]!);
      if (x < -50 || y < -50 || x > size.x + 50 || y > size.y + 50) return;
      if (layers.velocities) {
        const { velocity } = world.body(id).state;
        line(context, good, x, y, x + velocity.x * this.#scale * 0.2, y - velocity.y * this.#scale * 0.2);
      }
      if (layers.ids) {
        context.fillStyle = text;
        context.fillText(String(indexOf(id)), x + 3, y - 3);
      }
      if (id !== this.marked) return;
      context.strokeStyle = bad;
      context.beginPath();
      context.arc(x, y, 14, 0, 2 * Math.PI);
      context.stroke();
    });
    if (world.jointCount > 0) this.#drawJoints(world, context, text, at);
    if (!layers.contacts) return;
    for (const { points, normal } of world.contacts()) {
      for (const { pointA } of points) {
        const [x, y] = at(pointA.x, pointA.y);
        context.fillStyle = bad;
        context.fillRect(x - 2, y - 2, 4, 4);
        line(context, bad, x, y, x + normal.x * 12, y - normal.y * 12);
      }
    }
  }
}

function line(context: CanvasRenderingContext2D, color: string, ...[x, y, toX, toY]: [number, number, number, number]) {
  context.strokeStyle = color;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(toX, toY);
  context.stroke();
}
