// SPDX-License-Identifier: Apache-2.0
// Jobs, scans and scanners as the API shows them, and what their handlers share.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "server/http/problem.h"
#include "server/http/query.h"
#include "server/http/router.h"
#include "server/http/services.h"

namespace vitrine {

// In the order of JobState.
inline constexpr std::string_view kJobStates[] = {"queued", "running", "paused",
                                                  "done",   "failed",  "cancelled"};

// As everybody may see it: the server's own words may tell its paths.
JobStatus without_reasons(JobStatus job);

nlohmann::ordered_json job_json(const JobStatus& job);
nlohmann::ordered_json scan_json(const ScanInfo& scan);
nlohmann::ordered_json scanner_json(const ScannerStatus& scanner);

// What changes all the time is not kept by anybody.
Response json_answer(const nlohmann::ordered_json& json, unsigned status = 200);

// 409 for kState, 422 for kBadInput, 507 for kLimit: there is no room; 500 with the reason in the
// log for all else.
Response refused(const Error& error, const Request& request, Services& services);

// The same of the queue's begun_by() and add(), where kBadInput is about the Idempotency-Key.
Response refused_job(const Error& error, const Request& request, Services& services);

// 422: what is wrong with the body.
Response invalid(const FieldFaults& faults, const Request& request);

// The request's Idempotency-Key, of its caller alone, and what it is about; nothing without one.
// The error is the answer.
tl::expected<std::optional<OnceKey>, Response> once_key(const Request& request);

// The request's query, which has no parameters but `known`. The error is the answer.
tl::expected<Query, Response> read_query(const Request& request,
                                         std::span<const std::string_view> known);

// ?limit= &cursor= of a list; the errors name the parameter.
tl::expected<PageOf, std::vector<ParameterFault>> read_page(const Query& query);
// The same of a list that takes nothing else. The error is the answer.
tl::expected<PageOf, Response> read_page(const Request& request);

// 401: somebody with a token may.
Response token_needed(const Request& request);

}  // namespace vitrine
