// SPDX-License-Identifier: Apache-2.0
// Plays a tour: shows one note after the other in a panel over the model. The visitor can pause, step and end it, also by keyboard.
// Screen readers read the note of each step. If the visitor prefers reduced motion, the camera jumps, and the tour waits for the visitor.
import type { Bench } from "../tools/bench.ts";
import type { Annotation } from "./annotations.ts";
import { describe } from "./describe.ts";
import type { NoteKit } from "./note-reader.ts";
import { secondsToRead } from "./paragraphs.ts";

export interface TourStep {
  /** Index of the note in the list of notes, from 0. */
  index: number;
  note: Annotation;
  seconds?: number;
  transition?: "fly" | "cut";
}

const kTillAnnounced = 100; // milliseconds that screen readers need to notice a new live region

export class TourPlayer {
  readonly #panel: HTMLElement;
  readonly #place: HTMLElement;
  readonly #text: HTMLElement;
  readonly #toggle: HTMLButtonElement;
  #steps: TourStep[] = [];
  #at = 0;
  #isPlaying = false;
  #isSilent = false; // whether the browser refuses to play the sound of the step
  #waiting = new AbortController(); // ends the wait for a sound
  #timer: ReturnType<typeof setTimeout> | undefined;
  #before = { light: "", section: "", isTurning: false }; // settings before the tour
  #until = new AbortController(); // ends the listeners of the tour
  #starter: HTMLElement | undefined;

  /** `show` shows a note on the model. */
  constructor(private readonly bench: Bench, private readonly kit: NoteKit, private readonly show: (note: number, isCut: boolean) => void) {
    const { make } = kit, { tour } = bench.texts;
    const action = (name: string, label: string, sign: string, act: () => void) =>
      make("button", { type: "button", name, title: label, "aria-label": label, onclick: act }, make("span", { "aria-hidden": "true" }, sign));
    this.#toggle = action("play", tour.pause, "❚❚", () => (this.#playing = !this.#isPlaying));
    this.#place = make("span", { class: "place" });
    // The text is a live region, so that screen readers read each step.
    this.#text = make("div", { class: "text", "aria-live": "polite", "aria-atomic": "true", tabindex: "0" });
    const bar = make("div", { class: "bar" }, action("previous", tour.previous, "‹", () => this.#step(-1)), this.#toggle,
      action("next", tour.next, "›", () => this.#step(1)), this.#place, action("end", tour.end, "×", () => this.#leave()));
    this.#panel = make("section", { class: "tour-panel", role: "group" }, this.#text, bar);
    this.#panel.addEventListener("keydown", (event) => this.#press(event));
  }

  /** Starts a tour. `starter` gets the focus back at its end. */
  start(title: string, steps: TourStep[], starter: HTMLElement): void {
    const { light, section } = this.kit;
    this.end();
    this.#before = { light: light.setting ?? "", section: section.setting ?? "", isTurning: this.bench.stage.isTurning };
    this.#steps = steps;
    this.#at = 0;
    this.#starter = starter;
    this.#panel.ariaLabel = title;
    this.kit.onTour();
    this.bench.view.append(this.#panel);
    this.bench.view.classList.add("touring");
    this.bench.stage.isTurning = false;
    this.#until = new AbortController();
    for (const type of ["pointerdown", "wheel", "keydown"] as const)
      this.bench.view.addEventListener(type, (event) => this.#look(event), { signal: this.#until.signal, passive: true });
    this.#isPlaying = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.#label();
    this.#toggle.focus();
    this.#timer = setTimeout(() => this.#present(), kTillAnnounced);
  }

  /** Ends the tour, and restores light and section. */
  end(): void {
    this.#halt();
    if (!this.#panel.isConnected) return;
    this.#until.abort();
    this.#panel.remove();
    this.bench.view.classList.remove("touring", "playing");
    this.bench.stage.isTurning = this.#before.isTurning;
    this.#text.replaceChildren();
    for (const name of ["light", "section"] as const) {
      if (this.#before[name]) this.kit[name].setting = this.#before[name];
      else this.kit[name].reset?.();
    }
  }

  /** Ends the tour at the visitor's request. The focus returns to the button that started the tour. */
  #leave(): void {
    this.end();
    this.kit.onChosen(); // opens the sheet again
    this.#starter?.focus();
  }

  set #playing(on: boolean) {
    if (!this.#panel.isConnected || on === this.#isPlaying) return;
    this.#isPlaying = on;
    if (on && this.#at === this.#steps.length - 1) this.#at = 0;
    this.#present(on);
  }

  /** Pauses the tour if the visitor looks around. */
  #look(event: Event): void {
    const target = event.target as Node;
    if (this.#panel.contains(target)) return;
    if (event.type !== "pointerdown" && !(target instanceof HTMLCanvasElement && this.bench.stage.parts.controls.enabled)) return;
    if (event instanceof KeyboardEvent && (isModified(event) || ["Tab", "Shift"].includes(event.key))) return;
    this.#playing = false;
  }

  #step(by: number): void {
    const at = this.#at + by;
    if (at < 0 || at >= this.#steps.length) return;
    this.#at = at;
    this.#present();
  }

  /** Ends all waiting for the next step. */
  #halt(): void {
    clearTimeout(this.#timer);
    this.#waiting.abort();
  }

  /** Shows the present step. If not `isNew`, only the buttons change. */
  #present(isNew = true): void {
    const { make } = this.kit, { index, note, transition } = this.#steps[this.#at] as TourStep;
    this.#halt();
    if (isNew || !this.#text.hasChildNodes()) {
      this.#text.replaceChildren(make("p", { class: "title" }, note.title), ...describe(make, note));
      this.#text.lang = note.language ?? "";
      if (!note.language) this.#text.removeAttribute("lang");
      this.show(index, transition === "cut");
      this.bench.host.dispatchEvent(new CustomEvent("tour-step", { detail: { step: this.#at + 1, steps: this.#steps.length } }));
      const sound = this.#text.querySelector("audio");
      this.#isSilent = false;
      if (sound && this.#isPlaying) void sound.play().catch(() => void (this.#isSilent ||= sound === this.#text.querySelector("audio")));
    } else this.#text.querySelector("audio")?.pause();
    this.#label();
    if (this.#isPlaying) this.#wait();
  }

  #label(): void {
    const { tour } = this.bench.texts;
    this.bench.view.classList.toggle("playing", this.#isPlaying);
    const label = this.#isPlaying ? tour.pause : tour.play;
    this.#toggle.title = this.#toggle.ariaLabel = label;
    (this.#toggle.firstChild as HTMLElement).textContent = this.#isPlaying ? "❚❚" : "▶";
    this.#place.textContent = tour.stop(this.#at + 1, this.#steps.length);
  }

  /** Waits until the note is read, and until its sound has ended, has failed or is paused, then continues. */
  #wait(): void {
    const { note, seconds } = this.#steps[this.#at] as TourStep, sound = this.#text.querySelector("audio");
    const { signal } = (this.#waiting = new AbortController());
    const go = () => {
      this.#halt();
      if (this.#at < this.#steps.length - 1) return this.#step(1);
      this.#playing = false;
      this.bench.view.dispatchEvent(new Event("tour-rest")); // from now on, the viewer may be idle
    };
    const read = () => {
      if (!sound || !isSounding(sound) || this.#isSilent) return go();
      for (const type of ["ended", "error", "pause"]) sound.addEventListener(type, go, { signal });
    };
    this.#timer = setTimeout(read, 1000 * (seconds ?? secondsToRead(note.title, note.text)));
  }

  #press(event: KeyboardEvent): void {
    const act = { ArrowRight: () => this.#step(1), ArrowLeft: () => this.#step(-1), Escape: () => this.#leave() }[event.key];
    if (!act || isModified(event) || (event.target as Element).matches("audio")) return;
    event.preventDefault();
    event.stopPropagation(); // without this, Escape would also close a dialog of the page
    act();
  }
}

/** Whether a sound is playing. A sound that fails to load is never paused. */
export function isSounding({ paused, ended, error }: Pick<HTMLMediaElement, "paused" | "ended" | "error">): boolean {
  return !paused && !ended && error === null;
}

/** Whether a key is a shortcut of the browser or the system. */
function isModified({ altKey, ctrlKey, metaKey }: KeyboardEvent): boolean {
  return altKey || ctrlKey || metaKey;
}
