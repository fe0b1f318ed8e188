// SPDX-License-Identifier: Apache-2.0
// The visitor's settings for drawing the surface. They also apply to the next model.
import { Mesh, MeshBasicMaterial } from "three";
import type { Bench, Tool } from "./bench.ts";
import { curvatureShading } from "./curvature.ts";
import { checkbox, make } from "./dom.ts";
import { patchColour } from "./patch-colour.ts";

const kToggles = { form: false, curvature: false, facets: false, wireframe: false };
type Toggle = keyof typeof kToggles;

export class SurfaceStyle implements Tool {
  readonly content: HTMLElement;
  #wires: Mesh<Mesh["geometry"], MeshBasicMaterial> | undefined;

  constructor(private readonly bench: Bench) {
    const boxes = this.#each((name, first) => checkbox(name, bench.texts[name], first, (on) => this.#apply(name, on)));
    this.content = make("div", {}, ...boxes);
  }

  attach(until: AbortSignal): void {
    until.addEventListener("abort", () => this.#removeWires());
    const form = this.#box("form").closest("label") as HTMLElement;
    form.hidden = !this.bench.stage.mesh.hasColours;
    this.#each((name, first) => this.#box(name).checked !== first && this.#apply(name, !first));
  }

  reset(): void {
    this.#each((name, first) => this.#set(name, first));
  }

  get setting(): string {
    return this.#each((name) => (this.#box(name).checked ? name : "")).filter(Boolean).join(",");
  }
  set setting(text: string) {
    const names = text.split(",");
    this.#each((name) => names.includes(name) && this.#set(name, true));
  }

  #apply(name: Toggle, on: boolean): void {
    const { stage } = this.bench;
    const { material } = stage.mesh;
    if (name === "form") stage.form = on;
    if (name === "curvature") patchColour(material, name, on ? curvatureShading(stage.radius) : "");
    if (name === "facets") Object.assign(material, { flatShading: on, needsUpdate: true });
    if (name === "wireframe") this.#wire(on);
    void stage.draw();
  }

  #wire(on: boolean): void {
    const { mesh } = this.bench.stage;
    this.#removeWires();
    Object.assign(mesh.material, { polygonOffset: on, polygonOffsetFactor: Number(on), polygonOffsetUnits: Number(on) });
    if (!on) return;
    this.#wires = new Mesh(mesh.geometry, new MeshBasicMaterial({ color: 0x1f4e5f, wireframe: true, transparent: true, opacity: 0.45 }));
    mesh.morph(this.#wires.material);
    mesh.add(this.#wires); // the wires follow the mesh, for example into the visitor's room
  }

  #removeWires(): void {
    this.#wires?.removeFromParent();
    this.#wires?.material.dispose();
    this.#wires = undefined;
  }

  #set(name: Toggle, on: boolean): void {
    if (this.#box(name).checked !== on) this.#box(name).click();
  }

  #each<T>(use: (name: Toggle, first: boolean) => T): T[] {
    return (Object.keys(kToggles) as Toggle[]).map((name) => use(name, kToggles[name]));
  }

  #box(name: Toggle): HTMLInputElement {
    return this.content.querySelector(`[name=${name}]`) as HTMLInputElement;
  }
}
