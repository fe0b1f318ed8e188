// SPDX-License-Identifier: Apache-2.0
// Reads and writes meshes for tests.
import { readFile, writeFile } from "node:fs/promises";

/** Returns the vertices and faces of an OBJ file of triangles. */
export async function readObj(path) {
  const lines = (await readFile(path, "utf8")).split("\n").map((line) => line.trim().split(/\s+/));
  const numbers = (tag, map) => lines.filter(([first]) => first === tag).map(([, ...rest]) => rest.slice(0, 3).map(map));
  return { vertices: numbers("v", Number), faces: numbers("f", (corner) => parseInt(corner, 10) - 1) };
}

/** Writes the mesh as PLY, coloured by position: red to blue along x, green along y. */
export async function writeColoured({ vertices, faces }, path) {
  const range = (axis) => vertices.reduce(([low, high], v) => [Math.min(low, v[axis]), Math.max(high, v[axis])], [Infinity, -Infinity]);
  const [x, y] = [range(0), range(1)];
  const tint = (value, [low, high]) => Math.round((255 * (value - low)) / (high - low));
  const lines = vertices.map((v) => `${v.join(" ")} ${tint(v[0], x)} ${tint(v[1], y)} ${255 - tint(v[0], x)}`);
  const header = ["ply", "format ascii 1.0", `element vertex ${vertices.length}`,
    ...["x", "y", "z"].map((axis) => `property float ${axis}`),
    ...["red", "green", "blue"].map((channel) => `property uchar ${channel}`),
    `element face ${faces.length}`, "property list uchar int vertex_indices", "end_header"];
  await writeFile(path, [...header, ...lines, ...faces.map((face) => `3 ${face.join(" ")}`), ""].join("\n"));
}

/** Writes a watertight, bumpy ball of 12 n² triangles as PLY. From every direction, its outline has no holes. */
export async function writeBlob(path, n) {
  const vertices = [], faces = [], known = new Map();
  const at = (point) => {
    const key = point.join();
    if (!known.has(key)) {
      const size = Math.hypot(...point), [x, y, z] = point.map((c) => c / size);
      const r = 100 + 4 * Math.sin(5 * x + 2) * Math.sin(6 * y) + 1.5 * Math.sin(23 * z) * Math.sin(19 * x + 1) * Math.sin(17 * y);
      known.set(key, vertices.push([r * x, r * y, r * z].map((c) => c.toFixed(4))) - 1);
    }
    return known.get(key);
  };
  for (const axis of [0, 1, 2]) {
    for (const side of [-n, n]) {
      const corner = (i, j) => {
        const point = [0, 0, 0];
        point[axis] = side;
        point[(axis + 1) % 3] = 2 * i - n;
        point[(axis + 2) % 3] = 2 * j - n;
        return at(point);
      };
      for (let i = 0; i < n; ++i) {
        for (let j = 0; j < n; ++j) {
          const [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
          for (const [p, q, r] of [[a, b, c], [a, c, d]]) faces.push(side > 0 ? [p, q, r] : [p, r, q]);
        }
      }
    }
  }
  const header = ["ply", "format ascii 1.0", `element vertex ${vertices.length}`, ...["x", "y", "z"].map((axis) => `property float ${axis}`),
    `element face ${faces.length}`, "property list uchar int vertex_indices", "end_header"];
  await writeFile(path, [...header, ...vertices.map((v) => v.join(" ")), ...faces.map((face) => `3 ${face.join(" ")}`), ""].join("\n"));
}
