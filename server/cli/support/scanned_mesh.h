// SPDX-License-Identifier: Apache-2.0
// Writes the mesh of a scan to a file and describes the mesh.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "acquisition/session/scan_request.h"
#include "codec/export/write_mesh.h"
#include "server/cli/support/arguments.h"
#include "server/cli/support/outcome.h"

namespace vitrine::server::cli {

// Returns the mesh format for the extension of the file that -o names. Fails if no format with this
// extension can be written, or if check_output() fails.
tl::expected<MeshFormat, Fault> scan_output(const Arguments& arguments);

CommandOutcome write_scanned(const TriangleMesh& mesh, MeshFormat format, const std::string& out);

// Describes a scanned mesh: its numbers of vertices, faces and points, and the quality of the
// pictures. `stripe` is the sum of the row counts of all pictures. `calibration` is the number that
// identifies the calibration.
nlohmann::json describe_scanned(const acquisition::ScannedSurface& surface,
                                const acquisition::StripeCount& stripe,
                                const acquisition::ScanRecord& record, int calibration,
                                const std::string& out);
std::string scanned_as_text(const nlohmann::json& description);

}  // namespace vitrine::server::cli
