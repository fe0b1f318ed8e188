// SPDX-License-Identifier: Apache-2.0
// The viewer's visible and spoken texts in German.
import type { ViewerTexts } from "./en.ts";
import type { Formats } from "./formats.ts";

const units = "Einheiten";

const sides = {
  front: "vorne", "front-right": "vorne rechts", right: "rechts", "back-right": "hinten rechts",
  back: "hinten", "back-left": "hinten links", left: "links", "front-left": "vorne links",
};
const heights = { above: " oben", level: "", below: " unten" };

export const de = ({ count, size, length, extent, bound }: Formats): ViewerTexts => ({
  loading: "Wird geladen",
  viewOf: (title) => title || "Dreidimensionales Modell",
  keys: "Pfeiltasten drehen, Plus und Minus zoomen, Pos1 stellt die Ansicht zurück.",
  noWebGl: "Dieser Browser kann keine dreidimensionalen Inhalte zeigen (WebGL 2 fehlt).",

  quality: "Detail",
  lowest: "Wenig",
  refine: "Mehr",
  highest: "Voll",
  size,
  more: (bytes) => `+${size(bytes)}`,
  complete: "vollständig",
  atOnce: "sofort",
  wait: (seconds) => (seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.round(seconds / 60)} min`),
  triangles: (shown, total) => `${count(shown)} von ${count(total)} Dreiecken`,
  bytes: (held, total) => `${size(held)} von ${size(total)}`,
  error: (most, unit) => `Fehler ≤ ${bound(most, unit || units)}`,

  tools: "Werkzeuge",
  close: "Schließen",
  reset: "Ansicht zurückstellen",

  light: "Licht",
  museum: "Museum",
  studio: "Atelier",
  raking: "Streiflicht",
  relief: "Relief",
  shadow: "Schatten",
  rakingFrom: "Richtung des Streiflichts",
  degrees: (value) => `${count(value)} Grad`,

  section: "Schnitt",
  sectionOn: "Modell schneiden",
  sectionAcross: "Richtung des Schnitts",
  axes: { x: "Seite", y: "Höhe", z: "Tiefe" },
  sectionAt: "Lage des Schnitts",
  sectionFlip: "Andere Hälfte",
  percent: (fraction) => `${count(100 * fraction)} %`,

  measure: "Messen",
  measureFirst: "Klicken Sie einen Punkt der Oberfläche an, oder nehmen Sie mit der Eingabetaste den in der Bildmitte.",
  measureNext: "Nun den nächsten Punkt.",
  measured: (distance, unit) => length(distance, unit || units),
  measureWhat: "Was gemessen wird",
  measures: { distance: "Abstand", angle: "Winkel", area: "Fläche", profile: "Profil" },
  dimensions: "Breite × Höhe × Tiefe",
  extent: (x, y, z, unit) => extent([x, y, z], unit || units),
  measureClear: "Löschen",

  notes: "Notizen",
  noteMarker: (number, title) => `Notiz ${number}: ${title}`,
  notesMissing: "Die Notizen sind nicht lesbar.",
  tour: {
    start: (title) => `Rundgang abspielen: ${title}`,
    play: "Abspielen",
    pause: "Pause",
    next: "Nächste Station",
    previous: "Vorige Station",
    end: "Rundgang beenden",
    stop: (number, all) => `${number} von ${all}`,
  },

  surface: "Fläche",
  form: "Nur die Form",
  curvature: "Krümmung",
  facets: "Facetten",
  wireframe: "Drahtgitter",

  dragHint: "Ziehen, um zu drehen",

  save: "Teilen",
  screenshot: "Bild speichern",
  link: "Link zu dieser Ansicht",
  share: "Teilen …",
  copy: "Kopieren",
  copied: "Der Link ist kopiert.",
  copyByHand: "Der Link ist markiert: kopieren Sie ihn mit der Tastatur.",
  qr: "QR-Code",
  qrOf: "QR-Code des Links",
  qrMissing: "Der QR-Code kann nicht gezeichnet werden.",
  download: "Modell herunterladen",
  format: "Format",
  asShown: (triangles) => `Wie gezeigt, ${count(triangles)} Dreiecke`,
  original: (triangles) => `Voll, ${count(triangles)} Dreiecke`,
  coarsest: (triangles) => `Wenig, ${count(triangles)} Dreiecke`,
  fileAlone: "Das ganze Modell (.pmesh)",

  ar: "In Ihrem Raum",
  arHint: "Zeigt das Objekt in wahrer Größe im Bild Ihrer Kamera:",
  arStart: "Im Raum ansehen",
  arPlace: "Richten Sie die Kamera auf den Boden oder einen Tisch. Ein Tippen stellt das Objekt ab, ein weiteres nimmt es wieder auf.",
  arNoUnit: "Die Einheit dieses Objekts ist unbekannt. Daher kann es in Ihrem Raum nicht in wahrer Größe gezeigt werden.",
  arFailed: "Auf diesem Gerät lässt sich die erweiterte Realität nicht starten.",

  fullScreen: "Vollbild",

  seenFrom: (side, height) => `Gesehen von ${sides[side]}${heights[height]}.`,
  firstShape: (triangles) => `Die erste Form ist zu sehen, ${count(triangles)} Dreiecke.`,
  halfway: "Die Hälfte der Einzelheiten ist zu sehen.",
  reached: (triangles) => `Die gewünschte Detailstufe ist zu sehen, ${count(triangles)} Dreiecke.`,
});
