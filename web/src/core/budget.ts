// SPDX-License-Identifier: Apache-2.0
// What all models of a page may hold together. Each may take what the others leave, and never less
// than an equal share: who holds more gives it back when it next asks what its camera needs.

export interface Amount {
  triangles: number;
  /** Of the files. */
  bytes: number;
}

export class Budget {
  readonly #held = new Map<object, Amount>();

  constructor(public most: Amount = { triangles: Infinity, bytes: Infinity }) {}

  /** What `model` holds now. */
  hold(model: object, amount: Amount): void {
    this.#held.set(model, amount);
  }

  release(model: object): void {
    this.#held.delete(model);
  }

  /** The most that `model` may hold. */
  room(model: object): Amount {
    return { triangles: this.#room(model, "triangles"), bytes: this.#room(model, "bytes") };
  }

  #room(model: object, what: keyof Amount): number {
    const others = [...this.#held].filter(([other]) => other !== model);
    const share = this.most[what] / (others.length + 1);
    if (share === Infinity) return Infinity;
    return Math.floor(others.reduce((left, [, held]) => left - Math.min(held[what], share), this.most[what]));
  }
}
