// SPDX-License-Identifier: Apache-2.0
#include "server/http/router.h"

#include <gtest/gtest.h>

#include "server/http/routes.h"

namespace vitrine {
namespace {

const std::string kId = "01hf0000000000000000000000";
const std::string kSha(64, 'a');

// The template that a path reaches, "" for none.
std::string_view reached(const std::string& path) {
  const Router router(public_routes());
  const auto match = router.match(path);
  return match ? router.routes()[match->index].path : "";
}

TEST(Router, FindsEachRoute) {
  EXPECT_EQ(reached("/"), "/");
  EXPECT_EQ(reached("/models/" + kId), "/models/{id}");
  EXPECT_EQ(reached("/scans/" + kId), "/scans/{id}");
  EXPECT_EQ(reached("/assets/app.js"), "/{rest}");
  EXPECT_EQ(reached("/api/v1/models"), "/api/v1/models");
  EXPECT_EQ(reached("/api/v1/models/" + kId), "/api/v1/models/{id}");
  EXPECT_EQ(reached("/api/v1/models/" + kId + "/manifest"), "/api/v1/models/{id}/manifest");
  EXPECT_EQ(reached("/api/v1/models/" + kId + "/file.pmesh"), "/api/v1/models/{id}/file.pmesh");
  EXPECT_EQ(reached("/api/v1/models/" + kId + "/export.glb"),
            "/api/v1/models/{id}/export.{format}");
  EXPECT_EQ(reached("/api/v1/chunks/" + kSha), "/api/v1/chunks/{sha256}");
}

TEST(Router, AParameterThatIsNotOfItsTypeMatchesNoRouteOfTheInterface) {
  const std::string bad[] = {
      "/api/v1/models/" + kId.substr(1),       "/api/v1/models/" + kId + "0",
      "/api/v1/models/../etc/passwd",          "/api/v1/models/",
      "/api/v1/models/" + kId + "/export.",    "/api/v1/models/" + kId + "/",
      "/api/v1/models/" + kId + "/export.g/b", "/api/v1/chunks/" + kSha + "a",
      "/api/v1/chunks/" + std::string(64, 'g')};
  for (const std::string& path : bad)
    EXPECT_EQ(reached(path), "/{rest}") << path;
}

TEST(Router, GivesTheParametersAsTypes) {
  const Router router(public_routes());
  const std::string path = "/api/v1/models/" + kId + "/export.glb";  // the format is a part of it
  const auto model = router.match(path);
  ASSERT_TRUE(model);
  EXPECT_EQ(model->parameters.id.to_string(), kId);
  EXPECT_EQ(model->parameters.format, "glb");
  const auto chunk = router.match("/api/v1/chunks/" + kSha);
  ASSERT_TRUE(chunk);
  EXPECT_EQ(to_hex(chunk->parameters.sha256), kSha);
}

TEST(Router, APathWithoutALeadingSlashMatchesNothing) {
  EXPECT_EQ(reached("models"), "");
}

Response nothing(const Request&, Services&) {
  return {};
}

constexpr Route kRoutedPaths[] = {
    {Method::kGet, "/x/{name}/at/{number}", nothing, Place::kInline},
    {Method::kGet, "/x/{name}", nothing, Place::kInline, Role::kViewer},
    {Method::kPost, "/x/{name}/stop", nothing, Place::kInline, Role::kOperator},
    {Method::kDelete, "/x/{name}", nothing, Place::kInline, Role::kAdmin},
    {Method::kGet, "/{rest}", nothing, Place::kInline},
};
constexpr std::size_t kCatchAll = 4;

TEST(Router, ParsesNamesAndNumbers) {
  const Router router(kRoutedPaths);
  const std::string path = "/x/rig-2/at/999999";
  const auto match = router.match(path);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->parameters.name, "rig-2");
  EXPECT_EQ(match->parameters.number, 999'999u);
  EXPECT_EQ(router.match("/x/" + std::string(32, 'a'))->index, 1u);
  for (const std::string& bad :
       {std::string("/x/"), "/x/" + std::string(33, 'a'), std::string("/x/Rig"),
        std::string("/x/a_b"), std::string("/x/a%20b"), std::string("/x/.."),
        std::string("/x/a/at/0"), std::string("/x/a/at/01"), std::string("/x/a/at/1000000"),
        std::string("/x/a/at/-1"), std::string("/x/a/at/1a"), std::string("/x/a/at/")}) {
    EXPECT_EQ(router.match(bad)->index, kCatchAll) << bad;
  }
}

TEST(Router, FindsTheRouteOfAMethodAmongThoseOfOneTemplate) {
  const Router router(kRoutedPaths);
  const auto both = router.match("/x/a");
  EXPECT_EQ(router.find(*both, Method::kGet), 1u);
  EXPECT_EQ(router.find(*both, Method::kDelete), 3u);
  EXPECT_FALSE(router.find(*both, Method::kPost));
  EXPECT_EQ(router.allow(*both), "GET, HEAD, DELETE, OPTIONS");
  const auto stop = router.match("/x/a/stop");
  EXPECT_FALSE(router.find(*stop, Method::kGet)) << "the catch-all is another template";
  EXPECT_EQ(router.allow(*stop), "POST, OPTIONS");
}

TEST(Router, NamesEachTemplateOnce) {
  const Router router(kRoutedPaths);
  EXPECT_EQ(router.templates().size(), 4u);
  EXPECT_EQ(router.template_of(3), router.template_of(1));
  EXPECT_EQ(router.templates()[router.template_of(kCatchAll)], "/{rest}");
}

TEST(Router, WhatIsNotAPublicReadAsksForARole) {
  for (const Route& route : public_routes()) {
    if (route.method == Method::kGet && route.role == Role::kNone) continue;
    EXPECT_EQ(route.quick, nullptr) << route.path;
    if (route.method == Method::kOptions) continue;  // tells what is spoken
    EXPECT_NE(route.role, Role::kNone) << route.path;
  }
}

}  // namespace
}  // namespace vitrine
