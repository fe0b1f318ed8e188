// SPDX-License-Identifier: Apache-2.0
#include "server/stream/message.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace vitrine {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr int kMaxDepth = 4;
constexpr const char* kOneOf = "want: give one of triangles, bytes, level, error, view";

Unexpected malformed(const char* why) {
  return fail(ErrorCode::kBadInput, why);
}

std::optional<std::uint64_t> whole(const Json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  return value.get<std::uint64_t>();
}

bool read_number(const Json& json, const char* name, double& out) {
  const auto member = json.find(name);
  if (member == json.end() || !member->is_number()) return false;
  out = member->get<double>();
  return true;
}

std::optional<View> to_view(const Json& json) {
  View view;
  if (!json.is_object()) return std::nullopt;
  const auto camera = json.find("camera");
  if (camera == json.end() || !camera->is_array() || camera->size() != view.camera.size()) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < view.camera.size(); ++i) {
    if (!(*camera)[i].is_number()) return std::nullopt;
    view.camera[i] = (*camera)[i].get<double>();
  }
  const bool complete =
      read_number(json, "fov", view.field_of_view) && read_number(json, "width", view.width) &&
      read_number(json, "height", view.height) && read_number(json, "pixels", view.pixel_error);
  if (!complete || (json.contains("bytes") && !read_number(json, "bytes", view.bytes))) {
    return std::nullopt;
  }
  return is_sane(view) ? std::optional(view) : std::nullopt;
}

Expected<ClientMessage> parse_want(const Json& json) {
  if (const auto seen = json.find("view"); seen != json.end()) {
    const auto view = to_view(*seen);
    if (!view) return malformed("want: view has camera (16 numbers), fov, width, height, pixels");
    for (const char* const name : {"triangles", "bytes", "level", "error"}) {
      if (json.contains(name)) return malformed(kOneOf);
    }
    return Want(*view);
  }
  std::optional<Want> want;
  for (const char* const name : {"triangles", "bytes", "level", "error"}) {
    const auto member = json.find(name);
    if (member == json.end()) continue;
    if (want) return malformed(kOneOf);
    const std::string_view key = name;
    const auto count = whole(*member);
    if (key == "error") {
      if (!member->is_number() || !(member->get<double>() >= 0)) {
        return malformed("want: error is a number, 0 or more");
      }
      want = WantError{member->get<double>()};
    } else if (!count) {
      return malformed("want: triangles, bytes and level are whole numbers, 0 or more");
    } else if (key == "triangles") {
      want = WantTriangles{*count};
    } else if (key == "bytes") {
      want = WantBytes{*count};
    } else {
      want = WantLevel{static_cast<std::uint32_t>(std::min<std::uint64_t>(*count, UINT32_MAX))};
    }
  }
  if (!want) return malformed(kOneOf);
  return *want;
}

Expected<ClientMessage> parse_have(const Json& json) {
  const auto chunks = json.find("chunks");
  if (chunks == json.end() || !chunks->is_array() || chunks->size() > kMaxHaveRanges) {
    return malformed("have: chunks is a list of at most 4096 ranges");
  }
  HaveMessage have;
  for (const Json& range : *chunks) {
    if (!range.is_array() || range.size() != 2) return malformed("have: a range is [first, last]");
    const auto first = whole(range[0]);
    const auto last = whole(range[1]);
    if (!first || !last || *last < *first) return malformed("have: a range is [first, last]");
    if (!have.chunks.empty() && *first <= have.chunks.back().last) {
      return malformed("have: the ranges ascend");
    }
    have.chunks.push_back({*first, *last});
  }
  return have;
}

Expected<ClientMessage> parse_ack(const Json& json) {
  const auto bytes = json.find("bytes");
  const auto count = bytes == json.end() ? std::nullopt : whole(*bytes);
  if (!count || *count < 1 || *count > kMaxAck) {
    return malformed("ack: bytes is a whole number from 1 to 16777216");
  }
  return AckMessage{*count};
}

}  // namespace

Expected<ClientMessage> parse_message(std::string_view text) {
  // Deeper values are dropped while parsing, so that nesting cannot exhaust the stack.
  const auto shallow = [](int depth, Json::parse_event_t, Json&) { return depth < kMaxDepth; };
  const Json json = Json::parse(text, shallow, /*allow_exceptions=*/false);
  if (!json.is_object()) return malformed("a message is a JSON object");
  const auto type = json.find("type");
  if (type == json.end() || !type->is_string()) return malformed("a message has a type");
  if (*type == "want") return parse_want(json);
  if (*type == "have") return parse_have(json);
  if (*type == "ack") return parse_ack(json);
  return malformed("the type is want, have or ack");
}

std::string to_json(const ModelMessage& message) {
  return OrderedJson{{"type", "model"},
                     {"sha256", message.sha256},
                     {"chunks", message.chunks},
                     {"slice_bytes", message.slice_bytes},
                     {"credit", message.credit}}
      .dump();
}

std::string to_json(const DoneMessage& message) {
  return OrderedJson{{"type", "done"}, {"bytes", message.bytes}, {"triangles", message.triangles}}
      .dump();
}

}  // namespace vitrine
