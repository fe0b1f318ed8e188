// SPDX-License-Identifier: Apache-2.0
// Icons of licences and rights statements, as SVG paths in a 24 x 24 view box. They are drawn for this project in the manner of the
// symbols that Creative Commons and RightsStatements.org use. Screen readers ignore them, because a label stands beside each.
const kRing = "M12 2a10 10 0 1 0 0 20a10 10 0 0 0 0-20";
const kCopyright = "M15.6 9a4.6 4.6 0 1 0 0 6";
const kSlash = "M5 5l14 14";

const kPaths = {
  cc: "M10.8 10a2.7 2.7 0 1 0 0 4M17.3 10a2.7 2.7 0 1 0 0 4",
  by: "M12 5a1.4 1.4 0 1 0 0 2.8a1.4 1.4 0 0 0 0-2.8M9.4 9.8h5.2v4.7h-1.3v4.7h-2.6v-4.7H9.4z",
  nc: `M14.9 9.5c-.5-1.1-1.5-1.7-2.9-1.7c-1.6 0-2.8.8-2.8 2c0 2.9 5.8 1.5 5.8 4.4c0 1.3-1.3 2-3 2c-1.5 0-2.6-.6-3.1-1.8M12 6v12${kSlash}`,
  nd: "M8 10h8M8 14h8",
  sa: "M7.6 10.7a4.5 4.5 0 1 1 .7 4.8M5.6 9.2l2 2l2-2",
  zero: "M12 6.4c-2 0-3.2 2.3-3.2 5.6s1.2 5.6 3.2 5.6s3.2-2.3 3.2-5.6s-1.2-5.6-3.2-5.6M10.2 14.8l3.6-5.6",
  inCopyright: kCopyright,
  noCopyright: kCopyright + kSlash,
  other: "M9 9.6a3 3 0 1 1 4.3 2.7c-.9.4-1.3 1-1.3 1.9v.3M12 17.6v.1",
};
export type RightsIcon = keyof typeof kPaths;

/** Returns the icons of a Creative Commons licence, given as an identifier such as CC-BY-4.0 or as an address. Other licences have none. */
export function iconsOfLicence(licence: string): RightsIcon[] {
  const [, name, path] = /^CC[- ]?(0|PDM|BY[A-Z-]*?)[- ]\d\.\d(?:-[A-Z]+)?$/i.exec(licence)
    ?? /^https?:\/\/(?:www\.)?creativecommons\.org\/(?:licenses|publicdomain)(\/)(zero|mark|by[a-z-]*)\//.exec(licence) ?? [];
  const terms = (path ?? name ?? "").toLowerCase();
  if (terms === "0" || terms === "zero") return ["cc", "zero"];
  if (terms === "pdm" || terms === "mark") return ["noCopyright"];
  const icons = terms.split("-").filter((term): term is RightsIcon => term in kPaths);
  return icons.length > 0 ? ["cc", ...icons] : [];
}

/** Returns the icon of the group of a statement of RightsStatements.org: in copyright, no copyright, or other. */
export function iconOfStatement(uri: string): RightsIcon[] {
  const [, name = ""] = /^https?:\/\/(?:www\.)?rightsstatements\.org\/(?:vocab|page)\/([A-Za-z-]+)\//.exec(uri) ?? [];
  if (name === "") return [];
  return [name.startsWith("InC") ? "inCopyright" : name.startsWith("NoC") ? "noCopyright" : "other"];
}

const kSvg = "http://www.w3.org/2000/svg";

/** Draws the icons in a row, in one SVG image. */
export function drawn(icons: readonly RightsIcon[]): SVGSVGElement {
  const kSide = 24, kGap = 4;
  const svg = document.createElementNS(kSvg, "svg");
  svg.setAttribute("viewBox", `0 0 ${icons.length * (kSide + kGap) - kGap} ${kSide}`);
  svg.setAttribute("class", "rights-icons");
  svg.setAttribute("aria-hidden", "true");
  for (const [i, name] of icons.entries()) {
    const path = svg.appendChild(document.createElementNS(kSvg, "path"));
    path.setAttribute("d", kRing + kPaths[name]);
    path.setAttribute("transform", `translate(${i * (kSide + kGap)})`);
  }
  return svg;
}
