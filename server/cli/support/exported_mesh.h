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
#include "server/export/placed_mesh.h"

namespace vitrine::server::cli {

// The command-line flag that read_texture_side() reads.
inline constexpr Flag kTextureFlag = {
    "--texture", "PIXELS",
    "largest width of the texture's pictures; 0: vertex colours instead; default: a size that fits "
    "the detail"};

// A sentence about the pictures for the commands' help texts.
inline constexpr FixedText kNoteOnCompanions =
    concatenate("A .glb or .usdz contains the pictures of the texture. A .",
                join(kZipFormats, extension_of_format, ", .", " or ."),
                " has them in files beside it; if OUT ends in ", kZipExtensions,
                ", it is a zip of all these files. Other formats have none.");

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

inline constexpr Flag kLodFlag = {
    "--lod", "none|msft",
    "msft: a .glb that also holds coarser levels, for programs that know the "
    "glTF extension MSFT_lod; default: none"};

// Reads the four flags above.
tl::expected<ExportChoices, Fault> read_export_choices(const Arguments& arguments,
                                                       MeshFormat format);

// Reads the kind of an export from its file name. `others` lists other extensions that the command
// accepts, for the error message, such as ", .pmesh".
tl::expected<ExportKind, Fault> read_export_kind(const std::string& out,
                                                 std::string_view others = {});

// The command-line flag that name_of_output() reads.
inline constexpr std::string_view kOutputFormat = "--format",
                                  kOutputFormatHelp = "with -o -: format of the output";

// Returns the file name whose extension determines the kind of the output. For standard output, the
// extension is the value of kOutputFormat: an export kind or `other`.
tl::expected<std::string, Fault> name_of_output(const Arguments& arguments,
                                                std::string_view other = {});

// Returns the product of an export: the file `out`, and its companions unless it is a zip. The
// mesh is turned and scaled by `placement`. The texture has the pictures with the given numbers.
// `pmesh` must contain these pictures, and the format must support their roles. The report has the
// members "faces", "vertices" and "pictures" (the number of pictures). If something could not be
// exported, the report also has the member "note", with one line for each part that is missing.
// Fails (kBadInput) if check_unit() fails.
Expected<Product> exported_mesh(
    const Refiner& refiner, std::span<const std::uint8_t> pmesh, ExportKind kind,
    const std::string& out, std::span<const std::size_t> pictures, const ExportChoices& choices,
    const PresentationTransform& placement = PresentationTransform(Presentation{}));

// Returns the product of an export that has the originals of the texture (the source's own
// materials and pictures) instead of the display atlas. `out` must name a GLB, and `refiner` must
// be at full resolution. The report has the same members as the report of exported_mesh().
Expected<Product> exported_originals(const Refiner& refiner, std::span<const std::uint8_t> pmesh,
                                     const std::string& out);

// Writes the product's file to `out` and its companions to the same folder. Adds the companions'
// names to the report, as the member "companions". Writes no file if a companion's name is not
// among those that an export to `out` can have, or if check_output() refuses a companion.
Expected<void> write_export(const Arguments& arguments, const std::string& out, Product& product);

// Writes the product to the file that -o names, together with its companions (write_export()). If
// -o is "-", writes the product to standard output, and fails if it has companions.
CommandOutcome write_export_or_stdout(const Arguments& arguments, Product& product);

// Returns the names of the report's companions for a line of text: "" or ", with bust.mtl, ...".
std::string companions_as_text(const nlohmann::json& report);

}  // namespace vitrine::server::cli
