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

// Writes the member "asset", followed by a comma. It has the version, a copyright message and, as
// extras under the names that Sketchfab uses, the statements of statements_of(). If there is any
// descriptive text, also writes a KHR_xmp_json_ld packet after "asset" and refers to it. `options`
// must be those of the file.
void put_asset(FileWriter& json, const ExportOptions& options, GlbExtensions& extensions);

// Writes the members "extensionsUsed" and "extensionsRequired", each followed by a comma, if they
// have entries.
void put_extensions(FileWriter& json, const GlbExtensions& extensions);

// Writes the member "name", preceded by a comma, if the description has a title. The name is the
// title followed by `part`.
void put_name(FileWriter& json, const FileDescription& about, std::string_view part = {});

}  // namespace vitrine::inline codec
