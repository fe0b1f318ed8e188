// SPDX-License-Identifier: Apache-2.0
#include "server/messages/content_coding.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <boost/beast/core/string.hpp>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <variant>

namespace vitrine::server {
namespace {

using boost::beast::iequals;

constexpr std::string_view kBlanks = " \t";

// Removes the text before the next `separator`, and the separator, from `text`. Returns the removed
// text without surrounding blanks.
std::string_view take_item(std::string_view& text, char separator) {
  std::string_view item = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(text.size(), item.size() + 1));
  item.remove_prefix(std::min(item.size(), item.find_first_not_of(kBlanks)));
  return item.substr(0, item.find_last_not_of(kBlanks) + 1);
}

// Whether the parameters of a content coding allow its use. False if the weight (q) is 0 or
// malformed.
bool is_welcome(std::string_view parameters) {
  const std::string_view weight = take_item(parameters, ';');
  if (weight.empty()) return true;
  const std::string_view value = weight.substr(std::min<std::size_t>(weight.size(), 2));
  return iequals(weight.substr(0, 2), "q=") &&
         value.find_first_of("123456789") != std::string_view::npos &&
         value.find_first_not_of("0123456789.") == std::string_view::npos;
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Whether the response is public JSON. in_accepted_coding() compresses such a response if its size
// permits.
bool is_public_json(const Response& response) {
  return response.status == 200 && response.caching == Caching::kRevalidate &&
         (response.type.starts_with("application/json") ||
          response.type.starts_with("application/ld+json")) &&
         std::holds_alternative<std::string>(response.body);
}

// Marks a response whose body is a gzip file. Its entity tag differs from that of the uncompressed
// form: with equal tags, a cache could combine parts of both forms.
void mark_compressed(Response& response) {
  response.fields.emplace_back("Content-Encoding", "gzip");
  if (response.etag.ends_with('"')) response.etag.insert(response.etag.size() - 1, kGzipTagEnd);
}

}  // namespace

bool accepts_gzip(std::string_view accept_encoding) {
  bool accepts_any = false;
  while (!accept_encoding.empty()) {
    std::string_view item = take_item(accept_encoding, ',');
    const std::string_view coding = take_item(item, ';');
    if (iequals(coding, "gzip")) return is_welcome(item);
    if (coding == "*") accepts_any = is_welcome(item);
  }
  return accepts_any;
}

bool takes_gzip(const RequestHeader& request) {
  using beast::http::field;
  const auto codings = request[field::accept_encoding];
  return accepts_gzip({codings.data(), codings.size()}) && request.count(field::authorization) == 0;
}

std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes) {
  constexpr int kWindowBitsOfGzip = 15 + 16, kMemoryLevel = 8, kFast = 4;
  z_stream stream{};
  if (deflateInit2(&stream, kFast, Z_DEFLATED, kWindowBitsOfGzip, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  const std::unique_ptr<z_stream, decltype(&deflateEnd)> closer(&stream, deflateEnd);
  constexpr std::size_t kMostAtOnce = 1u << 30;  // zlib counts in 32 bits
  std::vector<std::uint8_t> out;
  std::array<std::uint8_t, 65'536> piece;
  for (int state = Z_OK; state != Z_STREAM_END;) {
    const std::size_t given = std::min(bytes.size(), kMostAtOnce);
    stream.next_in = const_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(given);
    stream.next_out = piece.data();
    stream.avail_out = static_cast<uInt>(piece.size());
    state = deflate(&stream, given == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    if (state < Z_OK) throw std::bad_alloc();
    bytes = bytes.subspan(given - stream.avail_in);
    out.insert(out.end(), piece.data(), stream.next_out);
  }
  out.shrink_to_fit();  // caches count the size of a file, so it must have no unused capacity
  return out;
}

Response in_accepted_coding(const RequestHeader& request, Response response, std::size_t most) {
  if (!is_public_json(response)) return response;
  const std::string& body = std::get<std::string>(response.body);
  if (body.size() < kLeastToCompress || body.size() > most) return response;
  add_vary(response, "Accept-Encoding");
  if (!takes_gzip(request)) return response;
  const auto packed = gzip(bytes_of(body));
  response.body = std::string(packed.begin(), packed.end());
  mark_compressed(response);
  return response;
}

std::shared_ptr<const Document> make_document(std::string json) {
  std::vector<std::uint8_t> packed;
  if (json.size() >= kLeastToCompress) packed = gzip(bytes_of(json));
  std::string etag = entity_tag(json);
  return std::make_shared<const Document>(
      Document{std::move(json), std::move(etag), std::move(packed)});
}

Response kept_json(const RequestHeader& request, std::shared_ptr<const Document> document) {
  Response response;
  response.type = "application/json";
  response.caching = Caching::kRevalidate;
  response.etag = document->etag;
  add_vary(response, "Accept-Encoding");
  std::span<const std::uint8_t> bytes = bytes_of(document->text);
  if (!document->gzip.empty() && takes_gzip(request)) {
    bytes = document->gzip;
    mark_compressed(response);
  }
  const std::uint64_t memory = document->text.size() + document->gzip.size();
  response.body = SharedBytes{std::move(document), bytes, memory};
  return response;
}

}  // namespace vitrine::server
