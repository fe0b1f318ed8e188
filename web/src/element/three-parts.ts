// SPDX-License-Identifier: Apache-2.0
// The part of three.js that the pages use. It is bundled into a file of its own (dist/three.js).
// That file rarely changes, so browsers can cache it for a long time.
export {
  ACESFilmicToneMapping, AgXToneMapping, Box3, BufferAttribute, BufferGeometry, CineonToneMapping, Color, DataTexture,
  DirectionalLight, DoubleSide, EquirectangularReflectionMapping, GLBufferAttribute, GLSL3, HalfFloatType, HemisphereLight,
  LinearFilter, LinearSRGBColorSpace, LinearToneMapping, Matrix4, Mesh, MeshBasicMaterial, MeshDepthMaterial,
  MeshStandardMaterial, NoToneMapping, PerspectiveCamera, Plane, Points, ReinhardToneMapping, REVISION, RGBADepthPacking,
  RGBAFormat, Scene, ShaderChunk, ShaderMaterial, Sphere, Spherical, Texture, Vector3, WebGLRenderer, WebGLRenderTarget,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
