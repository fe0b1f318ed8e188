// SPDX-License-Identifier: Apache-2.0
// first_paint.mjs BIN_FOLDER MESH [RUNS]
// Measures the time until the first picture, and the time until a picture with an error of 1 % of the diagonal.
// The line has 1.6 Mbit/s and a round trip of 150 ms. Compares Vitrine with model-viewer and three.js'
// GLTFLoader, which load the same mesh as a Draco GLB. One static host that compresses code serves all three. A
// "cold" browser has an empty cache; a "warm" browser has cached the code but not the model. Prints medians,
// and why gltf-progressive is not compared. Fails unless a warm first picture takes at most 0.6 s and at most
// 20 KB of the model. Also fails unless a cold first picture takes at most 1.9 s and less time than with
// model-viewer and GLTFLoader.
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch } from "../../e2e/browser.mjs";
import { StaticHost } from "../../e2e/static_host.mjs";
import { diagonal, dracoGlb } from "./draco_glb.mjs";
import { Line } from "./line.mjs";

const kLine = { rate: 200_000, delay: 75 };
// Limits of a first picture: time in ms with and without the viewer's code in the cache, and bytes of the model
// fetched by then.
const kWarm = 600, kCold = 1900, kHead = 20_000;
const web = new URL("../../../web/", import.meta.url);
const { build } = createRequire(new URL("package.json", web))("esbuild");

/** The script of a page that uses only three.js. */
const kGltf = `
import { Box3, HemisphereLight, PerspectiveCamera, Scene, Sphere, WebGLRenderer } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
const renderer = new WebGLRenderer({ antialias: true });
renderer.setSize(800, 600);
document.body.append(renderer.domElement);
const { scene } = await new GLTFLoader().setDRACOLoader(new DRACOLoader().setDecoderPath("/draco/")).loadAsync("/model.glb");
const world = new Scene().add(scene, new HemisphereLight(0xffffff, 0x8a8178, 3)), camera = new PerspectiveCamera(35, 4 / 3, 0.001, 10000);
const { center, radius } = new Box3().setFromObject(scene).getBoundingSphere(new Sphere());
camera.position.copy(center).z += 3.5 * radius;
renderer.render(world, camera);
renderer.domElement.dispatchEvent(new Event("load"));`;

const [bin, mesh, runs = "3"] = process.argv.slice(2);
if (!mesh) {
  console.error("Usage: first_paint.mjs BIN_FOLDER MESH [RUNS]");
  process.exit(2);
}

const folder = await mkdtemp(join(tmpdir(), "vitrine-"));
const host = await StaticHost.start({ tuned: true });
const line = await Line.to(host.server.address().port, kLine);
const browser = await launch();
try {
  const { fine, pages } = await published();
  const results = Object.fromEntries(["vitrine, warm", "vitrine, cold", "model-viewer, cold", "GLTFLoader, cold"].map((name) => [name, []]));
  for (let run = 0; run < Number(runs); ++run) {
    for (const [name, all] of Object.entries(results)) {
      const [who, cache] = name.split(", ");
      all.push(await visit(pages[who], who, cache === "warm" ? pages.other : undefined, fine));
    }
  }
  const medians = Object.fromEntries(Object.entries(results).map(([name, all]) => [name, median(all)]));
  for (const [name, { paint, fine, model, bytes, task }] of Object.entries(medians)) {
    console.log(`${name}: first picture after ${paint} ms and ${model} bytes of the model, error of 1 % after ${fine} ms, ${bytes} bytes in all, longest task ${task} ms`);
  }
  console.log("gltf-progressive, cold: not measured: its loader and what makes its assets (@needle-tools/gltf-build-pipeline) come without a licence, so that nobody may use them");
  const { "vitrine, warm": warm, "vitrine, cold": cold, ...peers } = medians;
  const kept = warm.paint <= kWarm && cold.paint <= kCold && warm.model <= kHead && Object.values(peers).every(({ paint }) => cold.paint < paint);
  process.exitCode = kept ? 0 : 1;
} finally {
  await browser.close();
  line.stop();
  host.stop();
  await rm(folder, { recursive: true });
}

/**
 * Publishes models, viewers and pages on the host. `fine` in the result is the number of triangles
 * at which the error is at most 1 %.
 */
async function published() {
  const vitrine = (...words) => execFileSync(join(bin, "vitrine"), words, { stdio: ["ignore", "pipe", "inherit"] });
  const file = join(folder, "model.pmesh"), plain = join(folder, "model.glb");
  vitrine("build", mesh, "--force", "-o", file);
  vitrine("decode", file, "--force", "-o", plain);
  const glb = await readFile(plain), { levels } = JSON.parse(vitrine("info", file, "--json"));
  const fine = levels.find(({ max_error: error }) => error <= 0.01 * diagonal(glb)).faces;
  host.add("model.pmesh", await readFile(file));
  host.add("other.pmesh", await readFile(file));
  host.add("model.glb", await dracoGlb(glb));
  for (const name of ["draco_decoder.wasm", "draco_wasm_wrapper.js"]) {
    host.add(`draco/${name}`, await readFile(new URL(`node_modules/three/examples/jsm/libs/draco/gltf/${name}`, web)));
  }
  host.add("model-viewer.js", await readFile(new URL("node_modules/@google/model-viewer/dist/model-viewer.min.js", web)));
  const { outputFiles } = await build({ stdin: { contents: kGltf, resolveDir: new URL(".", web).pathname }, bundle: true, minify: true, format: "esm", write: false });
  host.add("gltf.js", outputFiles[0].contents);
  const ours = (src) => page(`<script type="module" src="/progressive-mesh.js"></script>
    <progressive-mesh src="/${src}" camera-controls pixel-error="0"></progressive-mesh>`);
  return {
    fine,
    pages: {
      vitrine: ours("model.pmesh"), other: ours("other.pmesh"), GLTFLoader: page(`<script type="module" src="/gltf.js"></script>`),
      "model-viewer": page(`<script>self.ModelViewerElement = { dracoDecoderLocation: "/draco/" }</script>
        <script type="module" src="/model-viewer.js"></script><model-viewer src="/model.glb" camera-controls></model-viewer>`),
    },
  };
}

function page(body) {
  const name = `page${host.files.size}.html`;
  host.add(name, `<!doctype html><link rel="icon" href="data:,"><style>body > * { display: block; width: 800px; height: 600px }</style>${body}`);
  return `${line.url}/${name}`;
}

/**
 * Measures one visit to `url` with an empty cache. If `before` is given, first shows the page at that URL twice, to fill the
 * cache.
 */
async function visit(url, who, before, fine) {
  const context = await browser.newContext({ viewport: { width: 900, height: 700 } });
  await context.addInitScript(watch, fine);
  for (let i = 0; before && i < 2; ++i) await shown(context, before);
  host.sent = [];
  const seen = await shown(context, url);
  await context.close();
  const { sent } = host, isModel = ({ path }) => /\.(pmesh|glb)$/.test(path), sum = (some) => some.reduce((all, { bytes }) => all + bytes, 0);
  return {
    paint: Math.round(seen.paint), fine: Math.round(seen.fine ?? seen.paint), task: Math.round(seen.task), bytes: sum(sent),
    model: sum(sent.filter((one) => isModel(one) && one.at < seen.origin + seen.paint)),
  };
}

async function shown(context, url) {
  const tab = await context.newPage();
  await tab.goto(url, { waitUntil: "commit" });
  await tab.waitForFunction(() => window.paint.done, null, { timeout: 120_000 });
  const seen = await tab.evaluate(() => window.paint);
  await tab.close();
  return seen;
}

/**
 * Runs in the page. Records the times at which the first picture, a picture with an error of 1 %,
 * and the complete model (`done`) appear.
 */
function watch(fine) {
  const paint = (window.paint = { origin: performance.timeOrigin, task: 0 });
  new PerformanceObserver((list) => list.getEntries().forEach(({ duration }) => (paint.task = Math.max(paint.task, duration)))).observe({ type: "longtask", buffered: true });
  const drawn = () => requestAnimationFrame(() => requestAnimationFrame(() => (paint.paint = performance.now(), paint.done = true)));
  document.addEventListener("first-paint", () => (paint.paint = performance.now()), true);
  document.addEventListener("refine", ({ detail }) => detail.triangles >= fine && (paint.fine ??= performance.now()), true);
  document.addEventListener("load", ({ target }) => {
    if (target.localName === "progressive-mesh") paint.done = true;
    if (target.localName === "model-viewer" || target.localName === "canvas") drawn();
  }, true);
}

function median(results) {
  const middle = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
  return Object.fromEntries(Object.keys(results[0]).map((key) => [key, middle(results.map((result) => result[key]))]));
}
