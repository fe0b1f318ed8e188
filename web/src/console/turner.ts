// SPDX-License-Identifier: Apache-2.0
// A round handle that turns an object. Dragging inside tilts it, dragging along the rim rolls it. Arrow keys and PageUp/PageDown do
// the same.
import type { h as make } from "../ui/dom.ts";

export type Turn = (about: "right" | "up" | "eye", degrees: number) => void;

const kPerPixel = 0.5; // degrees that the object turns per pixel of dragging
const kRim = 0.68; // inner radius of the rim, as a share of the handle's radius
const kStep = 1, kLargeStep = 15; // degrees per key press, without and with Shift

const kKeys: Record<string, [about: "right" | "up" | "eye", sign: number]> = {
  ArrowLeft: ["up", -1], ArrowRight: ["up", 1], ArrowUp: ["right", -1], ArrowDown: ["right", 1], PageUp: ["eye", 1], PageDown: ["eye", -1],
};

export function turner(h: typeof make, label: string, act: Turn): HTMLButtonElement {
  const handle = h("button", { type: "button", class: "turner", "aria-label": label, title: label }, h("span"));
  let held: { x: number; y: number; isRim: boolean } | undefined;
  const fromMiddle = ({ clientX, clientY }: PointerEvent) => {
    const { left, top, width, height } = handle.getBoundingClientRect();
    return { x: clientX - left - width / 2, y: clientY - top - height / 2, radius: width / 2 };
  };
  handle.addEventListener("pointerdown", (event) => {
    const { x, y, radius } = fromMiddle(event);
    handle.setPointerCapture(event.pointerId);
    held = { x, y, isRim: Math.hypot(x, y) > kRim * radius };
  });
  handle.addEventListener("pointermove", (event) => {
    if (!held) return;
    const { x, y } = fromMiddle(event), before = held;
    held = { ...before, x, y };
    if (before.isRim) {
      const swept = ((Math.atan2(before.y, before.x) - Math.atan2(y, x)) * 180) / Math.PI;
      return act("eye", ((swept + 540) % 360) - 180);
    }
    if (x !== before.x) act("up", kPerPixel * (x - before.x));
    if (y !== before.y) act("right", kPerPixel * (y - before.y));
  });
  for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => (held = undefined));
  handle.addEventListener("keydown", (event) => {
    const [about, sign] = kKeys[event.key] ?? [];
    if (!about || !sign) return;
    event.preventDefault();
    act(about, sign * (event.shiftKey ? kLargeStep : kStep));
  });
  return handle;
}
