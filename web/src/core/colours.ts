// SPDX-License-Identifier: Apache-2.0
// three.js shades in linear light, scans carry sRGB.

const kLinear = Uint16Array.from({ length: 256 }, (_, i) => {
  const value = i / 255;
  return Math.round(65535 * (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
});

/** 3 sRGB bytes a vertex to 4 linear 16-bit values, opaque. */
export function linearColours(bytes: Uint8Array): Uint16Array {
  const count = bytes.length / 3;
  const linear = new Uint16Array(4 * count).fill(65535);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 3; ++k) linear[4 * i + k] = kLinear[bytes[3 * i + k] ?? 0] ?? 0;
  }
  return linear;
}
