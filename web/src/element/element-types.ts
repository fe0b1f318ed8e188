// SPDX-License-Identifier: Apache-2.0
// The element's attributes and events, for TypeScript programs, JSX and Vue templates.

/** The attributes of <progressive-mesh>. Booleans are true or absent. README.md explains them. */
export interface ProgressiveMeshAttributes {
  src?: string | undefined;
  alt?: string | undefined;
  poster?: string | undefined;
  loading?: "eager" | "lazy" | undefined;
  reveal?: "auto" | "manual" | undefined;
  "camera-controls"?: boolean | undefined;
  "camera-orbit"?: string | undefined;
  "camera-target"?: string | undefined;
  "field-of-view"?: string | undefined;
  ar?: boolean | undefined;
  "auto-rotate"?: boolean | undefined;
  "touch-action"?: "pan-x" | "pan-y" | "none" | undefined;
  "pixel-error"?: number | string | undefined;
  "max-triangles"?: number | string | undefined;
  "max-bytes"?: number | string | undefined;
  "target-error"?: number | string | undefined;
  "max-texture"?: number | string | undefined;
  "tone-mapping"?: string | undefined;
  exposure?: number | string | undefined;
  "shadow-intensity"?: number | string | undefined;
  transport?: "auto" | "http" | "ws" | undefined;
  annotations?: string | undefined;
  "idle-reset"?: number | string | undefined;
  lang?: string | undefined;
}

/** The events of <progressive-mesh>, for addEventListener. README.md says when each one is fired. */
export interface ProgressiveMeshElementEventMap {
  "first-paint": CustomEvent<null>;
  /** Bytes of the current and of the requested state. */
  progress: CustomEvent<{ bytes: number; total: number }>;
  refine: CustomEvent<{ triangles: number; vertices: number; bytes: number }>;
  /** Side of the picture in pixels, and texels and bytes of all pictures. */
  picture: CustomEvent<{ side: number; texels: number; bytes: number }>;
  load: CustomEvent<null>;
  error: CustomEvent<{ message: string }>;
  "tour-step": CustomEvent<{ step: number; steps: number }>;
  "camera-change": CustomEvent<{ source: "user-interaction" | "none" }>;
}
