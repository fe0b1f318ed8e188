// SPDX-License-Identifier: Apache-2.0
#include "server/records/links.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "codec/core/html.h"
#include "server/messages/timestamp.h"
#include "server/metadata/rights.h"
#include "server/records/collection_page.h"
#include "server/records/html.h"
#include "server/records/record_format.h"

namespace vitrine::server {
namespace {

// Whether `text` is a host and port without characters that are special in HTML, JSON or paths.
bool is_host(std::string_view text) {
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == ':' ||
           c == '[' || c == ']';
  };
  return !text.empty() && text.size() <= 255 && std::ranges::all_of(text, fits);
}

// The URLs of a model.
struct ModelLinks {
  ModelLinks(const ModelRecord& model, std::string_view origin)
      : page(fmt::format("{}/models/{}", origin, model.id.to_string())),
        api(fmt::format("{}/api/v1/models/{}", origin, model.id.to_string())),
        poster(fmt::format("{}/poster.png?width={}", api, kCanvasWidth)),
        oembed(fmt::format("{}/api/v1/oembed?url={}", origin, escape_query(page))),
        iiif(fmt::format("{}/api/v1/iiif/{}/manifest.json", origin, model.id.to_string())) {}

  std::string page, api, poster, oembed, iiif;
};

std::string description_of(const ModelRecord& model) {
  const auto found = model.more.find("description");
  if (found != model.more.end()) return found->second;
  return model.creator.empty() ? "A 3D model" : "A 3D model by " + model.creator;
}

// Returns the elements of a page's head for link previews, search engines and embedding sites.
std::string preview(const ModelRecord& model, const ModelLinks& links) {
  return fmt::format(
      "<meta name=\"description\" content=\"{about}\">\n"
      "<link rel=\"canonical\" href=\"{page}\">\n"
      "<meta property=\"og:title\" content=\"{title}\">\n"
      "<meta property=\"og:description\" content=\"{about}\">\n"
      "<meta property=\"og:type\" content=\"website\">\n"
      "<meta property=\"og:url\" content=\"{page}\">\n"
      "<meta property=\"og:image\" content=\"{poster}\">\n"
      "<meta property=\"og:image:width\" content=\"{width}\">\n"
      "<meta property=\"og:image:height\" content=\"{width}\">\n"
      "<meta name=\"twitter:card\" content=\"summary_large_image\">\n"
      "<link rel=\"alternate\" type=\"application/json+oembed\" title=\"{title}\" "
      "href=\"{oembed}\">\n"
      "<link rel=\"alternate\" type=\"application/ld+json\" href=\"{iiif}\">\n",
      fmt::arg("title", escape_html(model.title)),
      fmt::arg("about", escape_html(description_of(model))), fmt::arg("page", links.page),
      fmt::arg("poster", links.poster), fmt::arg("width", kCanvasWidth),
      fmt::arg("oembed", links.oembed), fmt::arg("iiif", links.iiif));
}

// Returns links to the model's records.
std::string record_links(const ModelLinks& links) {
  std::string html;
  for (const RecordFormat* format : kRecordFormats) {
    html += fmt::format(
        "<link rel=\"alternate\" type=\"application/xml\" title=\"{}\" href=\"{}/{}\">\n",
        format->label, links.api, format->file);
  }
  return html;
}

// Returns the DOI, the persistent identifier and the inventory number of a model, as schema.org
// writes them.
nlohmann::ordered_json identifiers(const ModelRecord& record) {
  const DescribedModel model(record, "");
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& uri : {model.doi_url(), model.text("persistent_identifier")})
    if (!uri.empty()) all.push_back(uri);
  if (const std::string& number = model.text("identifier"); !number.empty()) {
    all.push_back(
        {{"@type", "PropertyValue"}, {"propertyID", "inventory number"}, {"value", number}});
  }
  return all;
}

// Returns a script element with the model as a 3DModel of schema.org. Browsers do not run it, so
// the content security policy does not block it.
std::string structured_data(const ModelRecord& model, const ModelLinks& links) {
  nlohmann::ordered_json json = {
      {"@context", "https://schema.org"},       {"@type", "3DModel"}, {"name", model.title},
      {"description", description_of(model)},   {"url", links.page},  {"image", links.poster},
      {"dateCreated", timestamp(model.created)}};
  if (!model.creator.empty()) json["creator"] = {{"@type", "Person"}, {"name", model.creator}};
  if (!model.rights.empty()) json["copyrightNotice"] = model.rights;
  if (!model.licence.empty()) json["license"] = rights_url(model.licence).value_or(model.licence);
  if (const auto found = model.more.find("subject"); found != model.more.end())
    json["keywords"] = found->second;
  if (auto ids = identifiers(model); !ids.empty()) json["identifier"] = std::move(ids);
  json["encoding"] = {{"@type", "MediaObject"},
                      {"contentUrl", links.api + "/export.glb"},
                      {"encodingFormat", "model/gltf-binary"}};
  std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  // Escapes "<", because "</script>" in a text would end the element.
  for (std::size_t at = 0; (at = text.find('<', at)) != text.npos;)
    text.replace(at, 1, "\\u003c");
  return "<script type=\"application/ld+json\">" + text + "</script>\n";
}

// The labels of the facts on a model's page, in the same order as in web/src/ui/about.ts.
constexpr std::pair<const char*, const char*> kElements[] = {
    {"date", "Date"},
    {"subject", "Subject"},
    {"coverage", "Place and period"},
    {"place", "Place"},
    {"period", "Period"},
    {"material", "Material"},
    {"technique", "Technique"},
    {"provenance", "Provenance"},
    {"publisher", "Publisher"},
    {"contributor", "Contributors"},
    {"identifier", "Inventory number"},
    {"source", "Source"},
    {"relation", "Related"},
    {"language", "Language"},
    {"type", "Type"},
    {"scan_device", "Scanner"},
    {"scan_calibration", "Calibration"},
    {"scan_date", "Date of the scan"},
    {"scan_software", "Software of the scan"}};

std::string paragraphs(const std::string& text) {
  std::string html;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) html += "<p>" + escape_html(line) + "</p>";
  return html;
}

std::string fact(std::string_view name, const std::string& value) {
  if (value.empty()) return {};
  return fmt::format("<dt>{}</dt><dd>{}</dd>", name, escape_html(value));
}

std::string more(const ModelRecord& model, const std::string& name) {
  const auto found = model.more.find(name);
  return found == model.more.end() ? std::string() : found->second;
}

std::string collections(const std::string& names) {
  std::string html;
  for (const std::string& name : values_in(names)) {
    html += fmt::format("{}<a href=\"{}\">{}</a>", html.empty() ? "" : "; ", collection_path(name),
                        escape_html(name));
  }
  return html.empty() ? html : "<dt>Collection</dt><dd>" + html + "</dd>";
}

std::string doi(const ModelRecord& record) {
  const DescribedModel model(record, "");
  if (model.doi_url().empty()) return {};
  return fmt::format("<dt>DOI</dt><dd><a href=\"{}\">{}</a></dd>", escape_html(model.doi_url()),
                     escape_html(model.text("doi")));
}

std::string persistent_identifier(const std::string& uri) {
  if (!uri.starts_with("https://") && !uri.starts_with("http://"))
    return fact("Persistent identifier", uri);
  return fmt::format("<dt>Persistent identifier</dt><dd><a href=\"{0}\">{0}</a></dd>",
                     escape_html(uri));
}

std::string rights_statement(const std::string& uri) {
  if (uri.empty()) return {};
  return fmt::format("<dt>Rights statement</dt><dd><a href=\"{}\">{}</a></dd>", escape_html(uri),
                     escape_html(rights_statement_label(uri)));
}

std::string licence(const std::string& text) {
  const auto url = rights_url(text);
  if (!url) return fact("Licence", text);
  // The identifier begins with "http:", but the link uses "https:", as the page's script does.
  constexpr std::string_view kScheme = "http:";
  return fmt::format("<dt>Licence</dt><dd><a rel=\"license\" href=\"https:{}\">{}</a></dd>",
                     escape_html(url->substr(kScheme.size())), escape_html(text));
}

std::string facts(const ModelRecord& model, const std::string& dimensions) {
  std::string html = fact("Creator", model.creator);
  for (const auto& [name, label] : kElements)
    if (const auto found = model.more.find(name); found != model.more.end())
      html += fact(label, found->second);
  html += collections(more(model, "collection"));
  html += persistent_identifier(more(model, "persistent_identifier"));
  html += doi(model) + fact("Dimensions", dimensions);
  html += fact("Rights", model.rights) + rights_statement(more(model, "rights_statement"));
  html += licence(model.licence) + fact("Unit", model.unit);
  return html +
         fact("Detail", fmt::format("{} triangles, {} bytes", model.faces, model.file_bytes));
}

std::string about(const ModelRecord& model, const std::string& dimensions) {
  const std::string text = paragraphs(more(model, "description"));
  return fmt::format("<h2>About this object</h2><div class=\"description\">{}</div><dl>{}</dl>",
                     text, facts(model, dimensions));
}

// Returns HTML that shows the poster only in browsers without JavaScript.
std::string poster(const ModelRecord& model) {
  return fmt::format(
      "<noscript><img src=\"/api/v1/models/{}/poster.png?width={}\" width=\"{}\" height=\"{}\" "
      "alt=\"{}\"></noscript>",
      model.id.to_string(), kCanvasWidth, kCanvasWidth, kCanvasWidth, escape_html(model.title));
}

}  // namespace

std::string origin_of(const Request& request, const std::string& public_url) {
  if (!public_url.empty()) return public_url;
  const auto host = request.header[beast::http::field::host];
  const std::string_view text(host.data(), host.size());
  return is_host(text) ? (request.is_encrypted ? "https://" : "http://") + std::string(text)
                       : std::string();
}

std::string escape_query(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain =
        byte < 0x80 && (std::isalnum(byte) != 0 || c == '-' || c == '.' || c == '_' || c == '~');
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return out;
}

std::string with_links(std::string_view html, const ModelRecord& model, std::string_view origin) {
  const ModelLinks links(model, origin);
  std::string page(html);
  replace_title(page, model.title);
  return page.insert(std::min(page.find("</head>"), page.size()),
                     preview(model, links) + record_links(links) + structured_data(model, links));
}

std::string with_texts(std::string html, const ModelRecord& model, const std::string& dimensions) {
  insert_after(html, "<h1 id=\"title\">", escape_html(model.title));
  const bool has_both = !model.creator.empty() && !model.licence.empty();
  insert_after(html, "<p id=\"credit\">",
               escape_html(model.creator + (has_both ? " · " : "") + model.licence));
  insert_after(html, "<progressive-mesh camera-controls touch-action=\"none\">", poster(model));
  insert_after(html, "<aside id=\"about\">", about(model, dimensions));
  return html;
}

}  // namespace vitrine::server
