// SPDX-License-Identifier: Apache-2.0
#include "server/api/links.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <utility>

#include "codec/core/html.h"
#include "server/api/services.h"
#include "server/messages/timestamp.h"

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
constexpr std::pair<const char*, const char*> kElements[] = {{"date", "Date"},
                                                             {"subject", "Subject"},
                                                             {"coverage", "Place and period"},
                                                             {"publisher", "Publisher"},
                                                             {"contributor", "Contributors"},
                                                             {"identifier", "Inventory number"},
                                                             {"source", "Source"},
                                                             {"relation", "Related"},
                                                             {"language", "Language"},
                                                             {"type", "Type"}};

void insert_after(std::string& html, std::string_view place, std::string_view text) {
  if (const auto at = html.find(place); at != html.npos) html.insert(at + place.size(), text);
}

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

std::string licence(const std::string& text) {
  const auto url = rights_url(text);
  if (!url) return fact("Licence", text);
  return fmt::format("<dt>Licence</dt><dd><a rel=\"license\" href=\"{}\">{}</a></dd>",
                     escape_html(*url), escape_html(text));
}

std::string facts(const ModelRecord& model) {
  std::string html = fact("Creator", model.creator);
  for (const auto& [name, label] : kElements)
    if (const auto found = model.more.find(name); found != model.more.end())
      html += fact(label, found->second);
  html += fact("Rights", model.rights) + licence(model.licence) + fact("Unit", model.unit);
  return html +
         fact("Detail", fmt::format("{} triangles, {} bytes", model.faces, model.file_bytes));
}

std::string about(const ModelRecord& model) {
  const auto found = model.more.find("description");
  const std::string text = found == model.more.end() ? "" : paragraphs(found->second);
  return fmt::format("<h2>About this object</h2><div class=\"description\">{}</div><dl>{}</dl>",
                     text, facts(model));
}

// Returns HTML with the poster. Browsers with JavaScript do not load this poster.
std::string poster(const ModelRecord& model) {
  return fmt::format(
      "<noscript><img src=\"/api/v1/models/{}/poster.png?width={}\" width=\"{}\" height=\"{}\" "
      "alt=\"{}\"></noscript>",
      model.id.to_string(), kCanvasWidth, kCanvasWidth, kCanvasWidth, escape_html(model.title));
}

}  // namespace

std::string origin_of(const Request& request, Services& services) {
  if (std::string url = services.settings.get().public_url; !url.empty()) return url;
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

std::optional<std::string> rights_url(std::string_view licence) {
  for (const std::string_view scheme : {"https://", "http://"}) {
    if (!licence.starts_with(scheme)) continue;
    const std::string_view rest = licence.substr(scheme.size());
    if (rest.starts_with("creativecommons.org/") || rest.starts_with("rightsstatements.org/"))
      return "http://" + std::string(rest);
    return std::nullopt;
  }
  constexpr std::string_view kSite = "http://creativecommons.org/";
  if (licence == "CC0-1.0") return std::string(kSite) + "publicdomain/zero/1.0/";
  if (licence == "CC-PDM-1.0") return std::string(kSite) + "publicdomain/mark/1.0/";
  // Matches an identifier such as CC-BY-NC-SA-4.0. The groups are its terms and its version.
  const std::regex identifier("CC-(BY(?:-NC)?(?:-SA|-ND)?)-([1-4]\\.[05])");
  std::match_results<std::string_view::const_iterator> found;
  if (!std::regex_match(licence.begin(), licence.end(), found, identifier)) return std::nullopt;
  std::string terms = found[1].str();
  std::ranges::transform(terms, terms.begin(), [](unsigned char c) { return std::tolower(c); });
  return fmt::format("{}licenses/{}/{}/", kSite, terms, found[2].str());
}

std::string with_links(std::string_view html, const ModelRecord& model, std::string_view origin) {
  const ModelLinks links(model, origin);
  std::string page(html);
  const std::size_t title = page.find("<title>"), end = page.find("</title>");
  if (!model.title.empty() && title < end && end != page.npos)
    page.replace(title, end - title, "<title>" + escape_html(model.title));
  return page.insert(std::min(page.find("</head>"), page.size()),
                     preview(model, links) + structured_data(model, links));
}

std::string with_texts(std::string html, const ModelRecord& model) {
  insert_after(html, "<h1 id=\"title\">", escape_html(model.title));
  const bool has_both = !model.creator.empty() && !model.licence.empty();
  insert_after(html, "<p id=\"credit\">",
               escape_html(model.creator + (has_both ? " · " : "") + model.licence));
  insert_after(html, "<progressive-mesh camera-controls touch-action=\"none\">", poster(model));
  insert_after(html, "<aside id=\"about\">", about(model));
  return html;
}

}  // namespace vitrine::server
