// SPDX-License-Identifier: Apache-2.0
import { Problem } from "@console/problem.ts";
import { ScannerWatch } from "@console/scanner-watch.ts";
import { EmergencyStop } from "@console/stop.ts";
import type { LaserState, MotorState, Scanner } from "@console/types.ts";

/** A fake of the DOM's Element with only the members that the emergency stop uses. */
class Element {
  hidden = false;
  className = "";
  readonly children: (Element | string)[] = [];
  readonly #listeners = new Map<string, () => void>();
  setAttribute(name: string, value: string): void {
    if (name === "hidden") this.hidden = true;
    if (name === "class") this.className = value;
  }
  addEventListener(name: string, listener: () => void): void {
    this.#listeners.set(name, listener);
  }
  append(...children: (Element | string)[]): void {
    this.children.push(...children);
  }
  replaceChildren(...children: (Element | string)[]): void {
    this.children.splice(0, Infinity, ...children);
  }
  get text(): string {
    return this.children.map((child) => (typeof child === "string" ? child : child.text)).join("");
  }
  press(): void {
    this.#listeners.get("click")?.();
  }
}

const scanner = (name: string, laser: LaserState = "off", motor: MotorState = "off") =>
  ({ name, laser: { state: laser, since: null }, motor: { state: motor, since: null } }) as unknown as Scanner;

/** A fake daemon. Each request gets the next element of `lists` or `answers`. The last list is repeated. */
class Daemon {
  readonly stopped: string[] = [];
  constructor(readonly lists: (Scanner[] | Error | Promise<Scanner[]>)[], readonly answers: (Error | Scanner | undefined)[] = []) {}
  async get<T>(): Promise<T> {
    const list = this.lists.length > 1 ? this.lists.shift() : this.lists[0];
    if (list instanceof Error) throw list;
    return { scanners: await list } as T;
  }
  async stop(name: string): Promise<Scanner> {
    this.stopped.push(name);
    const answer = this.answers.shift();
    if (answer instanceof Error) throw answer;
    return answer ?? scanner(name);
  }
}

const kLook = 1000, kAllTries = 2500;
const away = () => new Problem(503, "Service Unavailable");
const left = scanner("left"), right = scanner("right"), lit = scanner("left", "on");
let end: AbortController;

async function learnt(daemon: Daemon) {
  const watch = new ScannerWatch(daemon), stop = new EmergencyStop(daemon, watch);
  void watch.run(end.signal).catch(() => undefined);
  await vi.advanceTimersByTimeAsync(0);
  const [button, said, power] = [stop.button, stop.said, watch.element] as unknown as [Element, Element, Element];
  const press = async () => {
    button.press();
    await vi.advanceTimersByTimeAsync(kAllTries);
  };
  return { button, said, power, press };
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("Node", Element);
  vi.stubGlobal("document", { createElement: () => new Element() });
  end = new AbortController();
});

afterEach(() => {
  end.abort();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

test("scanners that come and go are learnt, whatever goes wrong meanwhile", async () => {
  const daemon = new Daemon([new TypeError("network"), [], [left], away(), [left, right]]), { button, press } = await learnt(daemon);
  expect(button.hidden).toBe(true);
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(true);
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(false);
  await vi.advanceTimersByTimeAsync(2 * kLook);
  await press();
  expect(daemon.stopped).toEqual(["left", "right"]);
});

test("a scanner that is no more in the list is stopped nevertheless", async () => {
  const daemon = new Daemon([[left, right], [right], []]), { button, press } = await learnt(daemon);
  await vi.advanceTimersByTimeAsync(kLook);
  await press();
  expect(daemon.stopped).toEqual(["left", "right"]);
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(false);
});

test("who is left asks no more", async () => {
  const daemon = new Daemon([[], [left]]), { button } = await learnt(daemon);
  end.abort();
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(true);
});

test.each([
  ["cannot be done now", away()],
  ["is answered by nobody", new TypeError("network")],
])("a stop that %s is sent again", async (_, fault) => {
  const daemon = new Daemon([[left]], [fault, fault]), { said, press } = await learnt(daemon);
  await press();
  expect(daemon.stopped.length).toBe(3);
  expect(said.className).toBe("stopped good");
});

test.each([
  ["refused", new Problem(403, "Forbidden"), 1],
  ["not to be had", away(), 3],
])("a stop that is %s is reported, as long as the laser is on", async (_, fault, tries) => {
  const daemon = new Daemon([[lit]], [fault, fault, fault, fault]), { said, press } = await learnt(daemon);
  await press();
  expect(daemon.stopped.length).toBe(tries);
  expect(said.className).toBe("stopped bad");
});

test("the banner of a stop goes when the laser is lit again", async () => {
  const daemon = new Daemon([[left]]), { said, power, press } = await learnt(daemon);
  await press();
  expect(said.text).toMatch(/^Stopped: left/);
  daemon.lists[0] = [lit];
  await vi.advanceTimersByTimeAsync(kLook);
  expect(power.text).toMatch(/Laser on/);
  expect(said.hidden).toBe(true);
  daemon.lists[0] = [left];
  await vi.advanceTimersByTimeAsync(kLook);
  expect(said.hidden).toBe(true);
});

test("a state that was asked for before the stop does not count after it", async () => {
  let answer: (list: Scanner[]) => void = () => undefined;
  const late = new Promise<Scanner[]>((resolve) => (answer = resolve));
  const daemon = new Daemon([[lit], late, [left]]), { said, power, press } = await learnt(daemon);
  await vi.advanceTimersByTimeAsync(kLook);
  await press();
  answer([lit]);
  await vi.advanceTimersByTimeAsync(0);
  expect(power.text).toMatch(/Laser off/);
  expect(said.className).toBe("stopped good");
});

test("a daemon that does not respond leaves the state unknown, and the stop unconfirmed", async () => {
  const daemon = new Daemon([[left]]), { said, power, press } = await learnt(daemon);
  await press();
  daemon.lists[0] = away();
  await vi.advanceTimersByTimeAsync(kLook);
  expect(power.text).toMatch(/state unknown/);
  expect(said.className).toBe("stopped bad");
});
