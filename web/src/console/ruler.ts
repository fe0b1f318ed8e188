// SPDX-License-Identifier: Apache-2.0
// Picks two points on the object in a viewer, and shows the line between them.
import type { Presenter } from "../element/tools/presenter.ts";
import type { h as make } from "../ui/dom.ts";
import type { Vector } from "./rotation.ts";

/** Maximum distance, in pixels, that the pointer may move during a click. */
const kStill = 5;

export class Ruler {
  /** Called when the number of points has changed. */
  onChange: () => void = () => undefined;
  readonly #line: HTMLElement;
  #points: Vector[] = [];
  #isActive = false;

  /** `presenter` returns the functions of the viewer in `stage`, once they are available. */
  constructor(h: typeof make, private readonly stage: HTMLElement, private readonly presenter: () => Presenter | undefined, signal: AbortSignal) {
    stage.append((this.#line = h("div", { class: "known-length", hidden: true })));
    let down: PointerEvent | undefined;
    const options = { signal, capture: true };
    stage.addEventListener("pointerdown", (event) => (down = event), options);
    stage.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (down && Math.hypot(clientX - down.clientX, clientY - down.clientY) < kStill) this.#pick(clientX, clientY);
    }, options);
    for (const type of ["camera-change", "refine"]) stage.addEventListener(type, () => this.#draw(), options);
    addEventListener("resize", () => this.#draw(), { signal });
  }

  get isActive(): boolean {
    return this.#isActive;
  }
  set isActive(on: boolean) {
    this.#isActive = on;
    this.stage.classList.toggle("measuring", on);
    this.#set([]);
  }

  get points(): number {
    return this.#points.length;
  }

  /** The distance of the two points in the unit of the model. 0 if there are not two. */
  get length(): number {
    const [a, b] = this.#points;
    return a && b ? Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) : 0;
  }

  #pick(x: number, y: number): void {
    const point = this.#isActive ? this.presenter()?.pick(x, y) : undefined;
    if (point) this.#set([...(this.#points.length === 2 ? [] : this.#points), point]);
  }

  #set(points: Vector[]): void {
    this.#points = points;
    this.#draw();
    this.onChange();
  }

  #draw(): void {
    const presenter = this.presenter(), { left, top } = this.stage.getBoundingClientRect();
    const places = presenter ? this.#points.map((point) => presenter.project(point)) : [];
    const [a, b = a] = places;
    this.#line.hidden = !a || !b;
    if (!a || !b) return;
    this.#line.style.width = `${Math.hypot(b[0] - a[0], b[1] - a[1])}px`;
    this.#line.style.transform = `translate(${a[0] - left}px, ${a[1] - top}px) rotate(${Math.atan2(b[1] - a[1], b[0] - a[0])}rad)`;
  }
}
