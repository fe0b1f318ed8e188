// SPDX-License-Identifier: Apache-2.0
// The handlers, one file per noun. HEAD, conditions and ranges are derived
// from the answers to GET; a POST finds its JSON in Request::body.
#pragma once

#include "server/http/router.h"

namespace vitrine {

// models.cpp
Response list_models(const Request& request, Services& services);  // ?q= &limit= &cursor= &drafts=
Response show_model(const Request& request, Services& services);
Response show_manifest(const Request& request, Services& services);  // ? as of exports, to foresee
std::optional<Response> show_held_manifest(const Request& request, Services& services);
Response show_head(const Request& request, Services& services);
Response show_file(const Request& request, Services& services);
Response publish_model(const Request& request, Services& services);
Response unpublish_model(const Request& request, Services& services);  // a draft again

// model_orders.cpp
Response make_model(const Request& request, Services& services);    // of an upload; 202: a job
Response change_model(const Request& request, Services& services);  // texts, unit, what is public
Response remove_model(const Request& request, Services& services);

// chunks.cpp
Response show_chunk(const Request& request, Services& services);
std::optional<Response> show_held_chunk(const Request& request, Services& services);
Response show_model_chunk(const Request& request, Services& services);
std::optional<Response> show_held_model_chunk(const Request& request, Services& services);

// exports.cpp
Response export_model(const Request& request,
                      Services& services);  // ?triangles= | error= | bytes= | level=

// posters.cpp
Response show_poster(const Request& request, Services& services);  // ?width=; PNG

// iiif.cpp
Response show_iiif_manifest(const Request& request, Services& services);
Response redirect_to_iiif(const Request& request, Services& services);  // from its short address

// oembed.cpp
Response show_oembed(const Request& request,
                     Services& services);  // ?url= maxwidth maxheight format

// openapi.cpp
Response show_openapi(const Request& request, Services& services);

// streams.cpp
// ?head=; 101: go on as a WebSocket
Response open_stream(const Request& request, Services& services);
bool asks_for_head(std::string_view target);  // of a request that open_stream() has let in

// scanners.cpp
Response list_scanners(const Request& request, Services& services);
Response show_scanner(const Request& request, Services& services);
Response jog_scanner(const Request& request, Services& services);   // {"degrees": x}
Response switch_laser(const Request& request, Services& services);  // {"on": bool}
Response stop_scanner(const Request& request, Services& services);  // the red button
Response show_preview(const Request& request, Services& services);  // PNG

// calibrations.cpp
Response list_calibrations(const Request& request, Services& services);
Response start_calibration(const Request& request, Services& services);  // {"poses": n}; 202: a job
Response show_calibration(const Request& request, Services& services);
Response show_residuals(const Request& request, Services& services);  // SVG

// scans.cpp
Response start_scan(const Request& request, Services& services);  // 202: a job
Response list_scans(const Request& request, Services& services);  // ?limit= &cursor=
Response show_scan(const Request& request, Services& services);
Response show_points(const Request& request, Services& services);   // ?from=
Response show_profile(const Request& request, Services& services);  // [[rho, z], ...]
Response pause_scan(const Request& request, Services& services);
Response resume_scan(const Request& request, Services& services);
Response reprocess_scan(const Request& request, Services& services);  // 202: a job

// jobs.cpp
Response list_jobs(const Request& request, Services& services);  // ?limit= &cursor=
Response show_job(const Request& request, Services& services);
Response cancel_job(const Request& request, Services& services);
Response resume_job(const Request& request, Services& services);
Response show_job_events(const Request& request, Services& services);

// uploads.cpp: tus 1.0
Response show_upload_options(const Request& request, Services& services);
Response create_upload(const Request& request, Services& services);
Response show_upload(const Request& request, Services& services);
Response append_to_upload(const Request& request, Services& services);
Response remove_upload(const Request& request, Services& services);

// tokens.cpp
Response list_tokens(const Request& request, Services& services);  // ?limit= &cursor=
Response add_token(const Request& request, Services& services);    // {"role": r, "label": l}
Response revoke_token(const Request& request, Services& services);

// pages.cpp
Response show_gallery(const Request& request, Services& services);
Response show_viewer(const Request& request, Services& services);
Response show_docs(const Request& request, Services& services);
Response show_scan_page(const Request& request, Services& services);
Response show_console(const Request& request, Services& services);
Response show_asset(const Request& request, Services& services);

// health.cpp
Response show_livez(const Request& request, Services& services);
Response show_readyz(const Request& request, Services& services);
Response show_metrics(const Request& request, Services& services);

}  // namespace vitrine
