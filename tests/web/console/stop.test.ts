// SPDX-License-Identifier: Apache-2.0
import { Problem } from "@console/problem.ts";
import { EmergencyStop } from "@console/stop.ts";

/** A fake of the DOM's Element, with the members that the emergency stop uses. */
class Element {
  hidden = false;
  className = "";
  readonly children: (Element | string)[] = [];
  readonly #listeners = new Map<string, () => void>();
  setAttribute(name: string): void {
    if (name === "hidden") this.hidden = true;
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
  press(): void {
    this.#listeners.get("click")?.();
  }
}

/** A fake daemon. Each request gets the next of `lists` or `answers`; the last list is repeated. */
class Daemon {
  readonly stopped: string[] = [];
  constructor(readonly lists: (string[] | Error)[], readonly answers: (Error | undefined)[] = []) {}
  async get<T>(): Promise<T> {
    const list = this.lists.length > 1 ? this.lists.shift() : this.lists[0];
    if (list instanceof Error) throw list;
    return { scanners: list?.map((name) => ({ name })) } as T;
  }
  async stop(scanner: string): Promise<void> {
    this.stopped.push(scanner);
    const answer = this.answers.shift();
    if (answer) throw answer;
  }
}

const kLook = 3000, kAllTries = 2500;
const away = () => new Problem(503, "Service Unavailable");
let end: AbortController;

async function learnt(daemon: Daemon) {
  const stop = new EmergencyStop(daemon);
  void stop.keepLearning(end.signal).catch(() => undefined);
  await vi.advanceTimersByTimeAsync(0);
  const button = stop.button as unknown as Element, said = stop.said as unknown as Element;
  const press = async () => {
    button.press();
    await vi.advanceTimersByTimeAsync(kAllTries);
  };
  return { button, said, press };
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
  const daemon = new Daemon([new TypeError("network"), [], ["left"], away(), ["left", "right"]]), { button, press } = await learnt(daemon);
  expect(button.hidden).toBe(true);
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(true);
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(false);
  await vi.advanceTimersByTimeAsync(kLook);
  await press();
  expect(daemon.stopped).toEqual(["left"]);
  await vi.advanceTimersByTimeAsync(kLook);
  await press();
  expect(daemon.stopped).toEqual(["left", "left", "right"]);
});

test("a scanner that is no more in the list is stopped nevertheless", async () => {
  const daemon = new Daemon([["left", "right"], ["right"], []]), { button, press } = await learnt(daemon);
  await vi.advanceTimersByTimeAsync(kLook);
  await press();
  expect(daemon.stopped).toEqual(["left", "right"]);
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(false);
});

test("who is left asks no more", async () => {
  const daemon = new Daemon([[], ["left"]]), { button } = await learnt(daemon);
  end.abort();
  await vi.advanceTimersByTimeAsync(kLook);
  expect(button.hidden).toBe(true);
});

test.each([
  ["cannot be done now", away()],
  ["is answered by nobody", new TypeError("network")],
])("a stop that %s is sent again", async (_, fault) => {
  const daemon = new Daemon([["left"]], [fault, fault]), { said, press } = await learnt(daemon);
  await press();
  expect(daemon.stopped.length).toBe(3);
  expect(said.className).toBe("stopped good");
});

test.each([
  ["refused", new Problem(403, "Forbidden"), 1],
  ["not to be had", away(), 3],
])("a stop that is %s is reported", async (_, fault, tries) => {
  const daemon = new Daemon([["left"]], [fault, fault, fault, fault]), { said, press } = await learnt(daemon);
  await press();
  expect(daemon.stopped.length).toBe(tries);
  expect(said.className).toBe("stopped bad");
});
