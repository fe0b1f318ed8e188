// SPDX-License-Identifier: Apache-2.0
import { downloadOf, frame, snippet } from "@ui/about.ts";
import type { ModelRecord } from "@ui/api.ts";

const model = {
  id: "a", title: "Bust", links: { self: "/api/v1/models/a", page: "/models/a", file: "/api/v1/models/a/file.pmesh" },
} as ModelRecord;

test("a snippet names the page's own server and the model, which can be turned", () => {
  const text = snippet(model, "https://museum.example");
  expect(text.split("\n")).toEqual([
    '<script type="module" src="https://museum.example/progressive-mesh.js"></script>',
    '<progressive-mesh src="https://museum.example/api/v1/models/a" alt="Bust" camera-controls ar ' +
      'poster="https://museum.example/api/v1/models/a/poster.png?width=960" style="width: 100%; aspect-ratio: 4 / 3"></progressive-mesh>',
  ]);
});

test("what somebody has written into a title stays a title", () => {
  expect(snippet({ ...model, title: '"><script>&' }, "")).toContain('alt="&#34;&#62;&#60;script&#62;&#38;"');
});

test("a frame shows the object's page", () => expect(frame(model, "https://museum.example")).toBe(
  '<iframe src="https://museum.example/models/a" title="Bust" allow="fullscreen; web-share; xr-spatial-tracking" style="width: 100%; aspect-ratio: 4 / 3; border: 0"></iframe>'));

test.each([
  ["glb", "highest", "/api/v1/models/a/export.glb?level=highest"],
  ["ply", "20000", "/api/v1/models/a/export.ply?triangles=20000"],
  ["pmesh", "20000", "/api/v1/models/a/file.pmesh"],
] as const)("%s at %s is %s", (format, detail, url) => expect(downloadOf(model, format, detail)).toBe(url));
