// SPDX-License-Identifier: Apache-2.0
#include "codec/import/stated_colours.h"

#include <algorithm>
#include <cmath>

#include "codec/core/linear_colour.h"

namespace vitrine::inline codec {
namespace {

bool is_stated(const StatedColour& colour) {
  return !std::isnan(colour[0]);
}

std::string report_clipped(std::uint64_t count, const std::string& most) {
  return counted(count, "colour value") + " above " + most + " clipped to " + most +
         "; export colours from 0 to " + most;
}

}  // namespace

bool are_up_to_255(std::span<const StatedColour> stated) {
  constexpr float kMostOvershoot = 2;
  std::uint64_t above = 0, fractions = 0;
  float largest = 0;
  bool all_whole = true;
  for (const StatedColour& colour : stated) {
    if (!is_stated(colour)) continue;
    for (const float part : colour) {
      largest = std::max(largest, part);
      above += part > 1;
      fractions += part > 0 && part < 1;
      all_whole = all_whole && part == std::floor(part);
    }
  }
  if (largest <= 1 || all_whole) return largest > 1;
  return largest > kMostOvershoot && above >= fractions;
}

void scale_wide_integers(std::span<StatedColour> stated) {
  constexpr float kMostOvershoot = 2 * 255;
  const auto is_wide = [](const StatedColour& colour) {
    return std::ranges::max(colour) > kMostOvershoot;
  };
  if (std::ranges::none_of(stated, is_wide)) return;
  for (StatedColour& colour : stated) {
    for (float& part : colour)
      part /= 65535;
  }
}

std::vector<Colour> to_colours(std::span<const StatedColour> stated,
                               std::vector<std::string>& repairs) {
  const bool is_wide = are_up_to_255(stated);
  const double scale = is_wide ? 1.0 / 255 : 1.0;
  ColourFaults faults;
  std::vector<Colour> out;
  out.reserve(stated.size());
  for (const StatedColour& colour : stated) {
    const auto& [r, g, b] = colour;
    faults.count(colour, is_wide);
    out.push_back(is_stated(colour)
                      ? Colour{to_byte(r * scale), to_byte(g * scale), to_byte(b * scale)}
                      : Colour{255, 255, 255});
  }
  const auto lines = faults.report();
  repairs.insert(repairs.end(), lines.begin(), lines.end());
  return out;
}

void ColourFaults::count(const StatedColour& colour, bool is_wide) {
  if (!is_stated(colour)) return void(++missing_);
  for (const float part : colour) {
    above_255_ += is_wide && part > 255;
    above_1_ += !is_wide && part > 1;
    below_ += !(part >= 0);  // also counts values that are not numbers
  }
}

std::vector<std::string> ColourFaults::report() const {
  std::vector<std::string> lines;
  if (above_1_ > 0) lines.push_back(report_clipped(above_1_, "1"));
  if (above_255_ > 0) lines.push_back(report_clipped(above_255_, "255"));
  if (below_ > 0)
    lines.push_back(counted(below_, "colour value") +
                    " below 0 or not a number became 0; export colours from 0 up");
  if (missing_ > 0) lines.push_back(report_uncoloured(missing_));
  return lines;
}

std::string report_uncoloured(std::uint64_t count) {
  return counted(count, "colour") +
         " missing or not a number, white instead; paint the whole model and export it again";
}

void FaceColours::add_patch(std::span<const std::uint32_t> corners, const StatedColour& colour) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ends_.push_back(corners_.size());
  colours_.push_back(colour);
}

void FaceColours::add(std::span<const std::uint32_t> corners, const StatedColour& colour) {
  ++faces_;
  add_patch(corners, colour);
}

void FaceColours::add(const Triangle& corners, const std::array<StatedColour, 3>& colours) {
  if (colours[0] == colours[1] && colours[1] == colours[2]) return add(corners, colours[0]);
  ++faces_;
  for (std::size_t k = 0; k < 3; ++k)
    add_patch({&corners[k], 1}, colours[k]);
}

bool FaceColours::are_all(const StatedColour& colour) const {
  return std::ranges::all_of(colours_, [&](const auto& other) { return other == colour; });
}

template <class Visit>
void FaceColours::for_each_corner(std::size_t vertices, const Visit& visit) const {
  std::size_t begin = 0;
  for (std::size_t patch = 0; patch < ends_.size(); begin = ends_[patch++]) {
    for (std::size_t c = begin; c < ends_[patch]; ++c) {
      if (corners_[c] < vertices) visit(corners_[c], patch);
    }
  }
}

void FaceColours::give_to(RawMesh& mesh) const {
  if (colours_.empty() || are_all({1, 1, 1}) || are_all({255, 255, 255})) return;
  const std::string which = "colours of " + counted(faces_, "face");
  if (!mesh.attributes.colours.empty()) {
    mesh.repairs.push_back(which +
                           " not carried: the vertices have colours of their own; remove "
                           "these to use the colours of the faces");
    return;
  }
  const std::size_t vertices = mesh.positions.size();
  const std::vector<Colour> stated = to_colours(colours_, mesh.repairs);
  ColourMeans means(vertices);
  for_each_corner(vertices, [&](std::uint32_t v, std::size_t patch) {
    means.add(v, to_linear(stated[patch]));
  });
  mesh.attributes.colours = means.take();
  bool is_lossless = true;
  for_each_corner(vertices, [&](std::uint32_t v, std::size_t patch) {
    is_lossless = is_lossless && mesh.attributes.colours[v] == stated[patch];
  });
  if (is_lossless) return;
  mesh.repairs.push_back(which +
                         " averaged at the vertices; bake them into a texture map to keep their "
                         "borders sharp");
}

}  // namespace vitrine::inline codec
