// SPDX-License-Identifier: Apache-2.0
// Reads the attributes tone-mapping and exposure, whose values are those of model-viewer.
import {
  ACESFilmicToneMapping, AgXToneMapping, CineonToneMapping, LinearToneMapping, NoToneMapping, REVISION, ReinhardToneMapping, type ToneMapping,
} from "three";

export interface ToneWords {
  mapping: string | null;
  exposure: string | null;
}

export interface Tones {
  mapping: ToneMapping;
  /** Factor for the brightness. */
  exposure: number;
}

/**
 * NeutralToneMapping, which three.js has since revision 162. Older revisions get linear mapping, which differs in bright colours
 * only. The code has the number instead of the name, because bundlers refuse to import a name that the page's three.js does not
 * have.
 */
const kNeutralToneMapping: ToneMapping = parseInt(REVISION) < 162 ? LinearToneMapping : 7;

const kMappings: Record<string, ToneMapping> = {
  neutral: kNeutralToneMapping, aces: ACESFilmicToneMapping, agx: AgXToneMapping, reinhard: ReinhardToneMapping, cineon: CineonToneMapping,
  linear: LinearToneMapping, none: NoToneMapping,
};

/**
 * Returns the tone mapping and the exposure. Without attributes, a textured model looks as in model-viewer, and an
 * untextured one gets no tone mapping. A malformed value counts as missing. The mapping `none` ignores the exposure.
 */
export function tonesOf({ mapping, exposure }: ToneWords, isTextured: boolean): Tones {
  const factor = Number(exposure || NaN), hasFactor = Number.isFinite(factor) && factor >= 0;
  // Linear mapping with exposure 1 would change nothing, but would need another shader.
  const unmapped = hasFactor ? LinearToneMapping : NoToneMapping;
  return { mapping: kMappings[mapping ?? ""] ?? (isTextured ? kNeutralToneMapping : unmapped), exposure: hasFactor ? factor : 1 };
}
