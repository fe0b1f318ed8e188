// SPDX-License-Identifier: Apache-2.0
// The viewer's visible and spoken texts in English. Other languages have the same type.
import type { Formats } from "./formats.ts";

const units = "units"; // shown for a model without a unit

const sides = {
  front: "the front", "front-right": "the front right", right: "the right", "back-right": "the back right",
  back: "the back", "back-left": "the back left", left: "the left", "front-left": "the front left",
};
const heights = { above: ", from above", level: "", below: ", from below" };

export const en = ({ count, size, length, extent, bound }: Formats) => ({
  loading: "Loading",
  viewOf: (title: string) => title || "Three-dimensional model",
  keys: "Arrow keys turn, plus and minus zoom, Home resets the view.",
  noWebGl: "This browser cannot show three-dimensional content (WebGL 2 is missing).",

  quality: "Detail",
  lowest: "Low",
  refine: "More",
  highest: "Full",
  size,
  more: (bytes: number) => `+${size(bytes)}`,
  complete: "complete",
  atOnce: "at once",
  wait: (seconds: number) => (seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.round(seconds / 60)} min`),
  triangles: (shown: number, total: number) => `${count(shown)} of ${count(total)} triangles`,
  bytes: (held: number, total: number) => `${size(held)} of ${size(total)}`,
  error: (most: number, unit: string) => `error ≤ ${bound(most, unit || units)}`,

  tools: "Tools",
  close: "Close",
  reset: "Reset view",

  light: "Light",
  museum: "Museum",
  studio: "Studio",
  raking: "Raking",
  relief: "Relief",
  shadow: "Shadow",
  rakingFrom: "Direction of the raking light",
  degrees: (value: number) => `${count(value)} degrees`,

  section: "Section",
  sectionOn: "Cut the model",
  sectionAcross: "Direction of the cut",
  axes: { x: "Side", y: "Height", z: "Depth" },
  sectionAt: "Position of the cut",
  sectionFlip: "Other half",
  percent: (fraction: number) => `${count(100 * fraction)} %`,

  measure: "Measure",
  measureFirst: "Click a point on the surface, or press Enter to choose the one in the middle of the view.",
  measureNext: "Now the next point.",
  measured: (distance: number, unit: string) => length(distance, unit || units),
  measureWhat: "What to measure",
  measures: { distance: "Distance", angle: "Angle", area: "Area", profile: "Profile" },
  dimensions: "Width × height × depth",
  extent: (x: number, y: number, z: number, unit: string) => extent([x, y, z], unit || units),
  measureClear: "Clear",

  notes: "Notes",
  noteMarker: (number: number, title: string) => `Note ${number}: ${title}`,
  notesMissing: "The notes cannot be loaded.",
  tour: {
    start: (title: string) => `Play the tour: ${title}`,
    play: "Play",
    pause: "Pause",
    next: "Next stop",
    previous: "Previous stop",
    end: "End the tour",
    stop: (number: number, all: number) => `${number} of ${all}`,
  },

  surface: "Surface",
  form: "Form only",
  curvature: "Curvature",
  facets: "Facets",
  wireframe: "Wireframe",

  dragHint: "Drag to turn",

  save: "Share",
  screenshot: "Save a picture",
  link: "Link to this view",
  share: "Share…",
  copy: "Copy",
  copied: "Link copied.",
  copyByHand: "The link is selected: copy it with the keyboard.",
  qr: "QR code",
  qrOf: "QR code of the link",
  qrMissing: "The QR code cannot be drawn.",
  download: "Download the model",
  format: "Format",
  asShown: (triangles: number) => `As shown, ${count(triangles)} triangles`,
  original: (triangles: number) => `Full, ${count(triangles)} triangles`,
  coarsest: (triangles: number) => `Low, ${count(triangles)} triangles`,
  fileAlone: "The whole model (.pmesh)",

  ar: "In your room",
  arHint: "Shows the object at its real size in the picture of your camera:",
  arStart: "View in your room",
  arPlace: "Point the camera at the floor or a table. A tap sets the object down, another tap picks it up.",
  arNoUnit: "The unit of this object is unknown, so it cannot be shown at its real size in your room.",
  arFailed: "Augmented reality cannot be started on this device.",

  fullScreen: "Full screen",

  seenFrom: (side: keyof typeof sides, height: keyof typeof heights) => `Seen from ${sides[side]}${heights[height]}.`,
  firstShape: (triangles: number) => `The coarse shape is shown, ${count(triangles)} triangles.`,
  halfway: "Half of the detail is shown.",
  reached: (triangles: number) => `The requested detail is shown, ${count(triangles)} triangles.`,
});

export type ViewerTexts = ReturnType<typeof en>;
