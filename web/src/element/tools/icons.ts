// SPDX-License-Identifier: Apache-2.0
// Icons as SVG paths in a 24 x 24 view box.
const kPaths = {
  light: "M12 7a5 5 0 1 0 0 10a5 5 0 0 0 0-10M12 1.8v2M12 20.2v2M1.8 12h2M20.2 12h2M4.8 4.8l1.4 1.4M17.8 17.8l1.4 1.4M4.8 19.2l1.4-1.4M17.8 6.2l1.4-1.4",
  section: "M12 2.5l8 4.5v9.8l-8 4.7l-8-4.7V7zM12 2.5v19M12 12l8-5M12 17l8-5",
  measure: "M2.5 16.5l14-14l5 5l-14 14zM6.5 12.5l2 2M9.5 9.5l3 3M12.5 6.5l2 2",
  notes: "M12 21.5s7-6.4 7-11.7a7 7 0 1 0-14 0c0 5.3 7 11.7 7 11.7M12 7.2a2.6 2.6 0 1 0 0 5.2a2.6 2.6 0 0 0 0-5.2",
  surface: "M12 3l9 6.5l-3.5 10.5h-11L3 9.5zM12 3v7.5M3 9.5l9 1l9-1M12 10.5L6.5 20M12 10.5L17.5 20",
  ar: "M12 7l5 2.8v5.4l-5 2.8l-5-2.8V9.8zM12 12.6V18M7 9.8l5 2.8l5-2.8M2.5 7V2.5H7M17 2.5h4.5V7M21.5 17v4.5H17M7 21.5H2.5V17",
  save: "M12 15V3M7.5 7L12 2.5L16.5 7M5 12v8.5h14V12",
  fullScreen: "M3 8.5V3h5.5M15.5 3H21v5.5M21 15.5V21h-5.5M8.5 21H3v-5.5",
  reset: "M4.2 9.5a8.3 8.3 0 1 1-.3 4.5M3.5 4v5.8h5.8",
  close: "M5.5 5.5l13 13M18.5 5.5l-13 13",
};
export type Icon = keyof typeof kPaths;

const kSvg = "http://www.w3.org/2000/svg";

/** Creates an icon. Screen readers ignore it, because the button around it has a label. */
export function icon(name: Icon): SVGSVGElement {
  const svg = document.createElementNS(kSvg, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  svg.appendChild(document.createElementNS(kSvg, "path")).setAttribute("d", kPaths[name]);
  return svg;
}
