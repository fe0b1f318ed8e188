// SPDX-License-Identifier: Apache-2.0
// What people are told about each route of /api/v1, beside what the table of routes says already
// (method, path, role). openapi.cpp makes the document of both; a test finds what is missing here.
#pragma once

#include <span>
#include <string_view>

#include "server/http/router.h"

namespace vitrine {

struct RouteDoc {
  Handler handler;
  std::string_view id;       // operationId, unique
  std::string_view summary;  // one sentence
  std::string_view query;    // parameters in api_components(), separated by spaces
  std::string_view body;     // a schema there; empty: no body
  unsigned status;           // where all goes well
  std::string_view answer;   // a schema there, or a media type ("image/png"); empty: no body
};

std::span<const RouteDoc> route_docs();
const RouteDoc* find_doc(Handler handler);  // null where there is none

// The `components` of the OpenAPI document: schemas, parameters, and how to send a token.
std::string_view api_components();

}  // namespace vitrine
