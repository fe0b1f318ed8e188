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
  std::string unit;  // one of kLengthUnits; empty: by the format's custom
  UpAxis up = UpAxis::kY;
  Compression compression = Compression::kNone;
};

// The names of compressions, in the order of Compression.
inline constexpr std::string_view kCompressionNames[] = {"none", "meshopt", "draco"};

// The choices as a user writes them; nullopt: not given.
struct ChoiceTexts {
  std::optional<std::string_view> unit, up, compression;
};

struct ChoiceFault {
  std::string_view name;  // name of the choice: "unit", "up" or "compression"
  std::string wanted;     // a description of what it may be
};

// Reads choices. A choice that is not given is by the format's custom. Fails if a choice is none,
// or if the format's standard demands another one.
tl::expected<ExportChoices, ChoiceFault> read_choices(const ChoiceTexts& texts, MeshFormat format);

// Whether a model with this unit can be exported with these choices. Fails (kBadInput) if a unit is
// chosen and that of the model is unknown.
Expected<void> check_unit(const ExportChoices& choices, std::string_view model_unit);

// Returns the options of an export. `choices` and `model_unit` must outlive them.
// Compressed files round positions to `grid`.
ExportOptions export_options(const ExportChoices& choices, MeshFormat format,
                             std::string_view model_unit, FileDescription about,
                             const ExportGrid& grid);

// Returns a note for the user, "CAUSE; NEXT STEP", if the format has a unit by its standard or
// custom, and that of the model is unknown. Otherwise, returns an empty string.
std::string note_on_unknown_unit(MeshFormat format, std::string_view model_unit);

}  // namespace vitrine::server
