// SPDX-License-Identifier: Apache-2.0
// The visitor's tools. They are a separate bundle that is loaded after the first paint. The bundle
// shares no code with the viewer's other bundles: it gets the objects that it needs as arguments.
import type { ViewerTexts } from "../../texts/index.ts";
import type { Panel } from "../panel.ts";
import type { Stage } from "../stage.ts";
import { Announcer } from "./announcer.ts";
import type { Bench, Tool, ViewerControls } from "./bench.ts";
import { make } from "./dom.ts";
import { DragHint } from "./drag-hint.ts";
import { Idle } from "./idle.ts";
import { Keyboard } from "./keyboard.ts";
import { Light } from "./light.ts";
import { Measure } from "./measure.ts";
import { Notes } from "./notes.ts";
import { OrbitController } from "./orbit.ts";
import { Overlay } from "./overlay.ts";
import { Presenter } from "./presenter.ts";
import { Reality } from "./reality.ts";
import { Save } from "./save.ts";
import { Shadow } from "./shadow.ts";
import { Section } from "./section.ts";
import { Sheets } from "./sheets.ts";
import { SurfaceStyle } from "./surface.ts";
import { Visits } from "./visits.ts";
import style from "./tools.css?text";

export class Toolbox implements Bench {
  readonly view: HTMLElement;
  readonly overlay: Overlay;
  readonly orbit = new OrbitController(() => this.stage);
  readonly #choice: Panel["choice"];
  readonly #style: (css: string) => void;
  readonly #heard = make("p", { class: "heard", role: "status" });
  readonly #bar: HTMLElement;
  readonly #sheets: Sheets;
  readonly #tools: Tool[];
  presenter!: Presenter; // set by #fill()
  readonly #visits = new Visits(this);
  readonly #made: HTMLElement[];
  #stage: Stage | undefined;
  #page: ViewerControls | undefined;
  #until = new AbortController();

  constructor(readonly host: Bench["host"], panel: Panel, readonly texts: ViewerTexts) {
    const { root, view, choice } = panel;
    this.#style = (css) => panel.style(css);
    const marks = make("div", { class: "marks" });
    this.#made = [marks, this.#heard];
    panel.style(style);
    view.append(marks, this.#heard);
    this.view = view;
    this.overlay = new Overlay(marks);
    this.#choice = choice;
    this.#bar = root.querySelector(".tools") as HTMLElement;
    this.#sheets = new Sheets(this.#bar, texts.close);
    this.#tools = [...this.#fill(), new Keyboard(this), new Announcer(this), new DragHint(this), this.#visits, new Idle(this, () => this.#startOver())];
  }

  get stage(): Stage {
    return this.#stage as Stage;
  }
  get page(): ViewerControls {
    return this.#page as ViewerControls;
  }
  get triangles(): number {
    return this.#choice.triangles;
  }

  say(text: string): void {
    this.#heard.textContent = text;
  }

  attach(stage: Stage, page: ViewerControls): void {
    this.#stage = stage;
    this.#page = page;
    this.#until = new AbortController();
    this.#bar.inert = false;
    stage.onDraw = () => this.overlay.update(stage.parts.camera);
    // Stops an animation of the camera when the visitor presses anything except the buttons of a tour.
    const hold = ({ target }: Event) => void ((target as Element).closest(".tour-panel") || this.orbit.stop());
    this.view.addEventListener("pointerdown", hold, { signal: this.#until.signal });
    for (const tool of this.#tools) tool.attach?.(this.#until.signal);
    void stage.draw();
  }

  /** Detaches the tools from the stage. Called before the stage is disposed of. */
  detach(): void {
    this.#bar.inert = true;
    this.orbit.stop();
    this.#sheets.close();
    this.#until.abort();
    if (this.#stage) this.#stage.onDraw = () => undefined;
    this.#stage = undefined;
  }

  /** Removes the toolbox, so that another one can take its place. */
  remove(): void {
    if (this.#stage) for (const tool of this.#tools) tool.reset?.();
    this.detach();
    for (const element of this.#made) element.remove();
    this.#bar.replaceWith(this.#bar.cloneNode());
  }

  /** Adds the buttons to the toolbar, the most needed buttons first. Returns the tools. */
  #fill(): Tool[] {
    const { texts } = this, sheets = this.#sheets;
    const light = new Light(this), shadow = new Shadow(this), surface = new SurfaceStyle(this), section = new Section(this);
    const measure = new Measure(this), notes = new Notes(this, this.#style, { light, section }), reality = new Reality(this);
    this.presenter = new Presenter(this, light, notes);
    const save = new Save(this, { light, shadow, surface, section, note: notes });
    sheets.action("reset", texts.reset, () => this.page.frame());
    sheets.add("light", texts.light, make("div", {}, light.content, shadow.content));
    sheets.add("surface", texts.surface, surface.content);
    sheets.add("section", texts.section, section.content);
    sheets.add("measure", texts.measure, measure.content, (open) => (measure.isActive = open));
    const reader = sheets.add("notes", texts.notes, notes.content);
    reader.hidden = true;
    notes.onFilled = (any) => (reader.hidden = !any);
    notes.onChosen = () => reader.ariaExpanded === "false" && reader.click();
    notes.onTour = () => sheets.close();
    const room = sheets.add("ar", texts.ar, reality.content, (open) => open && void reality.open());
    room.hidden = true;
    reality.onKnown = (isUsable) => (room.hidden = !isUsable);
    sheets.add("save", texts.save, save.content, (open) => open && save.refresh());
    const full = sheets.action("fullScreen", texts.fullScreen, () => void this.#fillScreen());
    full.hidden = !document.fullscreenEnabled;
    return [light, shadow, surface, section, measure, notes, reality, save];
  }

  #fillScreen(): Promise<void> {
    return document.fullscreenElement ? document.exitFullscreen() : this.host.requestFullscreen();
  }

  #startOver(): void {
    this.#visits.leave();
    this.#sheets.close();
    for (const tool of this.#tools) tool.reset?.();
    this.page.frame();
    this.page.sharpen();
  }
}
