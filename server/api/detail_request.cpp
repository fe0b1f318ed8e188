// SPDX-License-Identifier: Apache-2.0
#include "server/api/detail_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "codec/core/parse_number.h"

namespace vitrine::server {
namespace {

constexpr std::string_view kParameters[] = {"triangles", "error", "bytes",
                                            "level",     "kbps",  "seconds"};

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
    return tl::unexpected(std::string("a distance in the coordinates of the file, 0 or more"));
  }
  const auto count = parse_number<std::uint64_t>(text);
  if (!count) return tl::unexpected(std::string("a whole number, 0 or more"));
  if (name == "bytes") return WantBytes{*count};
  return WantTriangles{*count};
}

// Reads `kbps`, a bandwidth in kilobits per second, and `seconds`. Returns a request for the number
// of bytes that arrive in this time.
tl::expected<DetailRequest, ParameterFault> parse_line(const Query& query) {
  double kbps = 0, seconds = 0;
  for (const auto& [name, value] : {std::pair("kbps", &kbps), std::pair("seconds", &seconds)}) {
    const auto text = query.get(name);
    if (!text) return tl::unexpected(ParameterFault{name, "kbps and seconds go together"});
    const auto number = parse_number<double>(*text);
    if (!number || !(*number > 0 && *number <= 1e9))
      return tl::unexpected(ParameterFault{name, "a number above 0, at most 1e9"});
    *value = *number;
  }
  const auto bytes = static_cast<std::uint64_t>(kbps * seconds * 1000 / 8);
  return DetailRequest{.want = WantBytes{bytes}, .kbps = kbps};
}

DetailRequest unstated(const RequestHeader& header, std::uint32_t levels) {
  if (saves_data(header)) return {.want = WantBytes{kSavedDataBytes}, .is_stated = false};
  return {.want = WantLevel{levels - 1}, .is_stated = false};
}

}  // namespace

bool saves_data(const RequestHeader& header) {
  return beast::iequals(header["Save-Data"], "on");
}

tl::expected<DetailRequest, ParameterFault> read_detail_request(
    const Query& query, const RequestHeader& header, const Manifest& manifest,
    std::span<const std::string_view> other) {
  const auto levels = static_cast<std::uint32_t>(manifest.levels.size());
  std::vector<std::string_view> known(std::begin(kParameters), std::end(kParameters));
  known.insert(known.end(), other.begin(), other.end());
  if (const auto name = query.unknown(known))
    return tl::unexpected(ParameterFault{std::string(*name), "unknown here"});
  std::optional<DetailRequest> detail;
  if (query.get("kbps") || query.get("seconds")) {
    const auto line = parse_line(query);
    if (!line) return line;
    detail = *line;
  }
  for (const std::string name : {"triangles", "error", "bytes", "level"}) {
    const auto text = query.get(name);
    if (!text) continue;
    if (detail)
      return tl::unexpected(
          ParameterFault{name, "only one of triangles, error, bytes, level, kbps with seconds"});
    const auto want = parse_want(name, *text, levels);
    if (!want) return tl::unexpected(ParameterFault{name, want.error()});
    detail = DetailRequest{.want = *want};
  }
  return detail.value_or(unstated(header, levels));
}

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

DetailForecast forecast_of(const Want& want, const Manifest& manifest) {
  Planner planner(manifest);
  planner.want(want);
  std::vector<bool> planned(manifest.chunks.size());
  while (const auto chunk = planner.next()) {
    planner.have(*chunk);
    planned[*chunk] = true;
  }
  const auto missing =
      static_cast<std::size_t>(std::ranges::find(planned, false) - planned.begin());
  const bool whole = missing == planned.size();
  const auto finest = static_cast<std::uint32_t>(manifest.levels.size() - 1);
  DetailForecast forecast{.level = whole ? finest : manifest.chunks[missing].level - 1,
                          .triangles = whole ? manifest.levels[finest].faces : planner.faces_held(),
                          .bytes = planner.bytes_held()};
  // The decoder applies only some vertex splits of the last chunk, so that the mesh stays within
  // the limit of WantTriangles.
  if (const auto* w = std::get_if<WantTriangles>(&want)) {
    while (forecast.level > 0 && manifest.levels[forecast.level].faces > w->triangles)
      --forecast.level;
    forecast.triangles = std::max<std::uint64_t>(std::min(forecast.triangles, w->triangles),
                                                 manifest.levels.front().faces);
  }
  forecast.error = manifest.levels[forecast.level].max_error;
  return forecast;
}

}  // namespace vitrine::server
