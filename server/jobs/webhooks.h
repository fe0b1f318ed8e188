// SPDX-License-Identifier: Apache-2.0
// Other servers are told of the ends of jobs: only those that the operator has named, since a
// request could else reach what is inside the museum's network.
#pragma once

#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/lane.h"
#include "server/log/log.h"

namespace vitrine {

class Webhooks {
 public:
  // `hosts`: "host" or "host:port" as URLs have them; none: nobody is told anything.
  Webhooks(std::vector<std::string> hosts, const Log& events)
      : hosts_(std::move(hosts)), events_(events) {}
  ~Webhooks() { stop(); }

  bool allows(std::string_view url) const;

  // Posts `json` there soon, on a thread of its own, a few times until it is taken; the log has
  // how that went.
  void tell(const std::string& url, const std::string& json);

  // What is under way is given up, and the rest.
  void stop();

 private:
  void post(const std::string& url, const std::string& json);
  bool pause(int tries);

  const std::vector<std::string> hosts_;
  const Log& events_;
  std::atomic<bool> stopping_{false};
  Lane lane_;
};

}  // namespace vitrine
