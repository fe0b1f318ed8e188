// SPDX-License-Identifier: Apache-2.0
// The metadata formats in which a model's record is available.
#pragma once

#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>

#include "server/records/described_model.h"

namespace vitrine::server {

struct RecordFormat {
  const char* prefix;         // metadataPrefix of OAI-PMH
  const char* file;           // last part of the record's path, /api/v1/models/{id}/FILE
  const char* label;          // name for people
  const char* xml_namespace;  // namespace of the format, metadataNamespace of OAI-PMH
  const char* schema;         // URL of the XML schema
};

inline constexpr RecordFormat kDublinCore{
    .prefix = "oai_dc",
    .file = "metadata.dc.xml",
    .label = "Dublin Core",
    .xml_namespace = "http://www.openarchives.org/OAI/2.0/oai_dc/",
    .schema = "http://www.openarchives.org/OAI/2.0/oai_dc.xsd"};
inline constexpr RecordFormat kEdm{.prefix = "edm",
                                   .file = "metadata.edm.xml",
                                   .label = "Europeana Data Model",
                                   .xml_namespace = "http://www.europeana.eu/schemas/edm/",
                                   .schema = "http://www.europeana.eu/schemas/edm/EDM.xsd"};
inline constexpr RecordFormat kLido{
    .prefix = "lido",
    .file = "metadata.lido.xml",
    .label = "LIDO",
    .xml_namespace = "http://www.lido-schema.org",
    .schema = "http://www.lido-schema.org/schema/v1.1/lido-v1.1.xsd"};
inline constexpr const RecordFormat* kRecordFormats[] = {&kDublinCore, &kEdm, &kLido};

// Returns null if there is no format with this prefix.
const RecordFormat* find_record_format(std::string_view prefix);

// Appends the record of the model in this format to `parent`.
void add_record(pugi::xml_node parent, const RecordFormat& format, const DescribedModel& model);

// Returns the record as an XML document.
std::string record_text(const RecordFormat& format, const DescribedModel& model);

}  // namespace vitrine::server
