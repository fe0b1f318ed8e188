// SPDX-License-Identifier: Apache-2.0
// Linked into a test, a daemon that tells of an error which the test has not waited for fails it.
#include <gtest/gtest.h>

#include "support/daemon.h"

namespace vitrine::test {
namespace {

[[maybe_unused]] const bool kIsSet = [] {
  Daemon::when_log_is_unclean = [](const std::string& line) {
    ADD_FAILURE() << "in the daemon's log: " << line;
  };
  return true;
}();

}  // namespace
}  // namespace vitrine::test
