// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/reprocess.h"

#include "acquisition/calibration/calibration_store.h"
#include "acquisition/session/scan_calibration.h"

namespace vitrine {
namespace {

// The scan's own, or another of its camera and region.
Expected<Calibration> chosen(const ScanRecord& record, const std::filesystem::path& calibrations,
                             int number) {
  if (number == record.calibration) return calibration_of(record, calibrations);
  auto calibration = CalibrationStore(calibrations).load(number);
  if (!calibration) return calibration;
  if (auto possible = fits(*calibration, record); !possible)
    return tl::unexpected(possible.error());
  return calibration;
}

Expected<void> measure_again(std::vector<Profile>& profiles, const ScanFolder& folder,
                             const ScanRequest& request, const Calibration& calibration,
                             const StripeOptions& stripe) {
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const int step = static_cast<int>(i);
    const auto frames = folder.frames(step);
    if (!frames) return tl::unexpected(frames.error());
    auto measured = measure_profile(*frames, calibration, stripe, angle_of(request, step));
    if (!measured) return tl::unexpected(measured.error());
    profiles[i] = std::move(measured->profile);
  }
  return {};
}

}  // namespace

Expected<ScannedSurface> reprocess(const ScanFolder& folder,
                                   const std::filesystem::path& calibrations,
                                   const ReprocessOptions& options) {
  const auto record = folder.record();
  if (!record) return tl::unexpected(record.error());
  const ScanRequest& request = (*record)->request;
  const int number = options.calibration == 0 ? (*record)->calibration : options.calibration;
  const auto calibration = chosen(**record, calibrations, number);
  if (!calibration) return tl::unexpected(calibration.error());
  auto profiles = folder.profiles();
  if (!profiles) return tl::unexpected(profiles.error());
  const bool other_points =
      number != (*record)->calibration || options.processing.stripe != request.processing.stripe;
  if (other_points && !request.keep_frames) {
    return fail(ErrorCode::kState,
                "the pictures of this scan were not kept, so its stripes cannot be found anew; "
                "scan again and keep them");
  }
  if (other_points) {
    if (auto measured =
            measure_again(*profiles, folder, request, *calibration, options.processing.stripe);
        !measured)
      return tl::unexpected(measured.error());
  }
  return mesh_of(std::move(*profiles), *calibration, options.processing);
}

}  // namespace vitrine
