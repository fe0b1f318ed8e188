// SPDX-License-Identifier: Apache-2.0
#include "server/messages/problem_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/messages/problem.h"

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kBrowser = "text/html,application/xhtml+xml,*/*;q=0.8";

RequestHeader request(const char* accept, const char* language = "en") {
  RequestHeader header;
  header.method(beast::http::verb::get);
  header.set(beast::http::field::accept, accept);
  header.set(beast::http::field::accept_language, language);
  return header;
}

std::string page(unsigned status, const char* language = "en") {
  const auto shown = problem_page(problem(status, "why", "42"), request(kBrowser, language));
  EXPECT_EQ(shown.status, status);
  EXPECT_THAT(shown.type, StartsWith("text/html"));
  return std::get<std::string>(shown.body);
}

TEST(ProblemPage, IsForBrowsersThatOpenAPage) {
  EXPECT_TRUE(wants_page(request(kBrowser)));
  EXPECT_FALSE(wants_page(request("*/*"))) << "fetch() and curl";
  EXPECT_FALSE(wants_page(request("application/json, text/html")));
  RequestHeader form = request(kBrowser);
  form.method(beast::http::verb::post);
  EXPECT_FALSE(wants_page(form));
}

TEST(ProblemPage, SaysWhatToDoNext) {
  EXPECT_THAT(page(404), HasSubstr("href=\"/\">To the collection"));
  EXPECT_THAT(page(401), HasSubstr("href=\"/console\">To the console"));
  EXPECT_THAT(page(503), HasSubstr("Request 42"));
}

TEST(ProblemPage, SpeaksGerman) {
  EXPECT_THAT(page(404, "de-AT,de;q=0.9"), HasSubstr("<html lang=\"de\">"));
  EXPECT_THAT(page(404, "fr"), HasSubstr("<html lang=\"en\">"));
}

TEST(ProblemPage, KeepsTheFieldsOfTheProblem) {
  const auto shown = problem_page(away("42"), request(kBrowser));
  EXPECT_EQ(shown.fields.front().first, "Retry-After");
}

TEST(ProblemPage, ShowsNoMarkupOfAClient) {
  const auto shown = problem_page(problem(404, "", "<b>"), request(kBrowser));
  EXPECT_THAT(std::get<std::string>(shown.body), Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace vitrine::server
