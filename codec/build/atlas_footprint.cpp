// SPDX-License-Identifier: Apache-2.0
#include "codec/build/atlas_footprint.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "codec/atlas/draw_atlas.h"
#include "codec/atlas/pack.h"
#include "codec/build/charts.h"
#include "codec/build/snap_atlas.h"
#include "codec/format/cell.h"

namespace vitrine::inline codec {
namespace {

// Expected share of the picture that the charts cover. The first scale to try follows from it. If
// the charts do not fit at that scale, smaller scales are tried.
constexpr double kCoverage = 0.4;
constexpr double kGutter = 1.0 / 256;       // least distance between charts, as a share of the side
constexpr std::size_t kMostFaces = 20'000;  // a base mesh with more faces gets no atlas
// smallest expected side of the picture, as a share of kMaxAtlasSide
constexpr double kLeastSide = 0.8;

// A face of one level, in the coordinates of the picture.
struct FlatFace {
  WedgeId wedge;  // wedge of the first corner; it keeps its chart and id in all finer levels
  std::array<Vec2i, 3> at;
};

Atlas atlas_of(const EncodedModel& model) {
  std::vector<Vec3> positions;
  positions.reserve(model.base.positions.size());
  for (const Vec3i& cell : model.base.positions)
    positions.push_back(to_vec3(middle_of(cell, model.manifest.levels[0].shift)));
  return draw_atlas(positions, model.base.faces);
}

double area_of(const Atlas& atlas) {
  double doubled = 0;
  const auto at = [&](std::uint32_t w) { return Vec2{atlas.uv[w][0], atlas.uv[w][1]}; };
  for (const auto& [a, b, c] : atlas.wedges)
    doubled += std::abs(cross(at(b) - at(a), at(c) - at(a)));
  return doubled / 2;
}

// The bounding box of each chart: its lowest and its highest coordinates.
struct ChartBoxes {
  std::vector<Vec2> low, high;
};

ChartBoxes boxes_of(const Atlas& atlas) {
  constexpr double kFar = std::numeric_limits<double>::max();
  ChartBoxes boxes{.low = std::vector<Vec2>(atlas.charts, {kFar, kFar}),
                   .high = std::vector<Vec2>(atlas.charts, {-kFar, -kFar})};
  for (std::size_t w = 0; w < atlas.uv.size(); ++w) {
    const auto [x, y] = atlas.uv[w];
    Vec2 &l = boxes.low[atlas.chart[w]], &h = boxes.high[atlas.chart[w]];
    l = {std::min(l.x, x), std::min(l.y, y)}, h = {std::max(h.x, x), std::max(h.y, y)};
  }
  return boxes;
}

// Returns the first scale to try, in units of coordinates per unit of length. At this scale, the
// picture has room for the longest chart and for the total area of all charts.
double first_scale(const Atlas& atlas) {
  const ChartBoxes boxes = boxes_of(atlas);
  double longest = 1e-9;
  for (std::size_t chart = 0; chart < atlas.charts; ++chart) {
    const Vec2 size = boxes.high[chart] - boxes.low[chart];
    longest = std::max({longest, size.x, size.y});
  }
  return kMaxAtlasSide *
         std::min(std::sqrt(kCoverage / std::max(area_of(atlas), 1e-9)), 0.8 / longest);
}

// Returns the coordinates with `scale` units per unit of length. Places each chart in the middle of
// the range of coordinates. Charts can be moved later, because the decoder's prediction depends
// only on differences of coordinates within a chart.
SnappedCoordinates in_middle(const Atlas& atlas, double scale) {
  const ChartBoxes boxes = boxes_of(atlas);
  constexpr double kMiddle = kMaxAtlasSide * 0.5;
  std::vector<Vec2> at;
  for (std::size_t w = 0; w < atlas.uv.size(); ++w) {
    const Vec2 middle = (boxes.low[atlas.chart[w]] + boxes.high[atlas.chart[w]]) * 0.5;
    at.push_back((Vec2{atlas.uv[w][0], atlas.uv[w][1]} - middle) * scale + Vec2{kMiddle, kMiddle});
  }
  return snap_coordinates(atlas.wedges, at);
}

void add_faces(const Refiner& refiner, std::vector<FlatFace>& faces) {
  const Connectivity& mesh = refiner.connectivity();
  const Wedges& wedges = refiner.wedges();
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!mesh.is_real(f)) continue;
    const auto at = [&](Corner c) { return wedges[wedges.of(c)].at; };
    faces.push_back({wedges.of(3 * f), {at(3 * f), at(3 * f + 1), at(3 * f + 2)}});
  }
}

// Refines the model to full resolution. Adds the faces of each level to `faces`.
Expected<Refiner> refine_flat(const EncodedModel& model, const BaseMesh& base,
                              std::vector<FlatFace>& faces) {
  auto refiner = Refiner::start(model.manifest, base);
  if (!refiner) return refiner;
  add_faces(*refiner, faces);
  std::size_t offset = model.manifest.base_length;
  const auto& chunks = model.manifest.chunks;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const auto bytes = std::span(model.body).subspan(offset, chunks[i].length);
    if (auto ok = refiner->apply(i, bytes); !ok) return tl::unexpected(ok.error());
    offset += chunks[i].length;
    if (i + 1 == chunks.size() || chunks[i + 1].level != chunks[i].level) {
      add_faces(*refiner, faces);
    }
  }
  return refiner;
}

// Returns the chart of `atlas` to which each wedge belongs at full resolution. Wedges of the base
// mesh keep their numbers in all levels, so the lowest wedge number in a chart is that of a base
// wedge.
std::vector<std::uint32_t> charts_at_full(const Refiner& refiner, const Atlas& atlas) {
  std::vector<std::uint32_t> charts = charts_of(refiner);
  for (std::uint32_t& chart : charts)
    chart = atlas.chart[chart];
  return charts;
}

std::vector<ChartTriangles> footprints(const std::vector<FlatFace>& faces,
                                       const std::vector<std::uint32_t>& charts,
                                       std::uint32_t count) {
  std::vector<ChartTriangles> out(count);
  for (const FlatFace& face : faces) {
    auto& corners = out[charts[face.wedge]].emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 at = to_vec2(face.at[k]);
      corners[k] = {at.x, at.y};
    }
  }
  return out;
}

// The final places of the charts: the move of each chart, and the side of the picture.
struct ChartPlaces {
  std::vector<Vec2i> moves;  // multiples of the coordinates' step
  double side;
};

// Packs the charts. Moves are rounded to whole steps, which can bring two charts closer by one
// step. The gutter is therefore one step wider.
ChartPlaces places_of(const std::vector<ChartTriangles>& charts, std::int32_t step) {
  const Packing packing = pack(charts, kGutter + step / (kLeastSide * kMaxAtlasSide));
  ChartPlaces out{.moves = {}, .side = std::ceil(1 / packing.scale) + step};
  const auto up = [&](double x) {
    return static_cast<std::int32_t>(std::ceil(x / packing.scale / step)) * step;
  };
  for (const auto& [x, y] : packing.offset)
    out.moves.push_back({up(x), up(y)});
  return out;
}

PlacedAtlas placed(const EncodedModel& model, const Refiner& refiner, BaseAtlas base,
                   const std::vector<std::uint32_t>& charts, const ChartPlaces& places) {
  PlacedAtlas out{.base = std::move(base), .side = static_cast<std::uint32_t>(places.side)};
  for (std::size_t w = 0; w < out.base.coordinates.size(); ++w)
    out.base.coordinates[w] = out.base.coordinates[w] + places.moves[charts[w]];
  const Connectivity& mesh = refiner.connectivity();
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!mesh.is_real(f)) continue;
    Triangle& face = out.faces.emplace_back();
    auto& corners = out.coordinates.emplace_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      const WedgeId w = refiner.wedges().of(3 * f + k);
      face[k] = model.fine_ids[mesh.vertex(3 * f + k)];
      corners[k] = refiner.wedges()[w].at + places.moves[charts[w]];
    }
  }
  return out;
}

}  // namespace

Expected<PlacedAtlas> place_atlas(const EncodedModel& model) {
  if (const std::size_t faces = model.base.faces.size(); faces > kMostFaces) {
    return fail(
        ErrorCode::kLimit,
        fmt::format("its handles and holes leave {} triangles in the base mesh, and a texture "
                    "needs at most {}; close small holes and tunnels in the mesh",
                    faces, kMostFaces));
  }
  const Atlas atlas = atlas_of(model);
  double scale = first_scale(atlas);
  for (int trial = 0; trial < 4; ++trial) {
    SnappedCoordinates snapped = in_middle(atlas, scale);
    BaseMesh base = model.base;
    base.atlas = {.wedges = atlas.wedges, .coordinates = std::move(snapped.at)};
    std::vector<FlatFace> faces;
    const auto refiner = refine_flat(model, base, faces);
    if (!refiner) return tl::unexpected(refiner.error());
    const auto charts = charts_at_full(*refiner, atlas);
    const ChartPlaces places = places_of(footprints(faces, charts, atlas.charts), snapped.step);
    if (places.side <= kMaxAtlasSide) {
      return placed(model, *refiner, std::move(base.atlas), charts, places);
    }
    scale *= 0.95 * kMaxAtlasSide / places.side;
  }
  return fail(ErrorCode::kLimit, "its charts do not fit in a picture; simplify the mesh");
}

}  // namespace vitrine::inline codec
