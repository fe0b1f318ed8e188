// SPDX-License-Identifier: Apache-2.0
// Table of the vertex attributes that a model can have in addition to positions. It states their
// layouts in the decoder's output and in the displayed surface.

export type Semantic = "colour";

/** All attribute semantics, in the order of the enumeration in codec/mesh/vertex_attributes.h. */
export const kSemantics: readonly Semantic[] = ["colour"];

interface AttributeKind {
  /** Bytes per vertex in the decoder's output. */
  bytes: number;
  /** Components per vertex in the displayed surface. */
  width: 3 | 4;
  /** Converts the decoder's bytes to the values of the displayed surface. */
  shown(bytes: Uint8Array): Uint16Array;
}

export const kAttributes: Readonly<Record<Semantic, AttributeKind>> = {
  colour: { bytes: 3, width: 4, shown: linearColours },
};

/** Values of one attribute for all vertices, in vertex order. */
export interface Attribute<Values> {
  semantic: Semantic;
  values: Values;
}

const kLinear = Uint16Array.from({ length: 256 }, (_, i) => {
  const value = i / 255;
  return Math.round(65535 * (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
});

/**
 * Converts 3 sRGB bytes per vertex to 4 linear 16-bit values with an opaque alpha. Scans store
 * sRGB, but three.js shades in linear light.
 */
function linearColours(bytes: Uint8Array): Uint16Array {
  const count = bytes.length / 3;
  const linear = new Uint16Array(4 * count).fill(65535);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 3; ++k) linear[4 * i + k] = kLinear[bytes[3 * i + k] ?? 0] ?? 0;
  }
  return linear;
}
