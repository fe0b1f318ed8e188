// SPDX-License-Identifier: Apache-2.0
// The file formats that can be uploaded.

/** The formats of codec/import/formats.h, inserted by the bundler. */
declare const MESH_FORMATS: { name: string; extension: string }[];

const kMeshSuffixes = MESH_FORMATS.map(({ extension }) => `.${extension}`);
/** Packages of a model with its files (codec/package). */
const kPackageSuffixes = [".zip", ".tar", ".gz", ".tgz"];

export const kUploadNames = [...MESH_FORMATS.map(({ name }) => name), "PMESH", "ZIP", "TAR", "GZ"];
export const kUploadSuffixes = [...kMeshSuffixes, ".pmesh", ...kPackageSuffixes];
/** Types of the files that a model may refer to. Files of other types may be dropped as well. */
export const kBesideTypes = [".mtl", ".bin", "image/*", ".tga"];

const endsInOneOf = (name: string, suffixes: string[]): boolean => suffixes.some((suffix) => name.toLowerCase().endsWith(suffix));
export const isMeshName = (name: string): boolean => endsInOneOf(name, kMeshSuffixes);
export const isUploadName = (name: string): boolean => endsInOneOf(name, kUploadSuffixes);
