// SPDX-License-Identifier: Apache-2.0
// Writes the mesh of a scan to a file and reports its figures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "acquisition/session/scan_request.h"
#include "codec/export/write_mesh.h"
#include "server/cli/support/arguments.h"
#include "server/cli/support/outcome.h"

namespace vitrine::server::cli {

// Returns the mesh format for the extension of the file that -o names. Fails if the extension is
// not that of a format that can be written, or if check_output() fails.
tl::expected<MeshFormat, Fault> scan_output(const Arguments& arguments);

CommandOutcome write_scanned(const TriangleMesh& mesh, MeshFormat format, const std::string& out);

// Returns the figures of a scanned mesh. `stripe` has the totals over all pictures. `calibration`
// is the calibration's number, which identifies it.
nlohmann::json describe_scanned(const acquisition::ScannedSurface& surface,
                                const acquisition::StripeCount& stripe,
                                const acquisition::ScanRecord& record, int calibration,
                                const std::string& out);
std::string scanned_as_text(const nlohmann::json& description);

}  // namespace vitrine::server::cli
