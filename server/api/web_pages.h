// SPDX-License-Identifier: Apache-2.0
// Finds the files of the embedded web client, with their entity tags, by their URL paths.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

namespace vitrine::server {

// A file of the web client, embedded in the executable.
struct WebAsset {
  std::string_view path;  // path in its URL, such as "/index.html" or "/assets/…"
  std::string_view type;  // media type, with its charset
  std::span<const std::uint8_t> bytes;
  // The same content compressed by gzip; empty if there is no compressed form.
  std::span<const std::uint8_t> gzip = {};
};

// Returns the files of the web client. The CMake target vitrine_web defines this function. In a
// build without the client (VITRINE_WEB=OFF), returns an empty span.
std::span<const WebAsset> web_assets();

struct WebPage {
  WebAsset asset;
  // The entity tags of the file and of its compressed form. The two must differ ([RFC9110] section
  // 8.8.3.3).
  std::string etag, gzip_etag;
};

class WebPages {
 public:
  explicit WebPages(std::span<const WebAsset> assets);

  const WebPage* find(std::string_view path) const;  // returns null if there is no such file

 private:
  std::unordered_map<std::string_view, WebPage> pages_;
};

}  // namespace vitrine::server
