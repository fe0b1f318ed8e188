// SPDX-License-Identifier: Apache-2.0
import { presentationOf } from "@core/presentation.ts";

test("a presentation is read", () => {
  const presentation = { rotation: [0, 0, 0, 1], scale: 2, view: null, poster: null, light: null };
  expect(presentationOf(JSON.stringify(presentation))).toEqual(presentation);
});

test.each([undefined, "", "null", "{", "7", "[]", '{"scale":2}', '{"rotation":[0,0,0,"1"],"scale":2}', '{"rotation":[0,0,0,1],"scale":0}'])(
  "'%s' is none", (text) => expect(presentationOf(text)).toBeUndefined());
