// SPDX-License-Identifier: Apache-2.0
#include "server/http/handlers.h"
#include "server/http/problem.h"
#include "server/http/published.h"
#include "server/http/services.h"

namespace vitrine {

// The hot path: a look-up in memory, and the bytes go from the page cache to the socket.
Response show_chunk(const Request& request, Services& services) {
  auto chunk = services.models.find_chunk(request.parameters.sha256);
  if (!chunk) return internal_error(chunk.error(), request, services);
  if (!chunk->model) return problem(404, "there is no such chunk", request.id);
  Response response;
  response.type = "application/octet-stream";
  response.caching = Caching::kImmutable;
  response.etag = '"' + to_hex(request.parameters.sha256) + '"';
  response.body = stored_body(chunk->model, chunk->range);
  return response;
}

}  // namespace vitrine
