// SPDX-License-Identifier: Apache-2.0
// The mesh of a scan as a file, and what is told of it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "acquisition/session/scan_request.h"
#include "codec/export/write_mesh.h"
#include "server/cli/outcome.h"

namespace vitrine::cli {

// The format that the name of `out` tells, where a mesh can be written there.
tl::expected<MeshFormat, Fault> scan_output(const std::string& out);

Outcome write_scanned(const TriangleMesh& mesh, MeshFormat format, const std::string& out);

// `stripe`: in all of its pictures; `calibration`: the number of the one that it was made with.
nlohmann::json describe_scanned(const ScannedSurface& surface, const StripeCount& stripe,
                                const ScanRecord& record, int calibration, const std::string& out);
std::string scanned_as_text(const nlohmann::json& description);

}  // namespace vitrine::cli
