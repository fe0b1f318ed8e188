// SPDX-License-Identifier: Apache-2.0
// The licences of Creative Commons and the statements of RightsStatements.org.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vitrine::server {

// Returns the URL that IIIF requires for `rights`. `licence` is a Creative Commons licence (an
// identifier such as CC-BY-4.0 or CC-BY-3.0-DE, or the URL of one of its pages), or the URL of a
// statement of RightsStatements.org or of its page. The result begins with "http:", because the
// identifiers in both vocabularies do. Returns nullopt for other texts.
std::optional<std::string> rights_url(std::string_view licence);

// Returns the English label of a statement of RightsStatements.org, such as "In Copyright", or an
// empty text if `uri` is not one of the twelve statements.
std::string_view rights_statement_label(std::string_view uri);

}  // namespace vitrine::server
