// SPDX-License-Identifier: Apache-2.0
// The embedded web client, looked up by path, each file with its entity tags.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "server/http/web_assets.h"

namespace vitrine {

struct WebPage {
  WebAsset asset;
  std::string etag, gzip_etag;  // each representation has its own (RFC 9110, section 8.8.3.3)
};

class WebPages {
 public:
  explicit WebPages(std::span<const WebAsset> assets);

  const WebPage* find(std::string_view path) const;  // null where there is none

 private:
  std::unordered_map<std::string_view, WebPage> pages_;
};

}  // namespace vitrine
