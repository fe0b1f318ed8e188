// SPDX-License-Identifier: Apache-2.0
// The visitor's controls of detail. Buttons request the lowest level, the next finer level or the
// highest level. Each button states the size of its level and the estimated waiting time. A slider
// requests any detail in between. A badge describes the surface shown.
import type { ModelInfo, Want } from "../core/types.ts";
import { inMillimetres } from "../texts/formats.ts";
import type { ViewerTexts } from "../texts/index.ts";
import { completeLevel, nextLevel, Throughput } from "./quality.ts";

export const kChoice = `
  <div class="choice" role="group" data-label="quality">
    <button type="button" name="lowest" disabled><b data-text="lowest"></b><small></small></button>
    <button type="button" name="refine" disabled><b data-text="refine"></b><small></small></button>
    <button type="button" name="highest" disabled><b data-text="highest"></b><small></small></button>
  </div>
  <div class="detail">
    <input type="range" name="detail" data-label="quality" min="0" max="1000" value="0" disabled>
    <output aria-live="off"><span class="triangles"></span><span class="bytes"></span><span class="error"></span></output>
  </div>`;

type ChoiceName = "lowest" | "refine" | "highest";

export class Choice {
  onChoose: (want: Want) => void = () => undefined;
  readonly #line = new Throughput();
  #info: ModelInfo | undefined;
  #triangles = 0; // number of triangles shown now
  #pictureBytes = 0; // size of all pictures fetched, except those in the file's head
  #again: (() => void) | undefined; // repeats the last call of show()
  #texts: ViewerTexts | undefined; // undefined until the texts have been loaded

  constructor(private readonly root: ParentNode) {
    this.#button("lowest").addEventListener("click", () => this.onChoose({ level: 0 }));
    this.#button("refine").addEventListener("click", () => this.onChoose({ level: this.#next ?? this.#finest }));
    this.#button("highest").addEventListener("click", () => this.onChoose({ level: this.#finest }));
  }

  set texts(texts: ViewerTexts) {
    this.#texts = texts;
    if (this.#again) this.#again();
    else this.#tell();
  }

  get triangles(): number {
    return this.#triangles;
  }

  /** Total size in bytes of the pictures fetched, except those in the file's head. */
  set pictureBytes(bytes: number) {
    this.#pictureBytes = bytes;
    this.#again?.();
  }

  /** Called when a download begins. Starts measuring the throughput. */
  begin(): void {
    this.#line.begin(performance.now());
  }

  arrived(bytes: number): void {
    this.#line.sample(bytes, performance.now());
    this.#tell();
  }

  enable(info: ModelInfo): void {
    this.#info = info;
    this.#pictureBytes = 0;
    this.#line.sample(this.#bytesOf(0), performance.now());
    // Shows the base mesh, for which show() was already called before the controls were enabled.
    this.#again?.();
  }

  disable(): void {
    this.#info = undefined;
    for (const name of ["lowest", "refine", "highest"] as const) this.#button(name).disabled = true;
  }

  /**
   * Shows the current state. `isBounded` is true if the model is refined uniformly. Only then is
   * the error bound of its level valid.
   */
  show({ triangles, bytes }: { triangles: number; bytes: number }, isBounded: boolean): void {
    this.#again = () => this.show({ triangles, bytes }, isBounded);
    this.#triangles = triangles;
    const texts = this.#texts;
    if (!texts || !this.#info) return;
    const counted = texts.triangles(triangles, this.#info.levels[this.#finest]?.faces ?? triangles);
    this.#write(".triangles", counted);
    this.#write(".bytes", texts.bytes(bytes + this.#pictureBytes, this.#bytesOf(this.#finest) + this.#pictureBytes));
    const error = completeLevel(this.#info, triangles).maxError * (this.#info.presentation?.scale ?? 1);
    this.#write(".error", isBounded ? texts.error(...inMillimetres(error, this.#info.unit)) : "");
    this.root.querySelector("[name=detail]")?.setAttribute("aria-valuetext", counted);
    this.#tell();
  }

  #tell(): void {
    const texts = this.#texts, next = this.#next;
    if (!this.#info || !texts) return;
    const lowest = this.#bytesOf(0), highest = this.#bytesOf(this.#finest);
    this.#offer("lowest", texts.size(lowest), this.#wait(texts, lowest)).ariaPressed = String(next === 1);
    this.#offer("highest", texts.size(highest), this.#wait(texts, highest)).ariaPressed = String(next === undefined);
    const refine = next === undefined
      ? this.#offer("refine", texts.complete)
      : this.#offer("refine", texts.more(this.#bytesOf(next) - this.#bytesOf(next - 1)), this.#wait(texts, this.#bytesOf(next)));
    refine.ariaDisabled = String(next === undefined); // unlike `disabled`, keeps the focus
  }

  #offer(name: ChoiceName, ...facts: string[]): HTMLButtonElement {
    const button = this.#button(name);
    const parts = facts.filter(Boolean).flatMap((fact) => [Object.assign(document.createElement("span"), { textContent: fact }), " "]);
    button.querySelector("small")?.replaceChildren(...parts.slice(0, -1));
    button.disabled = false;
    return button;
  }

  /**
   * Returns the estimated time until `bytes` are downloaded, as text. The text is empty before the
   * throughput has been measured.
   */
  #wait(texts: ViewerTexts, bytes: number): string {
    const seconds = this.#line.secondsTo(bytes);
    if (seconds === undefined) return "";
    return seconds < 0.5 ? texts.atOnce : texts.wait(seconds);
  }

  #bytesOf(level: number): number {
    return this.#info?.levels[level]?.cumulativeBytes ?? 0;
  }
  get #next(): number | undefined {
    return this.#info && nextLevel(this.#info, this.#triangles);
  }
  get #finest(): number {
    return (this.#info?.levels.length ?? 1) - 1;
  }

  #button(name: ChoiceName): HTMLButtonElement {
    return this.root.querySelector(`[name=${name}]`) as HTMLButtonElement;
  }
  #write(selector: string, text: string): void {
    (this.root.querySelector(selector) as HTMLElement).textContent = text;
  }
}
