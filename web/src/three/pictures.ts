// SPDX-License-Identifier: Apache-2.0
// Chooses which picture of a texture to show next. For each role, this is the smallest picture whose
// texels are at most about as large as a screen pixel. A picture with finer texels is scaled down.
import type { PictureRole, TextureInfo } from "../core/types.ts";

/** Desired side of a picture in pixels, per pixel of the model's size on the screen. */
const kSharpness = 1.5;
/** Used instead of kSharpness if the visitor has asked to save data. */
const kSavingSharpness = 0.75;

export interface PictureLimits {
  /** Largest side of a picture, in pixels. */
  side: number;
  /** Number of texels that all pictures shown may have together. Each role gets an equal share. */
  texels: number;
  /** Whether the visitor has asked to save data. */
  savesData: boolean;
}

/** A picture, and the side at which it is held in graphics memory, in pixels. */
export interface SizedPicture {
  index: number;
  side: number;
}

export class Pictures {
  readonly #shown = new Map<PictureRole, SizedPicture>();
  readonly #failed = new Set<number>();
  readonly #fetched = new Set<number>();
  readonly #roles: ReadonlySet<PictureRole>;
  #requested: SizedPicture | undefined;

  constructor(private readonly texture: TextureInfo) {
    this.#roles = new Set(texture.pictures.map(({ role }) => role));
  }

  /** Texels of all pictures shown. */
  get texels(): number {
    return [...this.#shown.values()].reduce((sum, { side }) => sum + side ** 2, 0);
  }

  /** Bytes of all pictures shown, with their mipmaps, in graphics memory. */
  get graphicsBytes(): number {
    return [...this.#shown.values()].reduce((sum, { side }) => sum + pyramidBytes(side), 0);
  }

  /** Forgets the pictures shown, which have lost their graphics memory. */
  forget(): void {
    this.#shown.clear();
  }

  /** Total size in bytes of the pictures fetched, except those in the file's head. */
  get bytes(): number {
    return [...this.#fetched].reduce((sum, index) => sum + (this.texture.pictures[index]?.length ?? 0), 0);
  }

  /**
   * Returns the next picture to request. `pixels` is the length of the model's longest side on the
   * screen, in pixels. Returns undefined if no picture is needed, or if the picture requested before
   * is neither shown nor forgotten.
   */
  next(pixels: number, limits: PictureLimits): SizedPicture | undefined {
    if (this.#requested) return undefined;
    const needed = pixels * (limits.savesData ? kSavingSharpness : kSharpness);
    const wanted = [...this.#roles].flatMap((role) => this.#wanted(role, needed, limits) ?? []);
    this.#requested = wanted.sort((a, b) => a.index - b.index)[0];
    return this.#requested;
  }

  /** Allows the next request. Call this if the previous one will not be answered, or its answer cannot be shown. */
  forgetRequest(): void {
    this.#requested = undefined;
  }

  /**
   * Returns the role of a picture that has arrived and should replace the one shown. Returns undefined if a picture of the
   * same or finer detail is shown. `side` is 0 if the picture cannot be fetched.
   */
  receive({ index, side }: SizedPicture): PictureRole | undefined {
    const role = this.texture.pictures[index]?.role, isAnswer = index === this.#requested?.index;
    if (side === 0) this.#failed.add(index);
    else if (index >= this.texture.inHead) this.#fetched.add(index);
    if (role && side > 0 && (isAnswer || side > this.#side(role))) return role;
    if (isAnswer) this.forgetRequest();
    return undefined;
  }

  /** Records that a picture is shown. */
  show(role: PictureRole, picture: SizedPicture): void {
    this.#shown.set(role, picture);
    if (picture.index === this.#requested?.index) this.forgetRequest();
  }

  /**
   * Returns the picture of `role` that should replace the one shown: a finer one, or a smaller one if there are too many texels.
   */
  #wanted(role: PictureRole, needed: number, limits: PictureLimits): SizedPicture | undefined {
    const most = Math.sqrt(limits.texels / this.#roles.size), target = Math.min(needed, most);
    const all = this.texture.pictures.map(({ side }, index) => ({ index, side }));
    const usable = all.filter(({ index, side }) => this.texture.pictures[index]?.role === role && side <= limits.side && !this.#failed.has(index));
    const ascending = usable.sort((a, b) => a.side - b.side);
    const best = ascending.find(({ side }) => side >= target) ?? ascending.at(-1);
    if (!best) return undefined;
    const side = heldSide(best.side, needed, most), shown = this.#side(role);
    return side > shown || (side > 0 && side < shown && shown > most) ? { index: best.index, side } : undefined;
  }

  #side(role: PictureRole): number {
    return this.#shown.get(role)?.side ?? 0;
  }
}

/**
 * Returns the bytes of a picture and its mipmaps. Each mipmap has half the side of the one before.
 */
function pyramidBytes(side: number): number {
  return side === 0 ? 0 : 4 * side ** 2 + pyramidBytes(side >> 1);
}

/**
 * Returns the side at which a picture is held: its own side, possibly divided by a power of the square root of 2. The
 * result is at most `most`, and at least `needed` if `side` and `most` permit that.
 */
function heldSide(side: number, needed: number, most: number): number {
  const halvings = Math.max(0, Math.floor(2 * Math.log2(side / needed)), Math.ceil(2 * Math.log2(side / most)));
  return Math.floor(side / 2 ** (halvings / 2));
}
