// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/separation.h"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <string_view>

#include "codec/files/file_descriptor.h"

namespace vitrine::server {

bool leave_network() noexcept {
  return ::unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0;
}

void be_killed_first() noexcept {
  constexpr std::string_view kMost = "1000";
  const FileDescriptor file(::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC));
  if (file) static_cast<void>(!::write(file.get(), kMost.data(), kMost.size()));
}

}  // namespace vitrine::server
