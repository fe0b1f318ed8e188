// SPDX-License-Identifier: Apache-2.0
// Describes a model in the formats that other catalogues read. All functions are thread-safe.
#pragma once

#include <pugixml.hpp>

#include "server/records/described_model.h"

namespace vitrine::server {

// Appends the element oai_dc:dc to `parent`: the model in Dublin Core, as OAI-PMH requires it
// [OAI-PMH].
void add_dublin_core(pugi::xml_node parent, const DescribedModel& model);

// Appends the element rdf:RDF to `parent`: the model in the Europeana Data Model, as data providers
// deliver it, with the object, its aggregation and its web resources [EDM]. EDM requires a rights
// statement from a list. If the model has none, the record states "Copyright Not Evaluated".
void add_edm(pugi::xml_node parent, const DescribedModel& model);

// Appends the element lido:lido to `parent`: the model in LIDO 1.1, the format in which museums
// exchange descriptions [LIDO].
void add_lido(pugi::xml_node parent, const DescribedModel& model);

}  // namespace vitrine::server
