// SPDX-License-Identifier: Apache-2.0
#include "server/messages/origin.h"

#include <gtest/gtest.h>

#include <boost/beast/http/field.hpp>
#include <vector>

namespace vitrine::server {
namespace {

using beast::http::field;

RequestHeader from(const std::string& origin) {
  RequestHeader header;
  header.set(field::host, "scans.example:8080");
  header.set(field::origin, origin);
  return header;
}

const std::vector<std::string> kNone, kMuseum = {"https://museum.example"};

TEST(Origin, OfTheDaemonsOwnPagesIsAlwaysAllowed) {
  EXPECT_TRUE(is_allowed_origin(from("http://scans.example:8080"), kMuseum));
  EXPECT_TRUE(is_allowed_origin(from("https://scans.example:8080"), kMuseum));
  EXPECT_FALSE(is_allowed_origin(from("http://scans.example"), kMuseum));
}

TEST(Origin, MustMatchExactlyWhereSomeAreListed) {
  EXPECT_TRUE(is_allowed_origin(from("https://museum.example"), kMuseum));
  for (const char* const other : {"https://museum.example/", "HTTPS://museum.example", "null",
                                  "https://museum.example.evil", "http://museum.example", ""}) {
    EXPECT_FALSE(is_allowed_origin(from(other), kMuseum)) << other;
  }
}

TEST(Origin, IsFreeForPublicModelsWhereNoneIsListed) {
  RequestHeader header = from("https://anywhere.example");
  EXPECT_TRUE(is_allowed_origin(header, kNone));
  header.set(field::authorization, "Bearer x");
  EXPECT_FALSE(is_allowed_origin(header, kNone)) << "with a token";
  header.set(field::origin, "http://scans.example:8080");
  EXPECT_TRUE(is_allowed_origin(header, kNone));
}

TEST(Origin, IsNotSentByWhatIsNoBrowserAndOnceByBrowsers) {
  RequestHeader header;
  EXPECT_TRUE(is_allowed_origin(header, kMuseum));
  header.insert(field::origin, "https://museum.example");
  header.insert(field::origin, "https://museum.example");
  EXPECT_FALSE(is_allowed_origin(header, kMuseum));
}

}  // namespace
}  // namespace vitrine::server
