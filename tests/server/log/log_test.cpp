// SPDX-License-Identifier: Apache-2.0
#include "server/log/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "server/log/request_id.h"

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;

std::string slurp(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Log, WritesOneLinePerRequest) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-access.log";
  std::filesystem::remove(file);
  {
    const auto log = Log::open(file);
    ASSERT_TRUE(log) << log.error().message;
    EXPECT_TRUE(log->access({.request_id = "0123",
                             .remote = "127.0.0.1",
                             .method = "GET",
                             .route = "/x/{id}",
                             .target = "/x/1\nevent=forged \"",
                             .status = 404,
                             .bytes = 12,
                             .seconds = 0.5}));
    log->event(Severity::kWarning, "all is well");
  }
  const std::string text = slurp(file);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_THAT(
      text,
      HasSubstr("id=0123 remote=127.0.0.1 method=GET route=/x/{id} "
                "target=\"/x/1\\x0aevent=forged \\\"\" status=404 bytes=12 seconds=0.500000\n"));
  EXPECT_THAT(text, HasSubstr("event=warning message=\"all is well\"\n"));
}

TEST(Log, RequestsAreBatchedUntilTheFlush) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-batch.log";
  std::filesystem::remove(file);
  const auto log = Log::open(file);
  EXPECT_TRUE(log->access({.request_id = "1"}));
  EXPECT_FALSE(log->access({.request_id = "2"}));
  EXPECT_EQ(slurp(file), "");
  log->flush();
  EXPECT_THAT(slurp(file), ::testing::ContainsRegex("id=1 .*\n.*id=2 .*\n$"));
  EXPECT_TRUE(log->access({.request_id = "3"}));
}

TEST(Log, ALargeBatchIsWrittenWithoutAFlush) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-many.log";
  std::filesystem::remove(file);
  const auto log = Log::open(file);
  const std::string target(10'000, 'x');
  for (int i = 0; i < 7; ++i)
    static_cast<void>(log->access({.request_id = "1", .target = target}));
  EXPECT_GT(std::filesystem::file_size(file), 60'000u);
}

TEST(Log, WritesOneLinePerChange) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-audit.log";
  std::filesystem::remove(file);
  Log::open(file)->audit({.request_id = "0123",
                          .remote = "127.0.0.1",
                          .token = "01hf",
                          .method = "POST",
                          .route = "/x/{name}/stop",
                          .target = "/x/a/stop?\nevent=audit",
                          .status = 200});
  EXPECT_THAT(slurp(file),
              HasSubstr("event=audit id=0123 remote=127.0.0.1 token=01hf method=POST "
                        "route=/x/{name}/stop target=\"/x/a/stop?\\x0aevent=audit\" status=200\n"));
}

TEST(Log, NamesTheFileThatItCannotOpen) {
  const auto log = Log::open("/nowhere/access.log");
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().message, HasSubstr("/nowhere/access.log: No such file"));
}

TEST(Log, QuotesAnEmptyValueAndLeavesAPlainOneBare) {
  EXPECT_EQ(logfmt_value(""), "\"\"");
  EXPECT_EQ(logfmt_value("/a/b?c"), "/a/b?c");
  EXPECT_EQ(logfmt_value("a=b"), "\"a=b\"");
  EXPECT_EQ(logfmt_value("\xff"), "\"\\xff\"");
}

TEST(RequestId, DiffersForEveryRequest) {
  EXPECT_NE(next_request_id(), next_request_id());
}

}  // namespace
}  // namespace vitrine::server
