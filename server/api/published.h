// SPDX-License-Identifier: Apache-2.0
// Helpers that the handlers of models share: finding the model that a caller may see, and common
// responses.
#pragma once

#include "server/api/path_parameters.h"
#include "server/api/services.h"
#include "server/messages/problem.h"

namespace vitrine::server {

// Returns the bytes of `range` as a body. The body keeps the model alive and its file open.
inline Body stored_body(const std::shared_ptr<const PublishedModel>& model, ByteRange range) {
  return StoredBytes{{model, &model->file()}, range.offset, range.length};
}

// Writes the error to the operator's log.
inline void tell_operator(const Error& error, const Request& request, Services& services) {
  services.errors.event(Severity::kError,
                        std::string("request ") + std::string(request.id) + ": " + error.message);
}

// Logs the error. Returns 503 if the catalogue, store or disk does not respond, else 500. The
// response does not contain the reason.
inline Response internal_error(const Error& error, const Request& request, Services& services) {
  tell_operator(error, request, services);
  return error.code == ErrorCode::kIo ? away(request.id) : problem(500, "", request.id);
}

// Whether a scan is visible without a token. While the scan has no model yet, it is visible if it
// was requested as public. Afterwards, it is visible as long as its model is published.
inline bool is_public(const ScanEntry& scan, Services& services) {
  if (!scan.model) return scan.is_public;
  const auto model = services.models.find(*scan.model);
  return model && *model != nullptr;
}

// Returns the faults of a webhook URL. An empty URL has none; it means that no webhook is called.
inline FieldFaults check_webhook(const std::string& url, Services& services) {
  if (url.empty() || services.webhooks.allows(url)) return {};
  return {{"webhook", "a URL at a host of the setting webhook-hosts"}};
}

// The model that was searched for, or null if there is no such model.
using FoundModel = Expected<std::shared_ptr<const PublishedModel>>;

// Calls `answer(model)` if the model was found. Otherwise returns 404, or 500 or 503 after an
// error.
template <class Answer>
Response with_found(const FoundModel& model, const Request& request, Services& services,
                    Answer&& answer) {
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  return answer(*model);
}

// Calls `answer` with the published model that the request's {id} names. Returns 404 if there is
// none, and 500 or 503 if an error occurs.
template <class Answer>
Response with_published(const Request& request, Services& services, Answer&& answer) {
  return with_found(services.models.find(id_in<ModelId>(request)), request, services, answer);
}

// Marks the response as private to this caller.
inline Response for_caller(Response response) {
  response.caching = Caching::kPrivate;
  return response;
}

struct VisibleModel {
  FoundModel model;
  bool is_private = false;  // true if caches must not keep responses about the model
};

// Finds a model as the client may see it. Without a token, only the public part of a published
// model is visible. With a token, the whole model is visible, even if it is a draft.
inline VisibleModel find_visible(const ModelId& id, bool has_token, PublishedModels& models) {
  FoundModel published = models.find(id);
  const bool is_all = published && *published && !(*published)->record().public_part;
  if (!has_token || !published || is_all) return {std::move(published)};
  return {models.find_whole(id), true};
}

// Returns the model that find_visible() would find, if it is cached and known to be current.
// Otherwise returns null.
inline std::shared_ptr<const PublishedModel> cached_visible(const ModelId& id, bool has_token,
                                                            PublishedModels& models) {
  auto published = models.cached(id);
  const bool is_all = published && !published->record().public_part;
  return has_token && !is_all ? models.cached_whole(id) : published;
}

// Calls `answer` with the part of the model that the caller may see. Returns 404 if there is none,
// and 500 or 503 if an error occurs.
template <class Answer>
Response with_model(const Request& request, Services& services, Answer&& answer) {
  const VisibleModel visible =
      find_visible(id_in<ModelId>(request), request.caller.has_value(), services.models);
  Response response = with_found(visible.model, request, services, answer);
  return visible.is_private ? for_caller(std::move(response)) : response;
}

}  // namespace vitrine::server
