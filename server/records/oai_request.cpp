// SPDX-License-Identifier: Apache-2.0
#include "server/records/oai_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <vector>

#include "server/messages/timestamp.h"
#include "server/records/oai_set.h"

namespace vitrine::server {
namespace {

using OaiStep = tl::expected<void, OaiFault>;

constexpr std::string_view kAfterSet = "after:";  // begins the resumption tokens of ListSets

struct VerbRow {
  std::string_view name;
  OaiVerb verb;
  std::vector<std::string_view> required, optional;
};

const std::vector<VerbRow>& verbs() {
  using enum OaiVerb;
  static const std::vector<VerbRow> rows = {
      {"Identify", kIdentify, {}, {}},
      {"ListMetadataFormats", kListMetadataFormats, {}, {"identifier"}},
      {"ListSets", kListSets, {}, {"resumptionToken"}},
      {"GetRecord", kGetRecord, {"identifier", "metadataPrefix"}, {}},
      {"ListIdentifiers",
       kListIdentifiers,
       {"metadataPrefix"},
       {"from", "until", "set", "resumptionToken"}},
      {"ListRecords",
       kListRecords,
       {"metadataPrefix"},
       {"from", "until", "set", "resumptionToken"}}};
  return rows;
}

tl::unexpected<OaiFault> bad_argument(std::string message) {
  return tl::unexpected(OaiFault{"badArgument", std::move(message)});
}

// Checks that the verb takes all given arguments, and that no required argument is missing. A
// resumption token must be the only argument besides the verb.
OaiStep check_names(const Query& arguments, const VerbRow& row) {
  if (const auto name = arguments.repeated())
    return bad_argument(fmt::format("the argument {} is given twice", *name));
  const bool resumes = arguments.get("resumptionToken").has_value();
  std::vector<std::string_view> known = {"verb"};
  if (resumes && std::ranges::count(row.optional, "resumptionToken") > 0) {
    known.emplace_back("resumptionToken");
  } else {
    known.insert(known.end(), row.required.begin(), row.required.end());
    known.insert(known.end(), row.optional.begin(), row.optional.end());
    for (const std::string_view name : row.required)
      if (!arguments.get(name))
        return bad_argument(fmt::format("the argument {} is missing", name));
  }
  if (const auto name = arguments.unknown(known))
    return bad_argument(fmt::format("{} does not take the argument {} here", row.name, *name));
  return {};
}

struct Datestamp {
  std::int64_t first = 0, last = 0;  // first and last second, since 1970, UTC
  bool is_day = false;
};

std::optional<Datestamp> read_datestamp(std::string_view text) {
  if (const auto seconds = parse_utc_time(text)) return Datestamp{*seconds, *seconds};
  const auto day = parse_date(text);
  if (!day) return std::nullopt;
  const std::int64_t first = std::chrono::seconds(day->time_since_epoch()).count();
  return Datestamp{first, first + 86'399, true};
}

OaiStep read_range(const Query& arguments, OaiRequest& request) {
  std::optional<Datestamp> from, until;
  for (const auto& [name, stamp] : {std::pair("from", &from), std::pair("until", &until)}) {
    const auto text = arguments.get(name);
    if (text && !(*stamp = read_datestamp(*text))) {
      return bad_argument(
          fmt::format("{} is not a day or a time such as 2026-11-28T09:30:00Z", name));
    }
  }
  if (from && until && from->is_day != until->is_day)
    return bad_argument("from and until have different granularities");
  if (from && until && from->first > until->last) return bad_argument("from is later than until");
  if (from) request.from = from->first;
  if (until) request.until = until->last;
  return {};
}

OaiStep read_token(std::string_view text, OaiRequest& request) {
  const tl::unexpected<OaiFault> fault(
      OaiFault{"badResumptionToken", "the token is not one of this server; begin the list again"});
  if (request.verb == OaiVerb::kListSets) {
    const auto after =
        text.starts_with(kAfterSet) ? collection_of(text.substr(kAfterSet.size())) : std::nullopt;
    if (!after) return fault;
    request.after_collection = *after;
    return {};
  }
  const auto token = parse_resumption_token(text);
  if (!token) return fault;
  request.format = token->format;
  request.from = token->from;
  request.until = token->until;
  request.collection = token->collection;
  request.after = token->after;
  request.cursor = token->cursor;
  request.all = token->all;
  return {};
}

bool is_prefix(std::string_view text) {
  const auto fits = [](char c) {
    return (static_cast<unsigned char>(c) < 0x80 &&
            std::isalnum(static_cast<unsigned char>(c)) != 0) ||
           std::string_view("-_.!~*'()").find(c) != std::string_view::npos;
  };
  return !text.empty() && std::ranges::all_of(text, fits);
}

// Reads the format last: if only the format is unknown, the response repeats all arguments, so the
// others must be valid.
OaiStep read_selection(const Query& arguments, OaiRequest& request) {
  request.identifier = arguments.get("identifier");
  if (const auto set = arguments.get("set")) {
    const auto collection = collection_of(*set);
    if (!collection) return bad_argument("the set is not one of ListSets");
    request.collection = *collection;
  }
  if (auto step = read_range(arguments, request); !step) return step;
  const auto prefix = arguments.get("metadataPrefix");
  if (!prefix) return {};
  if (!is_prefix(*prefix)) return bad_argument("the metadataPrefix is malformed");
  request.format = find_record_format(*prefix);
  if (request.format != nullptr) return {};
  return tl::unexpected(OaiFault{"cannotDisseminateFormat", "see ListMetadataFormats"});
}

}  // namespace

tl::expected<OaiRequest, OaiFault> read_oai_request(const Query& arguments) {
  const auto name = arguments.get("verb");
  const auto row = std::ranges::find(verbs(), name.value_or(""), &VerbRow::name);
  if (row == verbs().end() || arguments.repeated() == "verb")
    return tl::unexpected(OaiFault{"badVerb", "give one verb of OAI-PMH 2.0, such as Identify"});
  if (const auto step = check_names(arguments, *row); !step) return tl::unexpected(step.error());
  OaiRequest request{.verb = row->verb};
  const auto token = arguments.get("resumptionToken");
  const auto step = token ? read_token(*token, request) : read_selection(arguments, request);
  if (!step) return tl::unexpected(step.error());
  return request;
}

std::string token_after_set(std::string_view collection) {
  return std::string(kAfterSet) + set_spec(collection);
}

}  // namespace vitrine::server
