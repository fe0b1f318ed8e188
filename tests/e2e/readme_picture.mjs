// SPDX-License-Identifier: Apache-2.0
// Takes the README's picture from the real page: node readme_picture.mjs BIN MESH OUT.png
import { resolve } from "node:path";
import { launch, ViewerPage } from "./browser.mjs";
import { Daemon } from "./daemon.mjs";

const [bin, mesh, out] = process.argv.slice(2).map((path) => resolve(path));
const daemon = await Daemon.start(bin);
const browser = await launch();
try {
  const page = await daemon.publish(mesh, "Demosthenes");
  const viewer = await ViewerPage.open(browser, page, { width: 960, height: 720 });
  await viewer.releaseLayers();
  await viewer.events("load");
  await viewer.picture();
  await viewer.page.screenshot({ path: out });
} finally {
  await browser.close();
  await daemon.stop();
}
