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
  // Receives the share of the pictures processed so far, 0 to 1. May be empty.
  std::function<void(double)> progress;
};

struct Reprocessed : ScannedSurface {
  int steps = 0;  // number of steps from which the mesh was built
  StripeCount stripe;
};

// Checks whether the scan's pictures are needed. Fails with kState if they are needed but were not
// kept. Pictures are needed for another stripe method, or for another calibration than the scan's
// own, whose number is `own`.
Expected<void> check_pictures(const ScanRequest& scan, int own, const ReprocessOptions& options);

// Rebuilds the mesh from all steps on disk, even those of a cancelled scan. Fails for the same
// reasons as check_pictures(). Fails with kBadInput if the scan is done but steps are missing,
// because its journal is damaged.
Expected<Reprocessed> reprocess(const ScanFolder& folder, const std::filesystem::path& calibrations,
                                const ReprocessOptions& options);

}  // namespace vitrine::acquisition
