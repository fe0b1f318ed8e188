// SPDX-License-Identifier: Apache-2.0
// How a model is presented: set upright, scaled to its unit, and shown in a chosen view and light.
// The catalogue stores this beside the model, so that it can be changed without a new build. The
// model's file keeps the coordinates of its source.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "codec/core/bounds.h"

namespace vitrine::server {

// A view of a presented model.
struct PresentedView {
  // Direction from the model to the eye in degrees. Azimuth 0 is the front (z), azimuth 90 is the
  // right side (x), elevation 90 is above (y).
  double azimuth = 19.29, elevation = 8.06;  // the viewer's first view if none was chosen
  double zoom = 1;                           // 1: the whole model fills the view
  // The point in the middle of the view; nullopt stands for the centre of the model.
  std::optional<Vec3> target = {};
  bool operator==(const PresentedView&) const = default;
};

struct PresentedLight {
  std::string preset;  // one of kLightPresets
  double angle = 315;  // direction of raking light, in degrees clockwise from the top
  bool operator==(const PresentedLight&) const = default;
};

// The presets that visitors can choose, too. "museum" is the default, so it is not stored.
inline constexpr std::string_view kLightPresets[] = {"studio", "raking", "relief"};

struct Presentation {
  // Unit quaternion x, y, z, w: turns the model from the coordinates of its file so that y points
  // up.
  std::array<double, 4> rotation = {0, 0, 0, 1};
  double scale = 1;  // factor from the coordinates of the file to the model's unit
  std::optional<PresentedView> view = {};
  std::optional<PresentedView> poster = {};  // nullopt: posters show `view`
  std::optional<PresentedLight> light = {};
  // The bounding box of the vertices after the rotation, before the scaling. Set unless the
  // rotation consists of quarter turns, because the box of the file then does not determine this
  // box.
  std::optional<Bounds> turned_box = {};

  bool is_default() const { return *this == Presentation{}; }
  bool operator==(const Presentation&) const;
};

// Turns and scales points from the coordinates of the file.
class PresentationTransform {
 public:
  explicit PresentationTransform(const Presentation& presentation);

  // Whether the placement moves no point.
  bool is_identity() const { return *this == PresentationTransform(Presentation{}); }
  // Whether the axes of the file become axes again, so that boxes stay exact.
  bool keeps_axes() const;

  double scale() const { return scale_; }
  Vec3 turned(const Vec3& p) const {
    return {dot(rows_[0], p), dot(rows_[1], p), dot(rows_[2], p)};
  }
  Vec3 operator()(const Vec3& p) const { return turned(p) * scale_; }
  // Returns the bounding box of the placed corners of `box`.
  Bounds of(const Bounds& box) const;

  bool operator==(const PresentationTransform&) const = default;

 private:
  std::array<Vec3, 3> rows_;  // of the rotation matrix
  double scale_;
};

// Returns the bounding box of the presented model; `file` is the box in the coordinates of the
// file.
Bounds presented_box(const Presentation& presentation, const Bounds& file);

// Returns the unit direction from the model to the eye.
Vec3 direction_of(const PresentedView& view);

// Receives the name of a wrong field, such as "view.zoom", and a description of its values.
using WrongField = std::function<void(const std::string& field, const std::string& expected)>;

// Applies a JSON merge patch [RFC7396] to a presentation. Calls `wrong` for each wrong field, and
// leaves the value of that field unchanged. Sets `turned_box` only if `is_stored`, because clients
// cannot set it.
void read_presentation(const nlohmann::json& patch, Presentation& presentation,
                       const WrongField& wrong, bool is_stored = false);

// Returns the presentation as clients see it.
nlohmann::ordered_json to_json(const Presentation& presentation);

// Returns the JSON text that clients get with a model's head. If the model has notes, the text also
// states their number. Empty for the default presentation without notes.
std::string client_text(const Presentation& presentation, std::uint64_t notes = 0);

// Returns a short text that differs between presentations, for cache keys and entity tags.
std::string key_of(const Presentation& presentation);

// Converts a presentation to the text that the catalogue stores. The text of the default
// presentation is empty. An unreadable text counts as the default.
std::string stored_text(const Presentation& presentation);
Presentation from_stored_text(const std::string& text);

}  // namespace vitrine::server
