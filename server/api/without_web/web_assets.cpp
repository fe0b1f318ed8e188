// SPDX-License-Identifier: Apache-2.0
#include "server/api/web_pages.h"

namespace vitrine::server {

std::span<const WebAsset> web_assets() {
  return {};
}

}  // namespace vitrine::server
