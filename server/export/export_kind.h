// SPDX-License-Identifier: Apache-2.0
// The kinds of exports that commands and the REST interface offer: a mesh file in each format, and
// a zip of a mesh file with its pictures.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "codec/core/fixed_text.h"
#include "codec/export/write_mesh.h"

namespace vitrine::server {

struct ExportKind {
  MeshFormat format;
  bool is_zip = false;  // may be true only for formats with companions
};

// The formats that can be packed into a zip with their pictures.
inline constexpr MeshFormat kZipFormats[] = {MeshFormat::kPly, MeshFormat::kObj, MeshFormat::kVrml};
static_assert([] {
  for (const MeshFormat format : kZipFormats) {
    if (!has_companions(format)) return false;
  }
  return true;
}());

constexpr std::string_view extension_of_format(MeshFormat format) {
  return row_of(format).extension;
}
// Each constant lists all zips: ".ply.zip, .obj.zip, …", "ply.zip, obj.zip or wrl.zip" and
// "ply.zip|obj.zip|wrl.zip".
inline constexpr FixedText kZipSuffixes =
    concatenate(".", join(kZipFormats, extension_of_format, ".zip, .", ".zip, ."), ".zip");
inline constexpr FixedText kZipExtensions =
    concatenate(join(kZipFormats, extension_of_format, ".zip, ", ".zip or "), ".zip");
inline constexpr FixedText kZipChoice =
    concatenate(join(kZipFormats, extension_of_format, ".zip|", ".zip|"), ".zip");

// Returns the kind of an export from the end of its file name, such as "bust.glb" or
// "bust.obj.zip". Ignores the case of letters. Returns nullopt for other names.
std::optional<ExportKind> export_kind_of(std::string_view file_name);

// Returns the name of a file without its folder and without the extensions that choose its kind.
std::string stem_of_export(std::string_view path);

}  // namespace vitrine::server
