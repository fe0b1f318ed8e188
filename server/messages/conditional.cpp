// SPDX-License-Identifier: Apache-2.0
#include "server/messages/conditional.h"

#include <fmt/format.h>

#include <algorithm>

#include "codec/core/parse_number.h"
#include "server/messages/content_coding.h"
#include "server/messages/problem.h"

namespace vitrine::server {
namespace {

using beast::http::field;

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
    text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

// Whether a list of entity tags is "*" or has a tag for which `fits` returns true.
template <class Fits>
bool holds(std::string_view list, const Fits& fits) {
  if (trim(list) == "*") return true;
  while (!list.empty()) {
    const std::string_view item = list.substr(0, list.find(','));
    if (fits(trim(item))) return true;
    list.remove_prefix(std::min(list.size(), item.size() + 1));
  }
  return false;
}

RangeChoice part(std::uint64_t offset, std::uint64_t length) {
  return {RangeChoice::Outcome::kPart, offset, length};
}

constexpr RangeChoice kWhole{};
constexpr RangeChoice kUnsatisfiable{RangeChoice::Outcome::kUnsatisfiable};

// Chooses the last `text` bytes of a body of `size` bytes, for a range such as "bytes=-500".
RangeChoice choose_suffix(std::string_view text, std::uint64_t size) {
  const auto length = parse_number<std::uint64_t>(text);
  if (!length) return kWhole;
  if (*length == 0 || size == 0) return kUnsatisfiable;
  const std::uint64_t kept = std::min(*length, size);
  return part(size - kept, kept);
}

std::string_view value_of(const RequestHeader& request, field name) {
  const auto value = request[name];
  return {value.data(), value.size()};
}

Response not_modified(Response response) {
  response.status = 304;
  response.type.clear();
  std::erase_if(response.fields, [](const auto& one) { return one.first == "Content-Encoding"; });
  response.body = std::string();
  return response;
}

Response unsatisfiable(std::uint64_t size, std::string_view request_id) {
  Response response = problem(416, fmt::format("there are {} bytes", size), request_id);
  response.fields = {{"Content-Range", fmt::format("bytes */{}", size)}};
  return response;
}

Response partial(Response response, const RangeChoice& range) {
  response.fields.emplace_back(
      "Content-Range", fmt::format("bytes {}-{}/{}", range.offset, range.offset + range.length - 1,
                                   body_size(response.body)));
  response.status = 206;
  response.body = body_range(std::move(response.body), range.offset, range.length);
  return response;
}

}  // namespace

bool matches_any(std::string_view list, std::string_view etag) {
  // Also accepts the entity tag of the compressed body, because the client may have received the
  // body in this form.
  std::string compressed(etag);
  if (etag.ends_with('"')) compressed.insert(compressed.size() - 1, kGzipTagEnd);
  return holds(list, [&](std::string_view tag) { return tag == etag || tag == compressed; });
}

bool matches_any_weakly(std::string_view list, std::string_view etag) {
  return holds(list, [etag](std::string_view tag) {
    if (tag.starts_with("W/")) tag.remove_prefix(2);
    return tag == etag;
  });
}

RangeChoice choose_range(std::string_view range, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (!range.starts_with(kUnit) || range.find(',') != std::string_view::npos) return kWhole;
  range = trim(range.substr(kUnit.size()));
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return kWhole;
  if (dash == 0) return choose_suffix(range.substr(1), size);
  const auto first = parse_number<std::uint64_t>(range.substr(0, dash));
  const std::string_view end = range.substr(dash + 1);
  const auto last = end.empty() ? std::optional(UINT64_MAX) : parse_number<std::uint64_t>(end);
  if (!first || !last || *last < *first) return kWhole;
  if (*first >= size) return kUnsatisfiable;
  return part(*first, std::min(*last, size - 1) - *first + 1);
}

Response apply_conditions(const RequestHeader& request, Response response,
                          std::string_view request_id) {
  if (response.status != 200 || response.etag.empty()) return response;
  const std::string_view none_match = value_of(request, field::if_none_match);
  if (!none_match.empty() && matches_any_weakly(none_match, response.etag)) {
    return not_modified(std::move(response));
  }
  const std::string_view range = value_of(request, field::range);
  const std::string_view if_range = value_of(request, field::if_range);
  if (range.empty() || request.count(field::range) > 1 ||
      request.method() != beast::http::verb::get) {
    return response;
  }
  // If If-Range is a date, it never equals the entity tag, so the whole body is sent.
  if (!if_range.empty() && if_range != response.etag) return response;
  const std::uint64_t size = body_size(response.body);
  const RangeChoice choice = choose_range(range, size);
  if (choice.outcome == RangeChoice::Outcome::kWhole) return response;
  if (choice.outcome == RangeChoice::Outcome::kUnsatisfiable)
    return unsatisfiable(size, request_id);
  return partial(std::move(response), choice);
}

}  // namespace vitrine::server
