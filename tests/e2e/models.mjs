// SPDX-License-Identifier: Apache-2.0
// Reads and writes meshes for tests.
import { readFile, writeFile } from "node:fs/promises";
import { deflateSync } from "node:zlib";

/** Returns the vertices and faces of an OBJ file of triangles. */
export async function readObj(path) {
  const lines = (await readFile(path, "utf8")).split("\n").map((line) => line.trim().split(/\s+/));
  const numbers = (tag, map) => lines.filter(([first]) => first === tag).map(([, ...rest]) => rest.slice(0, 3).map(map));
  return { vertices: numbers("v", Number), faces: numbers("f", (corner) => parseInt(corner, 10) - 1) };
}

/** Writes the mesh as PLY with colours that depend on position: red to blue along x, green along y. */
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

/** Writes a watertight, bumpy ball of 12 n² triangles as PLY. Its outline has no holes from any direction. */
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

/**
 * Writes a ball of 2 * `around` * `up` triangles as GLB. Its picture is `columns` pixels wide and has
 * `stripes` red and blue stripes from pole to pole. If there are more stripes than vertices around the ball, vertex
 * colours cannot show them.
 */
export async function writeStripedBall(path, { around = 32, up = 16, stripes = 48, columns = 1024 } = {}) {
  const points = [], coordinates = [], corners = [];
  for (let j = 0; j <= up; ++j) {
    for (let i = 0; i <= around; ++i) {
      const a = (2 * Math.PI * (i % around)) / around, b = (Math.PI * j) / up;
      points.push(Math.sin(b) * Math.sin(a), Math.cos(b), Math.sin(b) * Math.cos(a));
      coordinates.push(i / around, j / up);
    }
  }
  for (let j = 0; j < up; ++j) {
    for (let i = 0; i < around; ++i) {
      const at = j * (around + 1) + i, below = at + around + 1;
      if (j > 0) corners.push(at, below, at + 1);
      if (j < up - 1) corners.push(at + 1, below, below + 1);
    }
  }
  const picture = png(columns, columns / 2, (x) => (Math.floor((stripes * x) / columns) % 2 === 0 ? [235, 25, 25] : [25, 25, 235]));
  await writeFile(path, glb({ points, coordinates, corners, picture }));
}

function glb({ points, coordinates, corners, picture }) {
  const parts = [new Float32Array(points), new Float32Array(coordinates), new Uint32Array(corners), picture]
    .map((values) => padded(Buffer.from(values.buffer, values.byteOffset, values.byteLength), 0));
  const starts = parts.map((_, i) => parts.slice(0, i).reduce((sum, part) => sum + part.length, 0));
  const [count, box] = [points.length / 3, { min: [-1, -1, -1], max: [1, 1, 1] }];
  const json = {
    asset: { version: "2.0" }, buffers: [{ byteLength: parts.reduce((sum, part) => sum + part.length, 0) }],
    bufferViews: parts.map((part, i) => ({ buffer: 0, byteOffset: starts[i], byteLength: part.length })),
    accessors: [
      { bufferView: 0, componentType: 5126, count, type: "VEC3", ...box }, { bufferView: 1, componentType: 5126, count, type: "VEC2" },
      { bufferView: 2, componentType: 5125, count: corners.length, type: "SCALAR" },
    ],
    images: [{ bufferView: 3, mimeType: "image/png" }], textures: [{ source: 0 }],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0 } }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, indices: 2, material: 0 }] }],
    nodes: [{ mesh: 0 }], scenes: [{ nodes: [0] }], scene: 0,
  };
  const chunk = (type, bytes) => Buffer.concat([Buffer.from(Uint32Array.of(bytes.length).buffer), Buffer.from(type), bytes]);
  const body = Buffer.concat([chunk("JSON", padded(Buffer.from(JSON.stringify(json)), 0x20)), chunk("BIN\0", Buffer.concat(parts))]);
  return Buffer.concat([Buffer.from("glTF"), Buffer.from(Uint32Array.of(2, 12 + body.length).buffer), body]);
}

function padded(bytes, fill) {
  return Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, fill)]);
}

/** Returns a PNG file. `colour(x, y)` gives the red, green and blue of a pixel, 0 to 255. */
function png(width, height, colour) {
  const rows = Array.from({ length: height }, (_, y) => Buffer.from([0, ...Array.from({ length: width }, (_, x) => colour(x, y)).flat()]));
  const number = (value) => Buffer.from([value >>> 24, value >>> 16, value >>> 8, value]);
  const chunk = (type, bytes) => {
    const body = Buffer.concat([Buffer.from(type), bytes]);
    return Buffer.concat([number(bytes.length), body, number(crc32(body))]);
  };
  return Buffer.concat([
    Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]), chunk("IHDR", Buffer.concat([number(width), number(height), Buffer.from([8, 2, 0, 0, 0])])),
    chunk("IDAT", deflateSync(Buffer.concat(rows))), chunk("IEND", Buffer.alloc(0)),
  ]);
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}
