// SPDX-License-Identifier: Apache-2.0
#include "server/messages/request_body.h"

#include <set>

#include "server/messages/http_header.h"

namespace vitrine::server {
namespace {

// Returns the media type without parameters such as "; charset=utf-8". All bodies are UTF-8.
std::string_view without_parameters(std::string_view media_type) {
  std::string_view name = media_type.substr(0, media_type.find(';'));
  while (name.ends_with(' ') || name.ends_with('\t'))
    name.remove_suffix(1);
  return name;
}

// Whether the media type is JSON, or a JSON merge patch [RFC7396], which a PATCH may send.
bool is_json(std::string_view media_type) {
  const auto name = without_parameters(media_type);
  return beast::iequals(name, "application/json") ||
         beast::iequals(name, "application/merge-patch+json");
}

// Detects repeated names and too deep nesting while the parser builds the value.
class Watch {
 public:
  bool operator()(int depth, nlohmann::json::parse_event_t event, const nlohmann::json& value) {
    using Event = nlohmann::json::parse_event_t;
    const bool starts = event == Event::object_start || event == Event::array_start;
    if (starts && depth >= kMaxBodyDepth) is_too_deep_ = true;
    if (event == Event::object_start) names_.emplace_back();
    if (event == Event::key && !names_.back().insert(value.get_ref<const std::string&>()).second)
      has_repeated_name_ = true;
    if (event == Event::object_end) names_.pop_back();
    return !is_too_deep_ && !has_repeated_name_;
  }
  bool is_too_deep() const { return is_too_deep_; }
  bool has_repeated_name() const { return has_repeated_name_; }

 private:
  std::vector<std::set<std::string>> names_;  // the names in each open object
  bool is_too_deep_ = false, has_repeated_name_ = false;
};

}  // namespace

tl::expected<nlohmann::json, BodyFault> parse_body(std::string_view media_type,
                                                   std::string_view text, std::size_t most) {
  if (text.empty()) return nlohmann::json::object();
  if (text.size() > most) return tl::unexpected(BodyFault{413, "the body is too large"});
  if (!is_json(media_type))
    return tl::unexpected(BodyFault{415, "send the body as application/json"});
  // Checks for NUL bytes, because the library would treat one as the end of the text.
  if (text.find('\0') != text.npos) return tl::unexpected(BodyFault{400, "the body is not JSON"});
  Watch watch;
  nlohmann::json json = nlohmann::json::parse(text, std::ref(watch), /*allow_exceptions=*/false);
  if (watch.is_too_deep()) return tl::unexpected(BodyFault{400, "the body is nested too deep"});
  if (watch.has_repeated_name()) return tl::unexpected(BodyFault{400, "the body has a name twice"});
  if (!json.is_object()) return tl::unexpected(BodyFault{400, "the body is not a JSON object"});
  return json;
}

std::optional<BodyFault> form_fault(std::string_view media_type, std::string_view text) {
  if (text.size() > kMaxForm) return BodyFault{413, "the form is larger than 8 KB"};
  if (!beast::iequals(without_parameters(media_type), "application/x-www-form-urlencoded"))
    return BodyFault{415, "send the body as application/x-www-form-urlencoded"};
  return std::nullopt;
}

}  // namespace vitrine::server
