// SPDX-License-Identifier: Apache-2.0
// Other servers are told of the ends of jobs: only those that the operator has named, since a
// request could else reach what is inside the museum's network.
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

#include "server/jobs/lane.h"
#include "server/log/log.h"

namespace vitrine {

// Thread-safe.
class Webhooks {
 public:
  // `hosts`: "host" or "host:port" as URLs have them; none: nobody is told anything.
  Webhooks(std::vector<std::string> hosts, const Log& events)
      : hosts_(std::move(hosts)), events_(events) {}
  ~Webhooks() { stop(); }

  bool allows(std::string_view url) const;

  // Posts `json` there soon, a few times until it is taken; the log has how that went. Each server
  // has a thread of its own: one that is dead holds up no other. What waits already is not posted
  // twice. `may` is asked when its turn has come: false where another has told it meanwhile. `done`
  // is called once it is taken or given up, and not where stop() comes before.
  void tell(const std::string& url, const std::string& json, std::function<bool()> may,
            std::function<void()> done);

  // What is under way is put aside, and the rest.
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
  std::atomic<bool> stopping_{false};

  std::mutex mutex_;                                       // guards what follows
  std::map<std::string, std::unique_ptr<Lane>> lanes_;     // by the server's origin
  std::set<std::pair<std::string, std::string>> waiting_;  // URL and JSON
};

}  // namespace vitrine
