// SPDX-License-Identifier: Apache-2.0
#include "codec/export/glb_description.h"

#include <string>

#include "codec/export/statements.h"

namespace vitrine::inline codec {
namespace {

// Writes the members of a JSON object, with commas between them.
class Members {
 public:
  explicit Members(FileWriter& json) : json_(json) {}

  void text(std::string_view name, std::string_view text) {
    const std::string line = one_line(text);
    if (!line.empty()) put_key(name), json_.quoted(line);
  }
  void put_key(std::string_view name) {
    if (!is_first_) json_.text(",");
    is_first_ = false;
    json_.quoted(name), json_.text(":");
  }

 private:
  FileWriter& json_;
  bool is_first_ = true;
};

std::string copyright_of(const FileDescription& about) {
  std::string all;
  for (const std::string* part : {&about.creator, &about.rights, &about.licence}) {
    const std::string line = one_line(*part);
    if (!line.empty()) all += (all.empty() ? "" : ", ") + line;
  }
  return all;
}

bool has_text(const FileDescription& about) {
  return !(about.title + about.creator + about.rights + about.licence + about.source).empty();
}

void put_extras(FileWriter& json, const ExportOptions& options) {
  const FileDescription& about = options.about;
  Members members(json);
  json.text("{");
  members.text("title", about.title);
  members.text("author", about.creator);
  members.text("rights", about.rights);
  members.text("license", about.licence);
  members.text("source", about.source);
  if (about.level) members.put_key("level"), json.number(*about.level);
  if (about.error) members.put_key("error"), json.number(*about.error);
  members.text("unit", options.unit.empty() ? "unknown" : options.unit);
  if (options.unit.empty())
    members.text("note", "the unit of the model is unknown; one unit is written as one metre");
  json.text("}");
}

// Writes a text without a language, as the "x-default" alternative that XMP demands for titles and
// rights.
void put_alternative(FileWriter& json, std::string_view text) {
  json.text(R"({"@type":"rdf:Alt","rdf:_1":{"@language":"x-default","@value":)");
  json.quoted(one_line(text)), json.text("}}");
}

// Writes an XMP packet with Dublin Core metadata and rights (KHR_xmp_json_ld of [glTF]).
void put_packet(FileWriter& json, const FileDescription& about) {
  json.text(R"({"@context":{"dc":"http://purl.org/dc/elements/1.1/",)"
            R"("rdf":"http://www.w3.org/1999/02/22-rdf-syntax-ns#",)"
            R"("xmpRights":"http://ns.adobe.com/xap/1.0/rights/"},"@id":"")");
  const auto put = [&](std::string_view name, const std::string& text) {
    if (text.empty()) return;
    json.text(","), json.quoted(name), json.text(":"), put_alternative(json, text);
  };
  put("dc:title", about.title);
  if (!about.creator.empty()) {
    json.text(R"(,"dc:creator":{"@list":[)"), json.quoted(one_line(about.creator));
    json.text("]}");
  }
  put("dc:rights", about.rights);
  put("xmpRights:UsageTerms", about.licence);
  if (!about.source.empty()) json.text(R"(,"dc:source":)"), json.quoted(one_line(about.source));
  json.text("}");
}

}  // namespace

void put_asset(FileWriter& json, const ExportOptions& options, GlbExtensions& extensions) {
  const bool has_packet = has_text(options.about);
  json.text(R"("asset":{"version":"2.0","generator":"Vitrine")");
  if (const std::string copyright = copyright_of(options.about); !copyright.empty())
    json.text(R"(,"copyright":)"), json.quoted(copyright);
  if (has_packet) json.text(R"(,"extensions":{"KHR_xmp_json_ld":{"packet":0}})");
  json.text(R"(,"extras":)"), put_extras(json, options), json.text("},");
  if (!has_packet) return;
  extensions.used.emplace_back("KHR_xmp_json_ld");
  json.text(R"("extensions":{"KHR_xmp_json_ld":{"packets":[)"), put_packet(json, options.about);
  json.text("]}},");
}

void put_extensions(FileWriter& json, const GlbExtensions& extensions) {
  const auto put = [&](std::string_view name, const std::vector<std::string_view>& list) {
    std::string_view separator = "[";
    if (!list.empty()) json.quoted(name), json.text(":");
    for (const std::string_view extension : list)
      json.text(separator), json.quoted(extension), separator = ",";
    if (!list.empty()) json.text("],");
  };
  put("extensionsUsed", extensions.used);
  put("extensionsRequired", extensions.required);
}

void put_name(FileWriter& json, const FileDescription& about, std::string_view part) {
  const std::string title = one_line(about.title);
  if (!title.empty()) json.text(R"(,"name":)"), json.quoted(title + std::string(part));
}

}  // namespace vitrine::inline codec
