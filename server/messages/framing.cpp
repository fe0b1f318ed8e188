// SPDX-License-Identifier: Apache-2.0
#include "server/messages/framing.h"

#include <algorithm>

namespace vitrine::server {
namespace {

using beast::http::field;

bool is_digits(std::string_view text) {
  return !text.empty() && text.size() <= 18 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string_view framing_fault(const RequestHeader& header) {
  const auto encodings = header.count(field::transfer_encoding);
  const auto lengths = header.count(field::content_length);
  const auto hosts = header.count(field::host);
  if (encodings > 0 && lengths > 0) return "both Transfer-Encoding and Content-Length";
  if (encodings > 1) return "more than one Transfer-Encoding";
  if (encodings == 1) {
    if (header.version() < 11) return "Transfer-Encoding in HTTP/1.0";
    if (!beast::iequals(header[field::transfer_encoding], "chunked")) {
      return "a Transfer-Encoding other than chunked";
    }
  }
  if (lengths > 1) return "more than one Content-Length";
  if (lengths == 1 && !is_digits(header[field::content_length]))
    return "a malformed Content-Length";
  if (hosts > 1) return "more than one Host";
  if (hosts == 0 && header.version() >= 11) return "no Host";
  return {};
}

}  // namespace vitrine::server
