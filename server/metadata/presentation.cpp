// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/presentation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "codec/core/sha256.h"
#include "server/metadata/members.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::json;

constexpr double kRounding = 1e-9;  // difference from 0 or 1 that rounding explains

// Rounds an entry of a rotation matrix to 0, 1 or -1 if only rounding keeps it from that.
double rounded_entry(double entry) {
  const double whole = std::round(entry);
  return std::abs(entry - whole) < kRounding ? whole + 0.0 : entry;
}

void read_rotation(const JsonMembers& members, std::array<double, 4>& rotation) {
  const Json* given = members.find("rotation");
  if (given == nullptr) return;
  auto q = given->is_null() ? Presentation{}.rotation
                            : json_numbers<4>(*given, 1.01).value_or(std::array<double, 4>{});
  double norm = 0;
  for (const double part : q)
    norm += part * part;
  norm = std::sqrt(norm);
  if (!(std::abs(norm - 1) < 0.01))
    return members.wrong("rotation", "a unit quaternion: four numbers x, y, z, w of length 1");
  if (std::abs(norm - 1) < kRounding) norm = 1;  // keeps the numbers as they were given
  for (double& part : q)
    part = (q[3] < 0 ? -part : part) / norm + 0.0;
  rotation = q;
}

void read_view(const JsonMembers& members, PresentedView& view) {
  constexpr PresentedView kUsual;
  members.only({"azimuth", "elevation", "zoom", "target"});
  members.real("azimuth", -360, 360, kUsual.azimuth, view.azimuth);
  members.real("elevation", -90, 90, kUsual.elevation, view.elevation);
  members.real("zoom", 0.1, 100, kUsual.zoom, view.zoom);
  const Json* target = members.find("target");
  if (target == nullptr) return;
  view.target = json_point(*target);
  if (!view.target && !target->is_null())
    members.wrong("target", "three numbers x, y, z, or null for the centre of the model");
}

void read_light(const JsonMembers& members, PresentedLight& light) {
  members.only({"preset", "angle"});
  members.real("angle", 0, 360, PresentedLight{}.angle, light.angle);
  const Json* preset = members.find("preset");
  const auto* name = preset != nullptr ? preset->get_ptr<const std::string*>() : nullptr;
  if (name != nullptr) light.preset = *name;
  if (std::ranges::find(kLightPresets, light.preset) == std::end(kLightPresets) ||
      (preset != nullptr && name == nullptr))
    members.wrong("preset", fmt::format("one of {}", fmt::join(kLightPresets, ", ")));
}

void read_box(const JsonMembers& members, std::optional<Bounds>& box) {
  const Json* given = members.find("turned_box");
  const auto corners = given != nullptr ? json_numbers<6>(*given, 1e300) : std::nullopt;
  if (!corners) return;
  const auto& c = *corners;
  box = Bounds{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
}

nlohmann::ordered_json triple(const Vec3& p) {
  return nlohmann::ordered_json::array({p.x, p.y, p.z});
}

nlohmann::ordered_json view_json(const std::optional<PresentedView>& view) {
  if (!view) return nullptr;
  return {{"azimuth", view->azimuth},
          {"elevation", view->elevation},
          {"zoom", view->zoom},
          {"target", view->target ? triple(*view->target) : nullptr}};
}

}  // namespace

bool Presentation::operator==(const Presentation& other) const {
  const auto corners = [](const Presentation& p) {
    return p.turned_box ? std::optional(std::pair(p.turned_box->low, p.turned_box->high))
                        : std::nullopt;
  };
  return rotation == other.rotation && scale == other.scale && view == other.view &&
         poster == other.poster && light == other.light && corners(*this) == corners(other);
}

PresentationTransform::PresentationTransform(const Presentation& presentation)
    : scale_(presentation.scale) {
  const auto [x, y, z, w] = presentation.rotation;
  rows_ = {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           Vec3{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           Vec3{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (Vec3& row : rows_)
    row = {rounded_entry(row.x), rounded_entry(row.y), rounded_entry(row.z)};
}

bool PresentationTransform::keeps_axes() const {
  return std::ranges::all_of(rows_, [](const Vec3& row) {
    return std::max({std::abs(row.x), std::abs(row.y), std::abs(row.z)}) == 1;
  });
}

Bounds PresentationTransform::of(const Bounds& box) const {
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] =
        (*this)({(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                 (i & 4) != 0 ? box.high.z : box.low.z});
  }
  return bounds_of(corners);
}

Bounds presented_box(const Presentation& presentation, const Bounds& file) {
  const PresentationTransform placement(presentation);
  if (!presentation.turned_box) return placement.of(file);
  return {presentation.turned_box->low * placement.scale(),
          presentation.turned_box->high * placement.scale()};
}

Vec3 direction_of(const PresentedView& view) {
  constexpr double kRadians = std::numbers::pi / 180;
  constexpr double kSteepest = 89.9;  // at 90 degrees, the view would have no upward direction
  const double up = std::clamp(view.elevation, -kSteepest, kSteepest) * kRadians;
  const double around = view.azimuth * kRadians;
  return {std::cos(up) * std::sin(around), std::sin(up), std::cos(up) * std::cos(around)};
}

void read_presentation(const Json& patch, Presentation& presentation, const WrongField& wrong,
                       bool is_stored) {
  if (patch.is_null()) return void(presentation = {});
  if (!patch.is_object()) return wrong("", "an object or null");
  const JsonMembers members(patch, "", wrong);
  if (is_stored)
    read_box(members, presentation.turned_box);
  else
    members.only({"rotation", "scale", "view", "poster", "light"});
  read_rotation(members, presentation.rotation);
  members.real("scale", 1e-9, 1e9, 1, presentation.scale);
  members.object("view", presentation.view, read_view);
  members.object("poster", presentation.poster, read_view);
  members.object("light", presentation.light, read_light);
}

nlohmann::ordered_json to_json(const Presentation& presentation) {
  nlohmann::ordered_json light;
  if (presentation.light)
    light = {{"preset", presentation.light->preset}, {"angle", presentation.light->angle}};
  return {{"rotation", presentation.rotation},
          {"scale", presentation.scale},
          {"view", view_json(presentation.view)},
          {"poster", view_json(presentation.poster)},
          {"light", std::move(light)}};
}

std::string client_text(const Presentation& presentation, std::uint64_t notes) {
  if (presentation.is_default() && notes == 0) return {};
  nlohmann::ordered_json json = to_json(presentation);
  if (notes > 0) json["notes"] = notes;
  return json.dump();
}

std::string key_of(const Presentation& presentation) {
  const std::string text = to_json(presentation).dump();
  return to_hex(sha256({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}))
      .substr(0, 16);
}

std::string stored_text(const Presentation& presentation) {
  if (presentation.is_default()) return {};
  nlohmann::ordered_json json = to_json(presentation);
  if (const auto& box = presentation.turned_box)
    json["turned_box"] = {box->low.x,  box->low.y,  box->low.z,
                          box->high.x, box->high.y, box->high.z};
  return json.dump();
}

Presentation from_stored_text(const std::string& text) {
  Presentation presentation;
  if (text.empty()) return presentation;
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  bool is_good = json.is_object();
  if (is_good) {
    read_presentation(
        json, presentation, [&](const auto&, const auto&) { is_good = false; },
        /*is_stored=*/true);
  }
  return is_good ? presentation : Presentation{};
}

}  // namespace vitrine::server
