// SPDX-License-Identifier: Apache-2.0
// The part of three.js that the pages use, as a file of its own: it changes rarely, so browsers keep
// it (dist/three.js).
export {
  Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, GLBufferAttribute, GLSL3, HemisphereLight, LinearSRGBColorSpace,
  Matrix4, Mesh, MeshBasicMaterial, MeshDepthMaterial, MeshStandardMaterial, PerspectiveCamera, Plane, Points, RGBADepthPacking, Scene,
  ShaderMaterial, Sphere, Spherical, Vector3, WebGLRenderer, WebGLRenderTarget,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
