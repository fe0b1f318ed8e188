// SPDX-License-Identifier: Apache-2.0
// The viewer's visible and spoken texts in French.
import type { ViewerTexts } from "./en.ts";
import type { Formats } from "./formats.ts";

const units = "unités";

const sides = {
  front: "de face", "front-right": "de trois quarts avant droit", right: "de droite", "back-right": "de trois quarts arrière droit",
  back: "de dos", "back-left": "de trois quarts arrière gauche", left: "de gauche", "front-left": "de trois quarts avant gauche",
};
const heights = { above: ", d’en haut", level: "", below: ", d’en bas" };

export const fr = ({ count, size, length, extent, bound }: Formats): ViewerTexts => ({
  loading: "Chargement",
  viewOf: (title) => title || "Modèle en trois dimensions",
  keys: "Les flèches tournent, plus et moins zooment, Origine rétablit la vue.",
  noWebGl: "Ce navigateur ne peut pas afficher de contenu en trois dimensions (WebGL 2 manque).",

  quality: "Détail",
  lowest: "Faible",
  refine: "Plus",
  highest: "Complet",
  size,
  more: (bytes) => `+${size(bytes)}`,
  complete: "complet",
  atOnce: "tout de suite",
  wait: (seconds) => (seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.round(seconds / 60)} min`),
  triangles: (shown, total) => `${count(shown)} triangles sur ${count(total)}`,
  bytes: (held, total) => `${size(held)} sur ${size(total)}`,
  error: (most, unit) => `erreur ≤ ${bound(most, unit || units)}`,

  tools: "Outils",
  close: "Fermer",
  reset: "Rétablir la vue",

  light: "Lumière",
  museum: "Musée",
  studio: "Studio",
  raking: "Rasante",
  relief: "Relief",
  shadow: "Ombre",
  rakingFrom: "Direction de la lumière rasante",
  degrees: (value) => `${count(value)} degrés`,

  section: "Coupe",
  sectionOn: "Couper le modèle",
  sectionAcross: "Direction de la coupe",
  axes: { x: "Côté", y: "Hauteur", z: "Profondeur" },
  sectionAt: "Position de la coupe",
  sectionFlip: "Autre moitié",
  percent: (fraction) => `${count(100 * fraction)} %`,

  measure: "Mesurer",
  measureFirst: "Cliquez un point de la surface, ou appuyez sur Entrée pour prendre celui du milieu de l’image.",
  measureNext: "Maintenant le point suivant.",
  measured: (distance, unit) => length(distance, unit || units),
  measureWhat: "Que mesurer",
  measures: { distance: "Distance", angle: "Angle", area: "Aire", profile: "Profil" },
  dimensions: "Largeur × hauteur × profondeur",
  extent: (x, y, z, unit) => extent([x, y, z], unit || units),
  measureClear: "Effacer",

  notes: "Notes",
  noteMarker: (number, title) => `Note ${number} : ${title}`,
  notesMissing: "Les notes ne peuvent pas être chargées.",
  tour: {
    start: (title) => `Lancer la visite : ${title}`,
    play: "Lire",
    pause: "Pause",
    next: "Étape suivante",
    previous: "Étape précédente",
    end: "Terminer la visite",
    stop: (number, all) => `${number} sur ${all}`,
  },

  surface: "Surface",
  form: "Forme seule",
  curvature: "Courbure",
  facets: "Facettes",
  wireframe: "Fil de fer",

  dragHint: "Glissez pour tourner",

  save: "Partager",
  screenshot: "Enregistrer une image",
  link: "Lien vers cette vue",
  share: "Partager…",
  copy: "Copier",
  copied: "Le lien est copié.",
  copyByHand: "Le lien est sélectionné : copiez-le au clavier.",
  qr: "Code QR",
  qrOf: "Code QR du lien",
  qrMissing: "Le code QR ne peut pas être dessiné.",
  download: "Télécharger le modèle",
  format: "Format",
  asShown: (triangles) => `Comme affiché, ${count(triangles)} triangles`,
  original: (triangles) => `Complet, ${count(triangles)} triangles`,
  coarsest: (triangles) => `Faible, ${count(triangles)} triangles`,
  fileAlone: "Le modèle entier (.pmesh)",

  ar: "Chez vous",
  arHint: "Montre l’objet à sa taille réelle dans l’image de votre caméra :",
  arStart: "Voir chez vous",
  arPlace: "Dirigez la caméra vers le sol ou une table. Touchez l’écran pour poser l’objet, puis encore une fois pour le reprendre.",
  arNoUnit: "L’unité de cet objet est inconnue : il ne peut pas être montré chez vous à sa taille réelle.",
  arFailed: "La réalité augmentée ne peut pas être lancée sur cet appareil.",

  fullScreen: "Plein écran",

  seenFrom: (side, height) => `Vu ${sides[side]}${heights[height]}.`,
  firstShape: (triangles) => `La première forme est affichée, ${count(triangles)} triangles.`,
  halfway: "La moitié des détails est affichée.",
  reached: (triangles) => `Le détail demandé est affiché, ${count(triangles)} triangles.`,
});
