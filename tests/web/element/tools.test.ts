// SPDX-License-Identifier: Apache-2.0
import { Box3, PerspectiveCamera, Vector3 } from "three";
import { passesHalf } from "@element/tools/announcer.ts";
import { readAnnotations, triple } from "@element/notes/annotations.ts";
import { rakingFrom } from "@element/tools/light.ts";
import { apiOf, exportOf, linkTo, settingIn } from "@element/tools/links.ts";
import { unpackDepth } from "@element/tools/pick.ts";
import { pixelsPerUnit, roundLength } from "@element/tools/scale-bar.ts";
import { cuttingPlane } from "@element/tools/section.ts";
import { directionOf } from "@element/viewpoint.ts";
import { anglesOf, formatView, heightOf, offsetOf, parseView, sideOf } from "@element/tools/view.ts";

describe("views", () => {
  test.each([
    [{ x: 0, y: 0, z: 2 }, 0, 0], [{ x: 2, y: 0, z: 0 }, 90, 0], [{ x: 0, y: 0, z: -2 }, 180, 0], [{ x: -1, y: Math.SQRT2, z: 1 }, -45, 45],
  ])("from %o are %s degrees round and %s up", (offset, azimuth, elevation) => {
    const angles = anglesOf(offset);
    expect(angles.azimuth).toBeCloseTo(azimuth);
    expect(angles.elevation).toBeCloseTo(elevation);
    const back = offsetOf(angles);
    for (const axis of ["x", "y", "z"] as const) expect(back[axis]).toBeCloseTo(offset[axis]);
  });

  test.each([[0, "front"], [22, "front"], [23, "front-right"], [90, "right"], [-45, "front-left"], [180, "back"], [-180, "back"], [700, "front"]])(
    "%s degrees are the %s", (azimuth, side) => expect(sideOf(azimuth)).toBe(side));

  test.each([[-60, "below"], [0, "level"], [25, "level"], [26, "above"]])("%s degrees up are %s", (elevation, height) =>
    expect(heightOf(elevation)).toBe(height));

  test("come back from their text", () => {
    const view = { azimuth: -12.3, elevation: 40, distance: 0.12345, target: [1.5, -2, 0] as [number, number, number] };
    expect(parseView(formatView(view))).toEqual(view);
  });

  test.each(["", "1,2,3", "1,2,0,0,0,0", "1,2,-3,0,0,0", "0,91,1,0,0,0", "a,b,c,d,e,f", "1,2,3,4,5,6,7"])(
    "are not read out of '%s'", (text) => expect(parseView(text)).toBeUndefined());
});

test.each([[0, 0, [0, 0, 1]], [90, 0, [1, 0, 0]], [0, 90, [0, 1, 0]], [-90, 0, [-1, 0, 0]]])(
  "azimuth %s and elevation %s look from %o", (azimuth, elevation, direction) => {
    directionOf({ azimuth, elevation }).toArray().forEach((part, axis) => expect(part).toBeCloseTo(direction[axis] as number));
  });

describe("links", () => {
  const view = { azimuth: 30, elevation: -10, distance: 2, target: [0, 1, 0] as [number, number, number] };

  test("hold settings and leave alone what else the address says", () => {
    const link = linkTo("https://museum.example/models/ab?transport=ws#page=3&view=1,2,3,4,5,6&light=soft", "",
      { view: formatView(view), light: "", section: "x,100,flip" });
    expect(link).toBe("https://museum.example/models/ab?transport=ws#page=3&view=30.0,-10.0,2,0,1,0&section=x,100,flip");
    expect(parseView(settingIn(new URL(link).hash, "", "view"))).toEqual(view);
    expect(settingIn(new URL(link).hash, "bust", "view")).toBe("");
  });

  test("tell the elements of a page apart by their ids", () => {
    const link = linkTo(linkTo("https://museum.example/", "bust", { light: "soft" }), "vase", { light: "front" });
    expect(settingIn(new URL(link).hash, "bust", "light")).toBe("soft");
    expect(settingIn(new URL(link).hash, "vase", "light")).toBe("front");
  });

  test.each([
    ["https://museum.example/models/ab", "https://museum.example/api/v1/models/ab"],
    ["https://museum.example/3d/api/v1/models/ab/", "https://museum.example/3d/api/v1/models/ab"],
    ["https://museum.example/models/bust.pmesh", undefined],
  ])("of %s lead to %s", (src, api) => expect(apiOf(src)).toBe(api));

  test("to exports name the level", () => {
    expect(exportOf("/api/v1/models/ab", "glb", { level: "highest" })).toBe("/api/v1/models/ab/export.glb?level=highest");
    expect(exportOf("/api/v1/models/ab", "ply", { triangles: 5000 })).toBe("/api/v1/models/ab/export.ply?triangles=5000");
  });
});

describe("annotations", () => {
  test("are read from a list or from an object with one", () => {
    const note = { position: [1, 2, 3], normal: "0 0 1", title: "Nose", text: "Restored." };
    const read = [{ position: [1, 2, 3], normal: [0, 0, 1], title: "Nose", text: "Restored." }];
    expect(readAnnotations([note])).toEqual(read);
    expect(readAnnotations({ annotations: [note] })).toEqual(read);
    expect(readAnnotations([{ position: [1, 2, 3], title: "Nose" }])[0]).toMatchObject({ normal: undefined, text: "" });
  });

  test.each([
    [{}, /no list/], [null, /no list/], [[null], /annotation 1 lacks/], [[{ position: [1, 2], title: "a" }], /annotation 1/],
    [[{ position: [1, 2, 3], title: "a" }, { position: [1, 2, 3] }], /annotation 2/],
  ])("%j is refused", (json, reason) => expect(() => readAnnotations(json)).toThrow(reason));

  test.each([["0.1m -2cm 3", [0.1, -2, 3]], ["1 2", undefined], ["a b c", undefined], [[1, 2, 3], [1, 2, 3]], [[1, 2, "3"], undefined], [undefined, undefined]])(
    "%j is the place %j", (text, place) => expect(triple(text)).toEqual(place));
});

test("raking light turns clockwise from above and hardly leaves the picture's plane", () => {
  const [right, up, front] = rakingFrom(90);
  expect(right).toBeCloseTo(1);
  expect(up).toBeCloseTo(0);
  expect(front).toBeLessThan(0.2);
  expect(rakingFrom(0)[1]).toBeCloseTo(1);
});

test("a cut keeps what is below it, or above where it is flipped", () => {
  const box = new Box3(new Vector3(-1, -2, -3), new Vector3(1, 2, 3));
  const low = new Vector3(0, -1, 0), high = new Vector3(0, 1, 0);
  expect(cuttingPlane(box, "y", 0.5, false).distanceToPoint(low)).toBeGreaterThan(0);
  expect(cuttingPlane(box, "y", 0.5, false).distanceToPoint(high)).toBeLessThan(0);
  expect(cuttingPlane(box, "y", 0.5, true).distanceToPoint(high)).toBeGreaterThan(0);
  expect(cuttingPlane(box, "y", 0.9, false).distanceToPoint(high)).toBeGreaterThan(0);
  expect(cuttingPlane(box, "y", 0.9, true).distanceToPoint(high)).toBeLessThan(0);
});

test("only the half on the way to the whole is worth a word", () => {
  expect(passesHalf(40, 60, 100)).toBe(true);
  expect(passesHalf(60, 70, 100)).toBe(false);
  expect(passesHalf(60, 40, 100)).toBe(false);
  expect(passesHalf(40, 100, 100)).toBe(false);
});

test.each([0.5, 0.25 + 1 / 65536, 0.9871234, 1 / 2 ** 24])("a depth of %s comes back from its bytes", (depth) => {
  const whole = Math.floor(depth * 2 ** 24), rest = Math.round(255 * (depth * 2 ** 24 - whole));
  expect(unpackDepth([whole >> 16, (whole >> 8) & 255, whole & 255, rest])).toBeCloseTo(depth, 8);
});

describe("a scale bar", () => {
  test.each([[0.0199, 0.01], [3, 2], [9.99, 5], [100, 100], [1999, 1000]])("of at most %s is %s long", (most, length) => expect(roundLength(most)).toBeCloseTo(length, 10));

  test("knows how large a length looks", () => {
    const camera = new PerspectiveCamera(90);
    camera.position.set(0, 0, 4); // a view of 90 degrees is 6 high at a distance of 3
    expect(pixelsPerUnit(camera, new Vector3(0, 0, 1), 600)).toBeCloseTo(100);
  });
});
