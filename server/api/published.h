// SPDX-License-Identifier: Apache-2.0
// Helpers that the handlers of models share: responses about the model that a caller may see, and
// common responses.
#pragma once

#include "server/api/path_parameters.h"
#include "server/api/services.h"
#include "server/api/visibility.h"
#include "server/messages/problem.h"
#include "server/store/change.h"

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

// Returns the faults of a webhook URL. An empty URL has none; it means that no webhook is called.
inline FieldFaults check_webhook(const std::string& url, Services& services) {
  if (url.empty() || services.webhooks.allows(url)) return {};
  return {{"webhook", "a URL at a host of the setting webhook-hosts"}};
}

// If the model was found, returns `answer(model)`. Otherwise returns 404, or 500 or 503 if an error
// occurred.
template <class Answer>
Response with_found(const FoundModel& model, const Request& request, Services& services,
                    Answer&& answer) {
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  return answer(*model);
}

// Returns the public parts of the published models, newest first, at most kMostListed of them.
inline constexpr std::size_t kMostListed = 10'000;
inline Expected<std::vector<ModelRecord>> all_public(Services& services) {
  std::vector<ModelRecord> all;
  ModelQuery query{.limit = kMaxPage};
  do {
    auto page = services.catalogue.search(query);
    if (!page) return tl::unexpected(page.error());
    for (ModelRecord& model : page->models)
      all.push_back(public_view(std::move(model)));
    query.after = page->next;
  } while (query.after && all.size() < kMostListed);
  return all;
}

// Marks the response as private to this caller.
inline Response for_caller(Response response) {
  response.caching = Caching::kPrivate;
  return response;
}

// Returns `answer(model)` for the part of the model that the caller may see. Returns 404 if there
// is no such part, and 500 or 503 if an error occurs.
template <class Answer>
Response with_model(const Request& request, Services& services, Answer&& answer) {
  const VisibleModel visible =
      find_visible(id_in<ModelId>(request), request.caller.has_value(), services.models);
  Response response = with_found(visible.model, request, services, answer);
  return visible.is_private ? for_caller(std::move(response)) : response;
}

}  // namespace vitrine::server
