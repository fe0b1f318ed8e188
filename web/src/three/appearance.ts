// SPDX-License-Identifier: Apache-2.0
// Sets the material of a mesh: its pictures, its vertex colours until there is a picture, or one
// plain tone that shows the form alone.
import type { MeshStandardMaterial, Texture } from "three";
import type { ModelInfo, PictureRole } from "../core/types.ts";

const kTone = 0xd8d3cb;
const kRoles: readonly PictureRole[] = ["colour", "normal", "surface", "emission"];

export class Appearance {
  readonly #textures = new Map<PictureRole, Texture>();
  #info: Pick<ModelInfo, "attributes" | "texture"> = { attributes: [] };
  #isBare = false;
  #reflection = 0;

  constructor(private readonly material: MeshStandardMaterial) {
    this.#dress();
  }

  /** Attributes and texture of the model. Must be set before the first call of show(). */
  set info(info: Pick<ModelInfo, "attributes" | "texture">) {
    this.#info = info;
    this.#dress();
  }

  /** Whether the model has vertex colours or a texture. */
  get hasColours(): boolean {
    return this.#info.attributes.includes("colour") || this.#info.texture !== undefined;
  }

  /** Whether only the form is shown, without colours and pictures. */
  get isBare(): boolean {
    return this.#isBare;
  }
  set isBare(on: boolean) {
    this.#isBare = on;
    this.#dress();
  }

  /** Shows `texture` for `role` from now on. Disposes of the texture that it replaces. */
  show(role: PictureRole, texture: Texture): void {
    this.#textures.get(role)?.dispose();
    this.#textures.set(role, texture);
    this.#dress();
  }

  /**
   * Sets the intensity of the scene's environment. Metal shows only what it reflects, and would be black without an
   * environment. Therefore, the weaker the environment is, the more metal is drawn like other surfaces.
   */
  light(reflection: number): void {
    this.#reflection = reflection;
    this.material.metalness = this.material.metalnessMap ? Math.min(reflection, 1) : 0;
  }

  /** Disposes of all textures, because their graphics memory may be lost. */
  forget(): void {
    for (const texture of this.#textures.values()) texture.dispose();
    this.#textures.clear();
    this.#dress();
  }

  dispose(): void {
    this.forget();
    this.material.dispose();
  }

  #dress(): void {
    const { material } = this, { attributes, texture } = this.#info;
    const [colour, normal, surface, emission] = kRoles.map((role) => (this.#isBare ? undefined : this.#textures.get(role)) ?? null);
    const isTextured = !!colour;
    material.map = colour ?? null;
    material.normalMap = normal ?? null;
    // Rows run downwards in a picture, but green in a normal map points up.
    material.normalScale.set(1, -1);
    material.aoMap = material.roughnessMap = material.metalnessMap = surface ?? null;
    material.roughness = surface ? 1 : 0.85;
    this.light(this.#reflection);
    material.emissiveMap = emission ?? null;
    material.emissive.set(emission ? 0xffffff : 0);
    material.vertexColors = !this.#isBare && !isTextured && attributes.includes("colour");
    material.color.set(isTextured || material.vertexColors ? 0xffffff : kTone);
    material.alphaTest = isTextured && texture?.alphaMode === "mask" ? texture.alphaCutoff : 0;
    material.transparent = isTextured && texture?.alphaMode === "blend";
    material.toneMapped = !(isTextured && texture?.isUnlit);
    material.defines = { STANDARD: "", ...(isTextured && texture?.isUnlit && { UNLIT: "" }) };
    material.needsUpdate = true;
  }
}
