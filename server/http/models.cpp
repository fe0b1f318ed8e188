// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/model_json.h"
#include "server/http/published.h"
#include "server/http/query.h"
#include "server/http/wish.h"

namespace vitrine {
namespace {

using Faults = std::vector<ParameterFault>;

// Bytes of the model's file under a name that changes with the file: "<sha256><suffix>".
Response stored(const std::shared_ptr<const PublishedModel>& model, ByteRange range,
                std::string_view suffix) {
  Response response;
  response.type = "application/octet-stream";
  response.caching = Caching::kRevalidate;
  response.etag = fmt::format("\"{}{}\"", to_hex(model->record().file), suffix);
  response.body = stored_body(model, range);
  return response;
}

ModelQuery read_query(const Query& query, Faults& faults) {
  constexpr std::size_t kMaxText = 200;
  ModelQuery out;
  if (const auto text = query.get("q")) {
    out.text = *text;
    if (text->size() > kMaxText) faults.push_back({"q", fmt::format("at most {} bytes", kMaxText)});
  }
  if (const auto page = read_page(query)) {
    out.after = page->after;
    out.limit = page->limit;
  } else {
    faults.insert(faults.end(), page.error().begin(), page.error().end());
  }
  if (const auto drafts = query.get("drafts")) {
    out.drafts = *drafts == "true";
    if (!out.drafts && *drafts != "false") faults.push_back({"drafts", "true or false"});
  }
  return out;
}

// The model as it is then. Who asks for what is so already changes nothing.
Response in_state(ModelState state, const Request& request, Services& services) {
  auto model = services.catalogue.find(request.parameters.id);
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  if ((*model)->state != state) {
    const auto done = services.catalogue.set_state((*model)->id, state);
    if (!done) return refused(done.error(), request, services);
    services.models.refresh();
    (*model)->state = state;
  }
  Response response;
  response.type = "application/json";
  response.body = model_json(**model);
  return response;
}

}  // namespace

Response list_models(const Request& request, Services& services) {
  constexpr std::string_view kKnown[] = {"q", "limit", "cursor", "drafts"};
  const auto query = read_query(request, kKnown);
  if (!query) return query.error();
  Faults faults;
  const ModelQuery wanted = read_query(*query, faults);
  if (!faults.empty()) return problem(400, "a parameter is out of range", request.id, faults);
  if (wanted.drafts && !request.caller) return token_needed(request);
  const auto page = services.catalogue.search(wanted);
  if (!page) return internal_error(page.error(), request, services);
  Response response =
      revalidated("application/json", model_page_json(*page, request.caller.has_value()));
  if (request.caller) return for_caller(std::move(response));
  return response;
}

Response show_model(const Request& request, Services& services) {
  return with_model(request, services, [](const auto& model) {
    Response response = revalidated("application/json", model_json(model->record()));
    response.etag = model_tag(model->record());
    return response;
  });
}

Response show_manifest(const Request& request, Services& services) {
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  return with_model(request, services, [&](const auto& model) {
    const auto wish = read_wish(*query, request.header, model->manifest());
    if (!wish) return problem(400, "a parameter is out of range", request.id, {wish.error()});
    const bool asked = wish->stated || saves_data(request.header);
    Response response = revalidated(
        "application/json", manifest_json(*model, asked ? std::optional(*wish) : std::nullopt));
    response.fields = {{"Vary", "Save-Data"}};
    if (!asked)
      services.models.keep_manifest(model, {std::get<std::string>(response.body), response.etag});
    return response;
  });
}

std::optional<Response> show_held_manifest(const Request& request, Services& services) {
  const bool is_plain = request.query.empty() && !saves_data(request.header) &&
                        request.header.count(beast::http::field::authorization) == 0;
  if (!is_plain) return std::nullopt;
  const auto model = services.models.held(request.parameters.id);
  const auto kept = model ? model->kept_manifest() : nullptr;
  if (!kept) return std::nullopt;
  const auto* text = reinterpret_cast<const std::uint8_t*>(kept->text.data());
  Response response;
  response.type = "application/json";
  response.caching = Caching::kRevalidate;
  response.etag = kept->etag;
  response.fields = {{"Vary", "Save-Data"}};
  response.body = SharedBytes{kept, {text, kept->text.size()}};
  return response;
}

Response show_head(const Request& request, Services& services) {
  return with_model(request, services,
                    [](const auto& model) { return stored(model, model->head(), "-head"); });
}

Response show_file(const Request& request, Services& services) {
  return with_model(request, services,
                    [](const auto& model) { return stored(model, model->whole(), ""); });
}

Response publish_model(const Request& request, Services& services) {
  return in_state(ModelState::kPublished, request, services);
}

Response unpublish_model(const Request& request, Services& services) {
  return in_state(ModelState::kDraft, request, services);
}

}  // namespace vitrine
