// SPDX-License-Identifier: Apache-2.0
// Describes a model in LIDO 1.1, the format in which museums exchange descriptions [LIDO].
#pragma once

#include <pugixml.hpp>

#include "server/records/described_model.h"

namespace vitrine::server {

// Appends the element lido:lido to `parent`. Thread-safe.
void add_lido(pugi::xml_node parent, const DescribedModel& model);

}  // namespace vitrine::server
