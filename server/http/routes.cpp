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
    {kGet, "/api/v1/models/{id}", show_model, kWorker},
    {kGet, "/api/v1/models/{id}/manifest", show_manifest, kWorker},
    {kGet, "/api/v1/models/{id}/head", show_head, kWorker},
    {kGet, "/api/v1/models/{id}/file.pmesh", show_file, kWorker},
    {kGet, "/api/v1/models/{id}/stream", open_stream, kWorker},
    {kGet, "/api/v1/models/{id}/export.{format}", export_model, kExport},
    {kGet, "/", show_gallery, kInline},
    {kGet, "/models/{id}", show_viewer, kWorker},
    {kGet, "/scans/{id}", show_scan_page, kInline},
    {kGet, "/{rest}", show_asset, kInline},
};

constexpr Route kAdmin[] = {
    {kGet, "/livez", show_livez, kInline},
    {kGet, "/readyz", show_readyz, kWorker},
    {kGet, "/metrics", show_metrics, kInline},
};

}  // namespace

std::span<const Route> public_routes() {
  return kPublic;
}
std::span<const Route> admin_routes() {
  return kAdmin;
}

}  // namespace vitrine
