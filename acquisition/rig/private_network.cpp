// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/private_network.h"

#include <fmt/format.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "codec/files/file_descriptor.h"

namespace vitrine::acquisition::rig {
namespace {

// Enters a new network namespace. If the user may not do this, first enters a new user namespace in
// which this process is root.
bool leave_network() {
  if (::unshare(CLONE_NEWNET) == 0) return true;
  const auto user = ::getuid();
  const auto group = ::getgid();
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << user << " " << user << " 1";
  std::ofstream("/proc/self/gid_map") << group << " " << group << " 1";
  return true;
}

bool raise_loopback() {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  if (::ioctl(socket.get(), SIOCSIFFLAGS, &request) != 0) return false;
  // Adds the address 127.0.0.2, because Aravis's simulated camera answers only at an address that
  // belongs to an interface.
  std::strcpy(request.ifr_name, "lo:2");
  sockaddr_in second{};
  second.sin_family = AF_INET;
  second.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
  std::memcpy(&request.ifr_addr, &second, sizeof second);
  return ::ioctl(socket.get(), SIOCSIFADDR, &request) == 0;
}

}  // namespace

Expected<void> enter_private_network() {
  if (leave_network() && raise_loopback()) return {};
  return fail(ErrorCode::kIo,
              fmt::format("private network: {}; allow user namespaces, or run without "
                          "--private-network, one rig at a time",
                          std::strerror(errno)));
}

}  // namespace vitrine::acquisition::rig
