// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/elsewhere.h"
#include "server/http/problem.h"
#include "server/http/router.h"
#include "server/http/services.h"

namespace vitrine {

// Calls `answer(scanner)` with the scanner of the request's {name}, has the daemon answer that
// drives it, or answers 404.
template <class Answer>
Response with_scanner(const Request& request, Services& services, Answer&& answer) {
  if (const auto address = elsewhere(std::string(request.parameters.name), request, services))
    return ask_elsewhere(*address, request, services);
  ScannerStation* scanner = services.scans.scanner(request.parameters.name);
  if (scanner == nullptr) return problem(404, "there is no such scanner", request.id);
  return answer(*scanner);
}

}  // namespace vitrine
