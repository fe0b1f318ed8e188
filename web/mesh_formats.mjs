// SPDX-License-Identifier: Apache-2.0
// Reads the table of the mesh formats that the server can import. The table is part of a C++
// header.
import { readFile } from "node:fs/promises";

const table = await readFile(new URL("../codec/import/formats.h", import.meta.url), "utf8");

/** The formats as {name, extension}, such as {name: "PLY", extension: "ply"}. */
export const meshFormats = [...table.matchAll(/\.name = "(\w+)",\s+\.extension = "(\w+)"/g)].map(([, name, extension]) => ({ name, extension }));
if (meshFormats.length === 0) throw new Error("codec/import/formats.h: no row with .name and .extension");
