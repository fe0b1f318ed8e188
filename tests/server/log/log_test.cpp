// SPDX-License-Identifier: Apache-2.0
#include "server/log/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

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
  const std::string route(10'000, 'x');
  for (int i = 0; i < 7; ++i)
    static_cast<void>(log->access({.request_id = "1", .route = route}));
  EXPECT_GT(std::filesystem::file_size(file), 60'000u);
}

TEST(Log, ALongTargetOrMethodMakesNoLongLine) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-long.log";
  std::filesystem::remove(file);
  const std::string target = "/" + std::string(8'000, '\xff'), method(9'000, 'M');
  {
    const auto log = Log::open(file);
    static_cast<void>(log->access({.method = method, .target = target}));
    log->audit({.method = method, .target = target});
  }
  const std::string text = slurp(file);
  EXPECT_LT(text.size(), 2u * 1'000);
  EXPECT_THAT(text, ::testing::ContainsRegex("event=access .* method=M+ method_bytes=9000 .* "
                                             "target=\"/.*\" target_bytes=8001 status="));
  EXPECT_THAT(text, ::testing::ContainsRegex("event=audit .* target_bytes=8001 status="));
}

TEST(Log, WritesOneLinePerCommandThatChangesAnInstallation) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-commands.log";
  std::filesystem::remove(file);
  Log::open(file)->audit(CommandRecord{.user = "vitrine",
                                       .login = "1000",
                                       .action = "token create",
                                       .target = "x\nevent=audit",
                                       .is_done = true});
  EXPECT_THAT(
      slurp(file),
      ::testing::MatchesRegex("time=.* event=audit user=vitrine login=1000 action=\"token create\" "
                              "target=\"x.x0aevent=audit\" outcome=done\n"));
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

TEST(Log, AFileThatIsFullIsReplacedAndOneOlderIsKept) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-full.log";
  const std::filesystem::path old = file.string() + ".old";
  std::filesystem::remove(file);
  constexpr std::uint64_t kLimit = 1'000;
  const auto log = Log::open(file, kLimit);
  const auto write = [&](std::string_view id) {
    static_cast<void>(log->access({.request_id = id, .route = std::string(kLimit, 'x')}));
    log->flush();
  };
  write("first");
  EXPECT_EQ(slurp(file), "");
  EXPECT_THAT(slurp(old), HasSubstr("id=first"));
  write("second");
  EXPECT_THAT(slurp(old),
              ::testing::AllOf(HasSubstr("id=second"), ::testing::Not(HasSubstr("id=first"))));
  static_cast<void>(log->access({.request_id = "third"}));
  log->flush();
  EXPECT_THAT(slurp(file), HasSubstr("id=third"));
  EXPECT_THAT(slurp(old), HasSubstr("id=second"));
}

TEST(Log, AFullFileThatAnotherProcessHasReplacedIsLeftBehind) {
  const std::filesystem::path file = ::testing::TempDir() + "vitrine-shared.log";
  const std::filesystem::path old = file.string() + ".old";
  std::filesystem::remove(file);
  const auto one = Log::open(file, 1), other = Log::open(file, 1);
  const auto write = [](const Log& log, std::string_view id) {
    static_cast<void>(log.access({.request_id = id}));
    log.flush();
  };
  write(*one, "first");  // `other` still has the old log file open
  write(*other, "second");
  EXPECT_EQ(slurp(file), "");
  EXPECT_THAT(slurp(old), ::testing::AllOf(HasSubstr("id=first"), HasSubstr("id=second")));
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

}  // namespace
}  // namespace vitrine::server
