// SPDX-License-Identifier: Apache-2.0
// Rebuilds the mesh of a stored scan with other parameters or another calibration.
#pragma once

#include <functional>

#include "acquisition/session/processing.h"
#include "acquisition/session/scan_folder.h"

namespace vitrine::acquisition {

struct ReprocessOptions {
  Processing processing;
  int calibration = 0;  // number of the calibration; 0: the scan's own
  // Receives the share of the pictures done, 0 to 1. May be empty.
  std::function<void(double)> progress;
};

struct Reprocessed : ScannedSurface {
  int steps = 0;  // number of the scan's steps that the mesh was built from
  StripeCount stripe;
};

// Fails with kState if the scan's pictures are needed but were not kept. They are needed for
// another calibration than the scan's own, whose number is `own`, and for another stripe method.
Expected<void> check_pictures(const ScanRequest& scan, int own, const ReprocessOptions& options);

// Rebuilds the mesh from all steps on disk, even those of a cancelled scan. Fails for the same
// reasons as check_pictures(). Fails with kBadInput if the scan is done but steps are missing,
// because its journal is damaged.
Expected<Reprocessed> reprocess(const ScanFolder& folder, const std::filesystem::path& calibrations,
                                const ReprocessOptions& options);

}  // namespace vitrine::acquisition
