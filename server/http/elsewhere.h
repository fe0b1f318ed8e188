// SPDX-License-Identifier: Apache-2.0
// What another daemon answers: the one that drives a scanner.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/http/router.h"
#include "server/http/services.h"

namespace vitrine {

// Where the request is to be answered: at the daemon that drives the scanner, unless that is this
// one, or another has passed the request on already. Empty where that daemon is away.
std::optional<std::string> elsewhere(const std::string& scanner, const Request& request,
                                     Services& services);

// That daemon's answer to the request, which it checks itself: it gets the caller's token. 503
// where there is none in time, or where too many wait for one.
Response ask_elsewhere(const std::string& address, const Request& request, Services& services);

struct Question {
  std::string address, path, query;
};

// What is one of several parts of an answer, from all of them at once, in the caller's name; null
// where none comes in five seconds.
std::vector<nlohmann::ordered_json> ask_all(std::span<const Question> questions,
                                            const Request& request, Services& services);

bool is_passed_on(const Request& request);

}  // namespace vitrine
