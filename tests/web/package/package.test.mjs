// SPDX-License-Identifier: Apache-2.0
// Tests the npm package as it would be published: its contents, its TypeScript types, and what it adds to a bundle. Also tests
// pages that bundlers have built with the package.
// node --test package.test.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { build as esbuild } from "esbuild";
import { ViewerPage, launch } from "../../e2e/browser.mjs";
import { buildForServer, buildWithEsbuild, buildWithVite, buildWithWebpack, startVite } from "./bundlers.mjs";
import { Installed } from "./installed.mjs";
import { kModel, pageOf, serve } from "./site.mjs";

/**
 * The strictest content security policy under which the viewer works. web/README.md states the same
 * policy.
 */
const kPolicy = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; style-src 'self'; img-src 'self'";

let installed, browser;
before(async () => {
  installed = new Installed();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  installed?.remove();
});

describe("the package", () => {
  test("has its files, licences and nothing else", () => {
    const { paths } = installed;
    const wanted = ["package.json", "README.md", "LICENSE", "NOTICE", "dist/types/three/index.d.ts", "dist/types/element/index.d.ts",
      ...["progressive-mesh.js", "progressive-mesh-loader.js", "progressive-mesh-worker.js", "progressive-mesh.wasm"].map((name) => `dist/package/${name}`),
      ...["plain.html", "three.html", "three.js", "react-three-fiber.jsx"].map((name) => `examples/${name}`)];
    for (const path of wanted) assert.ok(paths.includes(path), `${path} is in the package`);
    const known = /^(package\.json|README\.md|LICENSE|NOTICE|dist\/package\/progressive-mesh[^/]*|dist\/types\/.*|examples\/[^/]*)$/;
    assert.deepEqual(paths.filter((path) => !known.test(path)), []);
    const { resolve } = createRequire(join(installed.folder, "pages/"));
    for (const name of ["progressive-mesh-worker.js", "progressive-mesh.wasm"]) {
      assert.ok(resolve(`@vitrine/progressive-mesh/assets/${name}`).endsWith(join("dist/package", name)));
    }
    assert.match(readFileSync(join(installed.package, "NOTICE"), "utf8"), /three\.js authors[^]*The MIT licence/);
  });

  test("passes publint", () => {
    assert.match(installed.run("publint", installed.archive, "--strict"), /All good!/);
  });

  test("passes attw; a CommonJS program imports it dynamically, because it has modules only", () => {
    installed.run("attw", installed.archive, "--ignore-rules", "cjs-resolves-to-esm");
  });

  test("has types for TypeScript, React and Vue", () => {
    const flags = "--noEmit --strict --target es2022 --lib es2022,dom,dom.iterable --types three --jsx react-jsx --allowImportingTsExtensions".split(" ");
    writeFileSync(join(installed.folder, "package.json"), `{ "type": "module" }`);
    installed.run("tsc", ...flags, "--module", "nodenext", "--skipLibCheck", "pages/user.ts", "pages/react.tsx");
    writeFileSync(join(installed.folder, "tsconfig.json"), JSON.stringify({
      compilerOptions: { noEmit: true, strict: true, target: "es2022", module: "esnext", moduleResolution: "bundler", skipLibCheck: true, types: ["three"] },
      files: ["pages/Bust.vue", "pages/vue-page.ts"],
    }));
    installed.run("vue-tsc", "--project", installed.folder);
  });

  test("has types without errors where neither React nor Vue is installed", () => {
    const bare = installed.bare("three", "@types/three");
    writeFileSync(join(bare, "package.json"), `{ "type": "module" }`);
    const flags = "--noEmit --strict --target es2022 --lib es2022,dom,dom.iterable --types three --module esnext --moduleResolution bundler".split(" ");
    installed.run("tsc", ...flags, join(bare, "user.ts"));
  });

  test("adds to a bundle only what the program uses", async () => {
    const size = async (contents) => {
      const { outputFiles } = await esbuild({ stdin: { contents, resolveDir: installed.folder }, bundle: true, minify: true, format: "esm",
        external: ["three"], write: false, logLevel: "error" });
      return outputFiles[0].contents.length;
    };
    const loader = await size(`export { ProgressiveMeshLoader } from "@vitrine/progressive-mesh";`);
    const error = await size(`export { ModelError } from "@vitrine/progressive-mesh";`);
    const nothing = await size(`import "@vitrine/progressive-mesh";`);
    assert.ok(error < 0.1 * loader && nothing < 100, `loader ${loader}, one class of it ${error}, nothing of it ${nothing} bytes`);
  });

  for (const example of ["three.js", "react-three-fiber.jsx"]) {
    test(`exports what the example ${example} imports`, async () => {
      const { metafile } = await esbuild({ entryPoints: [join(installed.package, "examples", example)], bundle: true, write: false, metafile: true,
        format: "esm", jsx: "automatic", logLevel: "error", external: ["three", "three/*", "@react-three/*", "react", "react/*"] });
      assert.ok(Object.keys(metafile.inputs).some((input) => input.includes("progressive-mesh-loader.js")));
    });
  }
});

describe("a server", () => {
  test("imports the element and the loader as modules", () => {
    const program = `import "@vitrine/progressive-mesh/element"; import { ProgressiveMeshLoader } from "@vitrine/progressive-mesh"; new ProgressiveMeshLoader();`;
    execFileSync(process.execPath, ["--input-type=module", "--eval", program], { cwd: installed.folder });
  });

  test("renders a React page with the element, bundled as CommonJS", async () => {
    const script = join(installed.folder, "server.cjs");
    await buildForServer(installed.folder, "pages/react-server.tsx", script);
    const { html } = createRequire(import.meta.url)(script);
    assert.match(html, /<progressive-mesh src="\/model\.pmesh" alt="A bust" camera-controls="" pixel-error="0">/);
  });
});

/** Opens `url` and waits until its viewer shows the whole model or an error. Returns the event and the page. */
async function visit(url) {
  const viewer = await ViewerPage.open(browser, url, { attributes: {} });
  await viewer.page.waitForFunction(() => window.seen.some(({ type }) => type === "load" || type === "error"), null, { timeout: 60_000 });
  return { viewer, event: (await viewer.seen()).find(({ type }) => type === "load" || type === "error") };
}

/**
 * Checks that the page shows its models without errors or warnings, such as the warning about a second instance of
 * three.js. An element of the page must match the selector `mark`.
 */
async function checkPage(url, mark) {
  const { viewer, event } = await visit(url);
  assert.deepEqual(event, { type: "load", detail: null });
  await viewer.page.waitForSelector(mark, { state: "attached" });
  assert.deepEqual(await viewer.complaints(), []);
  await viewer.page.context().close();
}

/** Serves `folder` with the Content-Security-Policy `policy` while `check` runs with its URL. */
async function served(folder, policy, check) {
  const site = await serve(folder, policy);
  try {
    await check(site.url);
  } finally {
    site.close();
  }
}

const kLoaded = `body[data-loaded="6"]`;
const kCounted = `main[data-triangles="92"]`;

describe("a page shows a model under a strict security policy, built with", () => {
  const out = (name) => join(installed.folder, name);

  test("Vite, also with React and Vue", async () => {
    await buildWithVite(installed.folder, ["pages/plain.js", "pages/react-page.tsx", "pages/vue-page.ts"], out("vite"));
    await served(out("vite"), kPolicy, async (url) => {
      await checkPage(`${url}plain.html`, kLoaded);
      await checkPage(`${url}react-page.html`, kCounted);
      await checkPage(`${url}vue-page.html`, kCounted);
    });
  });

  test("webpack, whose bundle names no file of the machine that built it", async () => {
    await buildWithWebpack(installed.folder, "pages/plain.js", out("webpack"));
    for (const name of readdirSync(out("webpack")).filter((file) => file.endsWith(".js"))) {
      const text = readFileSync(join(out("webpack"), name), "utf8");
      assert.ok(!text.includes(`file://${installed.folder}`) && !text.includes(`"file:///`), name);
    }
    await served(out("webpack"), kPolicy, (url) => checkPage(`${url}plain.html`, kLoaded));
  });

  test("esbuild, with the viewer's files beside the bundle", async () => {
    await buildWithEsbuild(installed.folder, "pages/plain.js", out("esbuild"));
    await served(out("esbuild"), kPolicy, (url) => checkPage(`${url}plain.html`, kLoaded));
  });

  test("esbuild, with the viewer's files where setAssets says", async () => {
    await buildWithEsbuild(installed.folder, "pages/moved.js", out("elsewhere"), join(out("elsewhere"), "moved"));
    await served(out("elsewhere"), kPolicy, (url) => checkPage(`${url}moved.html`, kLoaded));
  });

  test("Vite's development server, without a policy", async () => {
    mkdirSync(out("public"));
    copyFileSync(kModel, out("public/model.pmesh"));
    writeFileSync(out("public/style.css"), "");
    writeFileSync(out("dev.html"), pageOf("pages/plain"));
    const server = await startVite(installed.folder);
    try {
      await checkPage(`${server.url}dev.html`, kLoaded);
    } finally {
      await server.close();
    }
  });
});

describe("the viewer says which rule is missing in", () => {
  const kWithout = {
    "'wasm-unsafe-eval'": [/forbids wasm-eval: add 'wasm-unsafe-eval' to script-src$/, "default-src 'self'"],
    "worker-src": [/forbids \S+\/progressive-mesh-worker\.js: add 'self' to worker-src$/, kPolicy.replace("worker-src 'self'", "worker-src 'none'")],
    "connect-src": [/forbids \S+: add 'self' to connect-src$/, kPolicy.replace("connect-src 'self'; ", "")],
  };
  for (const [rule, [expected, policy]] of Object.entries(kWithout)) {
    test(`a policy without ${rule}`, () => served(join(installed.folder, "esbuild"), policy, async (url) => {
      const { viewer, event } = await visit(`${url}plain.html`);
      assert.equal(event.type, "error");
      assert.match(event.detail.message, expected);
      await viewer.page.context().close();
    }));
  }

  test("no policy: where the worker's file is not there", async () => {
    const folder = join(installed.folder, "without-files");
    await buildWithEsbuild(installed.folder, "pages/plain.js", folder, join(folder, "elsewhere"));
    await served(folder, undefined, async (url) => {
      const { viewer, event } = await visit(`${url}plain.html`);
      assert.match(event.detail.message, /worker is not there: \S+\/progressive-mesh-worker\.js;/);
      await viewer.page.context().close();
    });
  });
});
