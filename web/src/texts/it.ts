// SPDX-License-Identifier: Apache-2.0
// The viewer's visible and spoken texts in Italian.
import type { ViewerTexts } from "./en.ts";
import type { Formats } from "./formats.ts";

const units = "unità";

const sides = {
  front: "di fronte", "front-right": "da davanti a destra", right: "da destra", "back-right": "da dietro a destra",
  back: "da dietro", "back-left": "da dietro a sinistra", left: "da sinistra", "front-left": "da davanti a sinistra",
};
const heights = { above: ", dall’alto", level: "", below: ", dal basso" };

export const it = ({ count, size, length, extent, bound }: Formats): ViewerTexts => ({
  loading: "Caricamento",
  viewOf: (title) => title || "Modello tridimensionale",
  keys: "Le frecce ruotano, più e meno ingrandiscono e riducono, Home ripristina la vista.",
  noWebGl: "Questo browser non può mostrare contenuti tridimensionali (manca WebGL 2).",

  quality: "Dettaglio",
  lowest: "Basso",
  refine: "Più",
  highest: "Pieno",
  size,
  more: (bytes) => `+${size(bytes)}`,
  complete: "completo",
  atOnce: "subito",
  wait: (seconds) => (seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.round(seconds / 60)} min`),
  triangles: (shown, total) => `${count(shown)} di ${count(total)} triangoli`,
  bytes: (held, total) => `${size(held)} di ${size(total)}`,
  error: (most, unit) => `errore ≤ ${bound(most, unit || units)}`,

  tools: "Strumenti",
  close: "Chiudi",
  reset: "Ripristina la vista",

  light: "Luce",
  museum: "Museo",
  studio: "Studio",
  raking: "Radente",
  relief: "Rilievo",
  shadow: "Ombra",
  rakingFrom: "Direzione della luce radente",
  degrees: (value) => `${count(value)} gradi`,

  section: "Sezione",
  sectionOn: "Taglia il modello",
  sectionAcross: "Direzione del taglio",
  axes: { x: "Lato", y: "Altezza", z: "Profondità" },
  sectionAt: "Posizione del taglio",
  sectionFlip: "Altra metà",
  percent: (fraction) => `${count(100 * fraction)} %`,

  measure: "Misura",
  measureFirst: "Fai clic su un punto della superficie, o premi Invio per prendere quello al centro dell’immagine.",
  measureNext: "Ora il punto successivo.",
  measured: (distance, unit) => length(distance, unit || units),
  measureWhat: "Che cosa misurare",
  measures: { distance: "Distanza", angle: "Angolo", area: "Area", profile: "Profilo" },
  dimensions: "Larghezza × altezza × profondità",
  extent: (x, y, z, unit) => extent([x, y, z], unit || units),
  measureClear: "Cancella",

  notes: "Note",
  noteMarker: (number, title) => `Nota ${number}: ${title}`,
  notesMissing: "Le note non possono essere caricate.",
  tour: {
    start: (title) => `Avvia la visita: ${title}`,
    play: "Riproduci",
    pause: "Pausa",
    next: "Tappa successiva",
    previous: "Tappa precedente",
    end: "Termina la visita",
    stop: (number, all) => `${number} di ${all}`,
  },

  surface: "Superficie",
  form: "Solo la forma",
  curvature: "Curvatura",
  facets: "Faccette",
  wireframe: "Reticolo",

  dragHint: "Trascina per ruotare",

  save: "Condividi",
  screenshot: "Salva un’immagine",
  link: "Link a questa vista",
  share: "Condividi…",
  copy: "Copia",
  copied: "Link copiato.",
  copyByHand: "Il link è selezionato: copialo con la tastiera.",
  qr: "Codice QR",
  qrOf: "Codice QR del link",
  qrMissing: "Non è possibile disegnare il codice QR.",
  download: "Scarica il modello",
  format: "Formato",
  asShown: (triangles) => `Come mostrato, ${count(triangles)} triangoli`,
  original: (triangles) => `Pieno, ${count(triangles)} triangoli`,
  coarsest: (triangles) => `Basso, ${count(triangles)} triangoli`,
  fileAlone: "Il modello intero (.pmesh)",

  ar: "Nella tua stanza",
  arHint: "Mostra l’oggetto a grandezza naturale nell’immagine della fotocamera:",
  arStart: "Guarda nella tua stanza",
  arPlace: "Punta la fotocamera verso il pavimento o un tavolo. Un tocco posa l’oggetto, un altro lo riprende.",
  arNoUnit: "L’unità di misura di questo oggetto è sconosciuta, quindi non può essere mostrato a grandezza naturale nella tua stanza.",
  arFailed: "Non è possibile avviare la realtà aumentata su questo dispositivo.",

  fullScreen: "Schermo intero",

  seenFrom: (side, height) => `Visto ${sides[side]}${heights[height]}.`,
  firstShape: (triangles) => `È mostrata la prima forma, ${count(triangles)} triangoli.`,
  halfway: "È mostrata la metà dei dettagli.",
  reached: (triangles) => `È mostrato il dettaglio richiesto, ${count(triangles)} triangoli.`,
});
