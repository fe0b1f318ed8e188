// SPDX-License-Identifier: Apache-2.0
// Makes absolute links to a model's pages and pictures. Adds links and metadata to the head of a
// page, so that other software finds the title, picture, oEmbed and IIIF manifest of a model.
#pragma once

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

// Returns `html` with the metadata and links of `model` inserted before the end of its head.
std::string with_links(std::string_view html, const ModelRecord& model, std::string_view origin);

// Percent-encodes `text` as a value in a query: all but unreserved characters become %XX (RFC
// 3986).
std::string escape_query(std::string_view text);

}  // namespace vitrine::server
