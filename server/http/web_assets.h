// SPDX-License-Identifier: Apache-2.0
// The web client as it lies in the program's image.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vitrine {

struct WebAsset {
  std::string_view
      path;  // of the URL: "/index.html" (gallery), "/model.html" (viewer), "/assets/…"
  std::string_view type;  // media type, with its charset
  std::span<const std::uint8_t> bytes;
  std::span<const std::uint8_t> gzip = {};  // the same by gzip; empty: there is none
};

// Defined by the web client (target vitrine_web); empty in a build without it (VITRINE_WEB=OFF).
std::span<const WebAsset> web_assets();

}  // namespace vitrine
