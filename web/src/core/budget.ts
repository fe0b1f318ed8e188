// SPDX-License-Identifier: Apache-2.0
// Shares a page's memory budget among its models. Each model may use what the others leave free, but
// at least an equal share. A model above its limit is coarsened at its next detail request.

export interface ModelSize {
  triangles: number;
  /** Bytes of .pmesh data. */
  bytes: number;
}

export class Budget {
  readonly #held = new Map<object, ModelSize>();

  constructor(public most: ModelSize = { triangles: Infinity, bytes: Infinity }) {}

  /** Records the triangles and bytes that `model` uses now. */
  hold(model: object, amount: ModelSize): void {
    this.#held.set(model, amount);
  }

  release(model: object): void {
    this.#held.delete(model);
  }

  /** Returns the maximum that `model` may use now. */
  room(model: object): ModelSize {
    return { triangles: this.#room(model, "triangles"), bytes: this.#room(model, "bytes") };
  }

  #room(model: object, what: keyof ModelSize): number {
    const others = [...this.#held].filter(([other]) => other !== model);
    const share = this.most[what] / (others.length + 1);
    if (share === Infinity) return Infinity;
    return Math.floor(others.reduce((left, [, held]) => left - Math.min(held[what], share), this.most[what]));
  }
}
