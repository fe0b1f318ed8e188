// SPDX-License-Identifier: Apache-2.0
// The unit, the up axis and the compression of an exported file, as a user chooses them.
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
};

// The names of compressions, in the order of Compression.
inline constexpr std::string_view kCompressionNames[] = {"none", "meshopt", "draco"};

// The choices as a user writes them; nullopt for choices that the user omits.
struct ChoiceTexts {
  std::optional<std::string_view> unit, up, compression;
};

struct ChoiceFault {
  std::string_view name;  // name of the choice: "unit", "up" or "compression"
  std::string wanted;     // a description of the allowed values
};

// Reads choices. Uses what is usual in the format for a choice that is not given. Fails if a text
// is not a valid choice, or if the format's standard demands another one.
tl::expected<ExportChoices, ChoiceFault> read_choices(const ChoiceTexts& texts, MeshFormat format);

// Checks that a model with the unit `model_unit` can be exported with these choices. Fails
// (kBadInput) if a unit is chosen but the unit of the model is unknown.
Expected<void> check_unit(const ExportChoices& choices, std::string_view model_unit);

// Returns the options of an export. `choices` and `model_unit` must outlive the result. Compressed
// files round positions to `grid`.
ExportOptions export_options(const ExportChoices& choices, MeshFormat format,
                             std::string_view model_unit, FileDescription about,
                             const ExportGrid& grid);

// Returns a note for the user, in the form "CAUSE; NEXT STEP", if the format prescribes or usually
// has a certain unit and the unit of the model is unknown. Otherwise returns an empty string.
std::string note_on_unknown_unit(MeshFormat format, std::string_view model_unit);

}  // namespace vitrine::server
