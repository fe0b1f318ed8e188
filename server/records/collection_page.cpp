// SPDX-License-Identifier: Apache-2.0
#include "server/records/collection_page.h"

#include <fmt/format.h>

#include "codec/core/html.h"
#include "server/records/described_model.h"
#include "server/records/html.h"
#include "server/records/links.h"

namespace vitrine::server {
namespace {

std::string collection_head(std::string_view collection, std::string_view origin) {
  return fmt::format(
      "<link rel=\"canonical\" href=\"{page}\">\n"
      "<meta property=\"og:title\" content=\"{name}\">\n"
      "<meta property=\"og:type\" content=\"website\">\n"
      "<meta property=\"og:url\" content=\"{page}\">\n"
      "<link rel=\"alternate\" type=\"application/ld+json\" href=\"{iiif}\">\n",
      fmt::arg("name", escape_html(collection)),
      fmt::arg("page", escape_html(std::string(origin) + collection_path(collection))),
      fmt::arg("iiif", escape_html(std::string(origin) + collection_iiif_path(collection))));
}

std::string model_card(const ModelRecord& record) {
  const DescribedModel model(record, "");
  return fmt::format(
      "<li><a href=\"{}\"><div class=\"poster\"><img src=\"{}\" alt=\"\" width=\"{}\" "
      "height=\"{}\" loading=\"lazy\"></div><h2>{}</h2><p>{}</p></a></li>",
      model.page_url(), model.poster_url(), kCanvasWidth, kCanvasWidth, escape_html(model.title()),
      escape_html(record.creator));
}

}  // namespace

std::string collection_path(std::string_view collection) {
  return "/collections/" + escape_query(collection);
}

std::string collection_iiif_path(std::string_view collection) {
  return "/api/v1/iiif/collection.json?collection=" + escape_query(collection);
}

std::string with_collection(std::string html, std::string_view collection,
                            std::span<const ModelRecord> models, std::string_view origin) {
  replace_title(html, collection);
  html.insert(std::min(html.find("</head>"), html.size()), collection_head(collection, origin));
  insert_after(html, "<h1 id=\"title\">", escape_html(collection));
  std::string cards;
  for (const ModelRecord& model : models)
    cards += model_card(model);
  insert_after(html, "<ul id=\"models\">", cards);
  return html;
}

}  // namespace vitrine::server
