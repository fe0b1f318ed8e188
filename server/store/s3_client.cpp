// SPDX-License-Identifier: Apache-2.0
#include "server/store/s3_client.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "server/store/s3_answers.h"

namespace vitrine::server {
namespace {

constexpr std::chrono::seconds kTimeout{5};
// If a request gets no response, failed requests are not retried for this time.
constexpr std::chrono::seconds kUnreachable{2};

// Whether the HTTP status means that another attempt may succeed: the store is busy (SlowDown) or
// restarting, or a proxy cannot reach the store.
bool is_passing(long status) {
  constexpr std::array<long, 6> kPassing{408, 429, 500, 502, 503, 504};
  return std::ranges::count(kPassing, status) > 0;
}

const char* advice(long status, std::string_view code) {
  if (code == "RequestTimeTooSkewed") return "set the clock of this machine";
  if (code == "NoSuchBucket") return "create the bucket, or correct the setting store";
  if (code == "PermanentRedirect" || code == "AuthorizationHeaderMalformed")
    return "correct endpoint and region in the setting store";
  if (status == 401 || status == 403)
    return "check store-access-key and store-secret-key, and the permissions of that key";
  return is_passing(status) ? "try again later" : "see the log of the object store";
}

}  // namespace

std::unique_ptr<RemoteServer> S3Client::take_connection() {
  const std::scoped_lock lock(mutex_);
  if (idle_.empty()) return std::make_unique<RemoteServer>();
  auto connection = std::move(idle_.back());
  idle_.pop_back();
  return connection;
}

Expected<RemoteAnswer> S3Client::ask_once(const S3Request& request) {
  constexpr std::uint8_t kNothing = 0;
  RemoteRequest remote{.method = request.method,
                       .url = address_.url_of(request.key, request.query),
                       .fields = {"x-amz-content-sha256: " + to_hex(request.body_sha256)},
                       .body = request.body,
                       .timeout = kTimeout,
                       .signer = &signer_,
                       .take = request.take};
  const bool has_body = request.method == "PUT" || request.method == "POST";
  // An empty body whose pointer is not null makes libcurl send Content-Length: 0.
  if (has_body && remote.body.empty()) remote.body = {&kNothing, 0};
  auto connection = take_connection();
  auto answer = connection->ask(remote);
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(connection));
  return answer;
}

Expected<RemoteAnswer> S3Client::ask(const S3Request& request) {
  const int attempts = Clock::now() < unreachable_until_.load() ? 1 : backoff_.attempts;
  bool is_cancelled = false;
  S3Request watched = request;
  if (request.take) {
    watched.take = [&](std::span<const std::uint8_t> bytes) {
      is_cancelled = !request.take(bytes);
      return !is_cancelled;
    };
  }
  for (int attempt = 1;; ++attempt) {
    if (request.restart) request.restart();
    auto answer = ask_once(watched);
    if (is_cancelled) return answer;
    if (answer && !is_passing(answer->status)) return answer;
    if (attempt >= attempts) {
      if (!answer) unreachable_until_ = Clock::now() + kUnreachable;
      return answer;
    }
    backoff_.wait(attempt);
  }
}

Unexpected S3Client::refused(std::string_view what, const RemoteAnswer& answer) const {
  const std::string code = s3_error(answer.body);
  return fail(ErrorCode::kIo,
              fmt::format("cannot {} in s3://{}: {} answers {}{}{}; {}", what, address_.bucket,
                          address_.origin, answer.status, code.empty() ? "" : " ", code,
                          advice(answer.status, code)));
}

}  // namespace vitrine::server
