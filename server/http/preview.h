// SPDX-License-Identifier: Apache-2.0
// What a model's page tells software that links to it: title, picture, and where oEmbed and IIIF
// describe it.
#pragma once

#include <string>
#include <string_view>

#include "server/catalogue/catalogue.h"

namespace vitrine {

// `html` with that before the end of its head.
std::string with_preview(std::string_view html, const ModelRecord& model, std::string_view origin);

// `text` as a value in a query (RFC 3986: all but unreserved characters as %XX).
std::string escape_query(std::string_view text);

}  // namespace vitrine
