// SPDX-License-Identifier: Apache-2.0
// A growing point cloud for three.js. Its points are in one buffer, which is replaced by one of
// twice the size when full.
import { BufferAttribute, BufferGeometry, Color, GLSL3, LinearSRGBColorSpace, Points, ShaderMaterial } from "three";

const kFirstRoom = 1 << 16; // number of points that the first buffer can hold
/** Share of the canvas that an object is assumed to cover. */
const kShare = 0.25;
const kFaintest = 0.15;

const kVertex = `
  uniform float size, cover, near, far;
  uniform int settled;
  uniform vec3 ink, accent;
  out vec4 tint;
  void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * seen;
    gl_PointSize = size;
    float depth = clamp((-seen.z - near) / (far - near), 0.0, 1.0);
    tint = gl_VertexID < settled ? vec4(ink, cover * mix(1.0, 0.1, depth)) : vec4(accent, cover);
  }`;
const kFragment = `
  in vec4 tint;
  out vec4 colour;
  void main() {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    colour = tint;
  }`;

/**
 * A point cloud. Distant points are fainter, and the newest points have the accent colour. The more
 * points there are, the more transparent each point is. Therefore, folds and rims, where many
 * points overlap, stay visible.
 */
export class Cloud extends Points<BufferGeometry, ShaderMaterial> {
  #count = 0;
  #positions = new BufferAttribute(new Float32Array(3 * kFirstRoom), 3);

  constructor() {
    const uniform = <T>(value: T) => ({ value });
    super(new BufferGeometry(), new ShaderMaterial({
      glslVersion: GLSL3, vertexShader: kVertex, fragmentShader: kFragment,
      transparent: true, depthTest: false,
      uniforms: {
        size: uniform(1), cover: uniform(1), near: uniform(0), far: uniform(1), settled: uniform(0),
        ink: uniform(new Color()), accent: uniform(new Color()),
      },
    }));
    // Disables culling. three.js would cull by the bounds of the first points, but the cloud grows.
    this.frustumCulled = false;
    this.rotation.x = -Math.PI / 2; // Measured points have z upwards, but three.js has y upwards.
    this.geometry.setAttribute("position", this.#positions);
  }

  append(points: Float32Array): void {
    const room = this.#positions.array.length, need = 3 * this.#count + points.length;
    if (need > room) this.#grow(Math.max(2 * room, need));
    this.#positions.array.set(points, 3 * this.#count);
    this.#positions.addUpdateRange(3 * this.#count, points.length);
    this.#positions.needsUpdate = true;
    this.#set("settled", this.#count);
    this.#count += points.length / 3;
    this.geometry.setDrawRange(0, this.#count);
  }

  /** Removes all points. */
  empty(): void {
    this.#count = 0;
    this.geometry.setDrawRange(0, 0);
  }

  /** Stops highlighting the newest points. */
  settle(): void {
    this.#set("settled", this.#count);
  }

  get isEmpty(): boolean {
    return this.#count === 0;
  }

  /** Sets the size of a point in device pixels. `pixels` is the number of pixels of the whole canvas. */
  spread(size: number, pixels: number): void {
    this.#set("size", size);
    this.#set("cover", Math.min(1, Math.max(kFaintest, (kShare * pixels) / (this.#count * size * size))));
  }

  /**
   * Sets the distances from the camera between which points fade. Points up to `near` are fully
   * visible; points from `far` on are faintest.
   */
  fade(near: number, far: number): void {
    this.#set("near", near);
    this.#set("far", far);
  }

  /** Sets the CSS colours of the points. */
  paint(colours: Record<"ink" | "accent", string>): void {
    // Sets the CSS values without conversion, because the shader outputs them without conversion.
    for (const [name, css] of Object.entries(colours)) this.#set(name, new Color().setStyle(css, LinearSRGBColorSpace));
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }

  #grow(room: number): void {
    const array = new Float32Array(room);
    array.set(this.#positions.array);
    this.geometry.dispose(); // frees the old buffer on the GPU
    this.#positions = new BufferAttribute(array, 3);
    this.geometry.setAttribute("position", this.#positions);
  }

  #set(name: string, value: unknown): void {
    const uniform = this.material.uniforms[name];
    if (uniform) uniform.value = value;
  }
}
