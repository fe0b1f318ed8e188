// SPDX-License-Identifier: Apache-2.0
// Formats numbers, sizes and lengths for a language.

const kMillimetres: Record<string, number> = { mm: 1, cm: 10, m: 1000, in: 25.4 };

export function formats(language: string) {
  const whole = new Intl.NumberFormat(language);
  const tenths = new Intl.NumberFormat(language, { maximumFractionDigits: 1 });
  const measured = new Intl.NumberFormat(language, { maximumSignificantDigits: 4 });
  const bound = new Intl.NumberFormat(language, { maximumSignificantDigits: 2 });

  const count = (value: number) => whole.format(Math.round(value));

  function size(bytes: number): string {
    if (bytes < 1000) return `${count(bytes)} B`;
    return bytes < 1e6 ? `${tenths.format(bytes / 1000)} KB` : `${tenths.format(bytes / 1e6)} MB`;
  }

  return {
    count,
    size,
    extent: (values: number[], unit: string) => `${values.map((value) => measured.format(value)).join(" × ")} ${unit}`,
    length: (value: number, unit: string) => `${measured.format(value)} ${unit}`,
    bound: (value: number, unit: string) => `${bound.format(value)} ${unit}`,
  };
}

export type Formats = ReturnType<typeof formats>;

/** Converts a length to millimetres if its unit is known. Returns the resulting length and its unit. */
export function inMillimetres(value: number, unit: string): [number, string] {
  const millimetres = kMillimetres[unit];
  return millimetres === undefined ? [value, unit] : [value * millimetres, "mm"];
}
