// SPDX-License-Identifier: Apache-2.0
// A clipping plane that cuts the model open. Back faces that become visible get one flat colour, so that a closed
// model looks solid at the cut.
import { Color, Plane, type Box3, type MeshStandardMaterial, type WebGLProgramParametersWithUniforms } from "three";
import type { Bench, Tool } from "./bench.ts";
import { checkbox, choices, make } from "./dom.ts";

type Axis = "x" | "y" | "z";

const kTone = new Color(0xa9836b);
const kSteps = 200;

/**
 * Returns the plane perpendicular to `axis` at `fraction` (0 to 1) of the box. It cuts away the side with larger
 * coordinates or, if `isFlipped`, the side with smaller ones.
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
  #undress: (() => void) | undefined;

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

  attach(until: AbortSignal): void {
    until.addEventListener("abort", () => (this.#undress = undefined)); // the patched material is disposed of with the model
    this.#cut();
  }

  reset(): void {
    (this.content.querySelector("[value=x]") as HTMLInputElement).checked = true;
    this.#axis = "x";
    this.#slider.value = String(kSteps / 2);
    box(this.#switch).checked = box(this.#flip).checked = false;
    this.#cut();
  }

  #turnOn(): void {
    box(this.#switch).checked = true;
    this.#cut();
  }

  #cut(): void {
    const { stage, texts } = this.bench, on = box(this.#switch).checked;
    const fraction = Number(this.#slider.value) / kSteps, bounds = stage.mesh.geometry.boundingBox;
    this.#slider.setAttribute("aria-valuetext", texts.percent(fraction));
    stage.parts.renderer.clippingPlanes = on && bounds ? [cuttingPlane(bounds, this.#axis, fraction, box(this.#flip).checked)] : [];
    if (on) this.#undress ??= evenInside(stage.mesh.material);
    else this.#undress = void this.#undress?.();
    void stage.draw();
  }
}

function box(label: HTMLLabelElement): HTMLInputElement {
  return label.querySelector("input") as HTMLInputElement;
}

/** Paints back faces in one flat colour; returns a function that undoes this. */
function evenInside(material: MeshStandardMaterial): () => void {
  const { onBeforeCompile, customProgramCacheKey } = material;
  const tone = `vec4(${kTone.toArray().map((part) => part.toFixed(4)).join(", ")}, 1.0)`;
  material.onBeforeCompile = (shader: WebGLProgramParametersWithUniforms, renderer) => {
    onBeforeCompile.call(material, shader, renderer);
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <opaque_fragment>", `#include <opaque_fragment>\nif (!gl_FrontFacing) gl_FragColor = ${tone};`);
  };
  material.customProgramCacheKey = () => `${customProgramCacheKey.call(material)} even inside`;
  material.needsUpdate = true;
  return () => {
    Object.assign(material, { onBeforeCompile, customProgramCacheKey });
    material.needsUpdate = true;
  };
}
