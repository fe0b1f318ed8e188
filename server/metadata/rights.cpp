// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/rights.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <utility>

namespace vitrine::server {
namespace {

// The statements of https://rightsstatements.org/page/1.0/.
constexpr std::pair<std::string_view, std::string_view> kStatements[] = {
    {"InC", "In Copyright"},
    {"InC-OW-EU", "In Copyright - EU Orphan Work"},
    {"InC-EDU", "In Copyright - Educational Use Permitted"},
    {"InC-NC", "In Copyright - Non-Commercial Use Permitted"},
    {"InC-RUU", "In Copyright - Rights-holder(s) Unlocatable or Unidentifiable"},
    {"NoC-CR", "No Copyright - Contractual Restrictions"},
    {"NoC-NC", "No Copyright - Non-Commercial Use Only"},
    {"NoC-OKLR", "No Copyright - Other Known Legal Restrictions"},
    {"NoC-US", "No Copyright - United States"},
    {"CNE", "Copyright Not Evaluated"},
    {"UND", "Copyright Undetermined"},
    {"NKC", "No Known Copyright"}};

// Returns an SPDX identifier in lower case, because SPDX ignores case. People also write blanks
// instead of hyphens, as in "CC BY 4.0".
std::string identifier_of(std::string_view licence) {
  std::string id(licence);
  std::ranges::transform(id, id.begin(), [](unsigned char c) {
    return c == ' ' ? '-' : static_cast<char>(std::tolower(c));
  });
  return id;
}

// Removes the parts of an address that are no part of the identifier: the query, the fragment, and
// the name of a page such as "deed.de" or "legalcode".
std::string_view without_page(std::string_view url) {
  url = url.substr(0, url.find_first_of("?#"));
  for (const std::string_view page : {"/deed", "/legalcode"})
    if (const auto at = url.find(page); at != url.npos) return url.substr(0, at + 1);
  return url;
}

// Returns the identifier of a licence or statement from the address of one of its pages, without
// the scheme. Browsers show the address ".../page/InC/1.0/", but the identifier is
// ".../vocab/InC/1.0/".
std::optional<std::string> identifier_of_page(std::string_view address) {
  constexpr std::string_view kWww = "www.", kPage = "rightsstatements.org/page/";
  if (address.starts_with(kWww)) address.remove_prefix(kWww.size());
  if (!address.starts_with("creativecommons.org/") && !address.starts_with("rightsstatements.org/"))
    return std::nullopt;
  address = without_page(address);
  std::string id = address.starts_with(kPage)
                       ? "rightsstatements.org/vocab/" + std::string(address.substr(kPage.size()))
                       : std::string(address);
  if (!id.ends_with('/')) id += '/';
  return "http://" + id;
}

}  // namespace

std::optional<std::string> rights_url(std::string_view licence) {
  for (const std::string_view scheme : {"https://", "http://"}) {
    if (licence.starts_with(scheme)) return identifier_of_page(licence.substr(scheme.size()));
  }
  constexpr std::string_view kSite = "http://creativecommons.org/";
  const std::string id = identifier_of(licence);
  if (id == "cc0-1.0") return std::string(kSite) + "publicdomain/zero/1.0/";
  if (id == "cc-pdm-1.0") return std::string(kSite) + "publicdomain/mark/1.0/";
  // Matches an identifier such as cc-by-nc-sa-4.0 or cc-by-3.0-de. The groups are the licence's
  // terms, version and jurisdiction.
  const std::regex pattern("cc-(by(?:-nc)?(?:-sa|-nd)?)-([1-4]\\.[015])(?:-([a-z]{2}|igo))?");
  std::smatch found;
  if (!std::regex_match(id, found, pattern)) return std::nullopt;
  const std::string place = found[3].matched ? found[3].str() + '/' : "";
  return fmt::format("{}licenses/{}/{}/{}", kSite, found[1].str(), found[2].str(), place);
}

std::string_view rights_statement_label(std::string_view uri) {
  const auto url = rights_url(uri);
  for (const auto& [name, label] : kStatements) {
    if (url == fmt::format("http://rightsstatements.org/vocab/{}/1.0/", name)) return label;
  }
  return {};
}

}  // namespace vitrine::server
