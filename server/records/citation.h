// SPDX-License-Identifier: Apache-2.0
// Cites a model in the styles that journals and schools ask for.
#pragma once

#include <string>

#include "server/records/described_model.h"

namespace vitrine::server {

// Each citation is plain text, so titles are not in italics. It has the creators' names as the
// catalogue writes them, the date of the object, or else the year in which the model was added, and
// the most permanent address of the model.
struct Citations {
  std::string apa;      // American Psychological Association, 7th edition
  std::string chicago;  // The Chicago Manual of Style, 17th edition, bibliography
  std::string mla;      // Modern Language Association, 9th edition
};

Citations citations_of(const DescribedModel& model);

}  // namespace vitrine::server
