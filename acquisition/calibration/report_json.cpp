// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "acquisition/calibration/report.h"

namespace vitrine::acquisition {

using Json = nlohmann::ordered_json;

namespace {

Json json_of(const ResidualSummary& r) {
  return {{"rms", r.rms}, {"p95", r.p95}, {"max", r.max}};
}

}  // namespace

double CalibrationReport::stray_share() const {
  const std::size_t all = points + strays;
  return all == 0 ? 0 : static_cast<double>(strays) / static_cast<double>(all);
}

std::string report_json(const Calibration& calibration, const CalibrationReport& report) {
  Json degrees = Json::array();
  for (const DegreeResult& d : report.degrees) {
    degrees.push_back(
        {{"degree", d.degree}, {"condition", d.condition}, {"residuals_mm", json_of(d.residuals)}});
  }
  const Coverage& c = report.coverage;
  const SensorRegion& r = calibration.region;
  const TurntableAxis& axis = calibration.axis;
  const Json all = {
      {"number", calibration.number},
      {"created", calibration.created},
      {"camera", calibration.camera},
      {"region", {{"x", r.x}, {"y", r.y}, {"width", r.width}, {"height", r.height}}},
      {"degree", calibration.map.degree()},
      {"pictures", report.pictures},
      {"points", report.points},
      {"strays", report.strays},
      {"stray_share", report.stray_share()},
      {"unclear_pictures", report.unclear},
      {"residuals_mm", json_of(report.residuals)},
      {"noise_mm", calibration.noise},
      {"reprojection_pixels", report.reprojection},
      {"table_error_degrees", report.table_error},
      {"axis",
       {{"a", axis.a},
        {"b", axis.b},
        {"offset", axis.offset},
        {"tilt", axis.tilt},
        {"clockwise", axis.is_clockwise}}},
      {"coverage",
       {{"image", c.image_share}, {"x_mm", {c.x_low, c.x_high}}, {"y_mm", {c.y_low, c.y_high}}}},
      {"degrees", degrees}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace vitrine::acquisition
