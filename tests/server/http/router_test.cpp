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

}  // namespace
}  // namespace vitrine
