// SPDX-License-Identifier: Apache-2.0
#include "server/messages/problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string text_of(const Response& response) {
  return std::get<std::string>(response.body);
}

TEST(Problem, TellsTheClientWhatIsWrong) {
  const Response response =
      problem(400, "a parameter is out of range", "42", {{"limit", "1 to 200"}});
  EXPECT_EQ(response.status, 400u);
  EXPECT_EQ(response.type, "application/problem+json");
  EXPECT_EQ(
      text_of(response),
      "{\"type\":\"about:blank\",\"title\":\"Bad Request\",\"status\":400,\"request_id\":\"42\","
      "\"detail\":\"a parameter is out of range\","
      "\"errors\":[{\"parameter\":\"limit\",\"detail\":\"1 to 200\"}]}");
}

TEST(Problem, KeepsTheReasonOfAServerErrorToItself) {
  const std::string body = text_of(problem(500, "cannot read /srv/data/secret", "42"));
  EXPECT_THAT(body, HasSubstr("\"request_id\":\"42\""));
  EXPECT_THAT(body, Not(HasSubstr("secret")));
}

TEST(Problem, SaysWhatThereIsNoRoomFor) {
  EXPECT_THAT(text_of(problem(507, "7 of 9 bytes are taken", "42")),
              HasSubstr("\"detail\":\"7 of 9 bytes are taken\""));
}

TEST(Problem, IsValidJsonWhateverBytesTheDetailHolds) {
  EXPECT_THAT(text_of(problem(400, "\xff\"\n", "42")), HasSubstr("\xEF\xBF\xBD\\\"\\n"));
}

}  // namespace
}  // namespace vitrine::server
