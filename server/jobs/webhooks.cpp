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

void Webhooks::tell(const std::string& url, const std::string& json) {
  if (allows(url) && !stopping_) lane_.post([this, url, json] { post(url, json); });
}

void Webhooks::stop() {
  if (stopping_.exchange(true)) return;
  lane_.finish();
}

// False where it ends meanwhile.
bool Webhooks::pause(int tries) {
  constexpr std::chrono::milliseconds kStep{100};
  for (int i = 0; i < 10 * tries * tries && !stopping_; ++i)
    std::this_thread::sleep_for(kStep);
  return !stopping_;
}

void Webhooks::post(const std::string& url, const std::string& json) {
  RemoteServer server;
  std::string fault = "the daemon stops";
  for (int tries = 0; tries < kTries && (tries == 0 ? !stopping_ : pause(tries)); ++tries) {
    const auto answer =
        server.ask({.method = "POST",
                    .url = url,
                    .fields = {"Content-Type: application/json"},
                    .body = {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()},
                    .deadline = kDeadline});
    if (answer && answer->status < 300) {
      return events_.event(Severity::kInfo,
                           fmt::format("webhook {}: {}", origin_of(url), answer->status));
    }
    fault = answer ? fmt::format("it answers {}", answer->status) : answer.error().message;
  }
  events_.event(Severity::kWarning,
                fmt::format("webhook {} was not told: {}", origin_of(url), fault));
}

}  // namespace vitrine
