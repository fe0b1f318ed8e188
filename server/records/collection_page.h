// SPDX-License-Identifier: Apache-2.0
// Describes a collection, or all models, in its page: in <head> for search engines, link previews
// and IIIF viewers, in <body> for browsers without JavaScript.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "server/catalogue/catalogue.h"

namespace vitrine::server {

// Returns the path of a collection's page. The name is percent-encoded.
std::string collection_path(std::string_view collection);

// Returns the path of the IIIF document (of type Collection) of a collection.
std::string collection_iiif_path(std::string_view collection);

// Returns the page `html` (web/src/gallery/index.html) with the name of the collection, links, and
// a list of `models`, which the page's script replaces. `origin` is the start of absolute URLs,
// such as "https://museum.example"; may be empty.
std::string with_collection(std::string html, std::string_view collection,
                            std::span<const ModelRecord> models, std::string_view origin);

// Returns the page `html` (web/src/gallery/index.html) with a list of `models`, the newest of all,
// which the page's script replaces. `origin`: see origin_of().
std::string with_gallery(std::string html, std::span<const ModelRecord> models,
                         std::string_view origin);

}  // namespace vitrine::server
