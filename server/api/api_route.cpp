// SPDX-License-Identifier: Apache-2.0
#include "server/api/api_route.h"

#include "server/api/path_parameters.h"
#include "server/api/services.h"
#include "server/api/visibility.h"

namespace vitrine::server {
namespace {

std::optional<Opening> model_in_path(const Request& request, Services& services) {
  return opening_of(id_in<ModelId>(request), request.caller.has_value(), services.models);
}

std::optional<Opening> model_of_chunk(const Request& request, Services& services) {
  const auto model = services.models.model_with(sha256_in(request));
  if (!model || !*model) return std::nullopt;
  return opening_of(**model, /*has_token=*/false, services.models);
}

// Returns the model file that must be opened to decide whether a visitor may see the scan. Returns
// nullopt for a caller with a token, who may see every scan.
std::optional<Opening> model_of_scan(const Request& request, const ScanId& id, Services& services) {
  if (request.caller) return std::nullopt;
  const auto scan = services.scans.find(id);
  if (!scan || !*scan || !(*scan)->entry.model) return std::nullopt;
  return opening_of(*(*scan)->entry.model, /*has_token=*/false, services.models);
}

std::optional<Opening> model_of_scan_in_path(const Request& request, Services& services) {
  return model_of_scan(request, id_in<ScanId>(request), services);
}

std::optional<Opening> model_of_job_in_path(const Request& request, Services& services) {
  if (request.caller) return std::nullopt;
  const auto job = services.scans.jobs().find(id_in<JobId>(request));
  if (!job || !*job || !(*job)->record.scan) return std::nullopt;
  return model_of_scan(request, *(*job)->record.scan, services);
}

// Returns the function that finds the model file to open for a request to `path`. Returns null if
// the handlers of `path` open no model.
ApiOpeningFinder finder_for(std::string_view path) {
  if (path.find("{id}") != path.npos) {
    if (path.starts_with("/api/v1/models/") || path.starts_with("/models/") ||
        path.starts_with("/api/v1/iiif/")) {
      return model_in_path;
    }
    if (path.starts_with("/api/v1/scans/")) return model_of_scan_in_path;
    if (path.starts_with("/api/v1/jobs/")) return model_of_job_in_path;
  }
  return path == "/api/v1/chunks/{sha256}" ? model_of_chunk : nullptr;
}

bool may_open(const ApiRoute& route) {
  return route.executor == Executor::kWorker || route.executor == Executor::kCompute;
}

Route bind(const ApiRoute& route, Services& services) {
  Route bound{.method = route.method,
              .path = route.path,
              .handler = [handler = route.handler,
                          &services](const Request& request) { return handler(request, services); },
              .executor = route.executor,
              .role = route.role,
              .body = route.body};
  if (route.quick != nullptr) {
    bound.quick = [quick = route.quick, &services](const Request& request) {
      return quick(request, services);
    };
  }
  const ApiOpeningFinder opens =
      route.opens != nullptr || !may_open(route) ? route.opens : finder_for(route.path);
  if (opens != nullptr) {
    bound.opens = [opens, &services](const Request& request) { return opens(request, services); };
  }
  return bound;
}

}  // namespace

std::vector<Route> bind(std::span<const ApiRoute> routes, Services& services) {
  std::vector<Route> bound;
  bound.reserve(routes.size());
  for (const ApiRoute& route : routes)
    bound.push_back(bind(route, services));
  return bound;
}

}  // namespace vitrine::server
