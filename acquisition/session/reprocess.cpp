// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/reprocess.h"

#include <fmt/format.h>

#include <utility>

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
  if (auto possible = fits(*calibration, record.camera, record.settings.region); !possible)
    return tl::unexpected(possible.error());
  return calibration;
}

// A scan that is done has all its steps.
Expected<void> check_journal(const ScanFolder& folder, int steps_there, int steps) {
  if (folder.state().state != ScanState::kDone || steps_there == steps) return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("{} holds {} of the {} steps of a scan that is done; restore it, or scan "
                          "again",
                          folder.journal().string(), steps_there, steps));
}

Expected<void> measure_again(std::vector<Profile>& profiles, const ScanFolder& folder,
                             const ScanRequest& request, const Calibration& calibration,
                             const ReprocessOptions& options) {
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const int step = static_cast<int>(i);
    const auto frames = folder.frames(step);
    if (!frames) return tl::unexpected(frames.error());
    auto measured =
        measure_profile(*frames, calibration, options.processing.stripe, angle_of(request, step));
    if (!measured) return tl::unexpected(measured.error());
    profiles[i] = std::move(measured->profile);
    if (options.progress)
      options.progress(static_cast<double>(i + 1) / static_cast<double>(profiles.size()));
  }
  return {};
}

}  // namespace

Expected<Reprocessed> reprocess(const ScanFolder& folder, const std::filesystem::path& calibrations,
                                const ReprocessOptions& options) {
  const auto record = folder.record();
  if (!record) return tl::unexpected(record.error());
  if (!*record) {
    return fail(ErrorCode::kState, fmt::format("there is no scan in {} any more; name another "
                                               "folder",
                                               folder.path().string()));
  }
  const ScanRequest& request = (*record)->request;
  const int number = options.calibration == 0 ? (*record)->calibration : options.calibration;
  const auto calibration = chosen(**record, calibrations, number);
  if (!calibration) return tl::unexpected(calibration.error());
  auto profiles = folder.profiles();
  if (!profiles) return tl::unexpected(profiles.error());
  const int steps = static_cast<int>(profiles->size());
  if (auto whole = check_journal(folder, steps, request.steps); !whole)
    return tl::unexpected(whole.error());
  const bool other_points =
      number != (*record)->calibration || options.processing.stripe != request.processing.stripe;
  if (other_points && !request.keep_frames) {
    return fail(ErrorCode::kState,
                fmt::format("{} needs the pictures of the scan, which were not kept; scan again "
                            "and keep the frames",
                            number != (*record)->calibration ? "another calibration"
                                                             : "another stripe method"));
  }
  if (other_points) {
    if (auto measured = measure_again(*profiles, folder, request, *calibration, options); !measured)
      return tl::unexpected(measured.error());
  }
  return mesh_of(*profiles, *calibration, options.processing).map([&](ScannedSurface surface) {
    return Reprocessed{{std::move(surface)}, steps};
  });
}

}  // namespace vitrine
