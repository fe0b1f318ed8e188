// SPDX-License-Identifier: Apache-2.0
// The handlers, one file per noun. HEAD, conditions and ranges are derived
// from the answers to GET; a POST finds its JSON in Request::body.
#pragma once

#include "server/http/router.h"

namespace vitrine {

// models.cpp
Response list_models(const Request& request, Services& services);  // ?q= &limit= &cursor=
Response show_model(const Request& request, Services& services);
Response show_manifest(const Request& request, Services& services);
Response show_head(const Request& request, Services& services);
Response show_file(const Request& request, Services& services);

// chunks.cpp
Response show_chunk(const Request& request, Services& services);
std::optional<Response> show_held_chunk(const Request& request, Services& services);

// exports.cpp
Response export_model(const Request& request,
                      Services& services);  // ?triangles= | error= | bytes= | level=

// streams.cpp
Response open_stream(const Request& request, Services& services);  // 101: go on as a WebSocket

// pages.cpp
Response show_gallery(const Request& request, Services& services);
Response show_viewer(const Request& request, Services& services);
Response show_scan_page(const Request& request, Services& services);
Response show_asset(const Request& request, Services& services);

// health.cpp
Response show_livez(const Request& request, Services& services);
Response show_readyz(const Request& request, Services& services);
Response show_metrics(const Request& request, Services& services);

}  // namespace vitrine
