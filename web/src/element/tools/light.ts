// SPDX-License-Identifier: Apache-2.0
// Lighting presets. Raking light comes from the side, nearly parallel to the surface, so that shading
// reveals every tool mark; the visitor can turn its direction.
import { HemisphereLight } from "three";
import type { Bench, Tool } from "./bench.ts";
import { choices, make } from "./dom.ts";

interface Lighting {
  /** Direction from the object to the lamp: right, up, towards the visitor. */
  from: [number, number, number];
  lamp: number;
  sky: number;
}

export type Preset = "studio" | "soft" | "front" | "raking";

/**
 * Component of the raking light's direction towards the visitor. The component in the plane of the screen has length
 * 1.
 */
const kLift = 0.14;
const kFirstAngle = 315; // degrees clockwise from the top: light from the upper left, the convention for reliefs

export const kLightings: Record<Preset, Lighting> = {
  studio: { from: [-0.6, 0.9, 0.6], lamp: 2.2, sky: 1.1 },
  soft: { from: [-0.3, 0.9, 0.8], lamp: 0.7, sky: 2.4 },
  front: { from: [0, 0, 1], lamp: 2.4, sky: 0.7 },
  raking: { from: rakingFrom(kFirstAngle), lamp: 4.2, sky: 0.16 },
};

/** Returns the direction of raking light that comes from `angle` degrees clockwise from the top. */
export function rakingFrom(angle: number): [number, number, number] {
  const radians = (angle * Math.PI) / 180;
  return [Math.sin(radians), Math.cos(radians), kLift];
}

export class Light implements Tool {
  readonly content: HTMLElement;
  readonly #dial: HTMLElement;
  #preset: Preset = "studio";
  #angle = kFirstAngle;

  constructor(private readonly bench: Bench) {
    const { texts } = bench;
    const { studio, soft, front, raking } = texts;
    this.#dial = make("div", {
      class: "dial", role: "slider", tabindex: "0", hidden: true,
      "aria-label": texts.rakingFrom, "aria-valuemin": "0", "aria-valuemax": "359",
    }, make("span"));
    this.#dial.addEventListener("keydown", (event) => this.#press(event));
    this.#dial.addEventListener("pointerdown", (event) => this.#hold(event));
    this.#dial.addEventListener("pointermove", (event) => this.#dial.hasPointerCapture(event.pointerId) && this.#point(event));
    const presets = choices("light", texts.light, { studio, soft, front, raking }, (preset) => this.#choose(preset));
    this.content = make("div", {}, presets, this.#dial);
  }

  attach(): void {
    this.#shine();
  }

  reset(): void {
    (this.content.querySelector("[value=studio]") as HTMLInputElement).checked = true;
    this.#angle = kFirstAngle;
    this.#choose("studio");
  }

  #choose(preset: Preset): void {
    this.#preset = preset;
    this.#dial.hidden = preset !== "raking";
    this.#shine();
  }

  #shine(): void {
    const { scene, lamp } = this.bench.stage.parts, { from, lamp: power, sky } = kLightings[this.#preset];
    lamp.position.set(...(this.#preset === "raking" ? rakingFrom(this.#angle) : from));
    lamp.intensity = power;
    for (const light of scene.children) if (light instanceof HemisphereLight) light.intensity = sky;
    this.#dial.style.setProperty("--angle", `${this.#angle}deg`);
    this.#dial.setAttribute("aria-valuenow", String(this.#angle));
    this.#dial.setAttribute("aria-valuetext", this.bench.texts.degrees(this.#angle));
    void this.bench.stage.draw();
  }

  #turn(angle: number): void {
    this.#angle = ((Math.round(angle) % 360) + 360) % 360;
    this.#shine();
  }

  #press(event: KeyboardEvent): void {
    const step = { ArrowRight: 5, ArrowUp: 5, ArrowLeft: -5, ArrowDown: -5, PageUp: 45, PageDown: -45 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    this.#turn(this.#angle + step);
  }

  #hold(event: PointerEvent): void {
    this.#dial.setPointerCapture(event.pointerId);
    this.#point(event);
  }

  #point({ clientX, clientY }: PointerEvent): void {
    const { left, top, width, height } = this.#dial.getBoundingClientRect();
    this.#turn((Math.atan2(clientX - left - width / 2, top + height / 2 - clientY) * 180) / Math.PI);
  }
}
