// SPDX-License-Identifier: Apache-2.0
// Writes tar files (POSIX.1-2001, pax). The contents stay on the disk: a Blob refers to them.
export interface Packed {
  path: string;
  file: Blob;
}

const kBlock = 512;
const encoder = new TextEncoder();

const padding = (size: number): Uint8Array<ArrayBuffer> => new Uint8Array((kBlock - (size % kBlock)) % kBlock);
const octal = (value: number, digits: number): string => value.toString(8).padStart(digits, "0").slice(-digits);

function header(type: "0" | "x", size: number): Uint8Array<ArrayBuffer> {
  const block = new Uint8Array(kBlock);
  const put = (offset: number, text: string) => block.set(encoder.encode(text), offset);
  put(0, type === "x" ? "pax" : "file"); // the pax record holds the real path
  put(100, "0000644\0");
  put(124, `${octal(size, 11)} `);
  put(136, `${octal(0, 11)} `); // modification time
  put(148, " ".repeat(8)); // the checksum is computed as if its own field held spaces
  put(156, `${type}`);
  put(257, "ustar\x0000");
  put(148, `${octal(block.reduce((sum, byte) => sum + byte, 0), 6)}\0`);
  return block;
}

/** Returns a record of a pax header. It begins with its own length in bytes. */
function record(key: string, value: string): Uint8Array<ArrayBuffer> {
  const rest = encoder.encode(` ${key}=${value}\n`).length;
  let length = rest + 1;
  while (length !== rest + `${length}`.length) length = rest + `${length}`.length;
  return encoder.encode(`${length} ${key}=${value}\n`);
}

/** Returns a tar of the files. Paths may be of any length, and in any script. */
export function tarOf(files: Packed[]): Blob {
  const parts = files.flatMap(({ path, file }) => {
    const name = record("path", path), size = record("size", `${file.size}`), count = name.length + size.length;
    return [header("x", count), name, size, padding(count), header("0", file.size), file, padding(file.size)];
  });
  return new Blob([...parts, new Uint8Array(2 * kBlock)]);
}
