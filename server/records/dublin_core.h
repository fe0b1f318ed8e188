// SPDX-License-Identifier: Apache-2.0
// Describes a model in Dublin Core, as OAI-PMH requires it: the format oai_dc [OAI-PMH].
#pragma once

#include <pugixml.hpp>

#include "server/records/described_model.h"

namespace vitrine::server {

// Appends the element oai_dc:dc to `parent`. Thread-safe.
void add_dublin_core(pugi::xml_node parent, const DescribedModel& model);

}  // namespace vitrine::server
