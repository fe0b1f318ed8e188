// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "codec/mesh/unit.h"
#include "codec/package/unpack.h"

namespace vitrine::server::cli {

tl::expected<ReadOptions, Fault> reading_options(const Arguments& arguments) {
  std::array<std::string_view, kLengthUnits.size()> units;
  for (std::size_t i = 0; i < units.size(); ++i)
    units[i] = kLengthUnits[i].name;
  const auto unit = arguments.choice("--unit", units);
  if (!unit) return tl::unexpected(unit.error());
  constexpr std::string_view kAxes[] = {"y", "z"};
  const auto up = arguments.choice("--up", kAxes);
  if (!up) return tl::unexpected(up.error());
  ReadOptions options;
  if (arguments.has("--unit")) options.unit = units[*unit];
  if (*up == 1) options.up = UpAxis::kZ;
  return options;
}

tl::expected<const ImportFormat*, Fault> stated_format(const Arguments& arguments) {
  if (!arguments.has(kFormatFlag.name)) return nullptr;
  std::array<std::string_view, std::size(kImportFormats)> extensions;
  std::ranges::transform(kImportFormats, extensions.begin(), &ImportFormat::extension);
  const auto chosen = arguments.choice(kFormatFlag.name, extensions);
  if (!chosen) return tl::unexpected(chosen.error());
  return &kImportFormats[*chosen];
}

Expected<void> check_format(std::span<const std::uint8_t> mesh, const ImportFormat* stated) {
  if (stated == nullptr || is_package(mesh) || stated->recognises(mesh)) return {};
  // size in bytes of a UTF-8 byte order mark, with which the file may begin
  constexpr std::size_t kMark = 3;
  if (mesh.size() > kMark && stated->recognises(mesh.subspan(kMark))) return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("this is not {}, as {} says; leave {} out, or check the input",
                          stated->name, kFormatFlag.name, kFormatFlag.name));
}

std::string note_on_unit(std::span<const std::uint8_t> mesh, const ReadOptions& options) {
  if (options.unit.empty()) return {};
  const std::string_view stated = stated_unit(mesh);
  if (stated.empty() || stated == options.unit) return {};
  return fmt::format(
      "the file states {}, but --unit is {}; leave --unit out to use the file's unit", stated,
      options.unit);
}

}  // namespace vitrine::server::cli
