// SPDX-License-Identifier: Apache-2.0
// Makes the methods and exporters of three.js work with the geometry of a ProgressiveMesh, although its attributes
// are in GPU buffers.
import { Box3, BufferAttribute, BufferGeometry, Sphere, Vector3 } from "three";
import type { NumericArray } from "../core/types.ts";

/** An attribute whose array is uploaded to the GPU by SurfaceBuffers. three.js must not upload it. */
export class UploadedAttribute extends BufferAttribute {
  readonly isGLBufferAttribute = true;
  readonly elementSize: number;

  constructor(values: NumericArray, width: number, readonly buffer: WebGLBuffer | undefined, readonly type: number) {
    super(values, width, values instanceof Int16Array || values instanceof Uint16Array);
    this.elementSize = values.BYTES_PER_ELEMENT;
  }

  /**
   * Returns a copy that three.js uploads. Normals, which are padded to four 16-bit numbers for the GPU, become three floats, as
   * glTF expects.
   */
  override clone(): this {
    const isPadded = this.array instanceof Int16Array && this.itemSize === 4;
    if (!isPadded) return new BufferAttribute(this.array.slice(), this.itemSize, this.normalized) as this;
    const copy = new BufferAttribute(new Float32Array(3 * this.count), 3);
    for (let i = 0; i < this.count; ++i) copy.setXYZ(i, this.getX(i), this.getY(i), this.getZ(i));
    return copy as this;
  }
}

/** A geometry that computes its bounds from arrays in main memory, although its attributes are in GPU buffers. */
export class SurfaceGeometry extends BufferGeometry {
  override computeBoundingBox(): void {
    const position = this.attributes["position"];
    (this.boundingBox ??= new Box3()).makeEmpty();
    if (position) this.boundingBox.setFromArray(position.array);
  }

  /**
   * The sphere's radius is half the diagonal of the box plus 10 %, because refinement may add vertices outside the box.
   * Without vertices, the sphere is empty.
   */
  override computeBoundingSphere(): void {
    const box = new Box3(), position = this.attributes["position"];
    if (position) box.setFromArray(position.array);
    this.boundingSphere ??= new Sphere();
    if (box.isEmpty()) this.boundingSphere.makeEmpty();
    else this.boundingSphere.set(box.getCenter(new Vector3()), 0.55 * box.getSize(new Vector3()).length());
  }

  /**
   * Returns a geometry with the present state of the surface. Later refinements do not change the
   * copy.
   */
  override clone(): this {
    const copy = new BufferGeometry().copy(this);
    for (const [name, { count }] of Object.entries(copy.attributes)) if (count === 0) copy.deleteAttribute(name);
    copy.setDrawRange(0, Infinity);
    return copy as this;
  }
}
