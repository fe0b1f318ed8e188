// SPDX-License-Identifier: Apache-2.0
import { DirectionalLight, HemisphereLight, Object3D, Scene, Texture, type Camera } from "three";
import { Lights, type Lighting } from "@element/lights.ts";
import { kLightings } from "@element/tools/light.ts";

const still = { matches: false };

beforeEach(() => {
  still.matches = false;
  vi.stubGlobal("matchMedia", () => still);
});
afterEach(() => vi.unstubAllGlobals());

function lit() {
  const scene = new Scene(), camera = new Object3D(), lights = new Lights(scene, camera as Camera);
  const lamp = camera.children.find((light) => light instanceof DirectionalLight) as DirectionalLight;
  const sky = scene.children.find((light) => light instanceof HemisphereLight) as HemisphereLight;
  const now = () => [lamp.intensity, sky.intensity, scene.environment ? scene.environmentIntensity : 0];
  return { lights, lamp, scene, now };
}

describe("Lights", () => {
  test("show the relief until there is a room", () => {
    const { lights, now } = lit();
    expect(now()).toEqual([2.2, 1.1, 0]);
    expect(lights.advance(1000)).toBe(false);
    expect(now()).toEqual([2.2, 1.1, 0]);
  });

  test("change to the room gradually", () => {
    const { lights, now } = lit();
    lights.enter(new Texture(), 1000);
    const seen = [1000, 1100, 1200, 1300].map((time) => (expect(lights.advance(time)).toBe(true), now()));
    for (const i of [1, 2, 3]) {
      expect(seen[i]?.[0]).toBeLessThan(seen[i - 1]?.[0] as number);
      expect(seen[i]?.[2]).toBeGreaterThan(seen[i - 1]?.[2] as number);
    }
    expect(lights.advance(1400)).toBe(false);
    expect(now()).toEqual([0, 0, 1]);
  });

  test("change at once if the visitor wants no motion", () => {
    const { lights, now } = lit();
    still.matches = true;
    lights.enter(new Texture(), 1000);
    expect(lights.advance(1001)).toBe(false);
    expect(now()).toEqual([0, 0, 1]);
  });

  test("show the relief of the form alone, and the room again", () => {
    const { lights, now } = lit();
    lights.enter(new Texture(), 0);
    lights.advance(1000);
    lights.isRelief = true;
    expect(now()).toEqual([2.2, 1.1, 0]);
    lights.isRelief = false;
    expect(now()).toEqual([0, 0, 1]);
  });

  test("let raking light outshine the room", () => {
    const { lights, lamp, now } = lit(), raking: Lighting = kLightings.raking;
    lights.enter(new Texture(), 0);
    lights.advance(1000);
    lights.lighting = raking;
    expect(now()).toEqual([raking.inRoom.lamp, raking.inRoom.sky, raking.inRoom.room]);
    expect(lamp.intensity).toBeGreaterThan(10 * (now()[2] as number));
    expect(lamp.position.toArray()).toEqual(raking.from);
    lights.lighting = undefined;
    expect(now()).toEqual([0, 0, 1]);
  });

  test("show the relief of a textured model if the visitor chooses it", () => {
    const { lights, now } = lit();
    lights.enter(new Texture(), 0);
    lights.advance(1000);
    lights.lighting = kLightings.relief;
    expect(now()).toEqual([2.2, 1.1, 0]);
    lights.lighting = kLightings.studio;
    expect(now()).toEqual([0, 0, 1]);
  });
});
