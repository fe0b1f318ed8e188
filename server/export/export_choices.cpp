// SPDX-License-Identifier: Apache-2.0
#include "server/export/export_choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "codec/core/fixed_text.h"
#include "codec/mesh/unit.h"

namespace vitrine::server {
namespace {

constexpr FixedText kUnitNames = join(
    kLengthUnits, [](const LengthUnit& unit) { return unit.name; }, ", ", " or ");

tl::unexpected<ChoiceFault> fixed(std::string_view name, std::string_view value,
                                  const ExportFormat& row) {
  return tl::unexpected(
      ChoiceFault{name, fmt::format("{}, as the standard of {} files demands", value, row.name)});
}

}  // namespace

tl::expected<ExportChoices, ChoiceFault> read_choices(const ChoiceTexts& texts, MeshFormat format) {
  const ExportFormat& row = row_of(format);
  ExportChoices choices{.unit = {}, .up = row.up};
  if (texts.unit) {
    if (!metres_per(*texts.unit))
      return tl::unexpected(ChoiceFault{"unit", std::string(std::string_view(kUnitNames))});
    if (row.has_fixed_unit && *texts.unit != row.unit) return fixed("unit", row.unit, row);
    choices.unit = std::string(*texts.unit);
  }
  if (texts.up) {
    if (*texts.up != "y" && *texts.up != "z") return tl::unexpected(ChoiceFault{"up", "y or z"});
    choices.up = *texts.up == "z" ? UpAxis::kZ : UpAxis::kY;
    if (row.has_fixed_up && choices.up != row.up) return fixed("up", name_of(row.up), row);
  }
  if (texts.compression) {
    const auto* found = std::ranges::find(kCompressionNames, *texts.compression);
    if (found == std::end(kCompressionNames))
      return tl::unexpected(ChoiceFault{"compression", "none, meshopt or draco"});
    choices.compression = static_cast<Compression>(found - std::begin(kCompressionNames));
    if (choices.compression != Compression::kNone && format != MeshFormat::kGlb)
      return tl::unexpected(
          ChoiceFault{"compression", "none, because only GLB files can be compressed"});
  }
  if (texts.lod) {
    if (*texts.lod != "none" && *texts.lod != "msft")
      return tl::unexpected(ChoiceFault{"lod", "none or msft"});
    choices.has_levels = *texts.lod == "msft";
    if (choices.has_levels && format != MeshFormat::kGlb)
      return tl::unexpected(ChoiceFault{"lod", "none, because only GLB files hold several levels"});
  }
  return choices;
}

Expected<void> check_unit(const ExportChoices& choices, std::string_view model_unit) {
  if (choices.unit.empty() || metres_per(model_unit)) return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("the unit of the model is unknown, so it cannot be written in {}; leave "
                          "the unit out, or build the model with its unit",
                          choices.unit));
}

ExportOptions export_options(const ExportChoices& choices, MeshFormat format,
                             std::string_view model_unit, FileDescription about,
                             const ExportGrid& grid) {
  const std::string_view unit = choices.unit.empty() ? row_of(format).unit : choices.unit;
  return {.unit = model_unit,
          .unit_in_file = unit,
          .up = choices.up,
          .about = std::move(about),
          .compression = choices.compression,
          .grid = grid};
}

std::string note_on_unknown_unit(MeshFormat format, std::string_view model_unit) {
  const ExportFormat& row = row_of(format);
  if (row.unit.empty() || metres_per(model_unit)) return {};
  return fmt::format(
      "the unit of the model is unknown, and readers of {} take it for {}; build the model with "
      "--unit",
      row.name, row.unit);
}

}  // namespace vitrine::server
