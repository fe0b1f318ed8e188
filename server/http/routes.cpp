// SPDX-License-Identifier: Apache-2.0
#include "server/http/routes.h"

#include "server/http/handlers.h"

namespace vitrine {
namespace {

using enum Place;

constexpr Route kPublic[] = {
    {"/api/v1/chunks/{sha256}", show_chunk, kWorker, show_held_chunk},
    {"/api/v1/models", list_models, kWorker},
    {"/api/v1/models/{id}", show_model, kWorker},
    {"/api/v1/models/{id}/manifest", show_manifest, kWorker},
    {"/api/v1/models/{id}/head", show_head, kWorker},
    {"/api/v1/models/{id}/file.pmesh", show_file, kWorker},
    {"/api/v1/models/{id}/stream", open_stream, kWorker},
    {"/api/v1/models/{id}/export.{format}", export_model, kExport},
    {"/", show_gallery, kInline},
    {"/models/{id}", show_viewer, kWorker},
    {"/{rest}", show_asset, kInline},
};

constexpr Route kAdmin[] = {
    {"/livez", show_livez, kInline},
    {"/readyz", show_readyz, kWorker},
    {"/metrics", show_metrics, kInline},
};

}  // namespace

std::span<const Route> public_routes() {
  return kPublic;
}
std::span<const Route> admin_routes() {
  return kAdmin;
}

}  // namespace vitrine
