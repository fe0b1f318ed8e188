// SPDX-License-Identifier: Apache-2.0
#include "server/http/content_coding.h"
#include "server/http/handlers.h"
#include "server/http/preview.h"
#include "server/http/public_url.h"
#include "server/http/published.h"

namespace vitrine {
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

Response show_gallery(const Request& request, Services& services) {
  return page("/index.html", request, services);
}

Response show_viewer(const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const WebPage* found = services.pages.find("/model.html");
    if (found == nullptr) return problem(404, "there is no such page", request.id);
    const std::span html = found->asset.bytes;
    return revalidated(found->asset.type,
                       with_preview({reinterpret_cast<const char*>(html.data()), html.size()},
                                    model->record(), origin_of(request, services)));
  });
}

Response show_docs(const Request& request, Services& services) {
  return page("/docs.html", request, services);
}

// For every id: which scans there are is for the API to tell, and whom.
Response show_scan_page(const Request& request, Services& services) {
  return page("/scan.html", request, services);
}

// Whose buttons turn motors is framed by nobody.
Response show_console(const Request& request, Services& services) {
  Response response = page("/console.html", request, services);
  response.fields.emplace_back("X-Frame-Options", "DENY");
  return response;
}

Response show_asset(const Request& request, Services& services) {
  return page(request.path, request, services);
}

}  // namespace vitrine
