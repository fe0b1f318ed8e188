// SPDX-License-Identifier: Apache-2.0
import { AgXToneMapping, LinearToneMapping, NeutralToneMapping, NoToneMapping } from "three";
import { tonesOf } from "@element/tones.ts";

test.each([
  [null, null, true, NeutralToneMapping, 1],
  [null, null, false, NoToneMapping, 1],
  [null, "1.5", true, NeutralToneMapping, 1.5],
  [null, "1.5", false, LinearToneMapping, 1.5],
  ["agx", "0", false, AgXToneMapping, 0],
  ["none", null, true, NoToneMapping, 1],
  ["filmic", "-1", true, NeutralToneMapping, 1],
  ["", "bright", false, NoToneMapping, 1],
])("tone-mapping '%s' and exposure '%s' of a model with texture: %s", (mapping, exposure, isTextured, expected, factor) =>
  expect(tonesOf({ mapping, exposure }, isTextured)).toEqual({ mapping: expected, exposure: factor }));
