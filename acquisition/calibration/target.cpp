// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/target.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

namespace vitrine::acquisition {
namespace {

constexpr int kMostSquares = 64;
constexpr std::size_t kLeastCorners = 8;

struct Dictionary {
  const char* name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME id;
  int markers;
};

constexpr Dictionary kDictionaries[] = {
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50, 50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100, 100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250, 250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000, 1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50, 50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100, 100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250, 250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000, 1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50, 50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100, 100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250, 250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000, 1000},
};

const Dictionary* dictionary_of(const std::string& name) {
  const auto* found = std::ranges::find(kDictionaries, name, &Dictionary::name);
  return found == std::end(kDictionaries) ? nullptr : found;
}

Unexpected bad(const std::string& what) {
  return fail(ErrorCode::kBadInput, what + "; describe the target as it was printed");
}

// Returns advice on the exposure, or an empty string if the brightness is fine.
const char* light_of(const Frame& frame) {
  const double pixels = static_cast<double>(frame.pixels.size());
  const auto saturated = std::ranges::count(frame.pixels, 255);
  if (static_cast<double>(saturated) > 0.2 * pixels) return "lower the exposure, ";
  const auto bright = std::ranges::count_if(frame.pixels, [](int grey) { return grey >= 40; });
  return static_cast<double>(bright) < 0.02 * pixels ? "raise the exposure or light the target, "
                                                     : "";
}

// Returns whether the corners determine the board's pose. Corners in one row or one column do not.
bool tells_pose(const std::vector<int>& ids, int columns) {
  std::set<int> rows_seen, columns_seen;
  for (int id : ids) {
    rows_seen.insert(id / columns);
    columns_seen.insert(id % columns);
  }
  return ids.size() >= kLeastCorners && rows_seen.size() > 1 && columns_seen.size() > 1;
}

// Returns the distance, in pixels, between the two closest corners.
double spacing(const std::vector<cv::Point2f>& corners) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, cv::norm(corners[i] - corners[j]));
  }
  return least;
}

// Refines the corners in windows as large as the white margin around the markers allows.
// interpolateCornersCharuco() uses smaller windows, which shift corners by half a pixel.
void refine(const cv::Mat& image, const CharucoTarget& t, std::vector<cv::Point2f>& corners) {
  constexpr int kLeastWindow = 3, kMostWindow = 12;
  const double white = spacing(corners) * (t.square_mm - t.marker_mm) / (2 * t.square_mm);
  const int half = std::clamp(static_cast<int>(white), kLeastWindow, kMostWindow);
  cv::cornerSubPix(image, corners, {half, half}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-4));
}

}  // namespace

Expected<void> check_target(const CharucoTarget& t) {
  if (t.squares_x < 3 || t.squares_y < 3 || t.squares_x > kMostSquares ||
      t.squares_y > kMostSquares) {
    return bad(
        fmt::format("a target of {} x {} squares is not supported: 3 to {} in each direction",
                    t.squares_x, t.squares_y, kMostSquares));
  }
  const bool sizes = std::isfinite(t.square_mm) && t.marker_mm > 0 && t.marker_mm < t.square_mm;
  if (!sizes) {
    return bad(
        fmt::format("a target with squares of {} mm and markers of {} mm is impossible: "
                    "markers are smaller than squares",
                    t.square_mm, t.marker_mm));
  }
  const Dictionary* dictionary = dictionary_of(t.dictionary);
  if (dictionary == nullptr) {
    return bad(fmt::format(
        "the dictionary \"{}\" is unknown: DICT_4X4_, DICT_5X5_ and DICT_6X6_ with 50, 100, "
        "250 or 1000 are known",
        t.dictionary));
  }
  if (t.squares_x * t.squares_y / 2 > dictionary->markers) {
    return bad(fmt::format("{} has {} markers, too few for {} x {} squares", t.dictionary,
                           dictionary->markers, t.squares_x, t.squares_y));
  }
  return {};
}

TargetPoint corner_on(const CharucoTarget& t, int id) {
  const int columns = t.squares_x - 1;
  const int column = id % columns + 1, row = id / columns + 1;
  return {column * t.square_mm, row * t.square_mm};
}

Expected<TargetView> find_target(const Frame& frame, const CharucoTarget& t) {
  if (auto ok = check_target(t); !ok) return tl::unexpected(ok.error());
  const auto dictionary = cv::aruco::getPredefinedDictionary(dictionary_of(t.dictionary)->id);
  const auto board =
      cv::aruco::CharucoBoard::create(t.squares_x, t.squares_y, static_cast<float>(t.square_mm),
                                      static_cast<float>(t.marker_mm), dictionary);
  const cv::Mat image(frame.height, frame.width, CV_8U,
                      const_cast<std::uint8_t*>(frame.pixels.data()));
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> marker_ids, ids;
  std::vector<cv::Point2f> corners;
  cv::aruco::detectMarkers(image, dictionary, markers, marker_ids);
  if (!marker_ids.empty()) {
    cv::aruco::interpolateCornersCharuco(markers, marker_ids, image, board, corners, ids);
  }
  if (!tells_pose(ids, t.squares_x - 1)) {
    return fail(
        ErrorCode::kBadInput,
        fmt::format("the target is not seen: {} of {} markers and {} of {} corners found; {}place "
                    "it in view of the camera, turned less than 60 degrees from it, and check that "
                    "its squares and dictionary are described as printed",
                    marker_ids.size(), t.squares_x * t.squares_y / 2, ids.size(),
                    (t.squares_x - 1) * (t.squares_y - 1), light_of(frame)));
  }
  refine(image, t, corners);
  TargetView view{.ids = std::move(ids), .corners = {}};
  for (const cv::Point2f& corner : corners)
    view.corners.push_back({corner.x, corner.y});
  return view;
}

}  // namespace vitrine::acquisition
