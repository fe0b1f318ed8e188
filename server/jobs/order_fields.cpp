// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/order_fields.h"

#include "codec/format/manifest.h"
#include "server/metadata/fields.h"
#include "server/metadata/text.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::json;

// Returns the strings of an array, joined by line feeds. Returns nullopt if one of them is not a
// line of plain text, or if the result is too long.
std::optional<std::string> joined(const Json& lines) {
  if (!lines.is_array()) return std::nullopt;
  std::string text;
  for (const Json& line : lines) {
    const auto* given = line.get_ptr<const std::string*>();
    if (given == nullptr || !is_plain_text(*given)) return std::nullopt;
    text += (text.empty() ? "" : "\n") + *given;
  }
  return text.size() <= kMaxParagraphBytes ? std::optional(std::move(text)) : std::nullopt;
}

}  // namespace

void Fields::only(std::span<const std::string_view> known) {
  for (const auto& [name, value] : object_.items()) {
    if (std::ranges::find(known, name) == known.end()) fault(name, "unknown here");
  }
}

void Fields::text(const char* name, std::string& value) {
  const auto found = object_.find(name);
  if (found == object_.end()) return;
  if (found->is_null()) return value.clear();
  const auto* given = found->get_ptr<const std::string*>();
  if (given == nullptr || !is_line(*given))
    return fault(name, fmt::format("one line of text of at most {} bytes", kMaxLineBytes));
  value = *given;
}

void Fields::paragraphs(const char* name, std::string& value) {
  const auto found = object_.find(name);
  if (found == object_.end()) return;
  if (found->is_null()) return value.clear();
  const auto* given = found->get_ptr<const std::string*>();
  std::string text = given == nullptr ? "" : *given;
  std::erase(text, '\r');
  if (given == nullptr || !is_paragraphs(text))
    return fault(name, fmt::format("text of at most {} bytes", kMaxParagraphBytes));
  value = std::move(text);
}

void Fields::lines(const char* name, std::string& value) {
  const auto found = object_.find(name);
  if (found == object_.end()) return;
  auto text = joined(*found);
  if (!text)
    return fault(name, fmt::format("lines of text of at most {} bytes in all", kMaxParagraphBytes));
  value = std::move(*text);
}

void Fields::whole(const char* name, int low, int high, int& value) {
  const auto found = object_.find(name);
  if (found == object_.end()) return;
  const bool is_whole = found->is_number_integer();
  if (!is_whole || *found < low || *found > high) {
    return fault(name, fmt::format("a whole number from {} to {}", low, high));
  }
  value = found->get<int>();
}

void Fields::flag(const char* name, bool& value) {
  const auto found = object_.find(name);
  if (found == object_.end()) return;
  if (!found->is_boolean()) return fault(name, "true or false");
  value = found->get<bool>();
}

void read_bits(Fields& fields, const Json& body, int& bits) {
  const auto found = body.find("bits");
  if (found == body.end() || *found == "auto") return;
  if (found->is_number_integer() && *found == 0) {
    bits = 0;
    return;
  }
  const bool fits = found->is_number_integer() && *found >= kMinBits && *found <= kMaxBits;
  if (!fits) {
    return fields.fault("bits",
                        fmt::format("auto or a whole number from {} to {}", kMinBits, kMaxBits));
  }
  bits = found->get<int>();
}

std::vector<std::string_view> metadata_names() {
  std::vector<std::string_view> names = {"title", "creator", "rights", "licence"};
  names.insert(names.end(), std::begin(kMoreTexts), std::end(kMoreTexts));
  return names;
}

void read_texts(Fields& fields, ModelMetadata& metadata) {
  fields.text("title", metadata.title);
  fields.text("creator", metadata.creator);
  fields.paragraphs("rights", metadata.rights);
  fields.text("licence", metadata.licence);
  for (const std::string_view element : kMoreTexts) {
    const std::string name(element);
    std::string text = metadata.more[name];
    if (has_paragraphs(element))
      fields.paragraphs(name.c_str(), text);
    else
      fields.text(name.c_str(), text);
    if (const auto expected = expected_text(name, text))
      fields.fault(name.c_str(), *expected);
    else
      metadata.more[name] = text;
  }
  std::erase_if(metadata.more, [](const auto& element) { return element.second.empty(); });
}

void read_metadata(Fields& fields, const Json& body, ModelMetadata& metadata, FieldFaults& faults) {
  const auto found = body.find("metadata");
  if (found == body.end()) return;
  if (!found->is_object()) return fields.fault("metadata", "an object");
  Fields texts(*found, "metadata.", faults);
  texts.only(metadata_names());
  read_texts(texts, metadata);
}

Json to_json(const ModelMetadata& metadata) {
  Json json = metadata.more;
  json["title"] = metadata.title;
  json["creator"] = metadata.creator;
  json["rights"] = metadata.rights;
  json["licence"] = metadata.licence;
  return json;
}

}  // namespace vitrine::server
