// SPDX-License-Identifier: Apache-2.0
// Formats jobs, scans and scanners as JSON, and declares helpers that their handlers share.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "server/api/services.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/messages/router.h"

namespace vitrine::server {

// The names of job states in the API, in the order of JobState.
inline constexpr std::string_view kJobStates[] = {"queued", "running", "paused",
                                                  "done",   "failed",  "cancelled"};

// Returns the job's status as clients without a token may see it. Replaces error messages and
// notes by general ones, because they could reveal paths on the server. Omits the repairs.
JobStatus without_reasons(JobStatus job);

nlohmann::ordered_json job_json(const JobStatus& job);
nlohmann::ordered_json scan_json(const ScanInfo& scan);
nlohmann::ordered_json scanner_json(const ScannerStatus& scanner);

// Returns the JSON as a response that caches must not store, since its content changes often.
Response json_answer(const nlohmann::ordered_json& json, unsigned status = 200);

// Returns the response to a failed operation: 409 for kState, 422 for kBadInput, 507 for kLimit (no
// space left). Other errors are answered by internal_error(), which writes the reason only to the
// log.
Response refused(const Error& error, const Request& request, Services& services);

// Returns the response to an error of JobQueue::begun_by() or add(). Like refused(), but for
// kBadInput, the 422 response names the header Idempotency-Key as the faulty parameter.
Response refused_job(const Error& error, const Request& request, Services& services);

// Returns a 422 response that lists the faults of the body.
Response invalid(const FieldFaults& faults, const Request& request);

// Returns the idempotency key of a request: its Idempotency-Key header combined with its caller,
// and a hash of its path and body. Returns nullopt if there is no such header. The error is the
// response to send.
tl::expected<std::optional<IdempotencyKey>, Response> idempotency_key(const Request& request);

// Parses the query of the request. Fails if a parameter is not in `known`. The error is the
// response to send.
tl::expected<Query, Response> read_query(const Request& request,
                                         std::span<const std::string_view> known);

// Reads the parameters `limit` and `cursor` of a list. Each error names its parameter.
template <class Id>
tl::expected<PageOf<Id>, std::vector<ParameterFault>> read_page(const Query& query);
// Reads the query of a list that has no parameters except `limit` and `cursor`. The error is the
// response to send.
template <class Id>
tl::expected<PageOf<Id>, Response> read_page(const Request& request);

// Adds a Link field with the URL of the list's next page [RFC8288]. `cursor` is the last ID on
// this page, or nullopt if no page follows.
void link_next(const std::optional<std::string>& cursor, const Request& request,
               Response& response);

// Returns one page of a list as JSON: the items under `name`, and under "next" the cursor of the
// next page or null. Also adds a Link field with the URL of the next page.
Response list_answer(std::string_view name, nlohmann::ordered_json items,
                     const std::optional<std::string>& cursor, const Request& request);

// Returns the 401 response to a request that needs a token.
Response token_needed(const Request& request);

}  // namespace vitrine::server
