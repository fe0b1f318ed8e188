// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/starts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/session/json_members.h"
#include "codec/files/read_file.h"

namespace vitrine::server::cli {
namespace {

constexpr double kFarthest = 1e6;  // largest coordinate, in mm

Vec3 vector_in(acquisition::JsonMembers& root, std::string_view key) {
  auto members = root.object(key, {"x", "y", "z"});
  const auto coordinate = [&](const char* name) {
    return members.number(name, -kFarthest, kFarthest, 0);
  };
  const Vec3 vector = {coordinate("x"), coordinate("y"), coordinate("z")};
  root.adopt(members);
  return vector;
}

// Returns the rotation matrix by Rodrigues' formula. `axis` has length 1.
std::array<Vec3, 3> turned(const Vec3& axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const auto row = [&](const Vec3& unit, double along) {
    return unit * c + cross(unit, axis) * s + axis * (along * (1 - c));
  };
  return {row({1, 0, 0}, axis.x), row({0, 1, 0}, axis.y), row({0, 0, 1}, axis.z)};
}

Expected<RigidMotion> motion_of(const nlohmann::json& value, const std::string& place) {
  acquisition::JsonMembers members(value, place, {"axis", "degrees", "shift"});
  const Vec3 axis = vector_in(members, "axis");
  const double degrees = members.number("degrees", -360, 360, 0), size = length(axis);
  RigidMotion motion{.shift = vector_in(members, "shift")};
  if (degrees != 0 && !(size > 0)) members.fault("axis", "must be the axis of the rotation");
  if (auto checked = members.check(); !checked) return tl::unexpected(checked.error());
  if (size > 0) motion.rows = turned(axis * (1 / size), degrees);
  return motion;
}

}  // namespace

Expected<std::vector<RigidMotion>> parse_starts(std::string_view text, const std::string& place) {
  const auto object = acquisition::parse_json_object(text, place);
  if (!object) return tl::unexpected(object.error());
  acquisition::JsonMembers members(*object, place, {"starts"});
  const auto list = object->find("starts");
  const bool usable =
      list != object->end() && list->is_array() &&
      std::all_of(list->begin(), list->end(), [](const auto& item) { return item.is_object(); });
  if (!usable)
    members.fault("starts", "must be an array of objects, one for each scan but the first");
  if (auto checked = members.check(); !checked) return tl::unexpected(checked.error());
  std::vector<RigidMotion> starts(1);
  for (const auto& item : *list) {
    const auto motion = motion_of(item, fmt::format("{}: start {}", place, starts.size()));
    if (!motion) return tl::unexpected(motion.error());
    starts.push_back(*motion);
  }
  return starts;
}

Expected<std::vector<RigidMotion>> read_starts(const std::string& path) {
  const auto bytes = read_file(path, acquisition::kMaxJsonBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_starts({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path);
}

}  // namespace vitrine::server::cli
