// SPDX-License-Identifier: Apache-2.0
import { Box3, Matrix4, PerspectiveCamera, Vector3 } from "three";
import { distanceFor, kFieldOfView, kViewpoint } from "@element/viewpoint.ts";
import { Pictures, type PictureLimits, type SizedPicture } from "@three/pictures.ts";
import { sizeOnScreen } from "@three/size-on-screen.ts";
import type { PictureRole, TextureInfo } from "@core/types.ts";

const kSides = [256, 1024, 4096], kRoles: PictureRole[] = ["colour", "normal"];
const limits: PictureLimits = { side: 8192, texels: Infinity, savesData: false };

/**
 * Returns a texture with six pictures: 0 and 1 with sides of 256 pixels, 2 and 3 of 1024, 4 and 5 of 4096. The first
 * picture of each pair has the colours.
 */
function texture(roles = kRoles): TextureInfo {
  const pictures = kSides.flatMap((side) => roles.map((role) => ({ role, side, offset: 0, length: 1, sha256: "" })));
  return { atlasOffset: 0, atlasLength: 0, alphaMode: "opaque", alphaCutoff: 0, isDoubleSided: false, isUnlit: false, pictures, inHead: 1 };
}

/** Answers all requests. Returns the index and the side of each requested picture, in order. */
function all(pictures: Pictures, pixels: number, most = limits): [number, number][] {
  const asked: [number, number][] = [];
  for (let next = pictures.next(pixels, most); next; next = pictures.next(pixels, most)) {
    asked.push([next.index, next.side]);
    answer(pictures, next);
  }
  return asked;
}

function answer(pictures: Pictures, picture: SizedPicture): void {
  const role = pictures.receive(picture);
  if (role) pictures.show(role, picture);
}

describe("Pictures", () => {
  test("asks for the smallest picture of each role whose texels are fine enough", () => {
    const pictures = new Pictures(texture());
    answer(pictures, { index: 0, side: 256 });
    expect(pictures.bytes).toBe(0);
    expect(all(pictures, 600)).toEqual([[2, 1024], [3, 1024]]);
    expect(pictures.texels).toBe(2 * 1024 ** 2);
    expect(pictures.bytes).toBe(2);
    expect(all(pictures, 100)).toEqual([]);
  });

  test("holds a picture that is too fine in a smaller size, and in a larger one when the view needs it", () => {
    const pictures = new Pictures(texture(["colour"]));
    expect(all(pictures, 700)).toEqual([[2, 1448]]);
    expect(all(pictures, 950)).toEqual([]);
    expect(all(pictures, 1000)).toEqual([[2, 2048]]);
    expect(all(pictures, 5000)).toEqual([[2, 4096]]);
    expect(pictures.bytes).toBe(1);
  });

  test("asks again for a picture whose request will not be answered, or was lost with its graphics memory", () => {
    const pictures = new Pictures(texture());
    expect(pictures.next(600, limits)).toEqual({ index: 2, side: 1024 });
    pictures.forgetRequest();
    expect(pictures.next(600, limits)).toEqual({ index: 2, side: 1024 });
    expect(pictures.receive({ index: 2, side: 1024 })).toBe("colour");
    pictures.forgetRequest();
    expect(pictures.next(600, limits)).toEqual({ index: 2, side: 1024 });
  });

  test("asks for one picture at a time, and for none until that is shown", () => {
    const pictures = new Pictures(texture());
    pictures.next(600, limits);
    expect(pictures.next(600, limits)).toBeUndefined();
    pictures.receive({ index: 2, side: 1024 });
    expect(pictures.next(600, limits)).toBeUndefined();
    pictures.show("colour", { index: 2, side: 1024 });
    expect(pictures.next(600, limits)).toEqual({ index: 3, side: 1024 });
  });

  test("asks for the finest picture in a close-up", () => expect(all(new Pictures(texture()), Infinity)).toEqual([[4, 4096], [5, 4096]]));

  test("asks for no picture above the largest side", () => {
    expect(all(new Pictures(texture()), 5000, { ...limits, side: 4095 })).toEqual([[2, 1024], [3, 1024]]);
    const pictures = new Pictures(texture());
    answer(pictures, { index: 0, side: 256 });
    expect(all(pictures, 5000, { ...limits, side: 100 })).toEqual([]);
  });

  test("shares the budget of texels among the roles", () => {
    const pictures = new Pictures(texture()), texels = 2 * 3000 ** 2;
    expect(all(pictures, 5000, { ...limits, texels })).toEqual([[4, 2896], [5, 2896]]);
    expect(pictures.texels).toBeLessThanOrEqual(texels);
  });

  test("holds smaller pictures when the budget shrinks", () => {
    const pictures = new Pictures(texture()), texels = 2 * 1024 ** 2;
    all(pictures, 5000);
    expect(all(pictures, 5000, { ...limits, texels })).toEqual([[2, 1024], [3, 1024]]);
    expect(pictures.texels).toBe(texels);
    expect(all(pictures, 5000, { ...limits, texels: 2 * 100 ** 2 })).toEqual([[0, 90], [1, 90]]);
  });

  test("asks for half the resolution if the visitor saves data", () =>
    expect(all(new Pictures(texture(["colour"])), 1400, { ...limits, savesData: true })).toEqual([[2, 1448]]));

  test("asks again for lost pictures", () => {
    const pictures = new Pictures(texture());
    all(pictures, 600);
    pictures.forget();
    expect(pictures.texels).toBe(0);
    expect(all(pictures, 600)).toEqual([[2, 1024], [3, 1024]]);
  });

  test("replaces no picture by a coarser one that arrives later", () => {
    const pictures = new Pictures(texture());
    answer(pictures, { index: 2, side: 1024 });
    expect(pictures.receive({ index: 0, side: 256 })).toBeUndefined();
    expect(pictures.texels).toBe(1024 ** 2);
  });

  test("asks for the next best in place of a picture that cannot be shown", () => {
    const pictures = new Pictures(texture(["colour"]));
    expect(pictures.next(5000, limits)?.index).toBe(2);
    expect(pictures.receive({ index: 2, side: 0 })).toBeUndefined();
    expect(all(pictures, 5000)).toEqual([[1, 1024]]);
  });
});

test("three maps of 4096² on a page of 1440 × 900 take at most 40 MB of graphics memory", () => {
  const roles: PictureRole[] = ["colour", "normal", "surface"], pictures = new Pictures(texture(roles));
  const box = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1)), radius = 0.55 * box.getSize(new Vector3()).length();
  const camera = new PerspectiveCamera(kFieldOfView, 1440 / 900, 0.01, 100);
  camera.position.copy(kViewpoint).setLength(distanceFor(radius, camera.aspect, camera.fov));
  camera.updateMatrixWorld();
  all(pictures, sizeOnScreen(box, new Matrix4(), camera, 900));
  expect(pictures.graphicsBytes).toBeGreaterThan(10e6); // more than the coarsest pictures need
  expect(pictures.graphicsBytes).toBeLessThanOrEqual(40e6);
  all(pictures, 965); // the model fills the page
  expect(pictures.graphicsBytes).toBeLessThanOrEqual(40e6);
});
