// SPDX-License-Identifier: Apache-2.0
// Shows the model in the visitor's room: by WebXR, or in the system's own viewer. The viewer loads this code when it is first used.
export { RoomSession } from "./room-session.ts";

const kMetres: Readonly<Record<string, number>> = { mm: 0.001, cm: 0.01, m: 1, in: 0.0254 };

/** Returns the length of a unit in metres. Returns undefined if the unit is unknown; the model's real size is then unknown, too. */
export function metresPer(unit: string): number | undefined {
  return kMetres[unit];
}

/** A model for the viewers of the system: its API URL, its title, and the page to which they link. */
export interface Exhibit {
  api: string;
  title: string;
  page: string;
}

/** Maximum number of triangles in files for the system's viewers. Scene Viewer is made for files of at most 10 MB. */
const kTriangles = 100_000;

/** Returns the URL that opens Android's Scene Viewer, which downloads the model as GLB. Browsers without Scene Viewer open the page. */
export function sceneViewerUrl({ api, title, page }: Exhibit): string {
  const words = new URLSearchParams({ file: `${api}/export.glb?triangles=${kTriangles}`, mode: "ar_preferred", resizable: "false", title, link: page });
  return `intent://arvr.google.com/scene-viewer/1.2?${words}#Intent;scheme=https;package=com.google.android.googlequicksearchbox;` +
    `action=android.intent.action.VIEW;S.browser_fallback_url=${encodeURIComponent(page)};end;`;
}

/** Returns the URL that Quick Look of iOS shows if a link with rel="ar" leads to it. The fragment is for Quick Look. */
export function quickLookUrl({ api, page }: Exhibit): string {
  const words = new URLSearchParams({ allowsContentScaling: "0", canonicalWebPageURL: page });
  return `${api}/export.usdz?triangles=${kTriangles}#${words}`;
}
