// SPDX-License-Identifier: Apache-2.0
// The viewer's visible and spoken texts in Spanish.
import type { ViewerTexts } from "./en.ts";
import type { Formats } from "./formats.ts";

const units = "unidades";

const sides = {
  front: "de frente", "front-right": "desde delante a la derecha", right: "desde la derecha", "back-right": "desde detrás a la derecha",
  back: "desde detrás", "back-left": "desde detrás a la izquierda", left: "desde la izquierda", "front-left": "desde delante a la izquierda",
};
const heights = { above: ", desde arriba", level: "", below: ", desde abajo" };

export const es = ({ count, size, length, extent, bound }: Formats): ViewerTexts => ({
  loading: "Cargando",
  viewOf: (title) => title || "Modelo tridimensional",
  keys: "Las flechas giran, más y menos acercan y alejan, Inicio restablece la vista.",
  noWebGl: "Este navegador no puede mostrar contenido tridimensional (falta WebGL 2).",

  quality: "Detalle",
  lowest: "Bajo",
  refine: "Más",
  highest: "Completo",
  size,
  more: (bytes) => `+${size(bytes)}`,
  complete: "completo",
  atOnce: "al instante",
  wait: (seconds) => (seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.round(seconds / 60)} min`),
  triangles: (shown, total) => `${count(shown)} de ${count(total)} triángulos`,
  bytes: (held, total) => `${size(held)} de ${size(total)}`,
  error: (most, unit) => `error ≤ ${bound(most, unit || units)}`,

  tools: "Herramientas",
  close: "Cerrar",
  reset: "Restablecer la vista",

  light: "Luz",
  museum: "Museo",
  studio: "Estudio",
  raking: "Rasante",
  relief: "Relieve",
  shadow: "Sombra",
  rakingFrom: "Dirección de la luz rasante",
  degrees: (value) => `${count(value)} grados`,

  section: "Sección",
  sectionOn: "Cortar el modelo",
  sectionAcross: "Dirección del corte",
  axes: { x: "Lado", y: "Altura", z: "Profundidad" },
  sectionAt: "Posición del corte",
  sectionFlip: "Otra mitad",
  percent: (fraction) => `${count(100 * fraction)} %`,

  measure: "Medir",
  measureFirst: "Haga clic en un punto de la superficie, o pulse Intro para tomar el del centro de la imagen.",
  measureNext: "Ahora el punto siguiente.",
  measured: (distance, unit) => length(distance, unit || units),
  measureWhat: "Qué medir",
  measures: { distance: "Distancia", angle: "Ángulo", area: "Área", profile: "Perfil" },
  dimensions: "Anchura × altura × profundidad",
  extent: (x, y, z, unit) => extent([x, y, z], unit || units),
  measureClear: "Borrar",

  notes: "Notas",
  noteMarker: (number, title) => `Nota ${number}: ${title}`,
  notesMissing: "No se pueden cargar las notas.",
  tour: {
    start: (title) => `Iniciar el recorrido: ${title}`,
    play: "Reproducir",
    pause: "Pausa",
    next: "Parada siguiente",
    previous: "Parada anterior",
    end: "Terminar el recorrido",
    stop: (number, all) => `${number} de ${all}`,
  },

  surface: "Superficie",
  form: "Solo la forma",
  curvature: "Curvatura",
  facets: "Facetas",
  wireframe: "Malla de alambre",

  dragHint: "Arrastre para girar",

  save: "Compartir",
  screenshot: "Guardar una imagen",
  link: "Enlace a esta vista",
  share: "Compartir…",
  copy: "Copiar",
  copied: "Enlace copiado.",
  copyByHand: "El enlace está seleccionado: cópielo con el teclado.",
  qr: "Código QR",
  qrOf: "Código QR del enlace",
  qrMissing: "No se puede dibujar el código QR.",
  download: "Descargar el modelo",
  format: "Formato",
  asShown: (triangles) => `Como se muestra, ${count(triangles)} triángulos`,
  original: (triangles) => `Completo, ${count(triangles)} triángulos`,
  coarsest: (triangles) => `Bajo, ${count(triangles)} triángulos`,
  fileAlone: "El modelo entero (.pmesh)",

  ar: "En su espacio",
  arHint: "Muestra el objeto a su tamaño real en la imagen de su cámara:",
  arStart: "Ver en su espacio",
  arPlace: "Apunte la cámara al suelo o a una mesa. Un toque deja el objeto y otro toque lo recoge.",
  arNoUnit: "Se desconoce la unidad de este objeto, por lo que no se puede mostrar a su tamaño real en su espacio.",
  arFailed: "No se puede iniciar la realidad aumentada en este dispositivo.",

  fullScreen: "Pantalla completa",

  seenFrom: (side, height) => `Visto ${sides[side]}${heights[height]}.`,
  firstShape: (triangles) => `Se muestra la primera forma, ${count(triangles)} triángulos.`,
  halfway: "Se muestra la mitad del detalle.",
  reached: (triangles) => `Se muestra el detalle pedido, ${count(triangles)} triángulos.`,
});
