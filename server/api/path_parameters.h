// SPDX-License-Identifier: Apache-2.0
// Declares the parameters in the paths of routes, such as {id}: the pattern of each parameter, and
// functions that return the parameters' typed values.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/sha256.h"
#include "server/messages/router.h"

namespace vitrine::server {

// Returns the patterns of {id}, {sha256}, {format}, {name}, {number} and {collection} for the
// Router.
std::span<const ParameterPattern> parameter_patterns();

// Returns {id}: the ID of a model, scan, job, upload or token.
template <class Id>
Id id_in(const Request& request) {
  return *Id::parse(request.parameters["id"]);
}

Sha256 sha256_in(const Request& request);         // returns {sha256}
std::uint32_t number_in(const Request& request);  // returns {number}: 1 to 999,999, no leading zero
std::string collection_in(const Request& request);  // returns {collection}, percent-decoded
// Returns {name}: 1 to 32 characters of a-z, 0-9 and '-'.
inline std::string_view name_in(const Request& request) {
  return request.parameters["name"];
}
// Returns {format}: 1 to 8 characters of a-z, 0-9 and '.'.
inline std::string_view format_in(const Request& request) {
  return request.parameters["format"];
}

}  // namespace vitrine::server
