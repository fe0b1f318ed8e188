// SPDX-License-Identifier: Apache-2.0
// The unit, the up axis, the compression and the levels of an exported file, as a user chooses
// them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "codec/export/write_mesh.h"

namespace vitrine::server {

struct ExportChoices {
  std::string unit;  // one of kLengthUnits; empty for the unit usual in the format
  UpAxis up = UpAxis::kY;
  Compression compression = Compression::kNone;
  bool has_levels = false;  // whether the file holds coarser levels, too (ExportOptions::coarser)
};

// The names of compressions, in the order of Compression.
inline constexpr std::string_view kCompressionNames[] = {"none", "meshopt", "draco"};

// The choices as a user writes them; nullopt for choices that the user omits.
struct ChoiceTexts {
  std::optional<std::string_view> unit, up, compression, lod;
};

struct ChoiceFault {
  std::string_view name;  // name of the choice: "unit", "up", "compression" or "lod"
  std::string wanted;     // a description of the allowed values
};

// Reads choices. A choice that is not given gets the value that is usual in the format. Fails if a
// text is not a valid choice, or if the format's standard demands another value.
tl::expected<ExportChoices, ChoiceFault> read_choices(const ChoiceTexts& texts, MeshFormat format);

// Checks that a model with the unit `model_unit` can be exported with these choices. Fails
// (kBadInput) if a unit is chosen but the unit of the model is unknown.
Expected<void> check_unit(const ExportChoices& choices, std::string_view model_unit);

// Returns the options of an export, without its coarser levels. `choices` and `model_unit` must
// outlive the result. Compressed files round positions to `grid`.
ExportOptions export_options(const ExportChoices& choices, MeshFormat format,
                             std::string_view model_unit, FileDescription about,
                             const ExportGrid& grid);

// Returns a note for the user, "CAUSE; NEXT STEP", if the unit of the model is unknown and the
// format prescribes a unit or usually has a certain one. Otherwise returns an empty string.
std::string note_on_unknown_unit(MeshFormat format, std::string_view model_unit);

}  // namespace vitrine::server
