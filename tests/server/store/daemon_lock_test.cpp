// SPDX-License-Identifier: Apache-2.0
#include "server/store/daemon_lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include "server/store/installation.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

// Locks the folder as a child process of a killed daemon does: it has inherited the daemon's lock
// and still runs.
FileDescriptor lock_of_a_child(const test::TemporaryFolder& folder) {
  FileDescriptor file(::open((folder.path() / kDaemonLock).c_str(), O_RDWR | O_CREAT, 0600));
  EXPECT_EQ(::flock(file.get(), LOCK_EX), 0);
  return file;
}

TEST(DaemonLock, ADaemonStartsOnceTheChildrenOfAKilledOneHaveEnded) {
  const test::TemporaryFolder folder;
  FileDescriptor child = lock_of_a_child(folder);
  int pauses = 0;
  const auto lock = lock_data_folder(folder.path(), [&] {
    if (++pauses == 3) child = {};
  });
  EXPECT_TRUE(lock.has_value());
  EXPECT_EQ(pauses, 3);
}

TEST(DaemonLock, ALockThatStaysIsOfAnotherDaemon) {
  const test::TemporaryFolder folder;
  const FileDescriptor other = lock_of_a_child(folder);
  int pauses = 0;
  const auto lock = lock_data_folder(folder.path(), [&] { ++pauses; });
  ASSERT_FALSE(lock.has_value());
  EXPECT_EQ(lock.error().code, ErrorCode::kState);
  EXPECT_EQ(pauses, 199);
}

}  // namespace
}  // namespace vitrine::server
