// SPDX-License-Identifier: Apache-2.0
import { Box3, Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { sizeOnScreen } from "@three/size-on-screen.ts";

const box = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));

test("the nearest side of a box counts", () => {
  const camera = new PerspectiveCamera(90, 1, 0.1, 100);
  camera.position.z = 3;
  camera.updateMatrixWorld();
  expect(sizeOnScreen(box, new Matrix4(), camera, 600)).toBeCloseTo(300);
  expect(sizeOnScreen(box, new Matrix4().makeScale(0.5, 0.5, 0.5), camera, 600)).toBeCloseTo(120);
});

test("a camera in the box sees the finest detail", () => {
  const camera = new PerspectiveCamera(90, 1, 0.1, 100);
  camera.updateMatrixWorld();
  expect(sizeOnScreen(box, new Matrix4(), camera, 600)).toBe(Infinity);
});

test("distance does not matter without perspective", () => {
  const camera = new OrthographicCamera(-2, 2, 2, -2, 0.1, 100);
  camera.position.z = 50;
  camera.updateMatrixWorld();
  expect(sizeOnScreen(box, new Matrix4(), camera, 600)).toBeCloseTo(300);
});
