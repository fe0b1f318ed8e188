// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/stop_signals.h"
#include "support/product_names.h"

#include <gtest/gtest.h>

#include <csignal>

namespace vitrine::test {
namespace {

using cli::StopSignals;

TEST(StopSignals, RequestAStop) {
  std::signal(SIGHUP, SIG_DFL);  // nohup may have set SIGHUP to be ignored in the tests
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const StopSignals signals;
    EXPECT_FALSE(StopSignals::arrived());
    std::raise(signal);
    EXPECT_TRUE(StopSignals::arrived()) << signal;
  }
}

TEST(StopSignals, AClosedTerminalSendsItTwice) {
  std::signal(SIGHUP, SIG_DFL);
  const StopSignals signals;
  std::raise(SIGHUP);
  std::raise(SIGHUP);
  EXPECT_TRUE(StopSignals::arrived());
}

TEST(StopSignals, AreIgnoredUnderNohup) {
  std::signal(SIGHUP, SIG_IGN);
  {
    const StopSignals signals;
    std::raise(SIGHUP);
    EXPECT_FALSE(StopSignals::arrived());
  }
  EXPECT_EQ(std::signal(SIGHUP, SIG_DFL), SIG_IGN);
}

}  // namespace
}  // namespace vitrine::test
