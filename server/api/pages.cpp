// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "server/api/handlers.h"
#include "server/api/links.h"
#include "server/api/published.h"
#include "server/messages/content_coding.h"

namespace vitrine::server {
namespace {

// The page that oEmbed offers to other sites in a frame.
constexpr std::string_view kViewer = "/model.html";

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

}  // namespace

static Response show_gallery(const Request& request, Services& services) {
  return page("/index.html", request, services);
}

static Response show_viewer(const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const WebPage* found = services.pages.find(kViewer);
    if (found == nullptr) return problem(404, "there is no such page", request.id);
    const std::span html = found->asset.bytes;
    const ModelRecord& record = model->record();
    const std::string text(reinterpret_cast<const char*>(html.data()), html.size());
    Response response =
        revalidated(found->asset.type,
                    with_texts(with_links(text, record, origin_of(request, services)), record));
    response.is_embeddable = true;
    return response;
  });
}

static Response show_docs(const Request& request, Services& services) {
  return page("/docs.html", request, services);
}

// Returns the same page for every ID. Whether a scan exists can be learned only from the API.
static Response show_scan_page(const Request& request, Services& services) {
  return page("/scan.html", request, services);
}

static Response show_console(const Request& request, Services& services) {
  return page("/console.html", request, services);
}

Response show_asset(const Request& request, Services& services) {
  return page(request.path, request, services);
}

// Tells search engines to index the collection and its models, but no pages that need a token.
static Response show_robots(const Request& request, Services& services) {
  return revalidated("text/plain; charset=utf-8",
                     fmt::format("User-agent: *\nDisallow: /console\nDisallow: /scans/\n"
                                 "Sitemap: {}/sitemap.xml\n",
                                 origin_of(request, services)));
}

// Lists the pages of the published models (sitemaps.org).
static Response show_sitemap(const Request& request, Services& services) {
  const auto models = all_public(services);
  if (!models) return internal_error(models.error(), request, services);
  const std::string origin = origin_of(request, services);
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<urlset xmlns=\"http://www.sitemaps.org/schemas/sitemap/0.9\">\n";
  xml += fmt::format("<url><loc>{}/</loc></url>\n", origin);
  for (const ModelRecord& model : *models)
    xml += fmt::format("<url><loc>{}/models/{}</loc></url>\n", origin, model.id.to_string());
  return revalidated("application/xml", xml + "</urlset>\n");
}

// Browsers request this path even if no page links to it.
static Response show_favicon(const Request& request, Services& services) {
  return page("/favicon.svg", request, services);
}

static constexpr ApiRoute kPageRoutes[] = {
    {.method = Method::kGet, .path = "/", .handler = show_gallery, .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/models/{id}",
     .handler = show_viewer,
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
