// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http/problem.h"
#include "server/http/router.h"
#include "server/http/services.h"

namespace vitrine {

// Calls `answer(scanner)` with the scanner of the request's {name}, or answers 404.
template <class Answer>
Response with_scanner(const Request& request, Services& services, Answer&& answer) {
  ScannerStation* scanner = services.scans.scanner(request.parameters.name);
  if (scanner == nullptr) return problem(404, "there is no such scanner", request.id);
  return answer(*scanner);
}

}  // namespace vitrine
