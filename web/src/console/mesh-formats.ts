// SPDX-License-Identifier: Apache-2.0
// The file formats that can be uploaded.

/** The formats of codec/import/formats.h, inserted by the bundler. */
declare const MESH_FORMATS: { name: string; extension: string }[];

export const kUploadNames = [...MESH_FORMATS.map(({ name }) => name), "PMESH"];
export const kUploadSuffixes = [...MESH_FORMATS.map(({ extension }) => `.${extension}`), ".pmesh"];
