// SPDX-License-Identifier: Apache-2.0
// The resumption token of OAI-PMH, with which a harvester asks for the next page of a list.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/catalogue/catalogue.h"
#include "server/records/record_format.h"

namespace vitrine::server {

// A token states the whole request for the next page, so the server stores nothing for a harvester,
// and tokens do not expire.
struct ResumptionToken {
  const RecordFormat* format = nullptr;
  std::optional<std::int64_t> from, until;  // times of changes, both inclusive
  std::string collection;                   // empty: all models
  HarvestPlace after;                       // the last model of the previous page
  std::uint32_t cursor = 0;                 // number of records on all previous pages
  std::uint32_t all = 0;  // number of records on all pages, counted at the first page
};

std::string to_text(const ResumptionToken& token);

// Returns nullopt if `text` is not a token. Anybody can write a token, but it gives access to no
// more than the same request without a token.
std::optional<ResumptionToken> parse_resumption_token(std::string_view text);

}  // namespace vitrine::server
