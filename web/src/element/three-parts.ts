// SPDX-License-Identifier: Apache-2.0
// The part of three.js that the pages use. It is bundled into a separate file (dist/three.js), because it rarely
// changes and browsers can cache it for a long time.
export {
  Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, GLBufferAttribute, GLSL3, HemisphereLight, LinearSRGBColorSpace,
  Matrix4, Mesh, MeshBasicMaterial, MeshDepthMaterial, MeshStandardMaterial, PerspectiveCamera, Plane, Points, RGBADepthPacking, Scene,
  ShaderMaterial, Sphere, Spherical, Vector3, WebGLRenderer, WebGLRenderTarget,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
