// SPDX-License-Identifier: Apache-2.0
// Helpers that the handlers of models share: they find the model that a caller may see, and make
// common responses.
#pragma once

#include <fmt/format.h>

#include "server/api/job_json.h"
#include "server/api/model_json.h"
#include "server/api/path_parameters.h"
#include "server/api/services.h"
#include "server/api/visibility.h"
#include "server/messages/problem.h"
#include "server/records/links.h"
#include "server/store/change.h"

namespace vitrine::server {

// Returns the bytes `range` of the model's file as a body. The body keeps the model alive and its
// file open.
inline Body stored_body(const std::shared_ptr<const PublishedModel>& model, ByteRange range) {
  return StoredBytes{{model, &model->file()}, range.offset, range.length};
}

// Returns the start of absolute URLs, such as "https://museum.example"; see
// server/records/links.h.
inline std::string origin_of(const Request& request, const Services& services) {
  return origin_of(request, services.settings.get().public_url);
}

// Returns how models are shown to the client of the request.
inline ModelView view_for(const Request& request, const Services& services) {
  return {.has_token = request.caller.has_value(),
          .counts_visits = services.settings.get().counts_visits,
          .origin = origin_of(request, services),
          .public_url = services.settings.get().public_url};
}

// Returns the entity tag of a part of the model's file; `sha256` is the part's hash. After a
// damaged file was repaired, the tag changes. Otherwise, a 304 response could confirm a damaged
// copy in a client's cache.
inline std::string stored_tag(const PublishedModel& model, const Sha256& sha256,
                              std::string_view suffix = "") {
  std::string tag = '"' + to_hex(sha256);
  tag += suffix;
  if (model.damages() > 0) tag += fmt::format("-repaired{}", model.damages());
  return tag + '"';
}

// Writes the error to the operator's log.
inline void tell_operator(const Error& error, std::string_view request_id, Services& services) {
  services.errors.event(Severity::kError,
                        std::string("request ") + std::string(request_id) + ": " + error.message);
}

// Logs the error. Returns 503 if the catalogue, store or disk does not respond, else 500. The
// response does not contain the reason.
inline Response internal_error(const Error& error, std::string_view request_id,
                               Services& services) {
  tell_operator(error, request_id, services);
  return error.code == ErrorCode::kIo ? away(request_id) : problem(500, "", request_id);
}
inline Response internal_error(const Error& error, const Request& request, Services& services) {
  return internal_error(error, request.id, services);
}

// Returns the faults of a webhook URL. An empty URL is valid and means that no webhook is called.
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

// Largest number of models in one page of a listing. A sitemap may have up to 50,000 addresses.
inline constexpr std::uint32_t kMostListed = 10'000;

// Returns the public parts of the published models that the query finds, at most kMostListed of
// them. Ignores the query's limit.
inline Expected<std::vector<ModelRecord>> list_public(ModelQuery query, Services& services) {
  std::vector<ModelRecord> all;
  query.limit = kMaxPage;
  do {
    auto page = services.catalogue.search(query);
    if (!page) return tl::unexpected(page.error());
    for (ModelRecord& model : page->models)
      all.push_back(public_view(std::move(model)));
    query.after = page->next;
  } while (query.after && all.size() < kMostListed);
  return all;
}

// The cursor of the first page, newest models first: the greatest ID, which no model has.
inline ModelId first_cursor() {
  Ulid greatest;
  greatest.fill(0xFF);
  return ModelId::from_bytes(greatest);
}

// Answers a request for a document that lists all published models. If they need several pages and
// the request has no cursor, returns `index(cursors)`, with the cursor of each page. Otherwise
// returns `page(models, cursor)` with the models of the requested page.
template <class Index, class Page>
Response in_pages(const Request& request, Services& services, Index&& index, Page&& page) {
  constexpr std::string_view kKnown[] = {"cursor"};
  const auto query = read_query(request, kKnown);
  if (!query) return query.error();
  const auto asked = read_page<ModelId>(*query);
  if (!asked) return problem(400, "a parameter is out of range", request.id, asked.error());
  if (!asked->after) {
    auto cursors = services.catalogue.page_cursors(kMostListed);
    if (!cursors) return internal_error(cursors.error(), request, services);
    if (!cursors->empty()) {
      cursors->insert(cursors->begin(), first_cursor());
      return index(*cursors);
    }
  }
  const auto models = list_public({.after = asked->after}, services);
  if (!models) return internal_error(models.error(), request, services);
  return page(*models, asked->after);
}

// Marks the response as private (Caching::kPrivate): caches must not store it, and pages of other
// origins must not read it.
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
