// SPDX-License-Identifier: Apache-2.0
// Computes the environment map of the room in a worker, and sends it to the page.
import { environmentMap } from "./environment-map.ts";
import { radiance } from "./radiance.ts";

const map = environmentMap(radiance);
self.postMessage(map, { transfer: [map.buffer] });
