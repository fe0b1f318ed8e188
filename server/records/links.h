// SPDX-License-Identifier: Apache-2.0
// Makes absolute links to a model's pages and pictures. Describes a model in its page: in <head>
// for search engines, link previews and other software, in <body> for browsers without JavaScript.
#pragma once

#include <string>
#include <string_view>

#include "server/catalogue/catalogue.h"
#include "server/messages/router.h"

namespace vitrine::server {

// Widths of a model's posters in pixels. A poster is a square picture with a transparent
// background.
inline constexpr unsigned kPosterWidths[] = {240, 480, 960};
inline constexpr unsigned kPosterWidth = 480;  // default width of a poster
inline constexpr unsigned kThumbnailWidth = 240, kCanvasWidth = 960;

// Returns the start of absolute URLs, such as "https://museum.example": the setting public-url or,
// if that is empty, the host of the request. Returns an empty string if the host is invalid; links
// are then relative.
std::string origin_of(const Request& request, const std::string& public_url);

// Returns the page `html` with the title of `model`. Also inserts metadata and links at the end of
// the head: description, Open Graph, oEmbed, IIIF, records, and JSON-LD (3DModel of schema.org).
std::string with_links(std::string_view html, const ModelRecord& model, std::string_view origin);

// Returns the page `html` (web/src/gallery/model.html) with the heading, creator, description and
// facts of `model`, and the poster for browsers without JavaScript. In other browsers, a script
// replaces these texts by translations. `dimensions` is the size of the mesh as text; may be
// empty.
std::string with_texts(std::string html, const ModelRecord& model, const std::string& dimensions);

// Percent-encodes `text` as a value in a query: all characters except the unreserved ones become
// %XX [RFC3986].
std::string escape_query(std::string_view text);

}  // namespace vitrine::server
