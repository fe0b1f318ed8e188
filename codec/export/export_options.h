// SPDX-License-Identifier: Apache-2.0
// The options of write_mesh(), and what an exported file says about its content.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/export/coarser_level.h"
#include "codec/mesh/up_axis.h"

namespace vitrine::inline codec {

// Whether files have a normal per vertex. STL, DRC and 3MF files never do. Most programs show a
// mesh without normals as flat facets.
enum class Normals { kSmooth, kNone };

// The statements of a file about its content. Texts may have any bytes: writers replace control
// characters by spaces and shorten long texts. Empty texts are left out.
struct FileDescription {
  std::string title, creator, rights, licence;
  std::string source;                       // URL of the model's page
  std::optional<std::uint32_t> level = {};  // the finest complete level of detail
  std::optional<double> error = {};         // upper bound of the error, in the positions' unit
};

// The compression of GLB files: none, EXT_meshopt_compression or KHR_draco_mesh_compression.
enum class Compression { kNone, kMeshopt, kDraco };

struct ExportOptions {
  std::string_view unit = {};  // unit of the positions; empty if it is unknown
  // The unit of the positions in the file: one of kLengthUnits. If empty, this is `unit`, or the
  // metre if the format requires metres. Has no effect unless `unit` is one of kLengthUnits.
  std::string_view unit_in_file = {};
  // The axis that points up in the file. The mesh itself has y up. nullopt: the file has the axis
  // that the format requires. If the format requires none, the mesh is written as it is, and the
  // file's comments state no axis.
  std::optional<UpAxis> up = {};
  Normals normals = Normals::kSmooth;
  FileDescription about = {};
  // For GLB files only. Compression rounds positions to `grid`, normals to about one degree and
  // texture coordinates to 16 bits. Without a grid, meshopt keeps positions exactly, and Draco
  // rounds them to 24 bits per coordinate of the bounding box.
  Compression compression = Compression::kNone;
  std::optional<ExportGrid> grid = {};
  // For GLB files only: coarser levels of the same model, from fine to coarse. The file then has a
  // node for each level, as the glTF extension MSFT_lod prescribes. All levels share the material
  // and the pictures of the finest level. Programs that do not know the extension show the finest
  // level.
  std::span<const CoarserLevel> coarser = {};
};

}  // namespace vitrine::inline codec
