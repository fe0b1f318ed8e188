// SPDX-License-Identifier: Apache-2.0
#include "server/api/web_pages.h"

#include "codec/core/sha256.h"

namespace vitrine::server {

namespace {

std::string tag_of(std::span<const std::uint8_t> bytes) {
  return '"' + to_hex(sha256(bytes)) + '"';
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

}  // namespace vitrine::server
