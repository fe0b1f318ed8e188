// SPDX-License-Identifier: Apache-2.0
// Tests drawing. Base mesh, middle level and full resolution must match stored pictures. No state
// of a watertight model may have a crack. Several models must share one worker and one budget.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { launch } from "./browser.mjs";
import { writeBlob, writeStripedBall } from "./models.mjs";
import { openScene } from "./scene.mjs";
import { StaticHost } from "./static_host.mjs";

const { VITRINE_BIN: bin, VITRINE_MODEL: scan, VITRINE_SCREENSHOTS: pictures } = process.env;
const stored = new URL("pictures/", import.meta.url);
const kView = { width: 640, height: 640 }; // pixels of the view that is searched for cracks
const kWhole = 3.6; // camera distance, in radii of the bounding sphere, at which the whole model is in view

let folder, browser, host, blob, bust, ball;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vitrine-"));
  await mkdir(pictures, { recursive: true });
  browser = await launch();
  host = await StaticHost.start();
  const mesh = join(folder, "blob.ply");
  await writeBlob(mesh, 120);
  blob = await serve(mesh, "blob");
  bust = await serve(scan, "bust");
  const striped = join(folder, "ball.glb");
  await writeStripedBall(striped, { stripes: 48 });
  ball = await serve(striped, "ball");
});
after(async () => {
  await browser?.close();
  host?.stop();
  await rm(folder, { recursive: true });
});

async function serve(mesh, name) {
  const file = join(folder, `${name}.pmesh`);
  await promisify(execFile)(join(bin, "vitrine"), ["build", mesh, "-o", file]);
  return host.add(`${name}.pmesh`, await readFile(file));
}

/**
 * Runs in the page. Counts the pixels of the surface (`covered`) and the pixels of cracks, through which the inside of the
 * surface can be seen. A ray enters a watertight model as often as it leaves it. So if only the triangles that face away cover a
 * pixel, the surface has a crack at that pixel. Returns the place of one such pixel, too. The whole model must be in view:
 * clipping would round the shared edge of two triangles separately for each triangle.
 */
function findCracks() {
  const { scene } = window, { FrontSide, BackSide } = scene.THREE;
  const pixels = (side) => {
    scene.scene.traverseVisible(({ material }) => material && (material.side = side));
    return scene.pixels();
  };
  const back = pixels(BackSide), front = pixels(FrontSide), { width, height } = front;
  const isBackground = ({ data }, i) => data[4 * i] === 255 && data[4 * i + 1] === 0 && data[4 * i + 2] === 255;
  let cracks = 0, covered = 0, place;
  for (let i = 0; i < width * height; ++i) {
    if (!isBackground(front, i)) ++covered;
    else if (!isBackground(back, i)) ++cracks, place = [i % width, Math.floor(i / width)];
  }
  return { cracks, covered, place };
}

for (const reducedMotion of ["reduce", "no-preference"]) {
  test(`no state of a watertight model lets the background through, ${reducedMotion === "reduce" ? "at once" : "while it moves"}`, async () => {
    const page = await openScene(browser, host, { ...kView, reducedMotion });
    await page.evaluate(`window.findCracks = ${findCracks}`);
    const seen = await page.evaluate(async ([url, distance]) => {
      const mesh = await scene.load(url), { THREE } = scene;
      const states = [];
      const look = async () => {
        scene.look(mesh, states.length, distance);
        states.push({ triangles: mesh.geometry.index.count / 3, ...findCracks() });
      };
      mesh.addEventListener("refine", look);
      mesh.addEventListener("morph", look);
      const near = new THREE.PerspectiveCamera(35, 1, 0.001, 100);
      for (const [theta, pixels] of [[0, 2], [4, 0.7], [2, 0.5]]) {
        near.position.setFromSphericalCoords(1.3 * mesh.geometry.boundingSphere.radius, 1.3, theta);
        near.lookAt(0, 0, 0);
        await mesh.refineFor(near, 600, 600, pixels);
      }
      const mixed = mesh.geometry.index.count / 3;
      for (let level = 0; level < mesh.info.levels.length; ++level) await mesh.refine({ level });
      while (mesh.morphing) await scene.frame();
      await look();
      return { states, mixed, faces: mesh.info.levels.at(-1).faces, levels: mesh.info.levels.map(({ faces }) => faces) };
    }, [blob, kWhole]);
    const cracked = seen.states.filter(({ cracks, covered }) => cracks > 0 || covered === 0);
    assert.deepEqual(cracked, []);
    assert.ok(seen.mixed < seen.faces && !seen.levels.includes(seen.mixed), `${seen.mixed} triangles: regions at several levels`);
    assert.equal(seen.states.at(-1).triangles, seen.faces);
    assert.ok(seen.states.length > 10);
    await page.screenshot({ path: join(pictures, `blob-${reducedMotion}.png`) });
    await page.context().close();
  });
}

test("a region shown at a level that its neighbours forbid lets the background through", async () => {
  const page = await openScene(browser, host, kView);
  await page.evaluate(`window.findCracks = ${findCracks}`);
  const [whole, broken] = await page.evaluate(async ([url, distance]) => {
    const mesh = await scene.load(url), { THREE } = scene;
    const top = mesh.info.levels.length - 1, { radius } = mesh.geometry.boundingSphere;
    /** Refines to `level` and returns a mesh of the triangles whose centroids satisfy `belongs`. */
    const part = async (level, belongs) => {
      await mesh.refine({ level });
      const { index, attributes: { position } } = mesh.geometry, corners = [];
      for (let i = 0; i < index.count; i += 3) {
        const face = [0, 1, 2].map((k) => new THREE.Vector3().fromBufferAttribute(position, index.getX(i + k)));
        const middle = face[0].clone().add(face[1]).add(face[2]).divideScalar(3);
        if (belongs(middle)) corners.push(...face);
      }
      return new THREE.Mesh(new THREE.BufferGeometry().setFromPoints(corners), new THREE.MeshBasicMaterial());
    };
    /**
     * Shows the patch that faces the camera at `level`, and all other parts at full resolution.
     * Returns the result of findCracks().
     */
    const patched = async (level) => {
      const inside = ({ z }) => z > 0.4 * radius;
      const parts = [await part(level, inside), await part(top, (middle) => !inside(middle))];
      mesh.visible = false;
      scene.scene.add(...parts);
      scene.look(mesh, 0, distance);
      const seen = findCracks();
      for (const one of parts) one.removeFromParent();
      return seen;
    };
    return [await patched(top), await patched(top - 3)];
  }, [blob, kWhole]);
  assert.ok(whole.cracks === 0 && whole.covered > 10_000, `the same level on both sides: ${whole.cracks} pixels of ${whole.covered}`);
  assert.ok(broken.cracks > 0, "three levels apart: no pixel");
  await page.context().close();
});

test("base, middle and full are drawn as in the stored pictures", async () => {
  const page = await openScene(browser, host);
  for (const [name, want] of [["base", { level: 0 }], ["middle", { triangles: 8000 }], ["full", { level: 99 }]]) {
    await page.evaluate(async ([url, wanted]) => {
      const [mesh = await scene.load(url)] = scene.meshes;
      await mesh.refine(wanted);
      scene.look(mesh, 0.3, 3.2);
      scene.draw();
    }, [bust, want]);
    const picture = await page.screenshot({ path: join(pictures, `drawing-${name}.png`) });
    const file = new URL(`${name}.png`, stored);
    if (process.env.VITRINE_STORE_PICTURES) await writeFile(file, picture);
    const { mean, far } = await difference(page, picture, await readFile(file));
    assert.ok(mean < 1 && far < 0.01, `${name}: ${mean} of 255 on average, ${100 * far} % of all pixels clearly`);
  }
  await page.context().close();
});

/**
 * Compares two pictures. Returns `mean`, the mean difference of all channel values (0 to 255), and
 * `far`, the share of pixels in which any channel differs by more than 32.
 */
function difference(page, ...pngs) {
  return page.evaluate(async (both) => {
    const [one, two] = await Promise.all(both.map(async (base64) => {
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    }));
    if (one.length !== two.length) return { mean: 255, far: 1 };
    let sum = 0, far = 0;
    for (let i = 0; i < one.length; i += 4) {
      const off = [0, 1, 2].map((k) => Math.abs(one[i + k] - two[i + k]));
      sum += off[0] + off[1] + off[2];
      if (Math.max(...off) > 32) ++far;
    }
    return { mean: sum / (0.75 * one.length), far: far / (one.length / 4) };
  }, pngs.map((png) => png.toString("base64")));
}

test("models share a worker, and a budget that moves to where the camera looks", async () => {
  const page = await openScene(browser, host);
  const held = await page.evaluate(async (urls) => {
    const { vitrine, camera } = scene;
    vitrine.setBudget({ triangles: 40_000, bytes: Infinity });
    const count = (mesh) => mesh.geometry.index.count / 3;
    const first = await scene.load(urls[0]), second = await scene.load(urls[1]);
    const states = [];
    scene.look(first, 0, 1.5);
    await first.refineFor(camera, 2000, 2000);
    states.push([count(first), count(second)]);
    await second.refineFor(camera, 2000, 2000);
    await first.refineFor(camera, 2000, 2000);
    await second.refineFor(camera, 2000, 2000);
    states.push([count(first), count(second)]);
    return states;
  }, [blob, blob.replace(/$/, "?again")]);
  assert.equal(page.workers().length, 1);
  assert.ok(held[0][0] > 24_000, `alone the first may take nearly all: ${held}`);
  for (const both of held) assert.ok(both[0] + both[1] <= 42_000, `${held} triangles`);
  assert.ok(held[1][1] > 12_000, `then the second gets its share: ${held}`);
  await page.evaluate(() => scene.meshes.forEach((mesh) => mesh.dispose()));
  while (page.workers().length > 0) await page.evaluate(() => scene.frame());
  await page.context().close();
});

test("a ray meets the surface where it is", async () => {
  const page = await openScene(browser, host);
  const [hit, radius] = await page.evaluate(async (url) => {
    const mesh = await scene.load(url), { THREE } = scene;
    await mesh.refine({ level: 4 });
    const ray = new THREE.Raycaster(new THREE.Vector3(0, 0, 1000), new THREE.Vector3(0, 0, -1));
    return [ray.intersectObject(mesh)[0]?.point.z, 100];
  }, blob);
  assert.ok(Math.abs(hit - radius) < 6, `at ${hit}`);
  await page.context().close();
});

/**
 * Runs in the page: exports the mesh as OBJ and GLB, loads both files, and returns the sizes of the loaded meshes.
 */
async function exported(mesh) {
  const { GLTFExporter, GLTFLoader, OBJExporter, OBJLoader } = window.scene;
  const glb = await new GLTFExporter().parseAsync(mesh, { binary: true });
  const [fromGlb] = (await new GLTFLoader().parseAsync(glb, "")).scene.children;
  const [fromObj] = new OBJLoader().parse(new OBJExporter().parse(mesh)).children;
  const normal = fromGlb.geometry.getAttribute("normal");
  return {
    glb: fromGlb.geometry.index.count / 3, obj: fromObj.geometry.getAttribute("position").count / 3,
    side: fromGlb.material.map?.image.width ?? 0, normals: [normal.itemSize, normal.array.constructor.name],
  };
}

for (const name of ["bust", "ball"]) {
  test(`three.js bounds, clones and exports a mesh as any other: ${name}`, async () => {
    const page = await openScene(browser, host, { reducedMotion: "no-preference" });
    const seen = await page.evaluate(async ([url, run]) => {
      const exported = eval(`(${run})`), mesh = await scene.load(url), { THREE } = scene;
      scene.look(mesh, 0.3, 2);
      scene.draw();
      await mesh.refine({ level: 3 });
      scene.draw();
      const attributes = Object.keys(mesh.geometry.attributes), moving = await exported(mesh);
      while (mesh.morphing) await scene.frame();
      const textured = () => scene.draw() ?? mesh.material.map !== null;
      if (mesh.info.texture) while (!textured()) await scene.frame();
      const sphere = mesh.geometry.boundingSphere.clone();
      mesh.geometry.computeBoundingSphere();
      mesh.geometry.computeBoundingBox();
      const still = new THREE.Mesh(mesh.geometry.clone(), mesh.material);
      const before = scene.pixels().data, copy = mesh.clone();
      scene.scene.remove(mesh);
      scene.scene.add(copy);
      const after = scene.pixels().data;
      scene.scene.remove(copy);
      scene.scene.add(still);
      const frozen = scene.pixels().data;
      const differ = (a, b) => a.filter((value, i) => Math.abs(value - b[i]) > 8).length / a.length;
      return {
        attributes, moving, mesh: await exported(mesh), still: await exported(still), triangles: mesh.geometry.index.count / 3,
        radii: [sphere.radius, mesh.geometry.boundingSphere.radius], box: mesh.geometry.boundingBox.isEmpty(),
        copy: [copy.isMesh, copy.geometry === mesh.geometry, copy instanceof scene.vitrine.ProgressiveMesh], changed: [differ(before, after), differ(before, frozen)],
      };
    }, [name === "bust" ? bust : ball, String(exported)]);
    assert.ok(seen.attributes.includes("fromPosition"), "the first export is made during a morph");
    for (const made of [seen.moving, seen.mesh, seen.still])
      assert.deepEqual([made.glb, made.obj], [seen.triangles, seen.triangles]);
    assert.equal(seen.mesh.side > 0, name === "ball");
    assert.deepEqual(seen.still.normals, [3, "Float32Array"]);
    assert.ok(Math.abs(seen.radii[1] / seen.radii[0] - 1) < 0.1, String(seen.radii));
    assert.equal(seen.box, false);
    assert.deepEqual(seen.copy, [true, true, false]);
    assert.ok(seen.changed[0] === 0 && seen.changed[1] < 0.01, `pixels differ: ${seen.changed}`);
    await page.context().close();
  });
}

for (const [reducedMotion, moves] of [["no-preference", true], ["reduce", false]]) {
  test(`new vertices ${moves ? "move to their places, and stand still then" : "stand still at once for those who want no motion"}`, async () => {
    const page = await openScene(browser, host, { reducedMotion });
    const [start, moved, end, attributes] = await page.evaluate(async (url) => {
      const mesh = await scene.load(url);
      scene.look(mesh, 0.3, 2);
      await mesh.refine({ level: 3 });
      const first = mesh.morphing, before = scene.pixels().data;
      while (mesh.morphing) await scene.frame();
      const after = scene.pixels().data;
      const differ = before.some((value, i) => value !== after[i]);
      return [first, differ, mesh.morphing, Object.keys(mesh.geometry.attributes)];
    }, bust);
    assert.deepEqual([start, moved, end], [moves, moves, false]);
    assert.deepEqual(attributes.sort(), ["normal", "position"]);
    await page.context().close();
  });
}
