// SPDX-License-Identifier: Apache-2.0
#include "server/http/web_assets.h"

namespace vitrine {

std::span<const WebAsset> web_assets() {
  return {};
}

}  // namespace vitrine
