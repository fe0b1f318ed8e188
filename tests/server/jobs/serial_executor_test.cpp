// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/serial_executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>

#include "codec/files/read_file.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

TEST(SerialExecutor, AnExceptionIsLoggedAndTheNextTaskRuns) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "log";
  const Log events = Log::open(file).value();
  SerialExecutor executor(events);
  executor.post([] { throw std::bad_alloc(); });
  EXPECT_EQ(executor.run([] { return 7; }), 7);
  const auto told = read_file(file, 1000).value();
  EXPECT_THAT(std::string(told.begin(), told.end()), testing::HasSubstr("bad_alloc"));
}

}  // namespace
}  // namespace vitrine::server
