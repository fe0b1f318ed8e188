// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/reprocess.h"

#include <fmt/format.h>

#include <utility>

#include "acquisition/calibration/calibration_store.h"
#include "acquisition/session/scan_calibration.h"

namespace vitrine::acquisition {
namespace {

// Returns calibration number `number`. It may be the scan's own calibration or another one for the
// same camera and region.
Expected<Calibration> chosen(const ScanRecord& record, const std::filesystem::path& calibrations,
                             int number) {
  if (number == record.calibration) return calibration_of(record, calibrations);
  auto calibration = CalibrationStore(calibrations).load(number);
  if (!calibration) return calibration;
  if (auto possible = fits(*calibration, record.camera, record.settings.region); !possible)
    return tl::unexpected(possible.error());
  return calibration;
}

// Fails if the scan is done but its journal lacks steps.
Expected<void> check_journal(const ScanFolder& folder, int steps_there, int steps) {
  if (folder.state().state != ScanState::kDone || steps_there == steps) return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("{} contains {} of the {} steps of a completed scan; restore it, or scan "
                          "again",
                          folder.journal().string(), steps_there, steps));
}

// Returns a description of the first option for which the points must be measured again from the
// pictures. Returns null if there is no such option.
const char* other_points(const ScanRequest& scan, int own, const ReprocessOptions& options) {
  if (options.calibration != 0 && options.calibration != own) return "another calibration";
  return options.processing.stripe == scan.processing.stripe ? nullptr : "another stripe method";
}

Expected<void> measure_again(JournalContents& scan, const ScanFolder& folder,
                             const ScanRequest& request, const Calibration& calibration,
                             const ReprocessOptions& options) {
  const std::size_t steps = scan.profiles.size();
  for (std::size_t i = 0; i < steps; ++i) {
    const int step = static_cast<int>(i);
    const auto frames = folder.frames(step);
    if (!frames) return tl::unexpected(frames.error());
    auto measured =
        measure_profile(*frames, calibration, options.processing.stripe, angle_of(request, step));
    if (!measured) return tl::unexpected(measured.error());
    scan.profiles[i] = std::move(measured->profile);
    scan.stripes[i] = measured->stripe;
    if (options.progress) options.progress(static_cast<double>(i + 1) / static_cast<double>(steps));
  }
  return {};
}

}  // namespace

Expected<void> check_pictures(const ScanRequest& scan, int own, const ReprocessOptions& options) {
  const char* what = other_points(scan, own, options);
  if (what == nullptr || scan.keeps_frames) return {};
  return fail(ErrorCode::kState, fmt::format("{} needs the pictures of the scan, which were not "
                                             "kept; scan again and keep the frames",
                                             what));
}

Expected<Reprocessed> reprocess(const ScanFolder& folder, const std::filesystem::path& calibrations,
                                const ReprocessOptions& options) {
  const auto record = folder.record();
  if (!record) return tl::unexpected(record.error());
  if (!*record) {
    return fail(ErrorCode::kState, fmt::format("there is no scan in {}; name another "
                                               "folder",
                                               folder.path().string()));
  }
  const ScanRequest& request = (*record)->request;
  const int number = options.calibration == 0 ? (*record)->calibration : options.calibration;
  const auto calibration = chosen(**record, calibrations, number);
  if (!calibration) return tl::unexpected(calibration.error());
  auto scan = folder.measured();
  if (!scan) return tl::unexpected(scan.error());
  const int steps = static_cast<int>(scan->profiles.size());
  if (auto whole = check_journal(folder, steps, request.steps); !whole)
    return tl::unexpected(whole.error());
  if (auto kept = check_pictures(request, (*record)->calibration, options); !kept)
    return tl::unexpected(kept.error());
  if (other_points(request, (*record)->calibration, options) != nullptr) {
    if (auto measured = measure_again(*scan, folder, request, *calibration, options); !measured)
      return tl::unexpected(measured.error());
  }
  auto surface = mesh_of(scan->profiles, *calibration, options.processing);
  if (!surface) return tl::unexpected(surface.error());
  return Reprocessed{{std::move(*surface)}, steps, sum(scan->stripes)};
}

}  // namespace vitrine::acquisition
