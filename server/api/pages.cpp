// SPDX-License-Identifier: Apache-2.0
#include "server/api/handlers.h"
#include "server/api/links.h"
#include "server/api/published.h"
#include "server/messages/content_coding.h"

namespace vitrine::server {
namespace {

Response page(std::string_view path, const Request& request, Services& services) {
  const WebPage* found = services.pages.find(path);
  if (found == nullptr) return problem(404, "there is no such page", request.id);
  Response response;
  response.type = found->asset.type;
  response.caching = Caching::kRevalidate;
  response.etag = found->etag;
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
    const WebPage* found = services.pages.find("/model.html");
    if (found == nullptr) return problem(404, "there is no such page", request.id);
    const std::span html = found->asset.bytes;
    return revalidated(found->asset.type,
                       with_links({reinterpret_cast<const char*>(html.data()), html.size()},
                                  model->record(), origin_of(request, services)));
  });
}

static Response show_docs(const Request& request, Services& services) {
  return page("/docs.html", request, services);
}

// The page is the same for every ID, so that only the API reveals which scans exist.
static Response show_scan_page(const Request& request, Services& services) {
  return page("/scan.html", request, services);
}

// Other pages must not frame the console, whose buttons move motors (clickjacking).
static Response show_console(const Request& request, Services& services) {
  Response response = page("/console.html", request, services);
  response.fields.emplace_back("X-Frame-Options", "DENY");
  return response;
}

Response show_asset(const Request& request, Services& services) {
  return page(request.path, request, services);
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
     .path = "/{rest}",
     .handler = show_asset,
     .executor = Executor::kInline},
};

const ApiNoun kPages = {.routes = kPageRoutes};

}  // namespace vitrine::server
