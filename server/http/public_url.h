// SPDX-License-Identifier: Apache-2.0
// What absolute addresses begin with.
#pragma once

#include <string>

#include "server/http/router.h"

namespace vitrine {

// "https://museum.example": the setting public-url, or else what the request says it came to. Empty
// where that is no host: addresses are then relative.
std::string origin_of(const Request& request, Services& services);

}  // namespace vitrine
