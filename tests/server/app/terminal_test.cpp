// SPDX-License-Identifier: Apache-2.0
// Tests a daemon in the foreground of a terminal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "support/process/daemon.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

TEST(Terminal, ThatIsClosedEndsTheDaemonAndOneThatIsThereLetsItReload) {
  const ServedFolder folder;
  const int screen = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(screen, 0);
  ASSERT_EQ(::grantpt(screen), 0);
  ASSERT_EQ(::unlockpt(screen), 0);
  Daemon daemon(folder.path(), {}, ::ptsname(screen));
  daemon.signal(SIGHUP);
  daemon.wait_for_line("configuration read again");
  ::close(screen);
  daemon.wait_for_line("stopping");
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

}  // namespace
}  // namespace vitrine::test
