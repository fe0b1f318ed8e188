// SPDX-License-Identifier: Apache-2.0
// Writes the description of a glTF file's content: title, creator, rights and source.
#pragma once

#include <string_view>
#include <vector>

#include "codec/export/export_options.h"
#include "codec/export/file_writer.h"

namespace vitrine::inline codec {

// The extensions that a glTF file uses. A reader must know the required ones.
struct GlbExtensions {
  std::vector<std::string_view> used, required;
};

// Writes the member "asset", followed by a comma. The member has the version, a copyright message
// and the extras: the values of statements_of() under the names that Sketchfab uses. If there is
// any descriptive text, also writes a KHR_xmp_json_ld packet after "asset", to which "asset"
// refers. `options.unit` must be the unit of the file, and the error in `options` must be in this
// unit.
void put_asset(FileWriter& json, const ExportOptions& options, GlbExtensions& extensions);

// Writes the members "extensionsUsed" and "extensionsRequired", each followed by a comma, if they
// have entries.
void put_extensions(FileWriter& json, const GlbExtensions& extensions);

// Writes the member "name", preceded by a comma, if the description has a title. The name is the
// title followed by `part`.
void put_name(FileWriter& json, const FileDescription& about, std::string_view part = {});

}  // namespace vitrine::inline codec
