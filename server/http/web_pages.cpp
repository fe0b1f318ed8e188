// SPDX-License-Identifier: Apache-2.0
#include "server/http/web_pages.h"

#include "codec/core/sha256.h"

namespace vitrine {

WebPages::WebPages(std::span<const WebAsset> assets) {
  for (const WebAsset& asset : assets) {
    pages_.emplace(asset.path, WebPage{asset, '"' + to_hex(sha256(asset.bytes)) + '"'});
  }
}

const WebPage* WebPages::find(std::string_view path) const {
  const auto found = pages_.find(path);
  return found == pages_.end() ? nullptr : &found->second;
}

}  // namespace vitrine
