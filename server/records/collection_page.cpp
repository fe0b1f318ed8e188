// SPDX-License-Identifier: Apache-2.0
#include "server/records/collection_page.h"

#include <fmt/format.h>

#include "codec/core/html.h"
#include "server/records/described_model.h"
#include "server/records/html.h"
#include "server/records/links.h"

namespace vitrine::server {
namespace {

// Returns the <head> elements of a page that lists models. `page` and `iiif` are the paths of the
// page and of its IIIF collection.
std::string list_head(std::string_view name, std::string_view page, std::string_view iiif,
                      std::string_view origin) {
  return fmt::format(
      "<link rel=\"canonical\" href=\"{page}\">\n"
      "<meta property=\"og:title\" content=\"{name}\">\n"
      "<meta property=\"og:type\" content=\"website\">\n"
      "<meta property=\"og:url\" content=\"{page}\">\n"
      "<link rel=\"alternate\" type=\"application/ld+json\" href=\"{iiif}\">\n",
      fmt::arg("name", escape_html(name)),
      fmt::arg("page", escape_html(fmt::format("{}{}", origin, page))),
      fmt::arg("iiif", escape_html(fmt::format("{}{}", origin, iiif))));
}

// The poster is that of the page's script, so that browsers load one picture.
std::string model_card(const ModelRecord& record) {
  const DescribedModel model(record, "");
  return fmt::format(
      "<li><a href=\"{}\"><div class=\"poster\"><img src=\"{}\" alt=\"\" width=\"{}\" "
      "height=\"{}\" loading=\"lazy\"></div><h2>{}</h2><p>{}</p></a></li>",
      model.page_url(), model.card_poster_url(), kPosterWidth, kPosterWidth,
      escape_html(model.title()), escape_html(record.creator));
}

// Returns `html` with a heading, elements for <head>, and a list of models.
std::string with_list(std::string html, std::string_view heading, std::string_view head,
                      std::span<const ModelRecord> models) {
  html.insert(std::min(html.find("</head>"), html.size()), head);
  insert_after(html, "<h1 id=\"title\">", escape_html(heading));
  std::string cards;
  for (const ModelRecord& model : models)
    cards += model_card(model);
  insert_after(html, "<ul id=\"models\">", cards);
  return html;
}

constexpr std::string_view kIiifPath = "/api/v1/iiif/collection.json";

}  // namespace

std::string collection_path(std::string_view collection) {
  return "/collections/" + escape_query(collection);
}

std::string collection_iiif_path(std::string_view collection) {
  return fmt::format("{}?collection={}", kIiifPath, escape_query(collection));
}

std::string with_collection(std::string html, std::string_view collection,
                            std::span<const ModelRecord> models, std::string_view origin) {
  replace_title(html, collection);
  return with_list(
      std::move(html), collection,
      list_head(collection, collection_path(collection), collection_iiif_path(collection), origin),
      models);
}

std::string with_gallery(std::string html, std::span<const ModelRecord> models,
                         std::string_view origin) {
  constexpr std::string_view kHeading = "Collection";  // as in web/src/ui/texts/en.ts
  return with_list(std::move(html), kHeading, list_head(kHeading, "/", kIiifPath, origin), models);
}

}  // namespace vitrine::server
