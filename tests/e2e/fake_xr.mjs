// SPDX-License-Identifier: Apache-2.0
// A stand-in for a phone's WebXR: https://www.w3.org/TR/webxr/, https://www.w3.org/TR/webxr-hit-test-1/.

/**
 * Runs in the page: `navigator.xr` offers sessions whose pictures are `side` pixels wide and high, with a field of view of 90 degrees.
 * `window.phone` is the phone. `eye` is the position of its camera, in metres. `floor` is the point, in metres, at which the middle of
 * the view meets a surface, or undefined if there is none. `isWall` states whether this surface is upright.
 */
export function fakeXr(side = 400) {
  const at = (x, y, z) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1];
  /** Returns the pose of a surface as a 4 x 4 matrix. The y axis is the normal of the surface, which is level or upright. */
  const surface = ([x, y, z], isWall) => (isWall ? [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, x, y, z, 1] : at(x, y, z));
  const phone = (window.phone = { eye: [0, 0, 0], floor: undefined, isWall: false, session: undefined, asked: [] });
  const projection = ([near, far] = [0.01, 50]) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];

  WebGL2RenderingContext.prototype.makeXRCompatible = async () => undefined;
  window.XRWebGLLayer = class {
    framebufferWidth = side;
    framebufferHeight = side;
    constructor(session, gl) {
      this.gl = phone.gl = gl;
      this.framebuffer = phone.framebuffer = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
      for (const [attachment, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA8], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
        const buffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
        gl.renderbufferStorage(gl.RENDERBUFFER, format, side, side);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      }
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }
    getViewport() {
      return { x: 0, y: 0, width: side, height: side };
    }
  };

  class Session extends EventTarget {
    isOver = false;
    drawn = [];
    async updateRenderState({ depthNear, depthFar }) {
      this.depths = [depthNear, depthFar];
    }
    async requestReferenceSpace(type) {
      return { type };
    }
    async requestHitTestSource() {
      return {};
    }
    requestAnimationFrame(draw) {
      requestAnimationFrame((time) => {
        if (this.isOver) return;
        draw(time, this.frame());
        for (const resolve of this.drawn.splice(0)) resolve();
      });
    }
    frame() {
      const [x, y, z] = phone.eye, transform = { matrix: at(x, y, z), position: { x, y, z } };
      return {
        getViewerPose: () => ({ transform, views: [{ transform, projectionMatrix: projection(this.depths) }] }),
        getHitTestResults: () => (phone.floor ? [{ getPose: () => ({ transform: { matrix: surface(phone.floor, phone.isWall) } }) }] : []),
      };
    }
    async end() {
      this.isOver = true;
      this.dispatchEvent(new Event("end"));
    }
  }

  /**
   * Waits for the next picture. Returns the number of its drawn pixels, the smallest rectangle around them, in pixels from the lower
   * left corner, and their mean brightness, from 0 to 255.
   */
  phone.seen = async () => {
    await new Promise((resolve) => phone.session.drawn.push(resolve));
    const { gl } = phone, data = new Uint8Array(4 * side * side), box = { left: side, right: -1, bottom: side, top: -1, light: 0 };
    gl.bindFramebuffer(gl.FRAMEBUFFER, phone.framebuffer);
    gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, data);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    let count = 0;
    for (let i = 0; i < side * side; ++i) {
      if (data[4 * i + 3] === 0) continue;
      const x = i % side, y = Math.floor(i / side);
      Object.assign(box, { left: Math.min(box.left, x), right: Math.max(box.right, x), bottom: Math.min(box.bottom, y), top: Math.max(box.top, y) });
      box.light += data[4 * i + 1];
      ++count;
    }
    return { ...box, count, light: count && box.light / count };
  };
  phone.tap = () => phone.session.dispatchEvent(new Event("select"));

  const xr = {
    isSessionSupported: async (mode) => mode === "immersive-ar",
    requestSession: async (mode, options) => {
      phone.asked.push({ mode, required: options.requiredFeatures, overlay: options.domOverlay.root.className });
      if (phone.refusal) throw new DOMException("", phone.refusal);
      return (phone.session = new Session());
    },
  };
  Object.defineProperty(navigator, "xr", { value: xr });
}
