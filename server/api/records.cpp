// SPDX-License-Identifier: Apache-2.0
// Serves the records of models: their metadata in the formats that other catalogues import.
#include "server/records/record_format.h"

#include "server/api/published.h"
#include "server/api/routes.h"

namespace vitrine::server {
namespace {

// Returns the record of the part of the model that the caller may see.
Response show_record(const RecordFormat& format, const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const DescribedModel described(model->record(), origin_of(request, services),
                                   dimensions_of(model->record(), model->manifest()));
    return revalidated("application/xml", record_text(format, described));
  });
}

}  // namespace

static Response show_dublin_core(const Request& request, Services& services) {
  return show_record(kDublinCore, request, services);
}

static Response show_edm(const Request& request, Services& services) {
  return show_record(kEdm, request, services);
}

static Response show_lido(const Request& request, Services& services) {
  return show_record(kLido, request, services);
}

static constexpr ApiRoute kRecordRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/metadata.dc.xml",
     .handler = show_dublin_core,
     .executor = Executor::kWorker,
     .doc = {.id = "getDublinCore",
             .summary = "Returns the model's metadata in Dublin Core (oai_dc).",
             .response = "application/xml"}},
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/metadata.edm.xml",
     .handler = show_edm,
     .executor = Executor::kWorker,
     .doc = {.id = "getEdm",
             .summary = "Returns the model's metadata in the Europeana Data Model, as RDF/XML.",
             .response = "application/xml"}},
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/metadata.lido.xml",
     .handler = show_lido,
     .executor = Executor::kWorker,
     .doc = {.id = "getLido",
             .summary = "Returns the model's metadata in LIDO 1.1.",
             .response = "application/xml"}},
};

const ApiNoun kRecords = {.routes = kRecordRoutes};

}  // namespace vitrine::server
