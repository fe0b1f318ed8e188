// SPDX-License-Identifier: Apache-2.0
// The part of three.js that the pages use. It is bundled into a file of its own (dist/three.js).
// That file rarely changes, so browsers can cache it for a long time.
export {
  ACESFilmicToneMapping, AgXToneMapping, Box3, BufferAttribute, BufferGeometry, CineonToneMapping, Color, CubeUVReflectionMapping,
  DataTexture, DirectionalLight, DoubleSide, GLBufferAttribute, GLSL3, HalfFloatType, HemisphereLight, LinearFilter,
  LinearSRGBColorSpace, LinearToneMapping, Matrix4, Mesh, MeshBasicMaterial, MeshDepthMaterial, MeshStandardMaterial, NeutralToneMapping,
  NoToneMapping, PerspectiveCamera, Plane, Points, ReinhardToneMapping, RGBADepthPacking, RGBAFormat, Scene, ShaderMaterial,
  Sphere, Spherical, Texture, Vector3, WebGLRenderer, WebGLRenderTarget,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
