// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/calibration_store.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>

#include "acquisition/calibration/calibration_json.h"
#include "codec/files/atomic_file.h"

namespace vitrine::acquisition {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = 1 << 20;

std::string text_of(const SensorRegion& r) {
  return fmt::format("{}x{}+{}+{}", r.width, r.height, r.x, r.y);
}

// Returns the calibration's number, or 0 if `path` is not the name of a calibration file.
int number_of(const fs::path& path) {
  const std::string stem = path.stem().string();
  int number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool whole = error == std::errc() && end == stem.data() + stem.size() && number > 0;
  return whole && path.filename() == fmt::format("{:04}.json", number) ? number : 0;
}

}  // namespace

fs::path CalibrationStore::file_of(int number) const {
  return folder_ / fmt::format("{:04}.json", number);
}

Expected<std::vector<int>> CalibrationStore::numbers() const {
  std::error_code error;
  std::vector<int> all;
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    if (const int number = number_of(it->path()); number > 0) all.push_back(number);
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot list {}: {}; check the folder's name and permissions",
                            folder_.string(), error.message()));
  }
  std::ranges::sort(all);
  return all;
}

Expected<Calibration> CalibrationStore::add(Calibration calibration) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    return fail(ErrorCode::kIo, fmt::format("cannot create {}: {}; {}", folder_.string(),
                                            error.message(), next_step(error.value())));
  }
  const auto taken = numbers();
  if (!taken) return tl::unexpected(taken.error());
  for (calibration.number = taken->empty() ? 1 : taken->back() + 1;; ++calibration.number) {
    const fs::path file = file_of(calibration.number);
    const std::string text = to_json(calibration);
    if (auto read = calibration_from_json(text, "the new calibration"); !read) return read;
    const auto created = create_file_atomically(
        file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    if (!created) return tl::unexpected(created.error());
    if (*created) return calibration;
  }
}

Expected<Calibration> CalibrationStore::load(int number) const {
  const fs::path file = file_of(number);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  if (error || !in) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot read {}; run `vitrine calibrate` for a new calibration",
                            file.string()));
  }
  if (size > kMostBytes) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{} is too large for a calibration ({} bytes); remove it and calibrate "
                            "again",
                            file.string(), size));
  }
  std::string text(static_cast<std::size_t>(size), '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(in.gcount()));
  auto calibration = calibration_from_json(text, file.string());
  if (calibration && calibration->number != number) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{} contains calibration {}: the file was renamed; restore its name",
                            file.string(), calibration->number));
  }
  return calibration;
}

Expected<Calibration> CalibrationStore::for_camera(const std::string& serial,
                                                   const SensorRegion& region) const {
  const auto all = numbers();
  if (!all) return tl::unexpected(all.error());
  std::string other_region, other_camera;
  std::optional<Error> damaged;
  for (auto number = all->rbegin(); number != all->rend(); ++number) {
    auto calibration = load(*number);
    if (!calibration) {
      if (!damaged) damaged = calibration.error();
      continue;
    }
    if (calibration->camera == serial && calibration->region == region) return calibration;
    std::string& other = calibration->camera == serial ? other_region : other_camera;
    if (!other.empty()) continue;
    other = calibration->camera == serial ? text_of(calibration->region) : calibration->camera;
  }
  if (damaged) return tl::unexpected(*damaged);
  if (!other_region.empty()) {
    return fail(ErrorCode::kState,
                fmt::format("camera {} is calibrated for the region {}, not for {}; set that "
                            "region, or run `vitrine calibrate`",
                            serial, other_region, text_of(region)));
  }
  if (!other_camera.empty()) {
    return fail(
        ErrorCode::kState,
        fmt::format("camera {} is not calibrated, {} has calibrations of camera {}; connect "
                    "that camera, or run `vitrine calibrate`",
                    serial, folder_.string(), other_camera));
  }
  return fail(ErrorCode::kState, fmt::format("there is no calibration in {}; run `vitrine "
                                             "calibrate` before a scan",
                                             folder_.string()));
}

}  // namespace vitrine::acquisition
