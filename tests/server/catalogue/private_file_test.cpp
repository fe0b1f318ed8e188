// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/private_file.h"

#include <gtest/gtest.h>

#include "server/catalogue/sqlite_catalogue.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

constexpr fs::perms kPrivate = fs::perms::owner_read | fs::perms::owner_write;
constexpr fs::perms kReadable = kPrivate | fs::perms::group_read | fs::perms::others_read;

TEST(PrivateFile, ACatalogueThatOthersCanReadBecomesPrivateWhenItIsOpened) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "catalogue.sqlite";
  const auto other = open_sqlite_catalogue(file).value();  // keeps the files beside it in place
  const std::string files[] = {file.string(), file.string() + "-wal", file.string() + "-shm"};
  for (const std::string& name : files)
    fs::permissions(name, kReadable);
  ASSERT_TRUE(open_sqlite_catalogue(file));
  for (const std::string& name : files)
    EXPECT_EQ(fs::status(name).permissions(), kPrivate) << name;
}

TEST(PrivateFile, MissingFilesAndFoldersStayAsTheyAre) {
  const test::TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_all | fs::perms::group_exec);
  make_private(folder.path());
  EXPECT_EQ(fs::status(folder.path()).permissions(), fs::perms::owner_all | fs::perms::group_exec);
  make_private(folder.path() / "missing");
  EXPECT_FALSE(fs::exists(folder.path() / "missing"));
}

}  // namespace
}  // namespace vitrine::server
