// SPDX-License-Identifier: Apache-2.0
// The codec's public interface. It builds, opens, refines and exports progressive meshes.
//
//   read_mesh    takes bytes of a mesh file (the formats: codec/import/formats.h), or of a zip, tar
//                or gzip package with one; returns an ImportedMesh
//   build_model  takes bytes of a mesh file, or an ImportedMesh; returns a `.pmesh` and a report
//   open_model   takes bytes of a `.pmesh`, or a prefix of them; returns a Refiner at the base mesh
//   refine       refines a Refiner until it meets a Want: triangles, bytes, error, level or view
//   Planner      chooses the next chunk to fetch, for clients that receive chunks one by one
//                (Refiner::apply)
//   write_mesh   takes a TriangleMesh; returns bytes of a mesh file (the formats: MeshFormat);
//                write_textured_mesh also takes a Texturing, and returns the file and its pictures
//
// verify_model proves that a `.pmesh` is intact and, if the original is given, that it is lossless.
// compare_appearance measures how alike two meshes look: PSNR and SSIM of pictures from twelve
// sides. read_file and write_file_atomically serve programs that have no file functions of their
// own.
//
// Coordinates and errors are doubles in the model's unit (Manifest::unit). Functions that can fail
// return Expected<T>. The message of its Error is one line: the fault, its place, the next step.
//
// Refiner, Planner, open_model and parse_header are safe on any bytes. The functions that read,
// build and verify call third-party decoders (Draco, Assimp, libarchive and picture decoders),
// which are not safe on hostile bytes. If the bytes are untrusted, call these functions in a
// process without privileges.
//
// There is no global state. Different objects may be used from different threads at the same time,
// but each object from only one thread at a time. build_model starts BuildOptions::threads threads;
// its result does not depend on their number.
//
// FORMAT.md specifies the file format. README.md explains how to install the library.
#pragma once

#include "codec/appearance/appearance.h"
#include "codec/build/build_model.h"
#include "codec/build/open_model.h"
#include "codec/build/originals.h"
#include "codec/build/refine.h"
#include "codec/build/verify_model.h"
#include "codec/export/write_mesh.h"
#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"
#include "codec/import/read_mesh.h"
#include "codec/plan/planner.h"
#include "codec/refine/refiner.h"
