// SPDX-License-Identifier: Apache-2.0
#include "server/records/record_writers.h"

#include "server/records/record_format.h"
#include "server/records/xml.h"

namespace vitrine::server {
namespace {

constexpr const char* kRdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
constexpr const char* kNotEvaluated = "http://rightsstatements.org/vocab/CNE/1.0/";

struct EdmProperty {
  const char* element;
  const char* text;  // name of the model's text
};

// Properties of the object whose texts may have several values.
constexpr EdmProperty kProperties[] = {{"dc:contributor", "contributor"},
                                       {"dc:coverage", "coverage"},
                                       {"dc:creator", "creator"},
                                       {"dc:date", "date"},
                                       {"dc:format", "technique"},
                                       {"dc:language", "language"},
                                       {"dc:publisher", "publisher"},
                                       {"dc:relation", "relation"},
                                       {"dc:source", "source"},
                                       {"dc:subject", "subject"},
                                       {"dc:type", "type"},
                                       {"dcterms:isPartOf", "collection"},
                                       {"dcterms:medium", "material"},
                                       {"dcterms:spatial", "place"},
                                       {"dcterms:temporal", "period"}};

void add_resource(pugi::xml_node parent, const char* name, std::string_view uri) {
  add_attribute(parent.append_child(name), "rdf:resource", uri);
}

pugi::xml_node add_entity(pugi::xml_node parent, const char* name, std::string_view uri) {
  pugi::xml_node node = parent.append_child(name);
  add_attribute(node, "rdf:about", uri);
  return node;
}

// EDM requires a subject, a type, a period or a place.
bool has_context(const DescribedModel& model) {
  for (const char* name : {"subject", "type", "period", "place"})
    if (!values_in(model.text(name)).empty()) return true;
  return false;
}

void add_object(pugi::xml_node rdf, const std::string& uri, const DescribedModel& model) {
  pugi::xml_node object = add_entity(rdf, "edm:ProvidedCHO", uri);
  add_text(object, "dc:title", model.title());
  add_text(object, "dc:description", model.text("description"));
  for (const auto& [element, name] : kProperties) {
    for (const std::string& value : values_in(model.text(name)))
      add_text(object, element, value);
  }
  if (!has_context(model)) add_text(object, "dc:type", "3D model");
  add_text(object, "dcterms:provenance", model.text("provenance"));
  if (model.size()) add_text(object, "dcterms:extent", to_text(*model.size()));
  for (const std::string& id :
       {model.text("identifier"), model.text("persistent_identifier"), model.doi_url()})
    add_text(object, "dc:identifier", id);
  add_text(object, "edm:type", "3D");
}

void add_aggregation(pugi::xml_node rdf, const std::string& object, const std::string& rights,
                     const DescribedModel& model) {
  pugi::xml_node aggregation =
      add_entity(rdf, "ore:Aggregation", model.page_url() + "#aggregation");
  add_resource(aggregation, "edm:aggregatedCHO", object);
  add_text(aggregation, "edm:dataProvider", model.provider());
  add_resource(aggregation, "edm:isShownAt", model.page_url());
  add_resource(aggregation, "edm:isShownBy", model.glb_url());
  add_resource(aggregation, "edm:object", model.poster_url());
  add_text(aggregation, "edm:provider", model.provider());
  add_text(aggregation, "dc:rights", model.text("rights"));
  add_resource(aggregation, "edm:rights", rights);
}

void add_web_resource(pugi::xml_node rdf, const std::string& uri, const char* media_type,
                      const std::string& rights) {
  pugi::xml_node resource = add_entity(rdf, "edm:WebResource", uri);
  add_text(resource, "dc:format", media_type);
  add_resource(resource, "edm:rights", rights);
}

}  // namespace

void add_edm(pugi::xml_node parent, const DescribedModel& model) {
  pugi::xml_node rdf = parent.append_child("rdf:RDF");
  add_namespace(rdf, "xmlns:rdf", kRdf);
  add_namespace(rdf, "xmlns:edm", kEdm.xml_namespace);
  add_namespace(rdf, "xmlns:ore", "http://www.openarchives.org/ore/terms/");
  add_namespace(rdf, "xmlns:dc", "http://purl.org/dc/elements/1.1/");
  add_namespace(rdf, "xmlns:dcterms", "http://purl.org/dc/terms/");
  add_schema_location(rdf, kRdf, kEdm.schema);
  const std::string object = model.page_url() + "#object", stated = model.rights_uri();
  const std::string rights = stated.empty() ? kNotEvaluated : stated;
  add_object(rdf, object, model);
  add_web_resource(rdf, model.page_url(), "text/html", rights);
  add_web_resource(rdf, model.glb_url(), "model/gltf-binary", rights);
  add_web_resource(rdf, model.poster_url(), "image/png", rights);
  add_aggregation(rdf, object, rights, model);
}

}  // namespace vitrine::server
