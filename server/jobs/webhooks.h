// SPDX-License-Identifier: Apache-2.0
// Calls webhooks when jobs end. Calls only hosts that the operator has listed. Without this limit,
// a client of the API could make the daemon call servers inside the museum's network.
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

struct WebhookMessage {
  std::string url;
  std::string id;    // ID of the message; all attempts to send it, by any daemon, use the same ID
  std::string json;  // body of the message
  // Called right before the first attempt to send the message. If it returns false, because another
  // daemon has sent or claimed the message, the message is not sent.
  std::function<bool()> may;
  // Called after the server has accepted the message, or after the last attempt has failed. Not
  // called after Webhooks::stop().
  std::function<void()> done;
};

// Thread-safe.
class Webhooks {
 public:
  // `hosts`: allowed hosts, "host" or "host:port" as in URLs. If empty, no webhook is called.
  // `key`: key with which messages are signed (webhook_signature.h). If empty, they are not signed.
  Webhooks(std::vector<std::string> hosts, const Log& events, std::string key = {})
      : hosts_(std::move(hosts)), key_(std::move(key)), events_(events) {}
  ~Webhooks() { stop(); }

  bool allows(std::string_view url) const;

  // Sends the message by POST on another thread, with at most three attempts, and logs the outcome.
  // Each server has a thread of its own, so that an unreachable server does not delay messages to
  // other servers. A message that is already waiting is not added again. Returns at once.
  void call(WebhookMessage message);

  // Cancels the messages that are being sent and drops all waiting ones.
  void stop();

 private:
  void deliver(const WebhookMessage& message);
  void post(const WebhookMessage& message);
  bool pause(int tries);
  std::vector<std::string> fields_of(const WebhookMessage& message) const;

  const std::vector<std::string> hosts_;
  const std::string key_;
  const Log& events_;
  std::atomic<bool> is_stopping_{false};

  std::mutex mutex_;  // guards the members below
  // One executor per origin of a server.
  std::map<std::string, std::unique_ptr<SerialExecutor>> executors_;
  std::set<std::pair<std::string, std::string>> waiting_;  // each message's URL and JSON
};

}  // namespace vitrine::server
