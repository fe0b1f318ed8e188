// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/json_members.h"

#include <fmt/format.h>

#include <algorithm>

namespace vitrine::acquisition {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 8;
const json kEmptyObject = json::object();

}  // namespace

Expected<json> parse_json_object(std::string_view text, const std::string& place) {
  if (text.size() > kMaxJsonBytes) {
    return fail(ErrorCode::kLimit, fmt::format("{} is longer than {} bytes; give the right file",
                                               place, kMaxJsonBytes));
  }
  bool is_deep = false;
  const auto shallow = [&](int depth, json::parse_event_t, json&) {
    is_deep = is_deep || depth > kMaxDepth;
    return !is_deep;
  };
  json object = json::parse(text, shallow, /*allow_exceptions=*/false);
  if (!is_deep && object.is_object()) return object;
  return fail(
      ErrorCode::kBadInput,
      fmt::format("{} is not a JSON object; see acquisition/README.md for an example", place));
}

JsonMembers::JsonMembers(const json& object, std::string place,
                         std::initializer_list<std::string_view> known)
    : object_(object), place_(std::move(place)) {
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      fault(key, fmt::format("is an unknown key (known are {})", fmt::join(known, ", ")));
  }
}

const json* JsonMembers::find(std::string_view key) const {
  const auto it = object_.find(key);
  return it == object_.end() ? nullptr : &*it;
}

void JsonMembers::fault(std::string_view key, std::string_view what) {
  if (fault_) return;
  fault_ = Error{ErrorCode::kBadInput,
                 fmt::format("{}: \"{}\" {}; correct it there", place_, key, what)};
}

Expected<void> JsonMembers::check() const {
  if (fault_) return tl::unexpected(*fault_);
  return {};
}

std::string JsonMembers::text(std::string_view key, std::string_view otherwise) {
  constexpr std::size_t kMaxLength = 4'096;
  const json* value = find(key);
  if (value == nullptr) return std::string(otherwise);
  if (value->is_string() && value->get_ref<const std::string&>().size() <= kMaxLength)
    return value->get<std::string>();
  fault(key, "must be a string");
  return std::string(otherwise);
}

double JsonMembers::number(std::string_view key, double low, double high, double otherwise) {
  const json* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->is_number() && value->get<double>() >= low && value->get<double>() <= high)
    return value->get<double>();
  fault(key, fmt::format("must be a number from {} to {}", low, high));
  return otherwise;
}

int JsonMembers::whole(std::string_view key, int low, int high, int otherwise) {
  const json* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->is_number_integer() && value->get<double>() >= low && value->get<double>() <= high)
    return value->get<int>();
  fault(key, fmt::format("must be a whole number from {} to {}", low, high));
  return otherwise;
}

bool JsonMembers::flag(std::string_view key, bool otherwise) {
  const json* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->is_boolean()) return value->get<bool>();
  fault(key, "must be true or false");
  return otherwise;
}

std::size_t JsonMembers::choice(std::string_view key, std::span<const std::string_view> choices,
                                std::size_t otherwise) {
  if (find(key) == nullptr) return otherwise;
  const auto it = std::find(choices.begin(), choices.end(), text(key));
  if (it != choices.end()) return static_cast<std::size_t>(it - choices.begin());
  fault(key, fmt::format("must be one of {}", fmt::join(choices, ", ")));
  return otherwise;
}

JsonMembers JsonMembers::object(std::string_view key,
                                std::initializer_list<std::string_view> known) {
  const json* value = find(key);
  if (value != nullptr && !value->is_object()) fault(key, "must be an object");
  const bool usable = value != nullptr && value->is_object();
  return {usable ? *value : kEmptyObject, fmt::format("{}: {}", place_, key), known};
}

void JsonMembers::adopt(const JsonMembers& inner) {
  if (!fault_) fault_ = inner.fault_;
}

}  // namespace vitrine::acquisition
