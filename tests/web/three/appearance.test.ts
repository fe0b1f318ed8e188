// SPDX-License-Identifier: Apache-2.0
import { MeshStandardMaterial, Texture } from "three";
import { Appearance } from "@three/appearance.ts";
import type { TextureInfo } from "@core/types.ts";

function dressed(more: Partial<TextureInfo> = {}) {
  const material = new MeshStandardMaterial(), appearance = new Appearance(material);
  const texture: TextureInfo = {
    atlasOffset: 0, atlasLength: 0, alphaMode: "opaque", alphaCutoff: 0.3, isDoubleSided: false, isUnlit: false, pictures: [], inHead: 0, ...more,
  };
  appearance.info = { attributes: ["colour"], texture };
  return { material, appearance };
}

describe("Appearance", () => {
  test("shows vertex colours until there is a picture", () => {
    const { material, appearance } = dressed();
    expect([material.vertexColors, material.map]).toEqual([true, null]);
    const picture = new Texture();
    appearance.show("colour", picture);
    expect(material.vertexColors).toBe(false);
    expect(material.map).toBe(picture);
    expect(material.color.getHex()).toBe(0xffffff);
  });

  test("shows a normal map whose green points up", () => {
    const { material, appearance } = dressed();
    appearance.show("normal", new Texture());
    expect(material.normalMap).not.toBeNull();
    expect(material.normalScale.toArray()).toEqual([1, -1]);
  });

  test("shows metal only where it has something to reflect", () => {
    const { material, appearance } = dressed();
    appearance.light(1);
    expect(material.metalness).toBe(0);
    appearance.show("surface", new Texture());
    expect(material.metalness).toBe(1);
    appearance.light(0.3);
    expect(material.metalness).toBe(0.3);
    appearance.light(0);
    expect(material.metalness).toBe(0);
    expect(material.roughnessMap).not.toBeNull();
  });

  test("hides colours and pictures where only the form is shown, and shows them again", () => {
    const { material, appearance } = dressed({ isUnlit: true });
    appearance.show("colour", new Texture());
    appearance.show("normal", new Texture());
    expect(material.defines).toHaveProperty("UNLIT");
    expect(material.toneMapped).toBe(false);
    appearance.isBare = true;
    expect([material.map, material.normalMap, material.vertexColors]).toEqual([null, null, false]);
    expect(material.defines).not.toHaveProperty("UNLIT");
    expect(material.toneMapped).toBe(true);
    appearance.isBare = false;
    expect(material.map).not.toBeNull();
    expect(material.normalMap).not.toBeNull();
  });

  test("frees a picture that a finer one replaces, and the last one at the end", () => {
    const { appearance } = dressed(), freed: string[] = [];
    for (const name of ["coarse", "fine"]) {
      const texture = new Texture();
      texture.addEventListener("dispose", () => freed.push(name));
      appearance.show("colour", texture);
    }
    expect(freed).toEqual(["coarse"]);
    appearance.dispose();
    expect(freed).toEqual(["coarse", "fine"]);
  });

  test("shows vertex colours again when the pictures are lost", () => {
    const { material, appearance } = dressed();
    appearance.show("colour", new Texture());
    appearance.forget();
    expect([material.vertexColors, material.map]).toEqual([true, null]);
  });

  test.each([
    ["opaque", 0, false], ["mask", 0.3, false], ["blend", 0, true],
  ] as const)("draws the alpha mode %s", (alphaMode, alphaTest, transparent) => {
    const { material, appearance } = dressed({ alphaMode });
    appearance.show("colour", new Texture());
    expect([material.alphaTest, material.transparent]).toEqual([alphaTest, transparent]);
  });
});
