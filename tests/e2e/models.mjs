// SPDX-License-Identifier: Apache-2.0
// Test meshes out of the scan that ships.
import { readFile, writeFile } from "node:fs/promises";

/** Vertices and faces of an OBJ file of triangles. */
export async function readObj(path) {
  const lines = (await readFile(path, "utf8")).split("\n").map((line) => line.trim().split(/\s+/));
  const numbers = (tag, map) => lines.filter(([first]) => first === tag).map(([, ...rest]) => rest.slice(0, 3).map(map));
  return { vertices: numbers("v", Number), faces: numbers("f", (corner) => parseInt(corner, 10) - 1) };
}

/** The same mesh as PLY, coloured by position: red to blue along x, green along y. */
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
