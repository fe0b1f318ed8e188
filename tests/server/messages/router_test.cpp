// SPDX-License-Identifier: Apache-2.0
#include "server/messages/router.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

bool is_lower_case(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= 'a' && c <= 'z'; });
}
bool is_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

constexpr ParameterPattern kPatterns[] = {{"name", is_lower_case}, {"number", is_digits}};
constexpr std::size_t kCatchAll = 4;

Router make_router() {
  return Router({{.method = Method::kGet, .path = "/x/{name}/at.{number}"},
                 {.method = Method::kGet, .path = "/x/{name}"},
                 {.method = Method::kPost, .path = "/x/{name}/stop"},
                 {.method = Method::kDelete, .path = "/x/{name}"},
                 {.method = Method::kGet, .path = "/{rest}"}},
                kPatterns);
}

TEST(Router, GivesTheTextsThatThePatternsAccept) {
  const Router router = make_router();
  const auto match = router.match("/x/rig/at.12");
  ASSERT_TRUE(match);
  EXPECT_EQ(match->parameters["name"], "rig");
  EXPECT_EQ(match->parameters["number"], "12");
}

TEST(Router, MatchesNoRouteIfAPatternRefusesTheText) {
  const Router router = make_router();
  for (const std::string_view path :
       {"/x/", "/x/Rig", "/x/a%20b", "/x/..", "/x/a/at.b", "/x/a/at."})
    EXPECT_EQ(router.match(path)->index, kCatchAll) << path;
}

TEST(Router, MatchesNoPathWithoutALeadingSlash) {
  EXPECT_FALSE(make_router().match("models"));
}

TEST(Router, RefusesAParameterThatNoPatternNames) {
  const Router router({{.method = Method::kGet, .path = "/x/{unknown}"}}, kPatterns);
  EXPECT_FALSE(router.match("/x/a"));
}

TEST(Router, FindsTheRouteOfAMethodAmongThoseOfOneTemplate) {
  const Router router = make_router();
  const auto both = router.match("/x/a");
  EXPECT_EQ(router.find(*both, Method::kGet), 1u);
  EXPECT_EQ(router.find(*both, Method::kDelete), 3u);
  EXPECT_FALSE(router.find(*both, Method::kPost));
  EXPECT_EQ(router.allow(*both), "GET, HEAD, DELETE, OPTIONS");
  const auto stop = router.match("/x/a/stop");
  EXPECT_FALSE(router.find(*stop, Method::kGet)) << "the catch-all is another template";
  EXPECT_EQ(router.allow(*stop), "POST, OPTIONS");
}

TEST(Router, ListsEachTemplateOnce) {
  const Router router = make_router();
  EXPECT_EQ(router.templates().size(), 4u);
  EXPECT_EQ(router.template_of(3), router.template_of(1));
  EXPECT_EQ(router.templates()[router.template_of(kCatchAll)], "/{rest}");
}

}  // namespace
}  // namespace vitrine::server
