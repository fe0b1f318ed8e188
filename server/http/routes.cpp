// SPDX-License-Identifier: Apache-2.0
#include "server/http/routes.h"

#include "server/http/handlers.h"

namespace vitrine {
namespace {

using enum Method;
using enum Place;

constexpr Route kPublic[] = {
    {kGet, "/api/v1/chunks/{sha256}", show_chunk, kWorker, Role::kNone, show_held_chunk},
    {kGet, "/api/v1/models", list_models, kWorker},
    // A token shows drafts, too; the handlers know.
    {kGet, "/api/v1/models/{id}", show_model, kWorker},
    {kGet, "/api/v1/models/{id}/manifest", show_manifest, kWorker, Role::kNone, show_held_manifest},
    {kGet, "/api/v1/models/{id}/head", show_head, kWorker},
    {kGet, "/api/v1/models/{id}/file.pmesh", show_file, kWorker},
    {kGet, "/api/v1/models/{id}/chunks/{sha256}", show_model_chunk, kWorker, Role::kNone,
     show_held_model_chunk},
    {kGet, "/api/v1/models/{id}/stream", open_stream, kWorker},
    {kGet, "/api/v1/models/{id}/export.{format}", export_model, kExport},
    {kGet, "/api/v1/models/{id}/poster.png", show_poster, kExport},
    {kGet, "/api/v1/iiif/{id}/manifest.json", show_iiif_manifest, kWorker},
    {kGet, "/api/v1/oembed", show_oembed, kWorker},
    {kGet, "/api/v1/openapi.json", show_openapi, kInline},
    {kPost, "/api/v1/models", make_model, kDisk, Role::kOperator},
    {kPatch, "/api/v1/models/{id}", change_model, kDisk, Role::kOperator},
    {kDelete, "/api/v1/models/{id}", remove_model, kDisk, Role::kOperator},
    {kPost, "/api/v1/models/{id}/publish", publish_model, kDisk, Role::kOperator},
    {kPost, "/api/v1/models/{id}/unpublish", unpublish_model, kDisk, Role::kOperator},
    {kGet, "/api/v1/scanners", list_scanners, kDevice, Role::kViewer},
    {kGet, "/api/v1/scanners/{name}", show_scanner, kDevice, Role::kViewer},
    {kPost, "/api/v1/scanners/{name}/jog", jog_scanner, kDevice, Role::kOperator},
    {kPost, "/api/v1/scanners/{name}/laser", switch_laser, kDevice, Role::kOperator},
    // Not behind those who wait for devices or the disk.
    {kPost, "/api/v1/scanners/{name}/stop", stop_scanner, kWorker, Role::kOperator, nullptr,
     /*reads_body=*/false, /*urgent=*/true},
    {kGet, "/api/v1/scanners/{name}/preview", show_preview, kDevice, Role::kOperator},
    {kGet, "/api/v1/scanners/{name}/calibrations", list_calibrations, kWorker, Role::kViewer},
    {kPost, "/api/v1/scanners/{name}/calibrations", start_calibration, kWorker, Role::kOperator},
    {kGet, "/api/v1/scanners/{name}/calibrations/{number}", show_calibration, kWorker,
     Role::kViewer},
    {kGet, "/api/v1/scanners/{name}/calibrations/{number}/residuals.svg", show_residuals, kWorker,
     Role::kViewer},
    {kGet, "/api/v1/scans", list_scans, kWorker, Role::kViewer},
    {kPost, "/api/v1/scans", start_scan, kWorker, Role::kOperator},
    // Those that will be public are watched by everybody, and their jobs; the handlers know.
    {kGet, "/api/v1/scans/{id}", show_scan, kWorker},
    {kGet, "/api/v1/scans/{id}/points", show_points, kWorker},
    {kGet, "/api/v1/scans/{id}/profile", show_profile, kWorker},
    {kPost, "/api/v1/scans/{id}/pause", pause_scan, kWorker, Role::kOperator},
    {kPost, "/api/v1/scans/{id}/resume", resume_scan, kWorker, Role::kOperator},
    {kPost, "/api/v1/scans/{id}/reprocess", reprocess_scan, kWorker, Role::kOperator},
    {kGet, "/api/v1/jobs", list_jobs, kWorker, Role::kViewer},
    {kGet, "/api/v1/jobs/{id}", show_job, kWorker},
    {kDelete, "/api/v1/jobs/{id}", cancel_job, kWorker, Role::kOperator},
    {kPost, "/api/v1/jobs/{id}/resume", resume_job, kWorker, Role::kOperator},
    {kGet, "/api/v1/jobs/{id}/events", show_job_events, kWorker},
    {kOptions, "/api/v1/uploads", show_upload_options, kInline},
    {kPost, "/api/v1/uploads", create_upload, kDisk, Role::kOperator, nullptr,
     /*reads_body=*/false},
    {kOptions, "/api/v1/uploads/{id}", show_upload_options, kInline},
    {kGet, "/api/v1/uploads/{id}", show_upload, kDisk, Role::kOperator},
    {kPatch, "/api/v1/uploads/{id}", append_to_upload, kDisk, Role::kOperator, nullptr,
     /*reads_body=*/false},
    {kDelete, "/api/v1/uploads/{id}", remove_upload, kDisk, Role::kOperator},
    {kGet, "/api/v1/tokens", list_tokens, kWorker, Role::kAdmin},
    {kPost, "/api/v1/tokens", add_token, kWorker, Role::kAdmin},
    {kDelete, "/api/v1/tokens/{id}", revoke_token, kWorker, Role::kAdmin},
    {kGet, "/", show_gallery, kInline},
    {kGet, "/models/{id}", show_viewer, kWorker},
    {kGet, "/scans/{id}", show_scan_page, kInline},
    {kGet, "/docs", show_docs, kInline},
    {kGet, "/console", show_console, kInline},
    {kGet, "/iiif/{id}/manifest.json", redirect_to_iiif, kInline},
    {kGet, "/{rest}", show_asset, kInline},
};

constexpr Route kAdmin[] = {
    {kGet, "/livez", show_livez, kInline},
    {kGet, "/readyz", show_readyz, kWorker},
    {kGet, "/metrics", show_metrics, kWorker},
};

}  // namespace

std::span<const Route> public_routes() {
  return kPublic;
}
std::span<const Route> admin_routes() {
  return kAdmin;
}

}  // namespace vitrine
