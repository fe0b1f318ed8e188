// SPDX-License-Identifier: Apache-2.0
#include "server/records/record_writers.h"

#include "server/metadata/rights.h"
#include "server/records/record_format.h"
#include "server/records/xml.h"

namespace vitrine::server {
namespace {

struct DublinCoreElement {
  const char* element;
  const char* text;  // name of the model's text
};

// Texts that may have several values. Dublin Core has no element for materials: `format` is "the
// file format, physical medium, or dimensions of the resource".
constexpr DublinCoreElement kLists[] = {
    {"dc:creator", "creator"},     {"dc:subject", "subject"},   {"dc:contributor", "contributor"},
    {"dc:publisher", "publisher"}, {"dc:date", "date"},         {"dc:type", "type"},
    {"dc:format", "material"},     {"dc:format", "technique"},  {"dc:source", "source"},
    {"dc:language", "language"},   {"dc:relation", "relation"}, {"dc:relation", "collection"},
    {"dc:coverage", "coverage"},   {"dc:coverage", "place"},    {"dc:coverage", "period"}};

void add_dublin_core_rights(pugi::xml_node dc, const DescribedModel& model) {
  const std::string &licence = model.text("licence"), &statement = model.text("rights_statement");
  const std::string licence_uri = rights_url(licence).value_or(licence),
                    statement_uri = rights_url(statement).value_or(statement);
  add_text(dc, "dc:rights", model.text("rights"));
  add_text(dc, "dc:rights", licence_uri);
  if (statement_uri != licence_uri) add_text(dc, "dc:rights", statement_uri);
}

}  // namespace

void add_dublin_core(pugi::xml_node parent, const DescribedModel& model) {
  pugi::xml_node dc = parent.append_child("oai_dc:dc");
  add_namespace(dc, "xmlns:oai_dc", kDublinCore.xml_namespace);
  add_namespace(dc, "xmlns:dc", "http://purl.org/dc/elements/1.1/");
  add_schema_location(dc, kDublinCore.xml_namespace, kDublinCore.schema);
  add_text(dc, "dc:title", model.title());
  for (const auto& [element, name] : kLists) {
    for (const std::string& value : values_in(model.text(name)))
      add_text(dc, element, value);
  }
  add_text(dc, "dc:type", "InteractiveResource");  // a term of the DCMI Type Vocabulary
  add_text(dc, "dc:description", model.text("description"));
  add_text(dc, "dc:format", "model/gltf-binary");
  if (model.size()) add_text(dc, "dc:format", to_text(*model.size()));
  add_text(dc, "dc:identifier", model.page_url());
  add_text(dc, "dc:identifier", model.doi_url());
  for (const char* name : {"persistent_identifier", "identifier"})
    add_text(dc, "dc:identifier", model.text(name));
  add_dublin_core_rights(dc, model);
}

}  // namespace vitrine::server
