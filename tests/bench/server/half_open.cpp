// SPDX-License-Identifier: Apache-2.0
#include <sys/socket.h>

#include <chrono>
#include <stdexcept>
#include <vector>

#include "sections.h"
#include "support/descriptor_limit.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/process/loopback.h"
#include "support/product_names.h"
#include "support/resident_memory.h"
#include "support/served_folder.h"

namespace vitrine::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kIdleTimeout = 20;  // idle timeout of the daemon, in seconds

}  // namespace

void half_open(Report& report, const Effort& effort) {
  const std::size_t count = effort.is_quick ? 1'000 : 10'000;
  test::raise_descriptor_limit();
  test::ServedFolder folder;
  const std::string model = "/api/v1/models/" + folder.publish("a model");
  const test::Daemon daemon(folder.path(), {"--max-connections", std::to_string(2 * count),
                                            "--max-connections-per-address", "0", "--idle-timeout",
                                            std::to_string(kIdleTimeout)});
  test::http_get(daemon.port(), model);
  const auto before = static_cast<double>(test::resident_bytes(daemon.pid()));
  std::vector<FileDescriptor> held;
  constexpr std::string_view kHalf = "GET / HTTP/1.1\r\nHost:";
  for (std::size_t i = 0; i < count; ++i) {
    held.push_back(test::connect_to(daemon.port()));
    ::send(held.back().get(), kHalf.data(), kHalf.size(), MSG_NOSIGNAL);
  }
  const auto opened = Clock::now();
  if (test::http_get(daemon.port(), model).status != 200)
    throw std::runtime_error("an honest visitor is not served");
  const double each = (static_cast<double>(test::resident_bytes(daemon.pid())) - before) /
                      static_cast<double>(count);
  report.add({"half_open", "bytes_each", each, 0, each, 20'000});
  for (const FileDescriptor& connection : held) {
    char byte;
    ::recv(connection.get(), &byte, 1, 0);  // waits until the daemon closes the connection
  }
  const double late = std::chrono::duration<double>(Clock::now() - opened).count() / kIdleTimeout;
  report.add({"half_open", "last_cut_ratio_to_deadline", late, 1, late, 1.25});
}

}  // namespace vitrine::bench
