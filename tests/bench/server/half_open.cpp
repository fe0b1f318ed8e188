// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "../../server/app/served_folder.h"
#include "connect.h"
#include "sections.h"
#include "support/daemon.h"
#include "support/http_client.h"

namespace vitrine::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kIdleTimeout = 20;  // seconds

double resident_bytes(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return 1024 * std::stod(line.substr(6));
  return 0;
}

// For so many sockets, here and in what is started from here.
void raise_descriptor_limit(std::size_t connections) {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur =
      std::max<rlim_t>(limit.rlim_cur, std::min<rlim_t>(limit.rlim_max, connections + 1000));
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

void half_open(Report& report, const Effort& effort) {
  const std::size_t count = effort.quick ? 1'000 : 10'000;
  raise_descriptor_limit(count);
  test::ServedFolder folder;
  const std::string model = "/api/v1/models/" + folder.publish("a model");
  const test::Daemon daemon(folder.path(), {"--max-connections", std::to_string(2 * count),
                                            "--max-connections-per-address", "0", "--idle-timeout",
                                            std::to_string(kIdleTimeout)});
  test::http_get(daemon.port(), model);
  const double before = resident_bytes(daemon.pid());
  std::vector<FileDescriptor> held;
  constexpr std::string_view kHalf = "GET / HTTP/1.1\r\nHost:";
  for (std::size_t i = 0; i < count; ++i) {
    held.push_back(connect_to(daemon.port()));
    ::send(held.back().get(), kHalf.data(), kHalf.size(), MSG_NOSIGNAL);
  }
  const auto opened = Clock::now();
  if (test::http_get(daemon.port(), model).status != 200)
    throw std::runtime_error("an honest visitor is not served");
  const double each = (resident_bytes(daemon.pid()) - before) / static_cast<double>(count);
  report.add({"half_open", "bytes_each", each, 0, each, 20'000});
  for (const FileDescriptor& connection : held) {
    char byte;
    ::recv(connection.get(), &byte, 1, 0);  // until it is cut
  }
  const double late = std::chrono::duration<double>(Clock::now() - opened).count() / kIdleTimeout;
  report.add({"half_open", "last_cut_ratio_to_deadline", late, 1, late, 1.25});
}

}  // namespace vitrine::bench
