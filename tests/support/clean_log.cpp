// SPDX-License-Identifier: Apache-2.0
// A test that links this file fails if a daemon logs an error that the test does not wait for.
#include <gtest/gtest.h>

#include "support/process/daemon.h"
#include "support/product_names.h"

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
