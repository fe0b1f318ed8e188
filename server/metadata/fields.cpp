// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/fields.h"

#include <algorithm>
#include <cctype>

#include "server/metadata/rights.h"

namespace vitrine::server {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Whether `text` is a DOI without a resolver, such as 10.5281/zenodo.1234 (ISO 26324).
bool is_doi(std::string_view text) {
  constexpr std::string_view kDirectory = "10.";
  if (!text.starts_with(kDirectory)) return false;
  text.remove_prefix(kDirectory.size());
  const std::size_t slash = text.find('/');
  if (slash == text.npos || slash < 4 || slash + 1 == text.size()) return false;
  const auto registrant = text.substr(0, slash);
  return std::ranges::all_of(registrant, [](char c) { return is_digit(c) || c == '.'; }) &&
         text.find(' ') == text.npos;
}

// Whether `text` is a URI: a scheme, a colon and no space ([RFC3986] section 3).
bool is_uri(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos || colon < 2 || colon + 1 == text.size()) return false;
  const auto fits = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.';
  };
  return std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
         std::ranges::all_of(text.substr(0, colon), fits) && text.find(' ') == text.npos;
}

}  // namespace

std::optional<std::string> expected_text(std::string_view name, std::string_view value) {
  if (value.empty()) return std::nullopt;
  if (name == "doi" && !is_doi(value)) return "a DOI without a resolver, such as 10.5281/zenodo.1";
  if (name == "persistent_identifier" && !is_uri(value))
    return "a URI, such as https://n2t.net/ark:/12345/x or urn:nbn:de:101:1";
  if (name == "rights_statement" && rights_statement_label(value).empty())
    return "the URI of a statement, such as http://rightsstatements.org/vocab/InC/1.0/";
  return std::nullopt;
}

}  // namespace vitrine::server
