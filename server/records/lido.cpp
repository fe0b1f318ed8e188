// SPDX-License-Identifier: Apache-2.0
#include "server/records/record_writers.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>

#include "server/metadata/rights.h"
#include "server/records/record_format.h"
#include "server/records/xml.h"

namespace vitrine::server {
namespace {

using Xml = pugi::xml_node;

// The term "Production" of LIDO's vocabulary of events.
constexpr const char* kProduction = "http://terminology.lido-schema.org/lido00007";

// Appends an element whose attribute lido:type is `type`, unless the text is empty.
void add_typed(Xml parent, const char* name, const char* type, std::string_view text) {
  if (text.empty()) return;
  add_attribute(add_element(parent, name, text), "lido:type", type);
}

void add_concept(Xml parent, const char* name, std::string_view term) {
  add_text(parent.append_child(name), "lido:term", term);
}

void add_concepts(Xml parent, const char* name, std::string_view terms) {
  for (const std::string& term : values_in(terms))
    add_concept(parent, name, term);
}

void add_appellation(Xml parent, const char* name, std::string_view value) {
  add_text(parent.append_child(name), "lido:appellationValue", value);
}

// LIDO requires a language of all texts, but the catalogue does not store it: the model's
// `language` is that of the object. ISO 639-2 has a code for undetermined languages.
constexpr const char* kUnknownLanguage = "und";

// Formats a number as XML Schema defines decimals: without an exponent.
std::string decimal(double value) {
  char digits[400];
  const auto end =
      std::to_chars(std::begin(digits), std::end(digits), value, std::chars_format::fixed);
  return {digits, end.ptr};
}

void add_classification(Xml description, const DescribedModel& model) {
  Xml types = description.append_child("lido:objectClassificationWrap")
                  .append_child("lido:objectWorkTypeWrap");
  const std::string& type = model.text("type");
  // LIDO requires a term in this element.
  add_concepts(types, "lido:objectWorkType", values_in(type).empty() ? "3D model" : type);
}

void add_repository(Xml identification, const DescribedModel& model) {
  Xml repository =
      identification.append_child("lido:repositoryWrap").append_child("lido:repositorySet");
  add_appellation(repository.append_child("lido:repositoryName"), "lido:legalBodyName",
                  model.provider());
  add_typed(repository, "lido:workID", "inventory number", model.text("identifier"));
}

void add_notes(Xml identification, const DescribedModel& model) {
  Xml notes = identification.append_child("lido:objectDescriptionWrap");
  for (const char* name : {"description", "provenance"}) {
    if (model.text(name).empty()) continue;
    Xml set = notes.append_child("lido:objectDescriptionSet");
    add_attribute(set, "lido:type", name);
    add_text(set, "lido:descriptiveNoteValue", model.text(name));
  }
}

void add_measurement(Xml measurements, const char* type, double value, const std::string& unit) {
  Xml set = measurements.append_child("lido:measurementsSet");
  add_text(set, "lido:measurementType", type);
  add_text(set, "lido:measurementUnit", unit);
  add_text(set, "lido:measurementValue", decimal(value));
}

void add_measurements(Xml identification, const Dimensions& size) {
  Xml set = identification.append_child("lido:objectMeasurementsWrap")
                .append_child("lido:objectMeasurementsSet");
  add_text(set, "lido:displayObjectMeasurements", to_text(size));
  Xml measurements = set.append_child("lido:objectMeasurements");
  add_measurement(measurements, "width", size.width, size.unit);
  add_measurement(measurements, "height", size.height, size.unit);
  add_measurement(measurements, "depth", size.depth, size.unit);
}

void add_materials(Xml identification, const DescribedModel& model) {
  Xml materials = identification.append_child("lido:objectMaterialsTechWrap");
  for (const char* name : {"material", "technique"}) {
    for (const std::string& value : values_in(model.text(name))) {
      Xml term = materials.append_child("lido:objectMaterialsTechSet")
                     .append_child("lido:materialsTech")
                     .append_child("lido:termMaterialsTech");
      add_attribute(term, "lido:type", name);
      add_text(term, "lido:term", value);
    }
  }
}

void add_identification(Xml description, const DescribedModel& model) {
  Xml identification = description.append_child("lido:objectIdentificationWrap");
  add_appellation(identification.append_child("lido:titleWrap"), "lido:titleSet", model.title());
  add_repository(identification, model);
  add_notes(identification, model);
  if (model.size()) add_measurements(identification, *model.size());
  add_materials(identification, model);
}

void add_actors(Xml event, const char* role, std::string_view names) {
  for (const std::string& name : values_in(names)) {
    Xml actor = event.append_child("lido:eventActor").append_child("lido:actorInRole");
    add_appellation(actor.append_child("lido:actor"), "lido:nameActorSet", name);
    add_concept(actor, "lido:roleActor", role);
  }
}

void add_display(Xml parent, const char* name, const char* display, std::string_view text) {
  if (!text.empty()) add_text(parent.append_child(name), display, text);
}

void add_production(Xml description, const DescribedModel& model) {
  Xml event = description.append_child("lido:eventWrap")
                  .append_child("lido:eventSet")
                  .append_child("lido:event");
  Xml type = event.append_child("lido:eventType");
  add_typed(type, "lido:conceptID", "URI", kProduction);
  add_text(type, "lido:term", "Production");
  add_actors(event, "creator", model.text("creator"));
  add_actors(event, "contributor", model.text("contributor"));
  add_display(event, "lido:eventDate", "lido:displayDate", model.text("date"));
  add_concepts(event, "lido:periodName", model.text("period"));
  for (const char* name : {"place", "coverage"})
    add_display(event, "lido:eventPlace", "lido:displayPlace", model.text(name));
}

void add_relations(Xml description, const DescribedModel& model) {
  Xml relations = description.append_child("lido:objectRelationWrap");
  Xml subjects = relations.append_child("lido:subjectWrap");
  for (const std::string& subject : values_in(model.text("subject"))) {
    Xml set = subjects.append_child("lido:subjectSet").append_child("lido:subject");
    add_concept(set, "lido:subjectConcept", subject);
  }
  Xml works = relations.append_child("lido:relatedWorksWrap");
  for (const char* name : {"relation", "source"})
    add_display(works, "lido:relatedWorkSet", "lido:displayRelatedWork", model.text(name));
}

// Appends a licence or a rights statement as a concept. If the licence or statement has a URI, the
// URI is the identifier of the concept.
void add_rights_type(Xml rights, const std::string& text, std::string_view label) {
  if (text.empty()) return;
  Xml type = rights.append_child("lido:rightsType");
  if (const auto uri = rights_url(text)) add_typed(type, "lido:conceptID", "URI", *uri);
  add_text(type, "lido:term", label.empty() ? text : label);
}

void add_work_rights(Xml administration, const DescribedModel& model) {
  Xml rights =
      administration.append_child("lido:rightsWorkWrap").append_child("lido:rightsWorkSet");
  const std::string& statement = model.text("rights_statement");
  add_rights_type(rights, statement, rights_statement_label(statement));
  add_text(rights, "lido:creditLine", model.text("rights"));
}

void add_administration(Xml administration, const DescribedModel& model) {
  Xml record = administration.append_child("lido:recordWrap");
  add_typed(record, "lido:recordID", "local", model.record().id.to_string());
  add_concept(record, "lido:recordType", "Single object");
  add_appellation(record.append_child("lido:recordSource"), "lido:legalBodyName", model.provider());
  add_text(record.append_child("lido:recordInfoSet"), "lido:recordInfoLink", model.page_url());
  for (const std::string& name : values_in(model.text("collection")))
    add_display(record, "lido:collection", "lido:displayObject", name);
}

void add_representation(Xml resource, const char* type, const std::string& url,
                        const char* media_type) {
  Xml representation = resource.append_child("lido:resourceRepresentation");
  add_attribute(representation, "lido:type", type);
  add_attribute(add_element(representation, "lido:linkResource", url), "lido:formatResource",
                media_type);
}

// Appends the model's file with its poster, its licence and the circumstances of the scan.
void add_scan(Xml administration, const DescribedModel& model) {
  Xml resource = administration.append_child("lido:resourceWrap").append_child("lido:resourceSet");
  add_typed(resource, "lido:resourceID", "local", model.record().id.to_string());
  add_representation(resource, "3D", model.glb_url(), "model/gltf-binary");
  add_representation(resource, "image", model.poster_url(), "image/png");
  add_concept(resource, "lido:resourceType", "3D model");
  add_typed(resource, "lido:resourceDescription", "scanner", model.text("scan_device"));
  add_typed(resource, "lido:resourceDescription", "calibration", model.text("scan_calibration"));
  add_typed(resource, "lido:resourceDescription", "software", model.text("scan_software"));
  if (const auto& accuracy = model.record().accuracy) {
    add_typed(resource, "lido:resourceDescription", "accuracy",
              fmt::format("± {} {}", *accuracy, model.record().unit));
  }
  add_display(resource, "lido:resourceDateTaken", "lido:displayDate", model.text("scan_date"));
  add_rights_type(resource.append_child("lido:rightsResource"), model.text("licence"), "");
}

}  // namespace

void add_lido(pugi::xml_node parent, const DescribedModel& model) {
  Xml lido = parent.append_child("lido:lido");
  add_namespace(lido, "xmlns:lido", kLido.xml_namespace);
  add_schema_location(lido, kLido.xml_namespace, kLido.schema);
  add_typed(lido, "lido:lidoRecID", "URI", model.page_url());
  add_typed(lido, "lido:objectPublishedID", "URI", model.text("persistent_identifier"));
  add_typed(lido, "lido:objectPublishedID", "DOI", model.doi_url());
  Xml description = lido.append_child("lido:descriptiveMetadata");
  add_attribute(description, "xml:lang", kUnknownLanguage);
  add_classification(description, model);
  add_identification(description, model);
  add_production(description, model);
  add_relations(description, model);
  Xml administration = lido.append_child("lido:administrativeMetadata");
  add_attribute(administration, "xml:lang", kUnknownLanguage);
  add_work_rights(administration, model);
  add_administration(administration, model);
  add_scan(administration, model);
}

}  // namespace vitrine::server
