// SPDX-License-Identifier: Apache-2.0
#include "server/http/handlers.h"
#include "server/http/problem.h"
#include "server/http/services.h"

namespace vitrine {
namespace {

Response text(std::string body) {
  Response response;
  response.type = "text/plain; charset=utf-8";
  response.body = std::move(body);
  return response;
}

}  // namespace

// Alive: this process answers. It stays so while it drains.
Response show_livez(const Request&, Services&) {
  return text("alive\n");
}

// Ready: visitors should be sent here. Not while starting or draining, nor without a catalogue.
Response show_readyz(const Request& request, Services& services) {
  if (!services.ready.load()) return problem(503, "", request.id);
  if (const auto revision = services.catalogue.revision(); !revision) {
    services.errors.event(Severity::kError, revision.error().message);
    return problem(503, "", request.id);
  }
  return text("ready\n");
}

Response show_metrics(const Request&, Services& services) {
  Response response = text(services.metrics.text());
  response.type = "text/plain; version=0.0.4; charset=utf-8";
  return response;
}

}  // namespace vitrine
