// SPDX-License-Identifier: Apache-2.0
// Decodes pictures in the worker.

/** Maximum size of a band, in pixels. The page copies a band to the GPU in one step, and this size causes no noticeable pause. */
const kBandPixels = 1 << 18;

/** Decoding options that keep the stored values: normals are not colours, and opacity must not darken colours. */
const kAsStored: ImageBitmapOptions = { colorSpaceConversion: "none", premultiplyAlpha: "none" };

/**
 * Decodes a WebP file, and returns the picture in bands from top to bottom, scaled to `side` by `side` pixels. Returns an empty
 * list if the browser cannot decode the file, or if the file's picture is not `fileSide` pixels wide and high.
 */
export async function decodePicture(bytes: Uint8Array, fileSide: number, side: number): Promise<ImageBitmap[]> {
  let image: ImageBitmap | undefined;
  try {
    image = await createImageBitmap(new Blob([bytes as BlobPart], { type: "image/webp" }), kAsStored);
    return image.width === fileSide && image.height === fileSide ? await bandsOf(image, side) : [];
  } catch {
    return [];
  } finally {
    image?.close();
  }
}

async function bandsOf(image: ImageBitmap, side: number): Promise<ImageBitmap[]> {
  const scaled = side === image.width ? image : await createImageBitmap(image, { ...kAsStored, resizeWidth: side, resizeHeight: side, resizeQuality: "high" });
  const rows = Math.max(1, Math.floor(kBandPixels / side)), bands = [];
  for (let y = 0; y < side; y += rows) bands.push(await createImageBitmap(scaled, 0, y, side, Math.min(rows, side - y), kAsStored));
  if (scaled !== image) scaled.close();
  return bands;
}
