// SPDX-License-Identifier: Apache-2.0
// Writes what a glTF file says about its content.
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

// Writes the member "asset", followed by a comma: the version, a copyright message, the statements
// of statements_of() as extras with the names that Sketchfab uses, and, if there is a text, a
// packet of KHR_xmp_json_ld. Writes that packet after it. `options` must be those of the file.
void put_asset(FileWriter& json, const ExportOptions& options, GlbExtensions& extensions);

// Writes the members "extensionsUsed" and "extensionsRequired", each followed by a comma, if they
// have entries.
void put_extensions(FileWriter& json, const GlbExtensions& extensions);

// Writes the member "name", preceded by a comma, if the description has a title. `part` follows the
// title.
void put_name(FileWriter& json, const FileDescription& about, std::string_view part = {});

}  // namespace vitrine::inline codec
