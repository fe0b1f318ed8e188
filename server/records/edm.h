// SPDX-License-Identifier: Apache-2.0
// Describes a model in the Europeana Data Model, as data providers deliver it: RDF/XML with the
// object, its aggregation and its web resources [EDM].
#pragma once

#include <pugixml.hpp>

#include "server/records/described_model.h"

namespace vitrine::server {

// Appends the element rdf:RDF to `parent`. EDM requires a rights statement from a list. If the
// model has none, the record states "Copyright Not Evaluated". Thread-safe.
void add_edm(pugi::xml_node parent, const DescribedModel& model);

}  // namespace vitrine::server
