// SPDX-License-Identifier: Apache-2.0
export { ProgressiveMesh, type ProgressiveMeshEventMap } from "./progressive-mesh.ts";
export { ProgressiveMeshLoader } from "./progressive-mesh-loader.ts";
export { setBudget } from "../core/client.ts";
export type { ModelSize } from "../core/budget.ts";
export type { Assets } from "../core/assets.ts";
export { ModelError, type CameraView, type Chunk, type Level, type ModelInfo, type Progress, type Surface, type Want } from "../core/types.ts";
