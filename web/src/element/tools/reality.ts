// SPDX-License-Identifier: Apache-2.0
// Augmented reality: shows the model at its real size in the visitor's room, if the page has the attribute `ar` and the device can.
// This file chooses the way; the code that shows the model is loaded when the sheet is first opened.
import type { RoomSession } from "../reality/augmented-reality.ts";
import type { Bench, Tool } from "./bench.ts";
import { make } from "./dom.ts";
import { apiOf } from "./links.ts";
import { Vector3 } from "three";

type Way = "webxr" | "scene-viewer" | "quick-look";

/** Headsets and browsers that are Android's but do not open Scene Viewer. */
const kNoSceneViewer = /firefox|oculus/i;

/** Returns how this device shows a model in augmented reality. `api` is the model's API URL, if the system's viewer may read it. */
export async function wayOf(api: string | undefined): Promise<Way | undefined> {
  const { userAgent, xr } = navigator;
  // Ignores an error, because it says that the page may not use WebXR.
  if (await xr?.isSessionSupported("immersive-ar").catch(() => false)) return "webxr";
  if (api === undefined) return undefined;
  // Scene Viewer downloads from servers with TLS only.
  if (/android/i.test(userAgent)) return !kNoSceneViewer.test(userAgent) && api.startsWith("https:") ? "scene-viewer" : undefined;
  return document.createElement("a").relList.supports("ar") ? "quick-look" : undefined;
}

export class Reality implements Tool {
  readonly content = make("div");
  /** Called when it is known whether the tool can be used. */
  onKnown: (isUsable: boolean) => void = () => undefined;
  readonly #guide: HTMLElement; // shown above the camera picture
  #session: RoomSession | undefined;

  constructor(private readonly bench: Bench) {
    const { arPlace, close } = bench.texts, leave = make("button", { type: "button", class: "framed", onclick: () => this.#session?.end() }, close);
    this.#guide = make("div", { class: "room-guide", hidden: true }, make("p", {}, arPlace), leave);
    leave.addEventListener("beforexrselect", (event) => event.preventDefault()); // keeps a tap on the button from also moving the model
    bench.view.append(this.#guide);
  }

  attach(until: AbortSignal): void {
    const attribute = new MutationObserver(() => void this.#learn(until));
    attribute.observe(this.bench.host, { attributeFilter: ["ar"] });
    until.addEventListener("abort", () => {
      attribute.disconnect();
      this.#session?.end();
    });
    void this.#learn(until);
  }

  async #learn(until: AbortSignal): Promise<void> {
    const isUsable = this.bench.host.hasAttribute("ar") && (await wayOf(this.#api)) !== undefined;
    if (!until.aborted) this.onKnown(isUsable);
  }

  /** The model's API URL. Undefined for a file, and for a model that is not public: other programs do not get the token. */
  get #api(): string | undefined {
    const { host } = this.bench;
    return host.token === "" ? apiOf(new URL(host.getAttribute("src") ?? "", document.baseURI).href) : undefined;
  }

  /** Shows the model's size and the button that starts. Called when the sheet opens. */
  async open(): Promise<void> {
    const { host, stage, texts } = this.bench, { presentedBox, info } = stage.mesh, api = this.#api;
    const [way, code] = await Promise.all([wayOf(api), import("../reality/augmented-reality.ts").catch(() => undefined)]);
    const metres = code?.metresPer(info.unit), { x = 0, y = 0, z = 0 } = presentedBox?.getSize(new Vector3()) ?? {};
    if (!code || metres === undefined) return this.#refuse(code ? texts.arNoUnit : texts.arFailed);
    const exhibit = { api: api ?? "", title: host.getAttribute("alt") ?? "", page: location.href };
    const link = (attributes: Record<string, string>, ...more: Node[]) => make("a", { class: "framed", name: "ar-start", ...attributes }, ...more, texts.arStart);
    const start = way === "scene-viewer" ? link({ href: code.sceneViewerUrl(exhibit) })
      : way === "quick-look" ? link({ href: code.quickLookUrl(exhibit), rel: "ar" }, make("img", { alt: "" })) // Safari requires a picture
      : make("button", { type: "button", class: "framed", name: "ar-start", onclick: () => void this.#enter(code.RoomSession, metres) }, texts.arStart);
    this.content.replaceChildren(make("p", { class: "hint" }, texts.arHint), make("p", { class: "result size" }, texts.extent(x, y, z, info.unit)), start);
  }

  #refuse(reason: string): void {
    this.content.replaceChildren(make("p", { class: "hint" }, reason));
    this.bench.say(reason);
  }

  async #enter(session: typeof RoomSession, metres: number): Promise<void> {
    const { stage } = this.bench;
    this.#guide.hidden = false;
    try {
      const started = await session.start(stage, metres, this.#guide, () => this.#leave());
      if (this.bench.stage === stage) this.#session = started;
      else started.end(); // another model has been chosen meanwhile
    } catch {
      this.#leave();
      this.#refuse(this.bench.texts.arFailed);
    }
  }

  #leave(): void {
    this.#guide.hidden = true;
    this.#session = undefined;
  }
}
