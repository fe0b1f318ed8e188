// SPDX-License-Identifier: Apache-2.0
// Makes absolute links to a model's pages and pictures. Describes a model in its page: in the head
// for search engines, link previews and other software, in the body for browsers without
// JavaScript.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/catalogue/catalogue.h"
#include "server/messages/router.h"

namespace vitrine::server {

struct Services;

// Widths of a model's posters in pixels. A poster is a square picture with a transparent
// background.
inline constexpr unsigned kPosterWidths[] = {240, 480, 960};
inline constexpr unsigned kPosterWidth = 480;  // default width of a poster
inline constexpr unsigned kThumbnailWidth = 240, kCanvasWidth = 960;

// Returns the start of absolute URLs, such as "https://museum.example": the setting public-url or,
// if that is not set, the host of the request. Returns an empty string if the host is invalid;
// links are then relative.
std::string origin_of(const Request& request, Services& services);

// Returns the URL of a licence or rights statement, or nullopt if `licence` is neither an SPDX
// identifier of a Creative Commons licence nor a URL at creativecommons.org or
// rightsstatements.org. The URL starts with http, not https, as IIIF and these sites require.
std::optional<std::string> rights_url(std::string_view licence);

// Returns `html` with the title of `model`, and with its metadata and links inserted before the end
// of the head: description, Open Graph, oEmbed, IIIF, and JSON-LD (3DModel of schema.org).
std::string with_links(std::string_view html, const ModelRecord& model, std::string_view origin);

// Returns the page `html` (web/src/gallery/model.html) with heading, creator, description, facts
// and, for browsers without JavaScript, the poster of `model`. The page's script later replaces the
// texts by those in the visitor's language.
std::string with_texts(std::string html, const ModelRecord& model);

// Percent-encodes `text` as a value in a query: all but unreserved characters become %XX (RFC
// 3986).
std::string escape_query(std::string_view text);

}  // namespace vitrine::server
