// SPDX-License-Identifier: Apache-2.0
#include "server/records/oai_token.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "codec/core/parse_number.h"
#include "server/records/oai_set.h"

namespace vitrine::server {
namespace {

// The parts of a token in their order. None contains a colon.
enum TokenPart { kPrefix, kFrom, kUntil, kSet, kChanged, kModel, kCursor, kAll, kTokenParts };

std::string optional_number(const std::optional<std::int64_t>& number) {
  return number ? std::to_string(*number) : "";
}

using TokenTexts = std::array<std::string_view, kTokenParts>;

std::optional<TokenTexts> split_token(std::string_view text) {
  if (std::ranges::count(text, ':') != kTokenParts - 1) return std::nullopt;
  TokenTexts parts;
  for (std::string_view& part : parts) {
    part = text.substr(0, text.find(':'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
  }
  return parts;
}

// Reads a number that may be missing. Returns false if it is malformed.
bool read_optional_number(std::string_view text, std::optional<std::int64_t>& number) {
  number = parse_number<std::int64_t>(text);
  return text.empty() || number;
}

}  // namespace

std::string to_text(const ResumptionToken& token) {
  return fmt::format("{}:{}:{}:{}:{}:{}:{}:{}", token.format->prefix, optional_number(token.from),
                     optional_number(token.until), set_spec(token.collection), token.after.changed,
                     token.after.model.to_string(), token.cursor, token.all);
}

std::optional<ResumptionToken> parse_resumption_token(std::string_view text) {
  const auto parts = split_token(text);
  if (!parts) return std::nullopt;
  const std::string_view set = (*parts)[kSet];
  const auto collection = collection_of(set);
  const auto changed = parse_number<std::int64_t>((*parts)[kChanged]);
  const auto model = ModelId::parse((*parts)[kModel]);
  const auto cursor = parse_number<std::uint32_t>((*parts)[kCursor]);
  const auto all = parse_number<std::uint32_t>((*parts)[kAll]);
  ResumptionToken token{.format = find_record_format((*parts)[kPrefix])};
  if (token.format == nullptr || !read_optional_number((*parts)[kFrom], token.from) ||
      !read_optional_number((*parts)[kUntil], token.until) || (!set.empty() && !collection) ||
      !changed || !model || !cursor || !all)
    return std::nullopt;
  token.collection = collection.value_or("");
  token.after = {.changed = *changed, .model = *model};
  token.cursor = *cursor;
  token.all = *all;
  return token;
}

}  // namespace vitrine::server
