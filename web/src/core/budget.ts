// SPDX-License-Identifier: Apache-2.0
// Shares a page's memory budget among its models. Each model may use the memory that the other
// models leave free, but always at least an equal share. A model above its limit is coarsened at
// its next detail request.

export interface ModelSize {
  triangles: number;
  /** Bytes of .pmesh data. */
  bytes: number;
  /**
   * Texels of all pictures, without their mipmaps. In graphics memory, a texel takes 5.3 bytes,
   * including its share of the mipmaps.
   */
  texels?: number;
}

export class Budget {
  readonly #held = new Map<object, Required<ModelSize>>();

  constructor(public most: Required<ModelSize> = { triangles: Infinity, bytes: Infinity, texels: Infinity }) {}

  /** Records how much `model` uses now. */
  hold(model: object, amount: Required<ModelSize>): void {
    this.#held.set(model, amount);
  }

  release(model: object): void {
    this.#held.delete(model);
  }

  /** Returns how much `model` may use now. */
  room(model: object): Required<ModelSize> {
    return { triangles: this.#room(model, "triangles"), bytes: this.#room(model, "bytes"), texels: this.#room(model, "texels") };
  }

  #room(model: object, what: keyof ModelSize): number {
    const others = [...this.#held].filter(([other]) => other !== model);
    const share = this.most[what] / (others.length + 1);
    if (share === Infinity) return Infinity;
    return Math.floor(others.reduce((left, [, held]) => left - Math.min(held[what], share), this.most[what]));
  }
}
