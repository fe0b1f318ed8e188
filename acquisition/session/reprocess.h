// SPDX-License-Identifier: Apache-2.0
// A scan's mesh made anew, with other parameters or another calibration.
#pragma once

#include <functional>

#include "acquisition/session/processing.h"
#include "acquisition/session/scan_folder.h"

namespace vitrine {

struct ReprocessOptions {
  Processing processing;
  int calibration = 0;                   // number; 0: the scan's own
  std::function<void(double)> progress;  // 0..1 of the pictures; may be empty
};

struct Reprocessed : ScannedSurface {
  int steps = 0;  // that it is made of
  StripeCount stripe;
};

// Of a scan with calibration number `own`: another calibration, and another way to find the stripe,
// need its pictures. Fails (kState) where they were not kept.
Expected<void> check_pictures(const ScanRequest& scan, int own, const ReprocessOptions& options);

// Of all steps that are on disk, also of a scan that was cancelled. Fails as check_pictures(), and
// (kBadInput) where the scan is done and yet steps are missing: its journal is damaged.
Expected<Reprocessed> reprocess(const ScanFolder& folder, const std::filesystem::path& calibrations,
                                const ReprocessOptions& options);

}  // namespace vitrine
