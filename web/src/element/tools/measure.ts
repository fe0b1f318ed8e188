// SPDX-License-Identifier: Apache-2.0
// Measures the straight distance between two points of the surface, in the model's unit.
import type { Bench, Tool } from "./bench.ts";
import { make } from "./dom.ts";
import type { Mark } from "./overlay.ts";
import { pick } from "./pick.ts";

/** Maximum pointer movement of a click, in pixels. */
const kStill = 5;

export class Measure implements Tool {
  readonly content: HTMLElement;
  readonly #hint = make("p", { class: "hint" });
  readonly #result = make("p", { class: "result" });
  readonly #line = make("div", { class: "ruler", hidden: true });
  readonly #label = make("div", { class: "length", hidden: true });
  #points: Mark[] = [];
  #isActive = false;

  constructor(private readonly bench: Bench) {
    const clear = make("button", { type: "button", class: "framed", onclick: () => this.reset() }, bench.texts.measureClear);
    this.content = make("div", {}, this.#hint, this.#result, clear);
    bench.view.append(this.#line, this.#label);
    bench.overlay.followers.add(() => this.#draw());
    this.#tell();
  }

  /** Set to true while the tool's sheet is open. Only then do clicks set points. */
  set isActive(on: boolean) {
    this.#isActive = on;
    this.bench.view.classList.toggle("measuring", on);
    if (on) this.bench.say(this.bench.texts.measureFirst);
  }

  attach(until: AbortSignal): void {
    this.reset();
    const canvas = this.bench.view.querySelector("canvas") as HTMLCanvasElement;
    let down: PointerEvent | undefined;
    canvas.addEventListener("pointerdown", (event) => (down = event), { signal: until });
    canvas.addEventListener("pointerup", (event) => {
      if (down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < kStill) this.#pick(event.offsetX, event.offsetY);
    }, { signal: until });
    canvas.addEventListener("keydown", ({ key }) => {
      if (key === "Enter") this.#pick(canvas.clientWidth / 2, canvas.clientHeight / 2);
    }, { signal: until });
  }

  reset(): void {
    for (const mark of this.#points.splice(0)) this.bench.overlay.remove(mark);
    this.#tell();
  }

  #pick(x: number, y: number): void {
    const point = this.#isActive ? pick(this.bench.stage, x, y) : undefined;
    if (!point) return;
    if (this.#points.length === 2) this.reset();
    const mark = { element: make("div", { class: "point" }), point };
    this.#points.push(mark);
    this.bench.overlay.add(mark);
    this.#tell();
    void this.bench.stage.draw();
  }

  #tell(): void {
    const { texts } = this.bench, [first, second] = this.#points;
    this.#hint.textContent = first && !second ? texts.measureSecond : texts.measureFirst;
    this.#line.hidden = this.#label.hidden = this.#result.hidden = !second;
    if (!first || !second) return;
    const length = first.point.distanceTo(second.point), { unit } = this.bench.stage.mesh.info;
    this.#label.textContent = this.#result.textContent = texts.measured(length, unit);
    this.bench.say(texts.distance(length, unit));
  }

  #draw(): void {
    const [first, second] = this.#points, { camera } = this.bench.stage.parts;
    if (!first || !second) return;
    const a = this.bench.overlay.project(first.point, camera), b = this.bench.overlay.project(second.point, camera);
    this.#line.style.width = `${Math.hypot(b.x - a.x, b.y - a.y)}px`;
    this.#line.style.transform = `translate(${a.x}px, ${a.y}px) rotate(${Math.atan2(b.y - a.y, b.x - a.x)}rad)`;
    this.#label.style.transform = `translate(${(a.x + b.x) / 2}px, ${(a.y + b.y) / 2}px) translate(-50%, -50%)`;
  }
}
