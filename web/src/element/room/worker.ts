// SPDX-License-Identifier: Apache-2.0
// Computes the environment map of the room in a worker, and sends it to the page. The worker's name says which of
// the two maps to compute.
import { environmentMap, plainMap } from "./environment-map.ts";
import { radiance } from "./radiance.ts";

const map = self.name === "plain" ? plainMap(radiance) : environmentMap(radiance);
self.postMessage(map, { transfer: [map.buffer] });
