// SPDX-License-Identifier: Apache-2.0
// Measures the model, and distances, angles, areas and profiles between points of its surface, in its unit.
import type { Bench, Tool } from "./bench.ts";
import { choices, make } from "./dom.ts";
import { angleAt, areaOf } from "./measures.ts";
import type { Mark } from "./overlay.ts";
import { pick } from "./pick.ts";
import { ProfileSheet } from "./profile-sheet.ts";
import { ScaleBar } from "./scale-bar.ts";
import { Vector3 } from "three";

/** Maximum distance, in pixels, that the pointer may move during a click. */
const kStill = 5;

/** Smallest and largest number of points of each measure. One more point begins a new measurement. */
const kPoints = { distance: [2, 2], angle: [3, 3], area: [3, 64], profile: [2, 2] } as const;
type Measurement = keyof typeof kPoints;

export class Measure implements Tool {
  readonly content: HTMLElement;
  readonly #hint = make("p", { class: "hint" });
  readonly #result = make("p", { class: "result" });
  readonly #label = make("div", { class: "length", hidden: true });
  readonly #size = make("p", { class: "result size" });
  readonly #scale: ScaleBar;
  readonly #profile: ProfileSheet;
  #kind: Measurement = "distance";
  #points: Mark[] = [];
  #lines: HTMLElement[] = [];
  #isActive = false;

  constructor(private readonly bench: Bench) {
    const { texts } = bench, clear = make("button", { type: "button", class: "framed", onclick: () => this.reset() }, texts.measureClear);
    const kinds = choices<Measurement>("measure-what", texts.measureWhat, texts.measures, (kind) => {
      this.#kind = kind;
      this.reset();
    });
    this.#scale = new ScaleBar(bench);
    this.#profile = new ProfileSheet(bench);
    this.content = make("div", {}, make("p", { class: "label" }, texts.dimensions), this.#size, kinds, this.#hint, this.#result, this.#profile.content, clear);
    bench.view.append(this.#label);
    bench.overlay.followers.add(() => this.#draw());
    this.#tell();
  }

  /** Set to true while the tool's sheet is open. Clicks set points only during that time. */
  set isActive(on: boolean) {
    this.#isActive = this.#scale.isShown = on;
    this.bench.view.classList.toggle("measuring", on);
    if (on) this.bench.say(this.bench.texts.measureFirst);
  }

  attach(until: AbortSignal): void {
    this.reset();
    const { presentedBox, info } = this.bench.stage.mesh, { x = 0, y = 0, z = 0 } = presentedBox?.getSize(new Vector3()) ?? {};
    this.#size.textContent = this.bench.texts.extent(x, y, z, info.unit);
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
    for (const line of this.#lines.splice(0)) line.remove();
    this.#profile.hide();
    this.#tell();
  }

  #pick(x: number, y: number): void {
    const point = this.#isActive ? pick(this.bench.stage, x, y) : undefined;
    if (!point) return;
    if (this.#points.length === kPoints[this.#kind][1]) this.reset();
    const mark = { element: make("div", { class: "point" }), point };
    this.#points.push(mark);
    this.bench.overlay.add(mark);
    this.#tell();
    void this.bench.stage.draw();
  }

  #tell(): void {
    const { texts } = this.bench, [needed, most] = kPoints[this.#kind], count = this.#points.length;
    this.#hint.textContent = count > 0 && count < most ? texts.measureNext : texts.measureFirst;
    this.#label.hidden = this.#result.hidden = count < needed;
    if (count < needed) return;
    const value = this.#measured(this.#points.map(({ point }) => point));
    this.#label.textContent = this.#result.textContent = value;
    this.bench.say(`${texts.measures[this.#kind]}: ${value}`);
  }

  /** Returns the result as text. `points` has at least as many points as the measure needs. */
  #measured(points: Vector3[]): string {
    const { texts, stage } = this.bench, { unit } = stage.mesh.info, [first, second, third] = points as [Vector3, Vector3, Vector3];
    if (this.#kind === "angle") return texts.measured(angleAt(second, first, third), "°");
    if (this.#kind === "area") return `${texts.measured(areaOf(points), unit)}²`;
    if (this.#kind === "profile") void this.#profile.show({ from: first, to: second, eye: stage.parts.camera.position.clone() });
    return texts.measured(first.distanceTo(second), unit);
  }

  #draw(): void {
    const { overlay, stage, view } = this.bench, places = this.#points.map(({ point }) => overlay.project(point, stage.parts.camera));
    const isClosed = this.#kind === "area" && places.length > 2, count = Math.max(0, places.length - (isClosed ? 0 : 1));
    while (this.#lines.length < count) {
      const line = make("div", { class: "ruler" });
      this.#lines.push(line);
      view.insertBefore(line, this.#label);
    }
    this.#lines.forEach((line, i) => {
      const a = places[i], b = places[(i + 1) % places.length];
      if (!a || !b) return;
      line.style.width = `${Math.hypot(b.x - a.x, b.y - a.y)}px`;
      line.style.transform = `translate(${a.x}px, ${a.y}px) rotate(${Math.atan2(b.y - a.y, b.x - a.x)}rad)`;
    });
    const around = this.#kind === "angle" ? places.slice(1, 2) : places, mean = (of: "x" | "y") => around.reduce((sum, place) => sum + place[of], 0) / around.length;
    this.#label.style.transform = `translate(${mean("x")}px, ${mean("y")}px) translate(-50%, ${this.#kind === "angle" ? "20%" : "-50%"})`;
  }
}
