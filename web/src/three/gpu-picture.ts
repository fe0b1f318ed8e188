// SPDX-License-Identifier: Apache-2.0
// A picture in graphics memory. It is uploaded band by band over several frames, so that a large
// picture needs no long task. It must be drawn only after its last band.
import { Texture, type WebGLRenderer } from "three";
import type { Steps } from "./gpu-array.ts";

/**
 * Maximum anisotropy of texture filtering. It keeps pictures sharp on surfaces that are seen at a
 * low angle.
 */
const kAnisotropy = 4;

export class GpuPicture {
  readonly texture = new Texture();
  readonly #gl: WebGL2RenderingContext;
  readonly #handle: WebGLTexture;

  /** Allocates a square picture. `isColour` is true for sRGB colours, and false for other values. */
  constructor(renderer: WebGLRenderer, side: number, isColour: boolean) {
    const gl = (this.#gl = renderer.getContext() as WebGL2RenderingContext);
    this.#handle = gl.createTexture() as WebGLTexture;
    this.#bound(() => {
      const levels = Math.floor(Math.log2(side)) + 1;
      gl.texStorage2D(gl.TEXTURE_2D, levels, isColour ? gl.SRGB8_ALPHA8 : gl.RGBA8, side, side);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
      const filter = gl.getExtension("EXT_texture_filter_anisotropic");
      if (filter) gl.texParameterf(gl.TEXTURE_2D, filter.TEXTURE_MAX_ANISOTROPY_EXT, Math.min(kAnisotropy, renderer.capabilities.getMaxAnisotropy()));
    });
    // Makes three.js bind this texture instead of uploading one.
    Object.assign(renderer.properties.get(this.texture) as object, { __webglTexture: this.#handle, __webglInit: true });
    this.texture.addEventListener("dispose", () => gl.deleteTexture(this.#handle));
    // Rows run downwards, as in glTF.
    this.texture.flipY = false;
    Object.defineProperty(this.texture.source, "data", { get: () => this.#read(side) });
  }

  /** Reads the picture back into a canvas, which exporters of three.js use as the texture's image. */
  #read(side: number): HTMLCanvasElement {
    const gl = this.#gl, before = gl.getParameter(gl.FRAMEBUFFER_BINDING) as WebGLFramebuffer | null;
    const frame = gl.createFramebuffer(), image = new ImageData(side, side);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.#handle, 0);
    gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(image.data.buffer));
    gl.bindFramebuffer(gl.FRAMEBUFFER, before);
    gl.deleteFramebuffer(frame);
    const canvas = Object.assign(document.createElement("canvas"), { width: side, height: side });
    canvas.getContext("2d")?.putImageData(image, 0, 0);
    return canvas;
  }

  /** Whether the picture is in graphics memory. False after the WebGL context was lost. */
  get isPresent(): boolean {
    return this.#gl.isTexture(this.#handle);
  }

  /** Uploads the picture in bands from top to bottom, and closes each of them. */
  *fill(bands: ImageBitmap[]): Steps {
    const gl = this.#gl;
    let row = 0;
    for (const band of bands) {
      this.#bound(() => {
        gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
        gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
        gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, gl.RGBA, gl.UNSIGNED_BYTE, band);
      });
      row += band.height;
      band.close();
      yield "continue";
    }
    this.#bound(() => gl.generateMipmap(gl.TEXTURE_2D));
  }

  /** Runs `use` while the texture is bound. Then restores the binding, which three.js relies on. */
  #bound(use: () => void): void {
    const gl = this.#gl, before = gl.getParameter(gl.TEXTURE_BINDING_2D) as WebGLTexture | null;
    gl.bindTexture(gl.TEXTURE_2D, this.#handle);
    use();
    gl.bindTexture(gl.TEXTURE_2D, before);
  }
}
