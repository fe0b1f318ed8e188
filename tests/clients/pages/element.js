// SPDX-License-Identifier: Apache-2.0
// A page with the npm package's element.
import "@vitrine/progressive-mesh/element";

const frame = () => new Promise(requestAnimationFrame);

/** Returns the numbers of opaque, red and blue pixels of a canvas, and the sum of their brightness. */
function seen(canvas) {
  const { width, height } = canvas, context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, width, height), found = { covered: 0, red: 0, blue: 0, light: 0 };
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b, alpha] = data.subarray(i, i + 4);
    if (alpha < 255) continue;
    found.covered += 1;
    found.red += r > 2 * b;
    found.blue += b > 2 * r;
    found.light += r + g + b;
  }
  return found;
}

window.client = {
  /**
   * Shows a textured model and waits for the room, an environment that lights the model. The room
   * is loaded after the first picture and fades in.
   */
  async show(src) {
    const element = document.createElement("progressive-mesh");
    for (const [name, value] of Object.entries({ src, alt: "", "pixel-error": "0" })) element.setAttribute(name, value);
    const loaded = new Promise((resolve, reject) => {
      element.addEventListener("load", resolve, { once: true });
      element.addEventListener("error", ({ detail }) => reject(new Error(detail.message)), { once: true });
    });
    document.body.append(element);
    await loaded;
    const canvas = element.shadowRoot.querySelector("canvas"), first = seen(canvas);
    let last = first;
    for (let still = 0; still < 30;) {
      await frame();
      const now = seen(canvas);
      still = now.light === last.light && now.light !== first.light ? still + 1 : 0;
      last = now;
    }
    return { ...last, unlit: first.light / first.covered, lit: last.light / last.covered };
  },
};
