// SPDX-License-Identifier: Apache-2.0
#include "server/export/export_kind.h"

#include <strings.h>

#include <filesystem>

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

bool is_zip_name(const fs::path& name) {
  return ::strcasecmp(name.extension().c_str(), ".zip") == 0;
}

}  // namespace

std::optional<ExportKind> export_kind_of(std::string_view file_name) {
  const fs::path name(file_name);
  const bool is_zip = is_zip_name(name);
  const auto format = format_of_extension((is_zip ? name.stem() : name).extension().string());
  if (!format || (is_zip && !has_companions(*format))) return std::nullopt;
  return ExportKind{*format, is_zip};
}

std::string stem_of_export(std::string_view path) {
  const fs::path name(path);
  return (is_zip_name(name) ? name.stem() : name).stem().string();
}

}  // namespace vitrine::server
