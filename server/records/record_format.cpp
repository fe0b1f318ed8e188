// SPDX-License-Identifier: Apache-2.0
#include "server/records/record_format.h"

#include <algorithm>

#include "server/records/record_writers.h"
#include "server/records/xml.h"

namespace vitrine::server {

const RecordFormat* find_record_format(std::string_view prefix) {
  const auto* const found = std::ranges::find_if(
      kRecordFormats, [&](const RecordFormat* format) { return format->prefix == prefix; });
  return found == std::end(kRecordFormats) ? nullptr : *found;
}

void add_record(pugi::xml_node parent, const RecordFormat& format, const DescribedModel& model) {
  if (&format == &kDublinCore) return add_dublin_core(parent, model);
  if (&format == &kEdm) return add_edm(parent, model);
  add_lido(parent, model);
}

std::string record_text(const RecordFormat& format, const DescribedModel& model) {
  pugi::xml_document document;
  add_record(document, format, model);
  return to_text(document);
}

}  // namespace vitrine::server
