// SPDX-License-Identifier: Apache-2.0
// What the handlers of models share.
#pragma once

#include "server/http/problem.h"
#include "server/http/services.h"

namespace vitrine {

// The bytes of `range`; the body keeps the model, and so its file, open.
inline Body stored_body(const std::shared_ptr<const PublishedModel>& model, ByteRange range) {
  return StoredBytes{{model, &model->file()}, range.offset, range.length};
}

// In the operator's log.
inline void tell_operator(const Error& error, const Request& request, Services& services) {
  services.errors.event(Severity::kError,
                        std::string("request ") + std::string(request.id) + ": " + error.message);
}

// With the reason in the log only: 503 where catalogue, store or disk do not answer now, else 500.
inline Response internal_error(const Error& error, const Request& request, Services& services) {
  tell_operator(error, request, services);
  return error.code == ErrorCode::kIo ? away(request.id) : problem(500, "", request.id);
}

// Everybody may see a public scan grow; once there is a model, a scan is shown as long as that is.
inline bool is_public(const ScanEntry& scan, Services& services) {
  if (!scan.model) return scan.is_public;
  const auto model = services.models.find(*scan.model);
  return model && *model != nullptr;
}

// What is wrong with telling `url` of the end of a job; an empty one is told nothing.
inline FieldFaults check_webhook(const std::string& url, Services& services) {
  if (url.empty() || services.webhooks.allows(url)) return {};
  return {{"webhook", "a URL at a host of the setting webhook-hosts"}};
}

using FoundModel = Expected<std::shared_ptr<const PublishedModel>>;  // null: there is none

// Calls `answer(model)`, or answers 404 or 500.
template <class Answer>
Response with_found(const FoundModel& model, const Request& request, Services& services,
                    Answer&& answer) {
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  return answer(*model);
}

// With the published model of the request's {id}.
template <class Answer>
Response with_published(const Request& request, Services& services, Answer&& answer) {
  return with_found(services.models.find(request.parameters.id), request, services, answer);
}

// As it is told to this caller alone.
inline Response for_caller(Response response) {
  response.caching = Caching::kPrivate;
  return response;
}

struct VisibleModel {
  FoundModel model;
  bool is_private = false;  // what is told of it is for nobody to keep
};

// The published model or, for those who have a token, a draft, or all of a model of which less is
// public.
inline VisibleModel find_visible(const ModelId& id, bool has_token, PublishedModels& models) {
  FoundModel published = models.find(id);
  const bool is_all = published && *published && !(*published)->record().public_part;
  if (!has_token || !published || is_all) return {std::move(published)};
  return {models.find_whole(id), true};
}

// The same model where it is in memory and known to be current; else null.
inline std::shared_ptr<const PublishedModel> held_visible(const ModelId& id, bool has_token,
                                                          PublishedModels& models) {
  auto published = models.held(id);
  const bool is_all = published && !published->record().public_part;
  return has_token && !is_all ? models.held_whole(id) : published;
}

// With what the caller may see of the request's {id}.
template <class Answer>
Response with_model(const Request& request, Services& services, Answer&& answer) {
  const VisibleModel visible =
      find_visible(request.parameters.id, request.caller.has_value(), services.models);
  Response response = with_found(visible.model, request, services, answer);
  return visible.is_private ? for_caller(std::move(response)) : response;
}

}  // namespace vitrine
