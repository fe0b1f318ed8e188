// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/lane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>

#include "codec/files/read_file.h"
#include "support/temporary_folder.h"

namespace vitrine {
namespace {

TEST(Lanes, what_a_task_throws_is_told_and_the_next_is_done) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "log";
  const Log events = Log::open(file).value();
  Lane lane(events);
  lane.post([] { throw std::bad_alloc(); });
  EXPECT_EQ(lane.run([] { return 7; }), 7);
  const auto told = read_file(file, 1000).value();
  EXPECT_THAT(std::string(told.begin(), told.end()), testing::HasSubstr("bad_alloc"));
}

}  // namespace
}  // namespace vitrine
