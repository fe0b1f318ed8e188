// SPDX-License-Identifier: Apache-2.0
#include "server/http/handlers.h"
#include "server/http/published.h"

namespace vitrine {
namespace {

Response chunk_response(const PublishedChunk& chunk, const Request& request) {
  Response response;
  response.type = "application/octet-stream";
  response.caching = Caching::kImmutable;
  response.etag = '"' + to_hex(request.parameters.sha256) + '"';
  response.body = stored_body(chunk.model, chunk.range);
  return response;
}

Response model_chunk(const std::shared_ptr<const PublishedModel>& model, const Request& request) {
  const auto range = model->find(request.parameters.sha256);
  if (!range) return problem(404, "there is no such chunk", request.id);
  Response response = chunk_response({model, *range}, request);
  response.caching = Caching::kPrivate;
  return response;
}

}  // namespace

// The hot path: a look-up in memory, and the bytes go from the page cache to the socket.
std::optional<Response> show_held_chunk(const Request& request, Services& services) {
  const auto chunk = services.models.held_chunk(request.parameters.sha256);
  if (!chunk) return std::nullopt;
  return chunk_response(*chunk, request);
}

Response show_chunk(const Request& request, Services& services) {
  auto chunk = services.models.find_chunk(request.parameters.sha256);
  if (!chunk) return internal_error(chunk.error(), request, services);
  if (!chunk->model) return problem(404, "there is no such chunk", request.id);
  return chunk_response(*chunk, request);
}

// Likewise, for who may see the model.
std::optional<Response> show_held_model_chunk(const Request& request, Services& services) {
  const bool is_unknown =
      !request.caller && request.header.count(beast::http::field::authorization) > 0;
  if (is_unknown) return std::nullopt;
  const auto model =
      held_visible(request.parameters.id, request.caller.has_value(), services.models);
  if (!model) return std::nullopt;
  return model_chunk(model, request);
}

// Where the chunks of drafts are.
Response show_model_chunk(const Request& request, Services& services) {
  return with_model(request, services,
                    [&](const auto& model) { return model_chunk(model, request); });
}

}  // namespace vitrine
