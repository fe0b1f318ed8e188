// SPDX-License-Identifier: Apache-2.0
#include "server/api/handlers.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"

namespace vitrine::server {
namespace {

Response chunk_response(const PublishedChunk& chunk, const Request& request) {
  Response response;
  response.type = "application/octet-stream";
  response.caching = Caching::kImmutable;
  response.etag = stored_tag(*chunk.model, sha256_in(request));
  response.body = stored_body(chunk.model, chunk.range);
  return response;
}

Response model_chunk(const std::shared_ptr<const PublishedModel>& model, const Request& request) {
  const auto range = model->find(sha256_in(request));
  if (!range) return problem(404, "there is no such chunk", request.id);
  Response response = chunk_response({model, *range}, request);
  response.caching = Caching::kPrivate;
  return response;
}

// A cache that sends If-None-Match has a copy of the chunk. It must store this response in place of
// the copy, because it would otherwise serve the withdrawn chunk whenever the daemon is
// unreachable. Responses to other requests are not stored: made-up hashes would fill the cache.
Response no_such_chunk(const Request& request) {
  Response response = problem(404, "there is no such chunk", request.id);
  const bool is_revalidation = request.header.count(beast::http::field::if_none_match) > 0;
  if (is_revalidation) response.caching = Caching::kReplacesCopy;
  return response;
}

}  // namespace

// Serves most chunk requests without a worker thread. Looks for the chunk only in models that are
// open in memory, and returns nullopt if no open model has it.
static std::optional<Response> show_cached_chunk(const Request& request, Services& services) {
  const auto chunk = services.models.cached_chunk(sha256_in(request));
  if (!chunk) return std::nullopt;
  return chunk_response(*chunk, request);
}

static Response show_chunk(const Request& request, Services& services) {
  auto chunk = services.models.find_chunk(sha256_in(request));
  if (!chunk) return internal_error(chunk.error(), request, services);
  if (!chunk->model) return no_such_chunk(request);
  return chunk_response(*chunk, request);
}

// Answers from memory with a chunk of a model that the caller may see. Returns nullopt if the model
// is not cached, or if the request has a token that has not been checked yet.
static std::optional<Response> show_held_model_chunk(const Request& request, Services& services) {
  const bool is_unknown =
      !request.caller && request.header.count(beast::http::field::authorization) > 0;
  if (is_unknown) return std::nullopt;
  const auto model =
      cached_visible(id_in<ModelId>(request), request.caller.has_value(), services.models);
  if (!model) return std::nullopt;
  return model_chunk(model, request);
}

// Serves a chunk of any model that the caller may see, drafts included.
static Response show_model_chunk(const Request& request, Services& services) {
  return with_model(request, services,
                    [&](const auto& model) { return model_chunk(model, request); });
}

static constexpr ApiRoute kChunkRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/chunks/{sha256}",
     .handler = show_chunk,
     .executor = Executor::kWorker,
     .quick = show_cached_chunk,
     .doc = {.id = "getChunk",
             .summary =
                 "Returns the layer, base mesh, atlas, picture or original with this hash. Its "
                 "content never changes.",
             .response = "application/octet-stream"}},
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/chunks/{sha256}",
     .handler = show_model_chunk,
     .executor = Executor::kWorker,
     .quick = show_held_model_chunk,
     .doc = {.id = "getChunkOfModel",
             .summary =
                 "Returns a chunk of a published model or of a draft. Caches must not store it.",
             .response = "application/octet-stream"}},
};

static constexpr ApiTag kChunksTags[] = {
    {.name = "chunks",
     .description = "Immutable parts of models, which a viewer fetches one by one."}};

const ApiNoun kChunks = {.routes = kChunkRoutes, .tags = kChunksTags};

}  // namespace vitrine::server
