// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/sight_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/alignment/camera_place.h"

namespace vitrine::acquisition {
namespace {

Vec3 towards(const Vec3& from, const Vec3& to) {
  const Vec3 d = to - from;
  return d * (1 / length(d));
}

// Converts a position in the frame of the table's axis to a position in the object's frame.
Vec3 place(const Profile& profile, const TablePoint& at) {
  return position(profile, {.at = at});
}

void add_lines(std::vector<SightLine>& lines, const Profile& profile, const ProfilePoint& point,
               const std::optional<TablePoint>& camera) {
  const Vec3 at = position(profile, point);
  TablePoint laser = point.at;
  // Distance in mm between the laser and the axis if the camera's position is unknown. It is so
  // large that the line to the laser is horizontal.
  constexpr double kFar = 1e6;
  laser.rho = camera ? std::hypot(camera->rho, camera->lateral) : kFar;
  if (camera) laser.z = camera->z;
  lines.push_back({at, towards(at, place(profile, laser))});
  if (camera) lines.push_back({at, towards(at, place(profile, *camera))});
}

}  // namespace

std::vector<SightLine> sight_lines(std::span<const Profile> profiles,
                                   const Calibration& calibration, std::size_t count) {
  std::size_t points = 0, i = 0;
  for (const Profile& profile : profiles)
    points += profile.points.size();
  const std::size_t step = points / std::max<std::size_t>(count, 1) + 1;
  const auto camera = camera_place(calibration);
  std::vector<SightLine> lines;
  for (const Profile& profile : profiles) {
    for (const ProfilePoint& point : profile.points) {
      if (i++ % step == 0) add_lines(lines, profile, point, camera);
    }
  }
  return lines;
}

}  // namespace vitrine::acquisition
