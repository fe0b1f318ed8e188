// SPDX-License-Identifier: Apache-2.0
#include "server/messages/request_body.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

unsigned status_of(std::string_view text, std::string_view type = "application/json") {
  const auto body = parse_body(type, text);
  return body ? 200 : body.error().status;
}

std::string nested(int depth) {
  std::string text = R"({"a":)";
  for (int i = 1; i < depth; ++i)
    text += '[';
  for (int i = 1; i < depth; ++i)
    text += ']';
  return text + '}';
}

TEST(RequestBody, IsAnObjectAndAnEmptyOneWhereThereIsNone) {
  EXPECT_EQ(parse_body("application/json", R"({"on":true})")->at("on"), true);
  EXPECT_TRUE(parse_body("", "")->is_object());
  EXPECT_EQ(status_of(" {} \r\n"), 200u);
  EXPECT_EQ(status_of("{}", "application/merge-patch+json"), 200u);
}

TEST(RequestBody, AnythingElseIsRefused) {
  for (const char* text :
       {" ", "[]", "1", "null", "\"a\"", "{", "{}{}", "{\"a\":1,}", "{'a':1}", "{\"a\":NaN}",
        "{\"a\":01}", "{\"a\":1e999}", "// c\n{}", "{\"a\":\"\xff\"}", "{\"a\":\"\\ud800\"}",
        "\xef\xbb\xbf[]", "{\"a\":1,\"a\":2}", "{\"b\":[{\"a\":1,\"\\u0061\":2}]}"}) {
    EXPECT_EQ(status_of(text), 400u) << text;
  }
  EXPECT_EQ(status_of({"{}\0", 3}), 400u);
  EXPECT_EQ(status_of("{\"b\":{\"a\":1},\"a\":[{\"a\":1},{\"a\":2}]}"), 200u);
}

TEST(RequestBody, IsNestedAtMostSixteenDeep) {
  EXPECT_EQ(status_of(nested(kMaxBodyDepth)), 200u);
  EXPECT_EQ(status_of(nested(kMaxBodyDepth + 1)), 400u);
  EXPECT_EQ(status_of("{\"a\":" + std::string(60'000, '[')), 400u);
  std::string objects;
  while (objects.size() < 60'000)
    objects += "{\"a\":";
  EXPECT_EQ(status_of(objects), 400u);
}

TEST(RequestBody, HasAMediaTypeAndABound) {
  EXPECT_EQ(status_of("{}", "Application/JSON ; charset=utf-8"), 200u);
  for (const char* type : {"", "text/plain", "application/jsonp", "application/json, text/plain",
                           "application/x-www-form-urlencoded", "multipart/form-data"}) {
    EXPECT_EQ(status_of("{}", type), 415u) << type;
  }
  const std::string padding(kMaxRequestBody - 2, ' ');
  EXPECT_EQ(status_of("{}" + padding), 200u);
  EXPECT_EQ(status_of("{} " + padding), 413u);
}

TEST(RequestBody, AFormHasItsOwnMediaTypeAndBound) {
  constexpr std::string_view kForm = "Application/X-WWW-Form-Urlencoded ; charset=utf-8";
  EXPECT_FALSE(form_fault(kForm, std::string(kMaxForm, 'a')));
  EXPECT_EQ(form_fault(kForm, std::string(kMaxForm + 1, 'a'))->status, 413u);
  for (const char* other : {"", "application/json", "application/x-www-form-urlencodedX"})
    EXPECT_EQ(form_fault(other, "verb=Identify")->status, 415u) << other;
}

}  // namespace
}  // namespace vitrine::server
