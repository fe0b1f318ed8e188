// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "codec/base/base_decoder.h"
#include "codec/export/write_mesh.h"
#include "codec/progressive/refine.h"
#include "server/http/handlers.h"
#include "server/http/published.h"
#include "server/http/query.h"

namespace vitrine {
namespace {

constexpr std::string_view kParameters[] = {"triangles", "error", "bytes",
                                            "level",     "kbps",  "seconds"};

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

tl::expected<Want, std::string> parse_level(std::string_view text, std::uint32_t levels) {
  if (text == "lowest") return WantLevel{0};
  if (text == "highest") return WantLevel{levels - 1};
  const auto level = parse_number<std::uint32_t>(text);
  if (level && *level < levels) return WantLevel{*level};
  return tl::unexpected(fmt::format("lowest, highest or a number from 0 to {}", levels - 1));
}

tl::expected<Want, std::string> parse_want(std::string_view name, std::string_view text,
                                           std::uint32_t levels) {
  if (name == "level") return parse_level(text, levels);
  if (name == "error") {
    const auto error = parse_number<double>(text);
    if (error && *error >= 0 && *error < 1e300) return WantError{*error};
    return tl::unexpected(std::string("a distance in the model's unit, 0 or more"));
  }
  const auto count = parse_number<std::uint64_t>(text);
  if (!count) return tl::unexpected(std::string("a whole number, 0 or more"));
  if (name == "bytes") return WantBytes{*count};
  return WantTriangles{*count};
}

// What a line of `kbps` kilobits per second carries in `seconds`.
tl::expected<Want, ParameterFault> parse_line(const Query& query) {
  double product = 1;
  for (const std::string name : {"kbps", "seconds"}) {
    const auto text = query.get(name);
    if (!text) return tl::unexpected(ParameterFault{name, "kbps and seconds go together"});
    const auto value = parse_number<double>(*text);
    if (!value || !(*value > 0 && *value <= 1e9))
      return tl::unexpected(ParameterFault{name, "a number above 0, at most 1e9"});
    product *= *value;
  }
  return WantBytes{static_cast<std::uint64_t>(product * 1000 / 8)};
}

// What the query asks for; the whole model where it does not say.
tl::expected<Want, ParameterFault> read_want(const Query& query, const Manifest& manifest) {
  const auto levels = static_cast<std::uint32_t>(manifest.levels.size());
  if (const auto name = query.unknown(kParameters))
    return tl::unexpected(ParameterFault{std::string(*name), "unknown here"});
  std::optional<Want> wanted;
  if (query.get("kbps") || query.get("seconds")) {
    const auto line = parse_line(query);
    if (!line) return tl::unexpected(line.error());
    wanted = *line;
  }
  for (const std::string name : {"triangles", "error", "bytes", "level"}) {
    const auto text = query.get(name);
    if (!text) continue;
    if (wanted)
      return tl::unexpected(
          ParameterFault{name, "only one of triangles, error, bytes, level, kbps with seconds"});
    const auto want = parse_want(name, *text, levels);
    if (!want) return tl::unexpected(ParameterFault{name, want.error()});
    wanted = *want;
  }
  return wanted.value_or(WantLevel{levels - 1});
}

// Equal wishes have equal keys, however they are written; beyond the finest level all are equal.
std::string key_of(const Want& want, const Manifest& manifest) {
  if (const auto* w = std::get_if<WantTriangles>(&want)) {
    return fmt::format("triangles={}",
                       std::min<std::uint64_t>(w->triangles, manifest.levels.back().faces));
  }
  if (const auto* w = std::get_if<WantBytes>(&want)) {
    return fmt::format("bytes={}", std::min(w->bytes, manifest.file_bytes));
  }
  if (const auto* w = std::get_if<WantError>(&want)) return fmt::format("error={}", w->error);
  return fmt::format("level={}", std::get<WantLevel>(want).level);
}

// Our own published file is decoded in this process: it was checked when it was published.
Expected<std::vector<std::uint8_t>> make_export(const PublishedModel& model, const Want& want,
                                                MeshFormat format) {
  const auto base_bytes = model.read(model.base());
  if (!base_bytes) return Unexpected(base_bytes.error());
  const auto base = decode_base(*base_bytes, model.manifest());
  if (!base) return Unexpected(base.error());
  auto refiner = Refiner::start(model.manifest(), *base);
  if (!refiner) return Unexpected(refiner.error());
  std::vector<std::uint8_t> bytes;  // of the newest chunk
  const auto read = [&](std::size_t chunk) -> Expected<std::span<const std::uint8_t>> {
    auto fresh = model.read(model.chunk(chunk));
    if (!fresh) return Unexpected(fresh.error());
    bytes = std::move(*fresh);
    return bytes;
  };
  if (const auto refined = refine(*refiner, want, read); !refined)
    return Unexpected(refined.error());
  return write_mesh(refiner->display_mesh(), format, model.manifest().unit);
}

std::string_view media_type(MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return "application/ply";
    case MeshFormat::kGlb:
      return "model/gltf-binary";
    case MeshFormat::kObj:
      return "model/obj";
    case MeshFormat::kStl:
      return "model/stl";
    case MeshFormat::kDrc:
      return "application/octet-stream";
    case MeshFormat::kVrml:
      return "model/vrml";
  }
  return "application/octet-stream";
}

Expected<ExportCache::File> find_or_make(ExportCache& cache, const std::string& key,
                                         const PublishedModel& model, const Want& want,
                                         MeshFormat format) {
  if (auto file = cache.find(key)) return file;
  auto bytes = make_export(model, want, format);
  if (!bytes) return Unexpected(bytes.error());
  std::string etag = '"' + to_hex(sha256(*bytes)) + '"';
  auto file =
      std::make_shared<const ExportedFile>(ExportedFile{std::move(*bytes), std::move(etag)});
  cache.insert(key, file);
  return file;
}

}  // namespace

Response export_model(const Request& request, Services& services) {
  const auto format = format_of_extension(request.parameters.format);
  if (!format) return problem(404, "export as glb, ply, obj, stl, drc or wrl", request.id);
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  return with_model(request, services, [&](const auto& model) {
    const auto wanted = read_want(*query, model->manifest());
    if (!wanted) return problem(400, "a parameter is out of range", request.id, {wanted.error()});
    const std::string key =
        fmt::format("{} {} {}", to_hex(model->record().file), request.parameters.format,
                    key_of(*wanted, model->manifest()));
    const auto file = find_or_make(services.exports, key, *model, *wanted, *format);
    if (!file) return internal_error(file.error(), request, services);
    Response response;
    response.type = media_type(*format);
    response.caching = Caching::kRevalidate;
    response.etag = (*file)->etag;
    response.fields = {{"Content-Disposition",
                        fmt::format("attachment; filename=\"{}.{}\"",
                                    model->record().id.to_string(), request.parameters.format)}};
    response.body = SharedBytes{*file, (*file)->bytes};
    return response;
  });
}

}  // namespace vitrine
