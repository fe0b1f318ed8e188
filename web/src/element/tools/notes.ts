// SPDX-License-Identifier: Apache-2.0
// Finds out whether there are notes on the model, and loads the code that shows them (notes/note-reader.ts). Notes come from the
// daemon, from the page's hotspots (slot="hotspot-…"), and from the file that the attribute `annotations` names.
import type { NoteKit, NoteReader } from "../notes/note-reader.ts";
import type { Bench, Tool } from "./bench.ts";
import { make } from "./dom.ts";
import { apiOf } from "./links.ts";
import { pick } from "./pick.ts";
import { anglesOf } from "./view.ts";

const kWatched = { childList: true, subtree: true, attributeFilter: ["slot", "data-position", "data-normal", "annotations"] };

export class Notes implements Tool {
  readonly content = make("div");
  /** Called when a note is chosen, to open the sheet with `content`. */
  onChosen: () => void = () => undefined;
  /** Called when `content` has changed. `any` is false if `content` has nothing to read. */
  onFilled: (any: boolean) => void = () => undefined;
  /** Called when a tour begins, to close the sheet. */
  onTour: () => void = () => undefined;
  #loading: Promise<NoteReader> | undefined;
  #reader: NoteReader | undefined;
  #wanted = ""; // the setting that was chosen before the code was loaded

  /** `moment`: the tools for light and section. A note can store their settings. */
  constructor(private readonly bench: Bench, private readonly style: (css: string) => void, private readonly moment: Pick<NoteKit, "light" | "section">) {}

  attach(until: AbortSignal): void {
    const watch = new MutationObserver(() => this.#gather(until));
    watch.observe(this.bench.host, kWatched);
    until.addEventListener("abort", () => {
      watch.disconnect();
      this.#reader?.leave();
      this.onFilled(false);
    });
    this.#gather(until);
  }

  reset(): void {
    this.#reader?.reset();
  }

  get setting(): string {
    return this.#reader?.setting ?? "";
  }
  set setting(text: string) {
    this.#wanted = text;
    if (this.#reader) this.#reader.setting = text;
  }

  /** Moves the marks after the presentation of the model has changed. */
  follow(): void {
    this.#reader?.follow();
  }

  /** Loads the code that shows notes. If that fails, a later call tries again. */
  reader(): Promise<NoteReader> {
    return (this.#loading ??= this.#load().catch((error) => {
      this.#loading = undefined;
      throw error;
    }));
  }

  async #load(): Promise<NoteReader> {
    const { NoteReader } = await import("../notes/note-reader.ts");
    this.#reader = new NoteReader(this.bench, {
      make, apiOf, anglesOf, pick, style: this.style, content: this.content, ...this.moment,
      onChosen: () => this.onChosen(), onFilled: (any) => this.onFilled(any), onTour: () => this.onTour(),
    });
    this.#reader.setting = this.#wanted;
    return this.#reader;
  }

  #gather(until: AbortSignal): void {
    const { host, stage } = this.bench;
    const hasNotes = host.hasAttribute("annotations") || host.querySelector(":scope > [slot^=hotspot-]") || stage.mesh.info.presentation?.notes;
    if (!hasNotes && !this.#reader) return;
    // Ignores an error. The model is then shown without notes.
    this.reader().then((reader) => until.aborted || reader.gather(until), () => undefined);
  }
}
