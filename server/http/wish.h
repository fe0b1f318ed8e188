// SPDX-License-Identifier: Apache-2.0
// Which level of detail a request asks for, in the words that exports and manifests share:
// triangles, error, bytes, level, or kbps with seconds.
#pragma once

#include <optional>
#include <string>

#include "codec/core/expected.h"
#include "codec/progressive/planner.h"
#include "server/http/http_header.h"
#include "server/http/problem.h"
#include "server/http/query.h"

namespace vitrine {

// What somebody who saves data gets unless they ask for more: the finest state within these bytes.
inline constexpr std::uint64_t kSavedDataBytes = 1'000'000;

struct Wish {
  Want want;
  bool stated = true;  // false: the request leaves it to us
  double kbps = 0;     // of the client's line, kilobits per second; 0: unknown
};

// Where the query says nothing, that is the whole model, or what suits one who says
// `Save-Data: on`.
tl::expected<Wish, ParameterFault> read_wish(const Query& query, const RequestHeader& header,
                                             const Manifest& manifest);

bool saves_data(const RequestHeader& header);

// Equal wishes have equal keys, however they are written; beyond the finest level all are equal.
std::string key_of(const Want& want, const Manifest& manifest);

// What comes of a wish, known without decoding anything.
struct Outlook {
  std::uint32_t level = 0;  // the finest that is complete
  std::uint64_t triangles =
      0;                    // as many as that level or more; a split off where asked for in part
  std::uint64_t bytes = 0;  // of the .pmesh: header, base mesh and chunks
  double error = 0;         // a bound: the level's, model units
};
Outlook outlook_of(const Want& want, const Manifest& manifest);

}  // namespace vitrine
