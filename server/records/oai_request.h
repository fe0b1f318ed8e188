// SPDX-License-Identifier: Apache-2.0
// Reads the arguments of a request of OAI-PMH 2.0.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "server/messages/query.h"
#include "server/records/oai_token.h"

namespace vitrine::server {

enum class OaiVerb : std::uint8_t {
  kIdentify,
  kListMetadataFormats,
  kListSets,
  kGetRecord,
  kListIdentifiers,
  kListRecords
};

// An error of [OAI-PMH] section 3.6.
struct OaiFault {
  const char* code;
  std::string message;
};

struct OaiRequest {
  OaiVerb verb = OaiVerb::kIdentify;
  std::optional<std::string> identifier;
  const RecordFormat* format = nullptr;  // set if the verb needs a metadataPrefix
  std::optional<std::int64_t> from, until;
  std::string collection;             // empty if no set is given
  std::optional<HarvestPlace> after;  // last model of the previous page of a list of records
  std::uint32_t cursor = 0, all = 0;  // numbers of records: on all previous pages, and in all
  std::string after_collection;       // last collection on the previous page of a list of sets
};

tl::expected<OaiRequest, OaiFault> read_oai_request(const Query& arguments);

// Returns the resumption token with which ListSets continues after the set of `collection`.
std::string token_after_set(std::string_view collection);

// The names of all arguments.
inline constexpr const char* kOaiArguments[] = {"verb",  "identifier", "metadataPrefix", "from",
                                                "until", "set",        "resumptionToken"};

}  // namespace vitrine::server
