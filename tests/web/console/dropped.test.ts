// SPDX-License-Identifier: Apache-2.0
import { execFileSync } from "node:child_process";
import { droppedFiles, uploadsOf, type Dropped } from "@console/dropped.ts";
import { tarOf } from "@console/tar.ts";

const file = (path: string, text = path): Dropped => ({ path, file: new File([text], path.split("/").pop()!, { lastModified: 7 }) });
const names = (files: File[]): string[] => files.map(({ name }) => name);

/** Passes a tar to the program tar, as an independent reader. */
const tar = async (bytes: Blob, ...options: string[]): Promise<string> =>
  execFileSync("tar", ["--quoting-style=literal", ...options, "-f", "-"], { input: Buffer.from(await bytes.arrayBuffer()), encoding: "utf8" });

test("a tar has paths of any length and script, and files of any size", async () => {
  const paths = ["a.obj", `${"long/".repeat(60)}b.png`, "Büste/scène.mtl", "empty.bin", "x".repeat(512)];
  const files = paths.map((path, i) => ({ path, file: new Blob(["y".repeat([0, 511, 512, 513, 1][i]!)]) }));
  const packed = tarOf(files);
  expect(packed.size % 512).toBe(0);
  expect((await tar(packed, "-t")).trim().split("\n")).toEqual(paths);
  expect(await tar(packed, "-xO")).toBe("y".repeat(511 + 512 + 513 + 1));
});

test("a model and its files become one upload", async () => {
  const [only, ...rest] = uploadsOf([file("statue/textures/a.png", "picture"), file("statue/scene.gltf", "json"), file("statue/scene.bin", "buffer")]);
  expect(rest).toEqual([]);
  expect(only).toMatchObject({ name: "scene.tar", lastModified: 7 });
  expect((await tar(only!, "-t")).trim().split("\n")).toEqual(["statue/scene.gltf", "statue/scene.bin", "statue/textures/a.png"]);
  expect(await tar(only!, "-xO", "statue/scene.bin")).toBe("buffer");
});

test("the order of a drop does not matter", async () => {
  const files = [file("b.mtl"), file("a.obj"), file("c.png")];
  const [one] = uploadsOf(files), [other] = uploadsOf([...files].reverse());
  expect(await one!.text()).toBe(await other!.text());
});

test("several models without other files are uploads of their own", () => {
  expect(names(uploadsOf([file("a.ply"), file("B.STL"), file("c.zip"), file("d.pmesh")]))).toEqual(["B.STL", "a.ply", "c.zip", "d.pmesh"]);
});

test("each of several models gets the files beside it", () => {
  expect(names(uploadsOf([file("a.obj"), file("b.obj"), file("t.png"), file("c.zip"), file(".DS_Store")]))).toEqual(["a.tar", "b.tar", "c.zip"]);
});

test("files without a model stay as they are, so that the server can name them", () => {
  expect(names(uploadsOf([file("a.max"), file("b.png")]))).toEqual(["a.max", "b.png"]);
});

test("the files in a dropped folder are found", async () => {
  const leaf = (path: string) => ({ isDirectory: false, fullPath: path, file: (done: (found: File) => void) => done(new File([], path.split("/").pop()!)) });
  const folder = (path: string, entries: object[]) => ({
    isDirectory: true, fullPath: path, createReader: () => ({ readEntries: (done: (some: object[]) => void) => done(entries.splice(0, 1)) }),
  });
  const statue = folder("/statue", [leaf("/statue/a.gltf"), folder("/statue/maps", [leaf("/statue/maps/b.png")]), leaf("/statue/c.bin")]);
  const items = [{ webkitGetAsEntry: () => statue, getAsFile: () => null }, { webkitGetAsEntry: () => null, getAsFile: () => new File([], "d.ply") }];
  const found = await droppedFiles({ items } as unknown as DataTransfer);
  expect(found.map(({ path }) => path)).toEqual(["statue/a.gltf", "statue/maps/b.png", "statue/c.bin", "d.ply"]);
});
