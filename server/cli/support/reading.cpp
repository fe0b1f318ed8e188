// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/reading.h"

#include <fmt/format.h>

#include "codec/mesh/unit.h"

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

std::string note_on_unit(std::span<const std::uint8_t> mesh, const ReadOptions& options) {
  const std::string_view stated = stated_unit(mesh);
  if (options.unit.empty() || stated.empty() || stated == options.unit) return {};
  return fmt::format(
      "the file states {}, but --unit is {}; leave --unit out to use the file's unit", stated,
      options.unit);
}

}  // namespace vitrine::server::cli
