// SPDX-License-Identifier: Apache-2.0
// Measures the memory of a page with viewers: the JavaScript heaps and arrays of page and worker, and the WebAssembly
// memory. Also counts the WebGL objects, and the bytes of WebGL buffers and pictures.
import { once } from "node:events";

/**
 * Runs in the page before the page's own scripts. Counts the WebGL objects of each context until
 * the context is lost.
 */
export function countWebGl() {
  const contexts = new Map(), kinds = ["Buffer", "Texture", "Program", "Shader", "VertexArray", "Framebuffer", "Renderbuffer"];
  const prototype = WebGL2RenderingContext.prototype;
  const wrap = (name, after) => {
    const original = prototype[name];
    prototype[name] = function (...words) {
      const result = original.apply(this, words);
      after(this, words, result);
      return result;
    };
  };
  const objects = (gl) => contexts.get(gl) ?? (contexts.set(gl, new Map()), contexts.get(gl));
  const bound = new WeakMap(); // maps each context to the buffers and textures that are bound to its targets
  for (const kind of kinds) {
    wrap(`create${kind}`, (gl, _, made) => objects(gl).set(made, 0));
    wrap(`delete${kind}`, (gl, [gone]) => objects(gl).delete(gone));
  }
  wrap("bindBuffer", (gl, [target, buffer]) => bound.set(gl, { ...bound.get(gl), [target]: buffer }));
  wrap("bufferData", (gl, [target, data]) => objects(gl).set(bound.get(gl)[target], data?.byteLength ?? data));
  wrap("bindTexture", (gl, [target, texture]) => bound.set(gl, { ...bound.get(gl), [target]: texture }));
  wrap("texStorage2D", (gl, [target, levels, format, width, height]) => {
    if (![gl.RGBA8, gl.SRGB8_ALPHA8].includes(format)) return;
    const texels = Array.from({ length: levels }, (_, i) => Math.max(1, width >> i) * Math.max(1, height >> i));
    objects(gl).set(bound.get(gl)[target], 4 * texels.reduce((sum, some) => sum + some));
  });
  wrap("getExtension", (gl, [name], extension) => {
    if (name !== "WEBGL_lose_context" || !extension) return;
    const lose = extension.loseContext;
    extension.loseContext = () => (contexts.delete(gl), lose.call(extension));
  });
  /** Returns the number of bytes of the models' pictures, which are the textures with 8 bits per channel. */
  window.pictureBytes = () => [...contexts.values()].flatMap((held) => [...held])
    .reduce((sum, [object, bytes]) => sum + (object instanceof WebGLTexture ? bytes : 0), 0);
  window.webGl = () => {
    const all = [...contexts.values()].flatMap((held) => [...held.values()]);
    return { contexts: contexts.size, objects: all.length, bytes: all.reduce((sum, bytes) => sum + bytes, 0) };
  };
}

/**
 * Runs in the worker. Counts the memory of each WebAssembly instance that is created later. An
 * instance no longer counts when it is garbage-collected.
 */
function countWebAssembly() {
  const memories = [], { instantiate } = WebAssembly;
  WebAssembly.instantiate = async (...words) => {
    const instance = await instantiate.apply(WebAssembly, words);
    memories.push(new WeakRef(instance.exports.memory));
    return instance;
  };
  self.webAssemblyBytes = () => memories.reduce((sum, memory) => sum + (memory.deref()?.buffer.byteLength ?? 0), 0);
}

export class Memory {
  /**
   * Prepares the measurement of a page whose worker is running. WebAssembly instances that already
   * exist are not counted.
   */
  static async of(page) {
    const devtools = await page.context().newCDPSession(page);
    const attached = once(devtools, "Target.attachedToTarget");
    await devtools.send("Target.setAutoAttach", { autoAttach: true, waitForDebuggerOnStart: false, flatten: false });
    const [{ sessionId }] = await attached;
    const memory = new Memory(page, devtools, sessionId);
    await memory.#ask("Runtime.evaluate", { expression: `(${countWebAssembly})()` });
    return memory;
  }

  #last = 0;

  constructor(page, devtools, worker) {
    Object.assign(this, { page, devtools, worker });
  }

  /** Collects garbage, then returns the memory in MB and the number of WebGL objects. */
  async measure() {
    await this.devtools.send("HeapProfiler.collectGarbage");
    await this.#ask("HeapProfiler.collectGarbage");
    const page = await this.devtools.send("Runtime.getHeapUsage"), worker = await this.#ask("Runtime.getHeapUsage");
    const wasm = await this.#ask("Runtime.evaluate", { expression: "webAssemblyBytes()" });
    const { objects, bytes } = await this.page.evaluate(() => window.webGl());
    return {
      "page's heap": page.usedSize / 1e6, "page's arrays": page.backingStorageSize / 1e6,
      "worker's heap": worker.usedSize / 1e6, "worker's arrays": worker.backingStorageSize / 1e6,
      "WebAssembly": wasm.result.value / 1e6, "WebGL objects": objects, "WebGL buffers": bytes / 1e6,
    };
  }

  /** Sends a command to the worker's debugger interface and returns the reply. */
  async #ask(method, params) {
    const id = ++this.#last;
    const answer = new Promise((resolve) => {
      const hear = ({ message }) => {
        const { id: to, result } = JSON.parse(message);
        if (to !== id) return;
        this.devtools.off("Target.receivedMessageFromTarget", hear);
        resolve(result);
      };
      this.devtools.on("Target.receivedMessageFromTarget", hear);
    });
    await this.devtools.send("Target.sendMessageToTarget", { sessionId: this.worker, message: JSON.stringify({ id, method, params }) });
    return answer;
  }
}
