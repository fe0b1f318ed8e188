// SPDX-License-Identifier: Apache-2.0
#include "server/api/model_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "server/messages/response.h"
#include "server/messages/timestamp.h"
#include "server/metadata/text.h"
#include "server/records/citation.h"
#include "server/store/change.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json model(const ModelRecord& record, const ModelView& view) {
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
               {"textures",
                {{"count", record.textures.count},
                 {"largest_side", record.textures.largest_side},
                 {"bytes", record.textures.bytes}}},
               {"presentation", to_json(record.presentation)},
               {"links",
                {{"self", self},
                 {"page", "/models/" + record.id.to_string()},
                 {"manifest", self + "/manifest"},
                 {"head", self + "/head"},
                 {"file", self + "/file.pmesh"},
                 {"stream", self + "/stream"},
                 {"notes", self + "/notes"},
                 {"tours", self + "/tours"},
                 {"poster", self + "/poster.png"}}}};
  if (view.has_token) json["repairs"] = lines_of(record.repairs);
  if (view.counts_visits && record.state == ModelState::kPublished)
    json["links"]["visits"] = self + "/visits";
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

Json corners(const Bounds& box) {
  return {{"min", vector(box.low)}, {"max", vector(box.high)}};
}

// Rounds to five significant digits, because no scan is accurate enough for more digits.
double rounded(double value) {
  return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr);
}

Json dimensions(const std::optional<Dimensions>& size) {
  if (!size) return nullptr;
  return {{"width", size->width},
          {"height", size->height},
          {"depth", size->depth},
          {"unit", size->unit}};
}

Json citation(const DescribedModel& model) {
  const Citations all = citations_of(model);
  return {{"apa", all.apa}, {"chicago", all.chicago}, {"mla", all.mla}};
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

std::string_view alpha_mode(AlphaMode mode) {
  constexpr std::array<std::string_view, 3> kNames = {"opaque", "mask", "blend"};
  return kNames[static_cast<std::size_t>(mode)];
}

Json place(std::uint64_t offset, std::uint64_t length, const Sha256& sha256) {
  return {{"offset", offset}, {"length", length}, {"sha256", to_hex(sha256)}};
}

// Returns the places of the original materials and pictures in the model's file. Returns null if
// the model has no originals or hides them.
Json originals(const Manifest& manifest) {
  Json source, pictures = Json::array();
  for (const OptionalBlock& block : manifest.optional_blocks) {
    Json json = place(block.offset, block.length, block.sha256);
    if (block.kind == static_cast<std::uint64_t>(OptionalKind::kSource))
      source = std::move(json);
    else if (block.kind == static_cast<std::uint64_t>(OptionalKind::kSourcePicture))
      pictures.push_back(std::move(json));
  }
  if (source.is_null()) return source;
  return {{"description", std::move(source)}, {"pictures", std::move(pictures)}};
}

// Returns the texture's description, or null if the model has no texture.
Json texture(const TextureInfo& info) {
  if (info.empty()) return nullptr;
  Json pictures = Json::array();
  for (std::uint32_t i = 0; i < info.pictures.size(); ++i) {
    const PictureInfo& picture = info.pictures[i];
    Json json = {
        {"role", name_of(picture.role)}, {"side", picture.side}, {"in_head", i < info.in_head}};
    json.update(place(picture.offset, picture.length, picture.sha256));
    pictures.push_back(std::move(json));
  }
  return {{"side", info.side},
          {"alpha_mode", alpha_mode(info.alpha_mode)},
          {"alpha_cutoff", info.alpha_cutoff},
          {"double_sided", info.is_double_sided},
          {"unlit", info.is_unlit},
          {"atlas", place(info.atlas_offset, info.atlas_length, info.atlas_sha256)},
          {"pictures", std::move(pictures)}};
}

// Returns the expected result of a detail request. The member `seconds` is the loading time at the
// client's bandwidth, or null if the bandwidth is unknown.
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

Bounds bounding_box(const Manifest& manifest) {
  const std::int32_t top = (1 << manifest.lattice.bits) - 1;
  const auto inside = [&](const Vec3i& p) -> Vec3i {
    return {std::clamp(p.x, 0, top), std::clamp(p.y, 0, top), std::clamp(p.z, 0, top)};
  };
  const LatticeBox& box = manifest.tree.nodes[0].box;
  return {manifest.lattice.to_model(inside(box.low)), manifest.lattice.to_model(inside(box.high))};
}

Bounds presented_box(const ModelRecord& record, const Manifest& manifest) {
  return presented_box(record.presentation, bounding_box(manifest));
}

std::string model_json(const ModelRecord& record, const ModelView& view) {
  return dump(model(record, view));
}

std::string model_json(const ModelRecord& record, const Manifest& manifest, const ModelView& view) {
  Json json = model(record, view);
  json["dimensions"] = dimensions(dimensions_of(record, manifest));
  json["citation"] = citation({record, view.origin});
  return dump(json);
}

std::optional<Dimensions> dimensions_of(const ModelRecord& record, const Manifest& manifest) {
  if (record.unit.empty()) return std::nullopt;
  const Bounds box = presented_box(record, manifest);
  return Dimensions{.width = rounded(box.high.x - box.low.x),
                    .height = rounded(box.high.y - box.low.y),
                    .depth = rounded(box.high.z - box.low.z),
                    .unit = record.unit};
}

std::string model_tag(const ModelRecord& record, const ModelView& view) {
  return entity_tag(std::to_string(record.version) + model_json(record, view) +
                    dump(citation({record, view.public_url})));
}

std::string model_page_json(const ModelPage& page, const ModelView& view) {
  Json json = {{"models", Json::array()}, {"next", nullptr}};
  for (const ModelRecord& record : page.models)
    json["models"].push_back(model(view.has_token ? record : public_view(record), view));
  if (page.next) json["next"] = page.next->to_string();
  return dump(json);
}

std::string facets_json(const Facets& facets) {
  Json json = {{"models", facets.models}, {"facets", Json::object()}};
  for (const std::string_view name : kFacetNames)
    json["facets"][name] = Json::array();
  for (const FacetCount& count : facets.counts)
    json["facets"][count.name].push_back({{"value", count.value}, {"models", count.models}});
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
               {"bounding_box", corners(bounding_box(manifest))},
               {"presentation", to_json(published.record().presentation)},
               {"levels", levels(manifest)},
               {"regions", manifest.tree.leaves()},
               {"adjacency", manifest.adjacency},
               {"base", place(manifest.base_offset, manifest.base_length, manifest.base_sha256)},
               {"texture", texture(manifest.texture)},
               {"originals", originals(manifest)},
               {"chunks", chunks(manifest)}};
  if (detail) json["expect"] = expectation(*detail, manifest);
  return dump(json);
}

}  // namespace vitrine::server
