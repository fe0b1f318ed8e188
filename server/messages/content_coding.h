// SPDX-License-Identifier: Apache-2.0
// Chooses and applies the content coding gzip ([RFC9110] sections 8.4 and 12.5.3; [RFC1952]).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/content/document.h"
#include "server/messages/http_header.h"
#include "server/messages/response.h"

namespace vitrine::server {

// Whether an Accept-Encoding field allows gzip. False if the value is empty or malformed.
bool accepts_gzip(std::string_view accept_encoding);

// Whether the response to a request may be compressed: the request accepts gzip and has no token.
// The size of a compressed body can reveal secrets in it (BREACH), so only bodies that everybody
// may read are compressed.
bool takes_gzip(const RequestHeader& request);

// Returns the bytes as a gzip file without name and time. Equal bytes give equal files. Throws
// std::bad_alloc if memory runs out.
std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes);

// The end of the entity tag of a compressed body, before the closing quote.
inline constexpr std::string_view kGzipTagEnd = "-gzip";

// Smaller bodies are not compressed, because they fit into one packet anyway.
inline constexpr std::size_t kLeastToCompress = 1024;

// Compresses the body of a response with gzip if the request allows it. Only public JSON from
// kLeastToCompress to `most` bytes is compressed. The entity tag of a compressed body ends in
// kGzipTagEnd. The request's conditions and range refer to the compressed form ([RFC9110] section
// 14.2), so apply_conditions() must be called afterwards.
Response in_accepted_coding(const RequestHeader& request, Response response, std::size_t most);

// Returns a document with its entity tag and, if it is large enough, its compressed form.
std::shared_ptr<const Document> make_document(std::string json);

// Returns a response with a public document, compressed if the request allows it. Does not copy the
// document.
Response kept_json(const RequestHeader& request, std::shared_ptr<const Document> document);

}  // namespace vitrine::server
