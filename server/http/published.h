// SPDX-License-Identifier: Apache-2.0
// What the handlers of published models share.
#pragma once

#include "server/http/problem.h"
#include "server/http/services.h"

namespace vitrine {

// The bytes of `range`; the body keeps the model, and so its file, open.
inline Body stored_body(const std::shared_ptr<const PublishedModel>& model, ByteRange range) {
  return StoredBytes{{model, &model->file()}, range.offset, range.length};
}

// 500, with the reason in the log only.
inline Response internal_error(const Error& error, const Request& request, Services& services) {
  services.errors.event(Severity::kError,
                        std::string("request ") + std::string(request.id) + ": " + error.message);
  return problem(500, "", request.id);
}

// Calls `answer(model)` with the published model of the request's {id}, or answers 404 or 500.
template <class Answer>
Response with_model(const Request& request, Services& services, Answer&& answer) {
  auto model = services.models.find(request.parameters.id);
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  return answer(*model);
}

}  // namespace vitrine
