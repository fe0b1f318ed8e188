// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "codec/core/sha256.h"
#include "server/api/handlers.h"
#include "server/api/published.h"
#include "server/api/web_pages.h"
#include "server/messages/content_coding.h"
#include "server/records/collection_page.h"
#include "server/records/links.h"

namespace vitrine::server {
namespace {

std::string tag_of(std::span<const std::uint8_t> bytes) {
  return '"' + to_hex(sha256(bytes)) + '"';
}

// The page that other sites show in an oEmbed frame.
constexpr std::string_view kViewer = "/model.html";
constexpr std::string_view kGallery = "/index.html";
// Number of models in the HTML of the gallery and of a collection's page. Its script loads the
// others.
constexpr std::uint32_t kModelsInPage = 24;

Response page(std::string_view path, const Request& request, Services& services) {
  const WebPage* found = services.pages.find(path);
  if (found == nullptr) return problem(404, "there is no such page", request.id);
  Response response;
  response.type = found->asset.type;
  response.caching = Caching::kRevalidate;
  response.etag = found->etag;
  response.is_embeddable = path == kViewer;
  response.body = SharedBytes{nullptr, found->asset.bytes};
  if (found->asset.gzip.empty()) return response;
  response.fields = {{"Vary", "Accept-Encoding"}};
  const auto codings = request.header[beast::http::field::accept_encoding];
  if (!accepts_gzip({codings.data(), codings.size()})) return response;
  response.fields.emplace_back("Content-Encoding", "gzip");
  response.etag = found->gzip_etag;
  response.body = SharedBytes{nullptr, found->asset.gzip};
  return response;
}

std::string_view text_of(const WebPage& page) {
  return {reinterpret_cast<const char*>(page.asset.bytes.data()), page.asset.bytes.size()};
}

std::string sitemap_entry(std::string_view element, std::string_view origin,
                          std::string_view path) {
  return fmt::format("<{0}><loc>{1}{2}</loc></{0}>\n", element, origin, path);
}

// Returns the sitemap entries of the gallery and of the first kMostListed collections.
std::string first_entries(const std::vector<std::string>& collections, std::string_view origin) {
  std::string entries = sitemap_entry("url", origin, "/");
  const std::size_t most = std::min<std::size_t>(collections.size(), kMostListed);
  for (const std::string& name : std::span(collections).first(most))
    entries += sitemap_entry("url", origin, collection_path(name));
  return entries;
}

Response sitemap(std::string_view element, std::string_view entries) {
  return revalidated(
      "application/xml",
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                  "<{0} xmlns=\"http://www.sitemaps.org/schemas/sitemap/0.9\">\n{1}</{0}>\n",
                  element, entries));
}

}  // namespace

WebPages::WebPages(std::span<const WebAsset> assets) {
  for (const WebAsset& asset : assets)
    pages_.emplace(asset.path, WebPage{asset, tag_of(asset.bytes), tag_of(asset.gzip)});
}

const WebPage* WebPages::find(std::string_view path) const {
  const auto found = pages_.find(path);
  return found == pages_.end() ? nullptr : &found->second;
}

// Shows the newest models, also to browsers without JavaScript. The script of the page shows them
// alone if the URL has a search or if the catalogue fails.
static Response show_gallery(const Request& request, Services& services) {
  const WebPage* gallery = services.pages.find(kGallery);
  if (gallery == nullptr || !request.query.empty()) return page(kGallery, request, services);
  const auto found = services.catalogue.search({.limit = kModelsInPage});
  if (!found) {
    tell_operator(found.error(), request.id, services);
    return page(kGallery, request, services);
  }
  return revalidated(
      gallery->asset.type,
      with_gallery(std::string(text_of(*gallery)), found->models, origin_of(request, services)));
}

static Response show_viewer(const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const WebPage* found = services.pages.find(kViewer);
    if (found == nullptr) return problem(404, "there is no such page", request.id);
    const ModelRecord& record = model->record();
    const auto size = dimensions_of(record, model->manifest());
    const std::string text(text_of(*found));
    Response response = revalidated(
        found->asset.type, with_texts(with_links(text, record, origin_of(request, services)),
                                      record, size ? to_text(*size) : ""));
    response.is_embeddable = true;
    return response;
  });
}

// Returns the page of a collection, or 404 if no published model belongs to the collection.
static Response show_collection(const Request& request, Services& services) {
  const std::string name = collection_in(request);
  const auto found =
      services.catalogue.search({.facets = {{"collection", name}}, .limit = kModelsInPage});
  if (!found) return internal_error(found.error(), request, services);
  const WebPage* gallery = services.pages.find(kGallery);
  if (found->models.empty() || gallery == nullptr)
    return problem(404, "there is no such collection", request.id);
  return revalidated(gallery->asset.type,
                     with_collection(std::string(text_of(*gallery)), name, found->models,
                                     origin_of(request, services)));
}

static Response show_docs(const Request& request, Services& services) {
  return page("/docs.html", request, services);
}

// Returns the same page for every ID, so that the page does not reveal which scans exist.
static Response show_scan_page(const Request& request, Services& services) {
  return page("/scan.html", request, services);
}

static Response show_console(const Request& request, Services& services) {
  return page("/console.html", request, services);
}

Response show_asset(const Request& request, Services& services) {
  return page(request.path, request, services);
}

// Asks search engines not to visit the console and the pages of scans, and names the sitemap.
static Response show_robots(const Request& request, Services& services) {
  return revalidated("text/plain; charset=utf-8",
                     fmt::format("User-agent: *\nDisallow: /console\nDisallow: /scans/\n"
                                 "Sitemap: {}/sitemap.xml\n",
                                 origin_of(request, services)));
}

// Returns a sitemap (sitemaps.org) of the pages of the published models and of their collections.
// If these are too many for one sitemap, returns a sitemap index.
static Response show_sitemap(const Request& request, Services& services) {
  const std::string origin = origin_of(request, services);
  const auto collections = services.catalogue.collections();
  if (!collections) return internal_error(collections.error(), request, services);
  const auto index = [&](const std::vector<ModelId>& cursors) {
    std::string entries;
    for (const ModelId& cursor : cursors)
      entries += sitemap_entry("sitemap", origin, "/sitemap.xml?cursor=" + cursor.to_string());
    return sitemap("sitemapindex", entries);
  };
  const auto models_page = [&](const std::vector<ModelRecord>& models,
                               const std::optional<ModelId>& cursor) {
    const bool is_first = !cursor || *cursor == first_cursor();
    std::string entries = is_first ? first_entries(*collections, origin) : std::string();
    for (const ModelRecord& model : models)
      entries += sitemap_entry("url", origin, "/models/" + model.id.to_string());
    return sitemap("urlset", entries);
  };
  return in_pages(request, services, index, models_page);
}

// Browsers request /favicon.ico even if a page does not link to it.
static Response show_favicon(const Request& request, Services& services) {
  return page("/favicon.svg", request, services);
}

static constexpr ApiRoute kPageRoutes[] = {
    {.method = Method::kGet, .path = "/", .handler = show_gallery, .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/models/{id}",
     .handler = show_viewer,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/collections/{collection}",
     .handler = show_collection,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/scans/{id}",
     .handler = show_scan_page,
     .executor = Executor::kInline},
    {.method = Method::kGet, .path = "/docs", .handler = show_docs, .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/console",
     .handler = show_console,
     .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/robots.txt",
     .handler = show_robots,
     .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/sitemap.xml",
     .handler = show_sitemap,
     .executor = Executor::kWorker},
    {.method = Method::kGet,
     .path = "/favicon.ico",
     .handler = show_favicon,
     .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/{rest}",
     .handler = show_asset,
     .executor = Executor::kInline},
};

const ApiNoun kPages = {.routes = kPageRoutes};

}  // namespace vitrine::server
