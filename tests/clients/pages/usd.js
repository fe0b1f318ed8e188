// SPDX-License-Identifier: Apache-2.0
// A page that reads USDZ with TinyUSDZ, which is built for browsers only.
import initTinyUsdz from "tinyusdz/tinyusdz.js";

const tinyUsdz = await initTinyUsdz({ locateFile: () => "/tinyusdz/tinyusdz.wasm" });

/** Returns the extent of points along x, y and z. */
function extent(points) {
  return [0, 1, 2].map((axis) => {
    const along = points.filter((_, i) => i % 3 === axis);
    return along.reduce((most, at) => Math.max(most, at), -Infinity) - along.reduce((least, at) => Math.min(least, at), Infinity);
  });
}

/**
 * Returns the file of the picture that gives a material its colour. Returns undefined if there is
 * no such picture.
 */
function picture(usd, { materialId }) {
  const { diffuseColorTextureId: texture } = usd.getMaterial(materialId);
  return texture === undefined ? undefined : usd.getImage(usd.getTexture(texture).textureImageId);
}

window.client = {
  async read(url) {
    const usd = new tinyUsdz.TinyUSDZLoaderNative(), bytes = await (await fetch(url)).arrayBuffer();
    if (!usd.loadFromBinary(new Uint8Array(bytes), "model.usdz")) throw new Error(usd.error());
    const mesh = usd.getMesh(0), image = picture(usd, mesh);
    return {
      meshes: usd.numMeshes(), triangles: mesh.faceVertexCounts.filter((corners) => corners === 3).length, size: extent(mesh.points),
      normals: mesh.normals.length / mesh.points.length, picture: image && Array.from(image.data.subarray(0, 3)),
    };
  },
};
