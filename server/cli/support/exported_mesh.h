// SPDX-License-Identifier: Apache-2.0
// Writes the mesh of a refined model, with its texture if the format holds one, for `decode` and
// `fetch`.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "codec/build/open_model.h"
#include "server/cli/support/arguments.h"
#include "server/cli/support/isolation.h"
#include "server/export/export_choices.h"
#include "server/export/export_kind.h"

namespace vitrine::server::cli {

// The command-line flag that read_texture_side() reads.
inline constexpr Flag kTextureFlag = {
    "--texture", "PIXELS",
    "largest width of the texture's pictures; 0: vertex colours instead; default: a size that fits "
    "the detail"};

// A sentence about the pictures for the commands' help texts.
inline constexpr FixedText kNoteOnCompanions = concatenate(
    "The pictures of a texture are in a .glb or .usdz, beside other files, or in a zip: OUT.{",
    kZipChoice, "}.");

// Reads kTextureFlag. Returns nullopt if the user gives no width.
tl::expected<std::optional<std::uint32_t>, Fault> read_texture_side(const Arguments& arguments);

// The command-line flags that read_export_choices() reads.
inline constexpr Flag kUnitInFileFlag = {
    "--unit", "mm|cm|m|in",
    "unit of OUT; default: mm for .stl and .3mf, m for .glb, .wrl and .usdz, the model's unit for "
    "the others"};
inline constexpr Flag kUpInFileFlag = {
    "--up", "y|z", "axis of OUT that points up; default: z for .stl and .3mf, y for the others"};

inline constexpr Flag kCompressionFlag = {
    "--compression", "none|meshopt|draco",
    "compression of a .glb, which rounds positions to the level's lattice; default: none"};

// Reads the three flags above.
tl::expected<ExportChoices, Fault> read_export_choices(const Arguments& arguments,
                                                       MeshFormat format);

// Reads the kind of an export from its file name. `others` lists other extensions that the command
// accepts, for the error message, such as ", .pmesh".
tl::expected<ExportKind, Fault> read_export_kind(const std::string& out,
                                                 std::string_view others = {});

// Returns the product of an export: the file `out`, and its companions unless it is a zip. The
// texture has the pictures with the given numbers. `pmesh` must contain these pictures, and the
// format must support their roles. The report has the members "faces", "vertices" and "pictures"
// (the number of pictures). If something could not be exported, it also has the member "note", with
// one line for each such fault. Fails (kBadInput) if check_unit() fails.
Expected<Product> exported_mesh(const Refiner& refiner, std::span<const std::uint8_t> pmesh,
                                ExportKind kind, const std::string& out,
                                std::span<const std::size_t> pictures,
                                const ExportChoices& choices);

// Returns the product of an export that has the originals of the texture instead of its display
// atlas. `out` must name a GLB, and `refiner` must be at full resolution. The report has the same
// members as that of exported_mesh().
Expected<Product> exported_originals(const Refiner& refiner, std::span<const std::uint8_t> pmesh,
                                     const std::string& out);

// Writes the product's file to `out` and its companions to the same folder. Adds the companions'
// names to the report, as the member "companions". Writes no file if the name of a companion is not
// one that an export to `out` has, or if check_output() refuses a companion.
Expected<void> write_export(const Arguments& arguments, const std::string& out, Product& product);

// Returns the names of the report's companions for a line of text: "" or ", with bust.mtl, ...".
std::string companions_as_text(const nlohmann::json& report);

}  // namespace vitrine::server::cli
