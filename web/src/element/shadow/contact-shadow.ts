// SPDX-License-Identifier: Apache-2.0
// A soft shadow on the ground below a model, as in model-viewer. The model is drawn from below, darker where it is nearer to the
// ground. Then this picture is blurred. The shadow is drawn after the scene, so that it does not affect the other objects of the
// scene.
import {
  BufferAttribute, BufferGeometry, DoubleSide, Mesh, PerspectiveCamera, Scene, ShaderMaterial, Vector3, WebGLRenderTarget,
  type Camera, type WebGLRenderer,
} from "three";
import type { ProgressiveMesh } from "../../three/progressive-mesh.ts";

/** Side of the shadow's picture in pixels. */
const kSide = 128;
/** Margin for the blurred edge at each border of the shadow's picture, as a fraction of the picture's width. */
const kMargin = 0.2;
/** Widths of the blurs in pixels: standard deviations of Gaussians. */
const kBlurs = [1.5, 5];
/**
 * Height above the ground at which a surface no longer darkens the ground, as a part of the model's largest
 * side.
 */
const kReach = 0.4;

const kGround = "varying vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }";
const kScreen = "varying vec2 at; void main() { at = uv; gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0); }";
const kHeight = `#include <clipping_planes_pars_vertex>
  varying float height; uniform float ground, reach;
  void main() {
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
    height = ((modelMatrix * vec4(position, 1.0)).y - ground) / reach;
    gl_Position = projectionMatrix * mvPosition;
    #include <clipping_planes_vertex>
  }`;
const kNearness = `#include <clipping_planes_pars_fragment>
  varying float height;
  void main() {
    #include <clipping_planes_fragment>
    gl_FragColor = vec4(0.0, 0.0, 0.0, pow(clamp(1.0 - height, 0.0, 1.0), 2.0));
  }`;
const kBlur = `varying vec2 at; uniform sampler2D source; uniform vec2 step;
  void main() {
    float sum = 0.0, weights = 0.0;
    for (int i = -6; i <= 6; ++i) {
      float weight = exp(-float(i * i) / 8.0);
      sum += weight * texture2D(source, at + float(i) * step).a;
      weights += weight;
    }
    gl_FragColor = vec4(0.0, 0.0, 0.0, sum / weights);
  }`;

export class ContactShadow {
  /** Intensity of the shadow, from 0 to 1. */
  intensity = 1;
  readonly #targets = [new WebGLRenderTarget(kSide, kSide, { depthBuffer: true }), new WebGLRenderTarget(kSide, kSide, { depthBuffer: false })] as const;
  readonly #square = square();
  readonly #body = new ShaderMaterial({
    side: DoubleSide, clipping: true, uniforms: { ground: { value: 0 }, reach: { value: 1 } }, vertexShader: kHeight, fragmentShader: kNearness,
  });
  readonly #blur = new ShaderMaterial({
    uniforms: { source: { value: null }, step: { value: [0, 0] } }, depthTest: false, depthWrite: false, vertexShader: kScreen, fragmentShader: kBlur,
  });
  readonly #ground = new ShaderMaterial({
    uniforms: { source: { value: this.#targets[0].texture }, intensity: { value: 1 } }, transparent: true, depthWrite: false, vertexShader: kGround,
    fragmentShader: `varying vec2 at; uniform sampler2D source; uniform float intensity;
      void main() { gl_FragColor = vec4(0.0, 0.0, 0.0, intensity * texture2D(source, at).a); }`,
  });
  readonly #below = new PerspectiveCamera(); // with a parallel projection
  readonly #plane = new Mesh(this.#square, this.#ground);
  readonly #onGround = new Scene().add(this.#plane);
  readonly #onScreen = new Scene().add(unculled(new Mesh(this.#square, this.#blur)));
  readonly #model: Scene;
  #isStale = true;
  #section: unknown; // the clipping planes with which the shadow was computed

  /** Casts the shadow of `mesh`, whose base mesh must be loaded. The caller must still dispose of `mesh`. */
  constructor(private readonly renderer: WebGLRenderer, mesh: ProgressiveMesh) {
    const body = unculled(new Mesh(mesh.geometry, this.#body));
    body.applyMatrix4(mesh.matrixWorld);
    this.#model = new Scene().add(body);
    const { min, max } = mesh.presentedBox ?? { min: new Vector3(), max: new Vector3() };
    const size = max.clone().sub(min), side = Math.max(size.x, size.z) / (1 - 2 * kMargin) || 1, reach = kReach * Math.max(size.x, size.y, size.z) || 1;
    const middle = min.clone().add(max).multiplyScalar(0.5);
    this.#body.uniforms.ground!.value = min.y;
    this.#body.uniforms.reach!.value = reach;
    this.#plane.position.set(middle.x, min.y, middle.z);
    this.#plane.scale.set(side, 1, side);
    // Looks up from the ground. x of the picture is x of the model, and y of the picture is -z.
    this.#below.position.copy(this.#plane.position);
    this.#below.up.set(0, 0, 1);
    this.#below.lookAt(middle.x, max.y + 1, middle.z);
    this.#below.updateMatrixWorld();
    this.#below.projectionMatrix.makeOrthographic(-side / 2, side / 2, side / 2, -side / 2, -0.001 * reach, size.y + reach);
    this.#below.projectionMatrixInverse.copy(this.#below.projectionMatrix).invert();
  }

  /** Compiles the shaders in the background, so that no frame waits for them. */
  async compile(): Promise<void> {
    const { renderer } = this;
    renderer.setRenderTarget(this.#targets[0]);
    const shaders = [renderer.compileAsync(this.#model, this.#below), renderer.compileAsync(this.#onScreen, this.#below)];
    renderer.setRenderTarget(null);
    await Promise.all([...shaders, renderer.compileAsync(this.#onGround, this.#below)]);
  }

  /** Makes the next call of draw() compute the shadow again. */
  forget(): void {
    this.#isStale = true;
  }

  /**
   * Draws the shadow into the frame that `camera` has just drawn. The model hides the parts of the
   * shadow behind it.
   */
  draw(camera: Camera): void {
    const { autoClear } = this.renderer;
    if (this.#isStale || this.#section !== this.renderer.clippingPlanes) this.#cast();
    this.#ground.uniforms.intensity!.value = this.intensity;
    this.renderer.autoClear = false;
    this.renderer.render(this.#onGround, camera);
    this.renderer.autoClear = autoClear;
  }

  dispose(): void {
    for (const part of [...this.#targets, this.#square, this.#body, this.#blur, this.#ground]) part.dispose();
  }

  #cast(): void {
    this.#isStale = false;
    this.#section = this.renderer.clippingPlanes;
    this.renderer.setRenderTarget(this.#targets[0]);
    this.renderer.render(this.#model, this.#below);
    for (const width of kBlurs) {
      this.#pass(0, 1, [width / 2 / kSide, 0]);
      this.#pass(1, 0, [0, width / 2 / kSide]);
    }
    this.renderer.setRenderTarget(null);
  }

  #pass(from: 0 | 1, to: 0 | 1, step: [number, number]): void {
    Object.assign(this.#blur.uniforms, { source: { value: this.#targets[from].texture }, step: { value: step } });
    this.renderer.setRenderTarget(this.#targets[to]);
    this.renderer.render(this.#onScreen, this.#below);
  }
}

/** Turns off frustum culling, so that a mesh is drawn wherever the camera is. */
function unculled(mesh: Mesh): Mesh {
  mesh.frustumCulled = false;
  return mesh;
}

/** Returns a square on the ground, of side 1, that is seen from above. */
function square(): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array([-0.5, 0, 0.5, 0.5, 0, 0.5, 0.5, 0, -0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, -0.5, 0, -0.5]), 3));
  geometry.setAttribute("uv", new BufferAttribute(new Float32Array([0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1]), 2));
  return geometry;
}
