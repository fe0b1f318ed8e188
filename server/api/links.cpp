// SPDX-License-Identifier: Apache-2.0
#include "server/api/links.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "codec/core/html.h"
#include "server/api/services.h"

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

}  // namespace

std::string origin_of(const Request& request, Services& services) {
  if (std::string url = services.settings.get()->public_url; !url.empty()) return url;
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
  constexpr std::string_view kEnd = "</head>";
  const std::string id = model.id.to_string(), title = escape_html(model.title);
  const std::string page = fmt::format("{}/models/{}", origin, id);
  const std::string api = fmt::format("{}/api/v1", origin);
  const std::size_t at = std::min(html.find(kEnd), html.size());
  return fmt::format(
      "{}<meta property=\"og:title\" content=\"{title}\">\n"
      "<meta property=\"og:type\" content=\"website\">\n"
      "<meta property=\"og:url\" content=\"{page}\">\n"
      "<meta property=\"og:image\" content=\"{api}/models/{id}/poster.png?width={width}\">\n"
      "<link rel=\"alternate\" type=\"application/json+oembed\" title=\"{title}\" "
      "href=\"{api}/oembed?url={url}\">\n"
      "<link rel=\"alternate\" type=\"application/ld+json\" "
      "href=\"{api}/iiif/{id}/manifest.json\">\n"
      "{}",
      html.substr(0, at), html.substr(at), fmt::arg("title", title), fmt::arg("page", page),
      fmt::arg("api", api), fmt::arg("id", id), fmt::arg("width", kCanvasWidth),
      fmt::arg("url", escape_query(page)));
}

}  // namespace vitrine::server
