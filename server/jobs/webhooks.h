// SPDX-License-Identifier: Apache-2.0
// Calls webhooks when jobs end. Only hosts that the operator has named are called. Otherwise a
// client of the API could make the daemon call servers inside the museum's network.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/jobs/serial_executor.h"
#include "server/log/log.h"

namespace vitrine::server {

// Thread-safe.
class Webhooks {
 public:
  // `hosts`: allowed hosts, "host" or "host:port" as in URLs. If empty, no webhook is called.
  Webhooks(std::vector<std::string> hosts, const Log& events)
      : hosts_(std::move(hosts)), events_(events) {}
  ~Webhooks() { stop(); }

  bool allows(std::string_view url) const;

  // Posts `json` to the URL on another thread, with a few retries until the server accepts it, and
  // logs the outcome. Each server has its own thread, so that an unreachable one does not delay
  // others. A message that already waits is not added again. `may` is called right before each
  // post; it returns false if another daemon has posted the message meanwhile. `done` is called
  // when the message is accepted or given up, but not after stop().
  void call(const std::string& url, const std::string& json, std::function<bool()> may,
            std::function<void()> done);

  // Cancels the messages that are being sent and drops all waiting ones.
  void stop();

 private:
  struct Message {
    std::string url, json;
    std::function<bool()> may;
    std::function<void()> done;
  };
  void deliver(const Message& message);
  void post(const Message& message);
  bool pause(int tries);

  const std::vector<std::string> hosts_;
  const Log& events_;
  std::atomic<bool> is_stopping_{false};

  std::mutex mutex_;                                                  // guards the members below
  std::map<std::string, std::unique_ptr<SerialExecutor>> executors_;  // by the server's origin
  std::set<std::pair<std::string, std::string>> waiting_;             // each message's URL and JSON
};

}  // namespace vitrine::server
