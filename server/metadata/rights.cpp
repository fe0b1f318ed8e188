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

// Removes the name of a page about a licence, such as "deed.de" or "legalcode", which is no part of
// the licence's identifier.
std::string_view without_page(std::string_view url) {
  for (const std::string_view page : {"/deed", "/legalcode"})
    if (const auto at = url.find(page); at != url.npos) return url.substr(0, at + 1);
  return url;
}

}  // namespace

std::optional<std::string> rights_url(std::string_view licence) {
  for (const std::string_view scheme : {"https://", "http://"}) {
    if (!licence.starts_with(scheme)) continue;
    const std::string_view rest = licence.substr(scheme.size());
    if (rest.starts_with("creativecommons.org/") || rest.starts_with("rightsstatements.org/"))
      return "http://" + std::string(without_page(rest));
    return std::nullopt;
  }
  constexpr std::string_view kSite = "http://creativecommons.org/";
  const std::string id = identifier_of(licence);
  if (id == "cc0-1.0") return std::string(kSite) + "publicdomain/zero/1.0/";
  if (id == "cc-pdm-1.0") return std::string(kSite) + "publicdomain/mark/1.0/";
  // Matches an identifier such as cc-by-nc-sa-4.0. The groups are the licence's terms and version.
  const std::regex pattern("cc-(by(?:-nc)?(?:-sa|-nd)?)-([1-4]\\.[05])");
  std::smatch found;
  if (!std::regex_match(id, found, pattern)) return std::nullopt;
  return fmt::format("{}licenses/{}/{}/", kSite, found[1].str(), found[2].str());
}

std::string_view rights_statement_label(std::string_view uri) {
  const auto url = rights_url(uri);
  for (const auto& [name, label] : kStatements) {
    if (url == fmt::format("http://rightsstatements.org/vocab/{}/1.0/", name)) return label;
  }
  return {};
}

}  // namespace vitrine::server
