// SPDX-License-Identifier: Apache-2.0
// Takes the picture for the README from the real page. The picture shows side by side: the base
// mesh, the model with the slider in the middle, and the whole model.
// node tests/e2e/picture.mjs build/release/bin tests/models/demosthenes.obj picture.png
import { ViewerPage, launch } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const [bin, model, out] = process.argv.slice(2);
if (!out) throw new Error("Usage: picture.mjs BIN MODEL OUT.png");

const daemon = await Daemon.start(bin);
const browser = await launch();
try {
  const viewer = await ViewerPage.open(browser, await daemon.publish(model, "Demosthenes"), { width: 560, height: 640 });
  await viewer.releaseLayers();
  await viewer.events("load");
  const pictures = [];
  for (const fraction of [0, 0.5, 1]) {
    await viewer.slide(fraction);
    pictures.push(await viewer.picture());
  }
  const { page } = viewer;
  await page.setViewportSize({ width: 3 * 560, height: 640 });
  await page.setContent(`<body style="margin:0;display:flex;background:#f6f4ef">${pictures
    .map((png) => `<img style="width:33.33%;height:auto;align-self:start" src="data:image/png;base64,${png.toString("base64")}">`).join("")}`);
  await page.locator("body").screenshot({ path: out });
} finally {
  await browser.close();
  await daemon.stop();
}
