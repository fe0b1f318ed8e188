// SPDX-License-Identifier: Apache-2.0
#include "server/messages/conditional.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

using beast::http::field;
using Outcome = RangeChoice::Outcome;

struct RangeCase {
  const char* range;
  Outcome outcome;
  std::uint64_t offset = 0, length = 0;
};

TEST(ChooseRange, ServesOneRangeOfATenByteBody) {
  const RangeCase cases[] = {
      {"bytes=0-0", Outcome::kPart, 0, 1},
      {"bytes=2-5", Outcome::kPart, 2, 4},
      {"bytes=9-", Outcome::kPart, 9, 1},
      {"bytes=5-1000", Outcome::kPart, 5, 5},
      {"bytes=0-18446744073709551615", Outcome::kPart, 0, 10},
      {"bytes=-3", Outcome::kPart, 7, 3},
      {"bytes=-11", Outcome::kPart, 0, 10},
      {"bytes=10-", Outcome::kUnsatisfiable},
      {"bytes=10-20", Outcome::kUnsatisfiable},
      {"bytes=-0", Outcome::kUnsatisfiable},
      {"bytes=5-2", Outcome::kWhole},
      {"bytes=a-b", Outcome::kWhole},
      {"bytes=1-2,4-5", Outcome::kWhole},
      {"bytes=", Outcome::kWhole},
      {"bytes=-", Outcome::kWhole},
      {"bytes=+1-2", Outcome::kWhole},
      {"bytes=0-99999999999999999999999", Outcome::kWhole},
      {"lines=1-2", Outcome::kWhole},
  };
  for (const RangeCase& test : cases) {
    const RangeChoice choice = choose_range(test.range, 10);
    EXPECT_EQ(choice.outcome, test.outcome) << test.range;
    EXPECT_EQ(choice.offset, test.offset) << test.range;
    EXPECT_EQ(choice.length, test.length) << test.range;
  }
}

TEST(ChooseRange, HasNothingToServeOfAnEmptyBody) {
  EXPECT_EQ(choose_range("bytes=0-", 0).outcome, Outcome::kUnsatisfiable);
  EXPECT_EQ(choose_range("bytes=-1", 0).outcome, Outcome::kUnsatisfiable);
}

TEST(MatchesAny, ReadsLists) {
  for (const auto matches : {matches_any, matches_any_weakly}) {
    EXPECT_TRUE(matches("*", "\"a\""));
    EXPECT_TRUE(matches("\"a\"", "\"a\""));
    EXPECT_TRUE(matches("\"x\", \t\"a\"", "\"a\""));
    EXPECT_FALSE(matches("\"aa\"", "\"a\""));
    EXPECT_FALSE(matches("a", "\"a\""));
    EXPECT_FALSE(matches(",", "\"a\""));
  }
}

TEST(MatchesAny, AWeakTagServesToKeepACopyAndNotToChangeAnything) {
  EXPECT_FALSE(matches_any("\"x\", W/\"a\"", "\"a\""));
  EXPECT_TRUE(matches_any_weakly("\"x\", W/\"a\"", "\"a\""));
}

Response answer(const std::vector<std::pair<field, std::string>>& fields,
                beast::http::verb method = beast::http::verb::get) {
  RequestHeader request;
  request.method(method);
  for (const auto& [name, value] : fields)
    request.insert(name, value);
  Response response;
  response.type = "text/plain";
  response.etag = "\"a\"";
  response.body = std::string("0123456789");
  return apply_conditions(request, std::move(response), "0123456789abcdef");
}

std::string text(const Response& response) {
  return std::get<std::string>(response.body);
}

TEST(ApplyConditions, WithoutConditionsTheAnswerIsWhole) {
  EXPECT_EQ(answer({}).status, 200u);
  EXPECT_EQ(text(answer({})), "0123456789");
}

TEST(ApplyConditions, AHeldEntityIsNotModifiedEvenWhereARangeIsAskedFor) {
  const Response response = answer({{field::if_none_match, "\"a\""}, {field::range, "bytes=0-1"}});
  EXPECT_EQ(response.status, 304u);
  EXPECT_EQ(text(response), "");
  EXPECT_EQ(response.etag, "\"a\"");
}

TEST(ApplyConditions, ARangeIsPartialContent) {
  const Response response = answer({{field::range, "bytes=2-3"}});
  EXPECT_EQ(response.status, 206u);
  EXPECT_EQ(text(response), "23");
  EXPECT_EQ(response.fields.back().second, "bytes 2-3/10");
}

TEST(ApplyConditions, ARangeBeyondTheEndIsUnsatisfiableAndTellsTheSize) {
  const Response response = answer({{field::range, "bytes=10-"}});
  EXPECT_EQ(response.status, 416u);
  EXPECT_EQ(response.fields.back().second, "bytes */10");
}

TEST(ApplyConditions, IfRangeGuardsTheRangeByAStrongMatch) {
  EXPECT_EQ(answer({{field::range, "bytes=2-3"}, {field::if_range, "\"a\""}}).status, 206u);
  EXPECT_EQ(answer({{field::range, "bytes=2-3"}, {field::if_range, "\"b\""}}).status, 200u);
  EXPECT_EQ(answer({{field::range, "bytes=2-3"}, {field::if_range, "W/\"a\""}}).status, 200u);
  EXPECT_EQ(
      answer({{field::range, "bytes=2-3"}, {field::if_range, "Sat, 29 Oct 1994 19:43:31 GMT"}})
          .status,
      200u);
}

TEST(ApplyConditions, HeadIgnoresRanges) {
  EXPECT_EQ(answer({{field::range, "bytes=2-3"}}, beast::http::verb::head).status, 200u);
}

TEST(ApplyConditions, ErrorsAreLeftAsTheyAre) {
  RequestHeader request;
  request.insert(field::range, "bytes=0-0");
  Response response;
  response.status = 404;
  response.etag = "\"a\"";
  EXPECT_EQ(apply_conditions(request, response, "").status, 404u);
}

TEST(BodyRange, IsAPartOfEveryKindOfBody) {
  const std::vector<std::uint8_t> bytes = {0, 1, 2, 3, 4};
  const Body shared = body_range(SharedBytes{nullptr, bytes}, 1, 2);
  EXPECT_EQ(std::get<SharedBytes>(shared).bytes.data(), bytes.data() + 1);
  EXPECT_EQ(body_size(shared), 2u);
  const Body stored = body_range(StoredBytes{nullptr, 100, 50}, 10, 20);
  EXPECT_EQ(std::get<StoredBytes>(stored).offset, 110u);
  EXPECT_EQ(body_size(stored), 20u);
}

}  // namespace
}  // namespace vitrine::server
