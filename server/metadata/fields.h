// SPDX-License-Identifier: Apache-2.0
// The names of a model's additional texts (ModelRecord::more), and the checks of their values.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vitrine::server {

inline constexpr std::string_view kMoreTexts[] = {
    // Dublin Core elements [DublinCore] that have no member of their own in ModelRecord.
    // `identifier` is the inventory number.
    "contributor", "coverage", "date", "description", "identifier", "language", "publisher",
    "relation", "source", "subject", "type",
    // texts about the object
    "material", "technique", "period", "place", "collection", "provenance", "rights_statement",
    "persistent_identifier", "doi",
    // texts about the scan
    "scan_device", "scan_calibration", "scan_date", "scan_software"};

// Whether a text of ModelRecord::more may have several paragraphs. Others have one line.
constexpr bool has_paragraphs(std::string_view name) {
  return name == "description" || name == "provenance";
}

// Returns nullopt if the text `name` may have this value, otherwise a description of the values
// that it may have. An empty value is always allowed.
std::optional<std::string> expected_text(std::string_view name, std::string_view value);

}  // namespace vitrine::server
