// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/webhooks.h"

#include <fmt/core.h>

#include <algorithm>

#include "server/remote/remote_server.h"

namespace vitrine {
namespace {

constexpr int kTries = 3;
constexpr std::chrono::seconds kDeadline{10};  // of one

}  // namespace

bool Webhooks::allows(std::string_view url) const {
  const std::string origin = origin_of(url);
  if (origin.empty()) return false;
  const std::string host = origin.substr(origin.find("//") + 2);
  return std::ranges::find(hosts_, host) != hosts_.end();
}

void Webhooks::tell(const std::string& url, const std::string& json, std::function<bool()> may,
                    std::function<void()> done) {
  if (!allows(url)) return;
  const std::scoped_lock lock(mutex_);
  if (stopping_ || !waiting_.emplace(url, json).second) return;
  auto& lane = lanes_[origin_of(url)];
  if (!lane) lane = std::make_unique<Lane>(events_);
  lane->post(
      [this, message = Message{url, json, std::move(may), std::move(done)}] { deliver(message); });
}

void Webhooks::stop() {
  std::map<std::string, std::unique_ptr<Lane>> lanes;
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    lanes.swap(lanes_);
  }
  for (const auto& [origin, lane] : lanes)
    lane->finish();
}

// False where it ends meanwhile.
bool Webhooks::pause(int tries) {
  constexpr std::chrono::milliseconds kStep{100};
  for (int i = 0; i < 10 * tries * tries && !stopping_; ++i)
    std::this_thread::sleep_for(kStep);
  return !stopping_;
}

void Webhooks::deliver(const Message& message) {
  if (!stopping_ && message.may()) post(message);
  const std::scoped_lock lock(mutex_);
  waiting_.erase({message.url, message.json});
}

void Webhooks::post(const Message& message) {
  const std::string origin = origin_of(message.url);
  RemoteServer server;
  std::string fault;
  for (int tries = 0; tries < kTries && (tries == 0 ? !stopping_ : pause(tries)); ++tries) {
    const auto answer = server.ask(
        {.method = "POST",
         .url = message.url,
         .fields = {"Content-Type: application/json"},
         .body = {reinterpret_cast<const std::uint8_t*>(message.json.data()), message.json.size()},
         .deadline = kDeadline,
         .given_up = [this] { return stopping_.load(); }});
    if (answer && answer->status < 300) {
      events_.event(Severity::kInfo, fmt::format("webhook {}: {}", origin, answer->status));
      return message.done();
    }
    fault = answer ? fmt::format("it answers {}", answer->status) : answer.error().message;
  }
  if (stopping_) return;
  events_.event(Severity::kWarning, fmt::format("webhook {} was not told: {}", origin, fault));
  message.done();
}

}  // namespace vitrine
