// SPDX-License-Identifier: Apache-2.0
// Serves OAI-PMH 2.0, a protocol by which other catalogues collect metadata. All callers see the
// published models only, whether or not they have a token.
#include "server/records/oai.h"

#include <chrono>

#include "server/api/published.h"
#include "server/api/routes.h"

namespace vitrine::server {
namespace {

OaiSite site_of(const Request& request, const Services& services) {
  return {.origin = origin_of(request, services),
          .contact = services.settings.get().contact,
          .now = std::chrono::duration_cast<std::chrono::seconds>(
                     std::chrono::system_clock::now().time_since_epoch())
                     .count()};
}

Response oai_answer(std::string_view arguments, const OaiSite& site, std::string_view request_id,
                    Services& services) {
  const auto query = Query::parse(arguments);
  if (!query) return problem(400, "the arguments are malformed", request_id);
  auto text = answer_oai(*query, site, services.catalogue);
  if (!text) return internal_error(text.error(), request_id, services);
  Response response;
  response.type = "text/xml; charset=utf-8";  // the protocol requires text/xml
  response.body = std::move(*text);
  return response;
}

}  // namespace

static Response harvest(const Request& request, Services& services) {
  return oai_answer(request.query, site_of(request, services), request.id, services);
}

static Response harvest_by_post(const Request& request, Services& services) {
  return oai_answer(request.form, site_of(request, services), request.id, services);
}

static constexpr std::string_view kOaiComponents = R"json({
"parameters": {
  "oaiVerb": {"name": "verb", "in": "query", "description": "The request of OAI-PMH",
    "schema": {"enum": ["Identify", "ListMetadataFormats", "ListSets", "GetRecord", "ListIdentifiers", "ListRecords"]}},
  "oaiIdentifier": {"name": "identifier", "in": "query", "description": "A record: `oai:HOST:ID`", "schema": {"type": "string"}},
  "metadataPrefix": {"name": "metadataPrefix", "in": "query", "description": "The format of records",
    "schema": {"enum": ["oai_dc", "edm", "lido"]}},
  "oaiFrom": {"name": "from", "in": "query", "description": "The first day or second, in UTC, of a record's last change", "schema": {"type": "string"}},
  "oaiUntil": {"name": "until", "in": "query", "description": "The last day or second, in UTC, of a record's last change", "schema": {"type": "string"}},
  "oaiSet": {"name": "set", "in": "query", "description": "The setSpec of a collection", "schema": {"type": "string"}},
  "resumptionToken": {"name": "resumptionToken", "in": "query", "description": "The token of the previous page; the only argument besides the verb",
    "schema": {"type": "string"}}
}
})json";

static constexpr ApiRoute kOaiRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/oai",
     .handler = harvest,
     .executor = Executor::kWorker,
     .doc = {.id = "harvest",
             .summary = "Answers a request of OAI-PMH 2.0: the records of all published models, in "
                        "Dublin Core, EDM and LIDO. Errors of the protocol have status 200.",
             .parameters = "oaiVerb oaiIdentifier metadataPrefix oaiFrom oaiUntil oaiSet "
                           "resumptionToken",
             .response = "text/xml"}},
    {.method = Method::kPost,
     .path = "/api/v1/oai",
     .handler = harvest_by_post,
     .executor = Executor::kWorker,
     .body = BodyKind::kForm,
     .doc = {.id = "harvestByPost",
             .summary = "Answers a request of OAI-PMH 2.0 whose arguments are in the body.",
             .request = "application/x-www-form-urlencoded",
             .response = "text/xml"}},
};

static constexpr ApiTag kOaiTags[] = {
    {.name = "oai",
     .description = "Records of all published models for other catalogues, by OAI-PMH 2.0."}};

const ApiNoun kOai = {.routes = kOaiRoutes, .components = kOaiComponents, .tags = kOaiTags};

}  // namespace vitrine::server
