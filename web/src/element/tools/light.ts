// SPDX-License-Identifier: Apache-2.0
// Lighting presets. The museum's light is the default: a room for textured models, a lamp and a sky for
// untextured ones. Raking light comes from the side, nearly parallel to the surface, so that shading reveals
// every tool mark. The visitor can turn the direction of raking light.
import type { PresentedLight } from "../../core/presentation.ts";
import type { Lighting } from "../lights.ts";
import type { Bench, Tool } from "./bench.ts";
import { choices, make } from "./dom.ts";

export type Preset = "museum" | "studio" | "raking" | "relief";

/**
 * Component of the raking light's direction towards the visitor, divided by the component in the
 * plane of the screen.
 */
const kLift = 0.14;
const kFirstAngle = 315; // degrees clockwise from the top: upper left, as is usual for reliefs

const kLamp: [number, number, number] = [-0.6, 0.9, 0.6];

export const kLightings: Record<Exclude<Preset, "museum">, Lighting> = {
  studio: { from: kLamp, relief: { lamp: 2.2, sky: 1.1 }, inRoom: { lamp: 0, sky: 0, room: 1 } },
  raking: { from: rakingFrom(kFirstAngle), relief: { lamp: 4.2, sky: 0.16 }, inRoom: { lamp: 3.6, sky: 0, room: 0.1 } },
  relief: { from: kLamp, relief: { lamp: 2.2, sky: 1.1 }, inRoom: { lamp: 2.2, sky: 1.1, room: 0 } },
};

/** Returns the direction of raking light that comes from `angle` degrees clockwise from the top. */
export function rakingFrom(angle: number): [number, number, number] {
  const radians = (angle * Math.PI) / 180;
  return [Math.sin(radians), Math.cos(radians), kLift];
}

/** Returns an angle in degrees as a whole number from 0 to 359. */
function wholeDegrees(angle: number): number {
  return ((Math.round(angle) % 360) + 360) % 360;
}

export class Light implements Tool {
  readonly content: HTMLElement;
  readonly #dial: HTMLElement;
  #preset: Preset = "museum";
  #angle = kFirstAngle;
  #isChosen = false; // whether the visitor or a link has chosen the light

  constructor(private readonly bench: Bench) {
    const { texts } = bench;
    const { museum, studio, raking, relief } = texts;
    this.#dial = make("div", {
      class: "dial", role: "slider", tabindex: "0", hidden: true,
      "aria-label": texts.rakingFrom, "aria-valuemin": "0", "aria-valuemax": "359",
    }, make("span"));
    this.#dial.addEventListener("keydown", (event) => this.#press(event));
    this.#dial.addEventListener("pointerdown", (event) => this.#hold(event));
    this.#dial.addEventListener("pointermove", (event) => this.#dial.hasPointerCapture(event.pointerId) && this.#point(event));
    const presets = choices("light", texts.light, { museum, studio, raking, relief }, (preset) => {
      this.#isChosen = true;
      this.#choose(preset);
    });
    this.content = make("div", {}, presets, this.#dial);
  }

  attach(): void {
    // Without textures, the preset "relief" would be the same as the museum's light, so it is
    // hidden.
    (this.#radio("relief").parentElement as HTMLElement).hidden = !this.bench.stage.mesh.info.texture;
    this.#take(this.#isChosen ? this.#chosen : this.#first);
  }

  reset(): void {
    this.#isChosen = false;
    this.#take(this.#first);
  }

  get setting(): string {
    return this.#chosen === this.#first ? "" : this.#chosen;
  }
  set setting(text: string) {
    const [preset = "", angle] = text.split(",");
    if (!Object.hasOwn(kLightings, preset) && preset !== "museum") return;
    this.#isChosen = true;
    this.#take(text);
  }

  /** The light as a presentation states it. Null stands for the museum's light. */
  get presented(): PresentedLight | null {
    return this.#preset === "museum" ? null : { preset: this.#preset, angle: this.#angle };
  }

  get #chosen(): string {
    return this.#preset === "raking" ? `raking,${this.#angle}` : this.#preset;
  }

  /** The light that the presentation of the model chooses. */
  get #first(): string {
    const light = this.bench.stage.mesh.info.presentation?.light;
    if (!light || !Object.hasOwn(kLightings, light.preset)) return "museum";
    return light.preset === "raking" ? `raking,${wholeDegrees(light.angle)}` : light.preset;
  }

  /** Chooses the light that a setting describes. */
  #take(text: string): void {
    const [preset, angle] = text.split(",");
    this.#angle = kFirstAngle;
    if (Number.isFinite(Number(angle))) this.#angle = wholeDegrees(Number(angle));
    this.#select(preset as Preset);
  }

  #select(preset: Preset): void {
    this.#radio(preset).checked = true;
    this.#choose(preset);
  }

  #radio(preset: Preset): HTMLInputElement {
    return this.content.querySelector(`[value=${preset}]`) as HTMLInputElement;
  }

  #choose(preset: Preset): void {
    this.#preset = preset;
    this.#dial.hidden = preset !== "raking";
    this.#shine();
  }

  #shine(): void {
    const { stage } = this.bench;
    stage.parts.lights.lighting = this.#lighting;
    // Ignores an error. Lamp and sky then light the model.
    if (this.#preset === "studio") stage.enterRoom().catch(() => undefined);
    this.#dial.style.setProperty("--angle", `${this.#angle}deg`);
    this.#dial.setAttribute("aria-valuenow", String(this.#angle));
    this.#dial.setAttribute("aria-valuetext", this.bench.texts.degrees(this.#angle));
    void stage.draw();
  }

  /**
   * The lighting of the chosen preset. A model without textures is lit by the room only in the
   * preset "studio".
   */
  get #lighting(): Lighting | undefined {
    const hasRoom = this.bench.stage.mesh.info.texture !== undefined;
    if (this.#preset === "museum") return hasRoom ? undefined : kLightings.relief;
    const lighting = kLightings[this.#preset];
    if (this.#preset !== "raking") return lighting;
    return { ...lighting, from: rakingFrom(this.#angle), ...(!hasRoom && { inRoom: { ...lighting.relief, room: 0 } }) };
  }

  #turn(angle: number): void {
    this.#isChosen = true;
    this.#angle = wholeDegrees(angle);
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
