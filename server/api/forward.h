// SPDX-License-Identifier: Apache-2.0
// Forwards requests about a scanner to the daemon that drives it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/api/path_parameters.h"
#include "server/api/services.h"
#include "server/messages/problem.h"
#include "server/messages/router.h"

namespace vitrine::server {

// Returns the address of the daemon to which the request must be forwarded, because it drives the
// scanner. Returns an empty string if that daemon cannot be reached. Returns nullopt if this daemon
// drives the scanner, or if another daemon has already forwarded the request to this daemon.
std::optional<std::string> forward_address(const std::string& scanner, const Request& request,
                                           Services& services);

// Forwards the request, with the caller's token, to the daemon at `address` and returns the
// response of that daemon, which checks the token. Returns 503 if that daemon does not respond in
// time or if too many requests are being forwarded.
Response forward(const std::string& address, const Request& request, Services& services);

struct DaemonQuery {
  std::string address, path, query;
};

// Sends queries to several daemons at the same time, with the caller's token. Returns one element
// per query: the JSON object of the response, or null if no valid response arrives within five
// seconds.
std::vector<nlohmann::ordered_json> ask_daemons(std::span<const DaemonQuery> queries,
                                                const Request& request, Services& services);

bool is_forwarded(const Request& request);

// Calls `answer(scanner)` with the scanner that the request's {name} names, and returns its
// response. If another daemon drives that scanner, forwards the request instead. Returns 404 if no
// daemon drives it.
template <class Answer>
Response with_scanner(const Request& request, Services& services, Answer&& answer) {
  if (const auto address = forward_address(std::string(name_in(request)), request, services))
    return forward(*address, request, services);
  ScannerStation* scanner = services.scans.scanner(name_in(request));
  if (scanner == nullptr) return problem(404, "there is no such scanner", request.id);
  return answer(*scanner);
}

}  // namespace vitrine::server
