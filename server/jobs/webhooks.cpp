// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/webhooks.h"

#include <fmt/core.h>

#include <algorithm>

#include "server/jobs/clock.h"
#include "server/jobs/webhook_signature.h"
#include "server/remote/remote_server.h"

namespace vitrine::server {
namespace {

constexpr int kTries = 3;
constexpr std::chrono::seconds kDeadline{10};  // time limit of each request

}  // namespace

bool Webhooks::allows(std::string_view url) const {
  const std::string origin = origin_of(url);
  if (origin.empty()) return false;
  const std::string host = origin.substr(origin.find("//") + 2);
  return std::ranges::find(hosts_, host) != hosts_.end();
}

void Webhooks::call(WebhookMessage message) {
  if (!allows(message.url)) return;
  const std::scoped_lock lock(mutex_);
  if (is_stopping_ || !waiting_.emplace(message.url, message.json).second) return;
  auto& executor = executors_[origin_of(message.url)];
  if (!executor) executor = std::make_unique<SerialExecutor>(events_);
  executor->post([this, message = std::move(message)] { deliver(message); });
}

void Webhooks::stop() {
  std::map<std::string, std::unique_ptr<SerialExecutor>> executors;
  {
    const std::scoped_lock lock(mutex_);
    is_stopping_ = true;
    executors.swap(executors_);
  }
  for (const auto& [origin, executor] : executors)
    executor->finish();
}

// Waits `tries` * `tries` seconds before the next attempt. Returns false if stop() is called during
// the wait.
bool Webhooks::pause(int tries) {
  constexpr std::chrono::milliseconds kStep{100};
  for (int i = 0; i < 10 * tries * tries && !is_stopping_; ++i)
    std::this_thread::sleep_for(kStep);
  return !is_stopping_;
}

void Webhooks::deliver(const WebhookMessage& message) {
  if (!is_stopping_ && message.may()) post(message);
  const std::scoped_lock lock(mutex_);
  waiting_.erase({message.url, message.json});
}

std::vector<std::string> Webhooks::fields_of(const WebhookMessage& message) const {
  std::vector<std::string> fields = {"Content-Type: application/json"};
  if (key_.empty()) return fields;
  const std::int64_t seconds = now_in_milliseconds() / 1000;
  const auto signature = signature_fields(key_, message.id, seconds, message.json);
  fields.insert(fields.end(), signature.begin(), signature.end());
  return fields;
}

void Webhooks::post(const WebhookMessage& message) {
  const std::string origin = origin_of(message.url);
  RemoteServer server;
  std::string fault;
  for (int tries = 0; tries < kTries && (tries == 0 ? !is_stopping_ : pause(tries)); ++tries) {
    const auto answer = server.ask(
        {.method = "POST",
         .url = message.url,
         .fields = fields_of(message),
         .body = {reinterpret_cast<const std::uint8_t*>(message.json.data()), message.json.size()},
         .deadline = kDeadline,
         .given_up = [this] { return is_stopping_.load(); }});
    if (answer && answer->status < 300) {
      events_.event(Severity::kInfo, fmt::format("webhook {}: {}", origin, answer->status));
      return message.done();
    }
    fault = answer ? fmt::format("the server responds with {}", answer->status)
                   : answer.error().message;
  }
  if (is_stopping_) return;
  events_.event(Severity::kWarning, fmt::format("webhook {} was not called: {}", origin, fault));
  message.done();
}

}  // namespace vitrine::server
