// SPDX-License-Identifier: Apache-2.0
// Serves a model as a tileset of 3D Tiles 1.1 [3DTiles]: a chain of tiles, each with a level of
// detail as GLB, from the base mesh to the finest level. Clients such as CesiumJS show the base
// mesh first, and replace it by a finer tile when its error is visible.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codec/build/coarser_levels.h"
#include "codec/mesh/unit.h"
#include "codec/mesh/up_axis.h"
#include "server/api/handlers.h"
#include "server/api/model_json.h"
#include "server/api/published.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::ordered_json;

// Describes a model as a tileset, in metres with z up. If the model's unit is unknown, the unit
// counts as one metre, as in exports.
class Tileset {
 public:
  explicit Tileset(const PublishedModel& model)
      : manifest_(model.manifest()),
        box_(presented_box(model.record(), model.manifest())),
        metres_(metres_per(manifest_.unit).value_or(1)),
        metres_in_file_(metres_ * model.record().presentation.scale) {
    const Manifest& manifest = manifest_;
    const auto finest = static_cast<std::uint32_t>(manifest.levels.size() - 1);
    levels_ = coarser_levels(manifest, finest, manifest.levels[finest].faces);
    levels_.insert(levels_.begin(), finest);
  }

  Json json() const {
    return {{"asset", {{"version", "1.1"}}},
            {"geometricError", length(box_.high - box_.low) * metres_},
            {"root", root()}};
  }

 private:
  // Returns the tile of the base mesh. Each tile has the next finer one as its child.
  Json root() const {
    const Json volume = {{"box", bounding_volume()}};
    Json tile;
    double error = 0;  // 0 for the finest tile, because no finer tile replaces it
    for (const std::uint32_t level : levels_) {
      if (level != levels_.front()) error = std::max(error, manifest_.levels[level].max_error);
      Json parent = {{"boundingVolume", volume},
                     {"geometricError", error * metres_in_file_},
                     {"refine", "REPLACE"},
                     {"content", {{"uri", fmt::format("export.glb?level={}", level)}}}};
      if (!tile.is_null()) parent["children"] = Json::array({std::move(tile)});
      tile = std::move(parent);
    }
    return tile;
  }

  // Returns a box around all levels, as its centre and half axes. The box has a margin, because a
  // level may reach beyond the original by its error.
  Json bounding_volume() const {
    double margin = 0;
    for (const std::uint32_t level : levels_)
      margin = std::max(margin, manifest_.levels[level].max_error * metres_in_file_);
    const Vec3 centre = turn_y_up_to_z(box_.centre() * metres_);
    const Vec3 half = (box_.high - box_.low) * (0.5 * metres_) + Vec3{margin, margin, margin};
    const double x = half.x, y = half.z, z = half.y;
    return Json::array({centre.x, centre.y, centre.z, x, 0, 0, 0, y, 0, 0, 0, z});
  }

  const Manifest& manifest_;
  Bounds box_;                         // of the presented model, in its unit
  double metres_;                      // length of the model's unit in metres
  double metres_in_file_;              // metres per unit of the file's coordinates, as presented
  std::vector<std::uint32_t> levels_;  // the levels of the tiles, from fine to coarse
};

}  // namespace

static Response show_tileset(const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    return revalidated("application/json", Tileset(*model).json().dump());
  });
}

static constexpr std::string_view kTilesetComponents = R"json({
"schemas": {
  "Tileset": {"type": "object", "required": ["asset", "geometricError", "root"], "properties": {
    "asset": {"type": "object", "required": ["version"], "properties": {"version": {"const": "1.1"}}},
    "geometricError": {"type": "number", "minimum": 0}, "root": {"$ref": "#/components/schemas/Tile"}}},
  "Tile": {"type": "object", "required": ["boundingVolume", "geometricError", "refine", "content"], "properties": {
    "boundingVolume": {"type": "object", "required": ["box"], "properties": {
      "box": {"type": "array", "minItems": 12, "maxItems": 12, "items": {"type": "number"}}}},
    "geometricError": {"type": "number", "minimum": 0,
      "description": "Upper bound of the error of the level in metres; 0 for the finest level"},
    "refine": {"const": "REPLACE"},
    "content": {"type": "object", "required": ["uri"], "properties": {"uri": {"type": "string"}}},
    "children": {"type": "array", "maxItems": 1, "items": {"$ref": "#/components/schemas/Tile"}}}}
}
})json";

static constexpr ApiRoute kTilesetRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/tileset.json",
     .handler = show_tileset,
     .executor = Executor::kWorker,
     .doc = {.id = "getTileset",
             .summary = "Returns a tileset of 3D Tiles 1.1: tiles with GLB files of the base mesh, "
                        "of levels with at least four times the triangles each, and of the finest "
                        "level.",
             .response = "Tileset",
             .may_be_gzip = true}},
};

const ApiNoun kTileset = {.routes = kTilesetRoutes, .components = kTilesetComponents};

}  // namespace vitrine::server
