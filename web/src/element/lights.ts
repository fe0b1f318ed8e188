// SPDX-License-Identifier: Apache-2.0
// The lights of a scene. A lamp that follows the camera and a sky show the relief of a surface. A
// textured model is lit by a room instead, as in model-viewer, because metal and gloss show only
// what they reflect. The room is added after the first picture, and the light then changes
// gradually.
import { Color, DirectionalLight, HemisphereLight, type Camera, type Scene, type Texture } from "three";

/** Intensities of the lights. `room` is a factor of the room's own light. */
export interface Intensities {
  lamp: number;
  sky: number;
  room: number;
}

export interface Lighting {
  /** Direction from the object to the lamp, as components to the right, upwards and towards the visitor. */
  from: [number, number, number];
  /** Intensities if there is no room. */
  relief: Omit<Intensities, "room">;
  /** Intensities if the room lights the scene. */
  inRoom: Intensities;
}

const kMuseum: Lighting = { from: [-0.6, 0.9, 0.6], relief: { lamp: 2.2, sky: 1.1 }, inRoom: { lamp: 0, sky: 0, room: 1 } };

/** Duration of the change from lamp and sky to the room, in milliseconds. */
const kFade = 400;

export class Lights {
  readonly #lamp = new DirectionalLight(0xfffaf2);
  readonly #sky = new HemisphereLight(new Color(0xffffff), new Color(0x8a8178));
  #lighting = kMuseum;
  #share = 0; // share of the room in the light, from 0 to 1
  #arrived: number | undefined; // time when the room was added, in milliseconds
  #isRelief = false;

  constructor(private readonly scene: Scene, camera: Camera) {
    camera.add(this.#lamp, this.#lamp.target);
    scene.add(this.#sky);
    this.lighting = undefined;
  }

  /** The lighting of the scene. Undefined selects the lighting of a new scene. */
  set lighting(lighting: Lighting | undefined) {
    this.#lighting = lighting ?? kMuseum;
    this.#lamp.position.set(...this.#lighting.from);
    this.#mix();
  }

  /** Whether lamp and sky alone light the scene, even if there is a room. */
  set isRelief(on: boolean) {
    this.#isRelief = on;
    this.#mix();
  }

  /** Adds the room. `now` is the current time in milliseconds. */
  enter(room: Texture, now: number): void {
    this.scene.environment = room;
    this.#arrived = now;
    this.#mix();
  }

  /** Sets all intensities for the time `now`, in milliseconds. Returns whether they are still changing. */
  advance(now: number): boolean {
    if (this.#arrived === undefined) return false;
    this.#share = matchMedia("(prefers-reduced-motion: reduce)").matches ? 1 : Math.min((now - this.#arrived) / kFade, 1);
    if (this.#share === 1) this.#arrived = undefined;
    this.#mix();
    return this.#share < 1;
  }

  dispose(): void {
    this.scene.environment?.dispose();
  }

  #mix(): void {
    const { relief, inRoom } = this.#lighting, room = this.#isRelief ? 0 : this.#share;
    this.#lamp.intensity = relief.lamp + room * (inRoom.lamp - relief.lamp);
    this.#sky.intensity = relief.sky + room * (inRoom.sky - relief.sky);
    this.scene.environmentIntensity = room * inRoom.room;
  }
}
