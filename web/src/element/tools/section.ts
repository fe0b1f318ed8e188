// SPDX-License-Identifier: Apache-2.0
// A clipping plane that cuts the model open. Back faces that become visible get one uniform colour,
// so that a closed model looks solid at the cut.
import { Color, Plane, type Box3 } from "three";
import type { Bench, Tool } from "./bench.ts";
import { checkbox, choices, make } from "./dom.ts";
import { patchColour } from "./patch-colour.ts";

type Axis = "x" | "y" | "z";

const kTone = new Color(0xa9836b);
const kSteps = 200;

/**
 * Returns the plane perpendicular to `axis` at `fraction` (0 to 1) of the box. The plane cuts away
 * the side with larger coordinates. If `isFlipped`, it cuts away the side with smaller coordinates.
 */
export function cuttingPlane(box: Box3, axis: Axis, fraction: number, isFlipped: boolean): Plane {
  const at = box.min[axis] + fraction * (box.max[axis] - box.min[axis]);
  const plane = new Plane();
  plane.normal[axis] = isFlipped ? 1 : -1;
  plane.constant = isFlipped ? -at : at;
  return plane;
}

export class Section implements Tool {
  readonly content: HTMLElement;
  readonly #switch: HTMLLabelElement;
  readonly #slider: HTMLInputElement;
  readonly #flip: HTMLLabelElement;
  #axis: Axis = "x";

  constructor(private readonly bench: Bench) {
    const { texts } = bench;
    this.#switch = checkbox("section", texts.sectionOn, false, () => this.#cut());
    this.#slider = make("input", {
      type: "range", name: "section-at", min: "0", max: String(kSteps), value: String(kSteps / 2), "aria-label": texts.sectionAt,
      oninput: () => this.#turnOn(),
    });
    this.#flip = checkbox("section-flip", texts.sectionFlip, false, () => this.#turnOn());
    const axes = choices<Axis>("section-axis", texts.sectionAcross, texts.axes, (axis) => {
      this.#axis = axis;
      this.#turnOn();
    });
    this.content = make("div", {}, this.#switch, axes, this.#slider, this.#flip);
  }

  attach(): void {
    this.#cut();
  }

  reset(): void {
    this.#set(false, "x", kSteps / 2, false);
  }

  get setting(): string {
    if (!box(this.#switch).checked) return "";
    return [this.#axis, this.#slider.value, ...(box(this.#flip).checked ? ["flip"] : [])].join(",");
  }
  set setting(text: string) {
    const [, axis, step, flip] = /^([xyz]),(\d{1,3})(,flip)?$/.exec(text) ?? [];
    if (axis) this.#set(true, axis as Axis, Number(step), flip !== undefined);
  }

  #set(isOn: boolean, axis: Axis, step: number, isFlipped: boolean): void {
    (this.content.querySelector(`[value=${axis}]`) as HTMLInputElement).checked = true;
    this.#axis = axis;
    this.#slider.value = String(step); // the slider clamps the value to its range
    box(this.#switch).checked = isOn;
    box(this.#flip).checked = isFlipped;
    this.#cut();
  }

  #turnOn(): void {
    box(this.#switch).checked = true;
    this.#cut();
  }

  #cut(): void {
    const { stage, texts } = this.bench, on = box(this.#switch).checked;
    const fraction = Number(this.#slider.value) / kSteps, bounds = stage.mesh.presentedBox;
    this.#slider.setAttribute("aria-valuetext", texts.percent(fraction));
    stage.parts.renderer.clippingPlanes = on && bounds ? [cuttingPlane(bounds, this.#axis, fraction, box(this.#flip).checked)] : [];
    patchColour(stage.mesh.material, "inside", on ? `if (!gl_FrontFacing) gl_FragColor = vec4(${kTone.toArray().map((part) => part.toFixed(4))}, 1.0);` : "");
    void stage.draw();
  }
}

function box(label: HTMLLabelElement): HTMLInputElement {
  return label.querySelector("input") as HTMLInputElement;
}
