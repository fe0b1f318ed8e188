// SPDX-License-Identifier: Apache-2.0
#include "server/api/model_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/messages/response.h"
#include "server/messages/timestamp.h"
#include "server/store/change.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json model(const ModelRecord& record) {
  const std::string self = "/api/v1/models/" + record.id.to_string();
  Json json = {{"id", record.id.to_string()},
               {"state", record.state == ModelState::kPublished ? "published" : "draft"},
               {"title", record.title},
               {"creator", record.creator},
               {"rights", record.rights},
               {"licence", record.licence},
               {"unit", record.unit},
               {"accuracy", record.accuracy ? Json(*record.accuracy) : Json(nullptr)},
               {"public_max_level",
                record.public_part ? Json(record.public_part->max_level) : Json(nullptr)},
               {"created", timestamp(record.created)},
               {"vertices", record.vertices},
               {"faces", record.faces},
               {"bytes", record.file_bytes},
               {"head_bytes", record.head_bytes},
               {"links",
                {{"self", self},
                 {"page", "/models/" + record.id.to_string()},
                 {"manifest", self + "/manifest"},
                 {"head", self + "/head"},
                 {"file", self + "/file.pmesh"},
                 {"stream", self + "/stream"},
                 {"poster", self + "/poster.png"}}}};
  for (const auto& [name, text] : record.more)
    json[name] = text;
  return json;
}

Json vector(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json lattice(const Lattice& grid) {
  return {{"origin", vector(grid.origin)}, {"step", grid.step}, {"bits", grid.bits}};
}

// Returns the bounding box of the coded positions of all levels, clamped to the lattice.
Json bounding_box(const Manifest& manifest) {
  const std::int32_t top = (1 << manifest.lattice.bits) - 1;
  const auto inside = [&](const Vec3i& p) -> Vec3i {
    return {std::clamp(p.x, 0, top), std::clamp(p.y, 0, top), std::clamp(p.z, 0, top)};
  };
  const LatticeBox& box = manifest.tree.nodes[0].box;
  return {{"min", vector(manifest.lattice.to_model(inside(box.low)))},
          {"max", vector(manifest.lattice.to_model(inside(box.high)))}};
}

Json levels(const Manifest& manifest) {
  Json all = Json::array();
  for (std::uint32_t i = 0; i < manifest.levels.size(); ++i) {
    const LevelInfo& level = manifest.levels[i];
    all.push_back({{"vertices", level.vertices},
                   {"faces", level.faces},
                   {"cumulative_bytes", manifest.cumulative_bytes(i)},
                   {"max_error", level.max_error},
                   {"rms_error", level.rms_error},
                   {"display_filter", level.display_filter}});
  }
  return all;
}

Json chunks(const Manifest& manifest) {
  Json all = Json::array();
  for (const ChunkInfo& chunk : manifest.chunks) {
    all.push_back({{"level", chunk.level},
                   {"region", chunk.region},
                   {"leaves", manifest.region(chunk).leaves},
                   {"offset", chunk.offset},
                   {"length", chunk.length},
                   {"splits", chunk.splits},
                   {"newborn", chunk.inserted},
                   {"max_error", chunk.max_error},
                   {"sha256", to_hex(chunk.sha256)}});
  }
  return all;
}

// Returns the expected result of a detail request. The member `seconds` is the loading time at the
// client's bandwidth, or null if the request does not state a bandwidth.
Json expectation(const DetailRequest& detail, const Manifest& manifest) {
  const DetailForecast forecast = forecast_of(detail.want, manifest);
  const double kilobits = static_cast<double>(forecast.bytes) * 8 / 1000;
  return {{"level", forecast.level},
          {"triangles", forecast.triangles},
          {"bytes", forecast.bytes},
          {"error", forecast.error},
          {"seconds", detail.kbps > 0 ? Json(kilobits / detail.kbps) : Json(nullptr)}};
}

}  // namespace

std::string model_json(const ModelRecord& record) {
  return dump(model(record));
}

std::string model_tag(const ModelRecord& record) {
  return entity_tag(std::to_string(record.version) + model_json(record));
}

std::string model_page_json(const ModelPage& page, bool whole) {
  Json json = {{"models", Json::array()}, {"next", nullptr}};
  for (const ModelRecord& record : page.models)
    json["models"].push_back(model(whole ? record : public_view(record)));
  if (page.next) json["next"] = page.next->to_string();
  return dump(json);
}

std::string manifest_json(const PublishedModel& published,
                          const std::optional<DetailRequest>& detail) {
  const Manifest& manifest = published.manifest();
  Json json = {{"id", published.record().id.to_string()},
               {"sha256", to_hex(published.record().file)},
               {"bytes", manifest.file_bytes},
               {"head_bytes", manifest.head_bytes()},
               {"unit", manifest.unit},
               {"placement", manifest.placement == Placement::kPyramid ? "pyramid" : "midpoint"},
               {"coloured", manifest.has(Semantic::kColour)},
               {"boundary_loops", manifest.loops},
               {"lattice", lattice(manifest.lattice)},
               {"bounding_box", bounding_box(manifest)},
               {"levels", levels(manifest)},
               {"regions", manifest.tree.leaves()},
               {"adjacency", manifest.adjacency},
               {"base",
                {{"offset", manifest.base_offset},
                 {"length", manifest.base_length},
                 {"sha256", to_hex(manifest.base_sha256)}}},
               {"chunks", chunks(manifest)}};
  if (detail) json["expect"] = expectation(*detail, manifest);
  return dump(json);
}

}  // namespace vitrine::server
