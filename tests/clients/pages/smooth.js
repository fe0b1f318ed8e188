// SPDX-License-Identifier: Apache-2.0
// A page with our viewer and model-viewer.
import "@google/model-viewer";
import "@vitrine/progressive-mesh/element";

/**
 * A change of brightness between two pixels that counts as a step. The brightness is the sum of
 * red, green and blue, at most 765.
 */
const kStep = 9;
const kCamera = { "camera-orbit": "15deg 80deg 100%", "field-of-view": "30deg" };

/** Adds an element to the page and waits until its model is loaded. */
function loaded(name, attributes) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries({ ...kCamera, alt: "", ...attributes })) element.setAttribute(key, value);
  return new Promise((resolve, reject) => {
    element.addEventListener("load", () => resolve(element), { once: true });
    element.addEventListener("error", ({ detail }) => reject(new Error(JSON.stringify(detail))), { once: true });
    document.body.append(element);
  });
}

/** Waits for two animation frames, in which the page draws what has been loaded. */
const drawn = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));

/**
 * Returns the share of the object's pixels with a step of brightness. At a step, a pixel differs
 * from its left neighbour by more than kStep, while the changes just before and after are less than
 * half of kStep. The borders of flat facets are steps; smooth shading has few steps.
 */
function steps(picture) {
  const { width, height } = picture, context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
  context.drawImage(picture, 0, 0);
  const { data } = context.getImageData(0, 0, width, height), light = (i) => data[i] + data[i + 1] + data[i + 2];
  const change = (i) => Math.abs(light(i) - light(i - 4));
  let pixels = 0, found = 0;
  for (let i = 8; i < data.length - 4; i += 4) {
    if ([-8, -4, 0, 4].some((at) => data[i + at + 3] < 255)) continue;
    pixels += 1;
    found += change(i) > kStep && change(i - 4) < kStep / 2 && change(i + 4) < kStep / 2;
  }
  return found / pixels;
}

window.client = {
  async ours(src, triangles) {
    const element = await loaded("progressive-mesh", { src, "max-triangles": String(triangles) });
    await drawn();
    return steps(element.shadowRoot.querySelector("canvas"));
  },
  async theirs(src) {
    const element = await loaded("model-viewer", { src, loading: "eager", "interaction-prompt": "none", exposure: "0.5" });
    await drawn();
    const picture = new Image();
    picture.src = element.toDataURL();
    await picture.decode();
    return steps(picture);
  },
};
