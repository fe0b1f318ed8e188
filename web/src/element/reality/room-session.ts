// SPDX-License-Identifier: Apache-2.0
// A WebXR session that shows the model at its real size in the camera picture of a phone. It draws with the viewer's own renderer,
// so it needs no second copy of the model. It does the part of three.js' WebXRManager that a phone needs, because the viewer's
// build of three.js has none: https://www.w3.org/TR/webxr/, https://www.w3.org/TR/webxr-hit-test-1/.
import { Matrix4, PerspectiveCamera, Quaternion, Vector3, WebGLRenderTarget } from "three";
import type { Stage } from "../stage.ts";

/** A surface counts as a floor or a table if the vertical component of its unit normal is at least this. */
const kLevel = 0.9;
/** Distances in metres between which the session draws. */
const kNear = 0.01, kFar = 50;
const kUp = new Vector3(0, 1, 0);

/** A render target whose framebuffer belongs to the session, and the method that sets it. The types of three.js omit both. */
type SessionTarget = WebGLRenderTarget & { isXRRenderTarget?: boolean };
type SessionRenderer = Stage["parts"]["renderer"] & { setRenderTargetFramebuffer(target: SessionTarget, framebuffer: WebGLFramebuffer): void };

export class RoomSession {
  readonly #camera = new PerspectiveCamera();
  readonly #before: { position: Vector3; turn: Quaternion; scale: Vector3; planes: Stage["parts"]["renderer"]["clippingPlanes"] };
  readonly #foot: number; // height of the model's lowest point above the origin of `mesh`, in metres
  #isPlaced = false;

  /**
   * Starts a session. `metres` is the length of a model unit. `overlay` is shown above the camera picture; a tap beside its buttons
   * sets the model down or picks it up. Calls `onEnd` when the session has ended. Rejects if the browser refuses the session.
   */
  static async start(stage: Stage, metres: number, overlay: HTMLElement, onEnd: () => void): Promise<RoomSession> {
    const { xr } = navigator, { renderer } = stage.parts, gl = renderer.getContext();
    if (!xr) throw new Error("WebXR is missing");
    const session = await xr.requestSession("immersive-ar", { requiredFeatures: ["hit-test"], optionalFeatures: ["dom-overlay"], domOverlay: { root: overlay } });
    try {
      await gl.makeXRCompatible();
      const layer = new XRWebGLLayer(session, gl);
      await session.updateRenderState({ baseLayer: layer, depthNear: kNear, depthFar: kFar });
      const [space, eye] = await Promise.all([session.requestReferenceSpace("local"), session.requestReferenceSpace("viewer")]);
      const hits = await session.requestHitTestSource?.({ space: eye });
      if (!hits) throw new Error("the browser finds no surfaces");
      return new RoomSession(stage, metres, session, layer, space, hits, onEnd);
    } catch (error) {
      await session.end();
      throw error;
    }
  }

  private constructor(
    private readonly stage: Stage, metres: number, private readonly session: XRSession, private readonly layer: XRWebGLLayer,
    private readonly space: XRReferenceSpace, private readonly hits: XRHitTestSource, onEnd: () => void,
  ) {
    const { mesh, parts: { renderer } } = stage, { position, quaternion, scale } = mesh;
    this.#before = { position: position.clone(), turn: quaternion.clone(), scale: scale.clone(), planes: renderer.clippingPlanes };
    const target: SessionTarget = new WebGLRenderTarget(layer.framebufferWidth, layer.framebufferHeight, { colorSpace: renderer.outputColorSpace });
    target.isXRRenderTarget = true; // three.js then maps tones and encodes colours as for the screen
    this.#camera.matrixAutoUpdate = false;
    this.#foot = metres * (mesh.presentedBox?.min.y ?? 0);
    mesh.scale.multiplyScalar(metres);
    mesh.visible = false; // until a floor or a table is found
    renderer.clippingPlanes = []; // removes a section, because its plane is not in the coordinates of the room
    session.addEventListener("select", () => (this.#isPlaced = mesh.visible && !this.#isPlaced));
    session.addEventListener("end", () => (this.#restore(), onEnd()));
    const draw = (_: number, frame: XRFrame) => {
      session.requestAnimationFrame(draw);
      this.#draw(frame, target);
    };
    session.requestAnimationFrame(draw);
  }

  end(): void {
    this.session.end().catch(() => undefined); // ignores the error if the session has already ended
  }

  #draw(frame: XRFrame, target: SessionTarget): void {
    const { scene } = this.stage.parts, renderer = this.stage.parts.renderer as SessionRenderer, pose = frame.getViewerPose(this.space);
    if (!pose) return;
    if (!this.#isPlaced) this.#follow(frame, pose);
    renderer.setRenderTargetFramebuffer(target, this.layer.framebuffer);
    target.scissorTest = true; // limits clearing to the part of the target that belongs to the view
    for (const view of pose.views) {
      const { x, y, width, height } = this.layer.getViewport(view) as XRViewport;
      target.viewport.set(x, y, width, height);
      target.scissor.set(x, y, width, height);
      this.#see(view);
      renderer.setRenderTarget(target);
      renderer.render(scene, this.#camera);
    }
    renderer.setRenderTarget(null);
  }

  /** Stands the model where the middle of the view meets a floor or a table, with its front to the visitor. */
  #follow(frame: XRFrame, { transform }: XRViewerPose): void {
    const { mesh } = this.stage, hit = frame.getHitTestResults(this.hits)[0]?.getPose(this.space);
    if (!hit) return;
    const place = new Matrix4().fromArray(hit.transform.matrix), [normal, at, eye] = [new Vector3(), new Vector3().setFromMatrixPosition(place), transform.position];
    place.extractBasis(new Vector3(), normal, new Vector3());
    if (normal.y < kLevel) return;
    mesh.position.set(at.x, at.y - this.#foot, at.z);
    mesh.quaternion.setFromAxisAngle(kUp, Math.atan2(eye.x - at.x, eye.z - at.z)).multiply(this.#before.turn);
    mesh.visible = true;
  }

  #see(view: XRView): void {
    const { matrix, projectionMatrix, projectionMatrixInverse } = this.#camera;
    matrix.fromArray(view.transform.matrix);
    this.#camera.matrixWorldNeedsUpdate = true;
    projectionMatrix.fromArray(view.projectionMatrix);
    projectionMatrixInverse.copy(projectionMatrix).invert();
  }

  /** Restores the parts of the viewer that the session has changed. */
  #restore(): void {
    const { mesh, parts: { renderer } } = this.stage, { position, turn, scale, planes } = this.#before;
    mesh.position.copy(position);
    mesh.scale.copy(scale);
    mesh.quaternion.copy(turn);
    mesh.visible = true;
    renderer.clippingPlanes = planes;
    void this.stage.draw();
  }
}
