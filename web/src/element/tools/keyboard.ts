// SPDX-License-Identifier: Apache-2.0
// Camera control by keyboard.
import type { Bench, Tool } from "./bench.ts";

const kTurn = 10; // angle of a turn per key press, in degrees
const kZoom = 1.15;

/** The effect of each key: degrees to the right, degrees up, and the factor for the distance. */
const kMoves: Record<string, [number, number, number]> = {
  ArrowLeft: [-kTurn, 0, 1], ArrowRight: [kTurn, 0, 1], ArrowUp: [0, kTurn, 1], ArrowDown: [0, -kTurn, 1],
  "+": [0, 0, 1 / kZoom], "=": [0, 0, 1 / kZoom], "-": [0, 0, kZoom],
};

export class Keyboard implements Tool {
  constructor(private readonly bench: Bench) {}

  attach(until: AbortSignal): void {
    const canvas = this.bench.view.querySelector("canvas") as HTMLCanvasElement;
    canvas.addEventListener("keydown", (event) => this.#press(event), { signal: until });
  }

  #press(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.bench.stage.parts.controls.enabled) return;
    const move = kMoves[event.key];
    if (move) this.bench.orbit.turn(...move);
    else if (event.key === "Home") this.bench.page.frame();
    else return;
    event.preventDefault();
  }
}
