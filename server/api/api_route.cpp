// SPDX-License-Identifier: Apache-2.0
#include "server/api/api_route.h"

namespace vitrine::server {
namespace {

Route bind(const ApiRoute& route, Services& services) {
  Route bound{.method = route.method,
              .path = route.path,
              .handler = [handler = route.handler,
                          &services](const Request& request) { return handler(request, services); },
              .executor = route.executor,
              .role = route.role,
              .reads_body = route.reads_body,
              .is_urgent = route.is_urgent};
  if (route.quick != nullptr) {
    bound.quick = [quick = route.quick, &services](const Request& request) {
      return quick(request, services);
    };
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
