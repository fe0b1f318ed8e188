// SPDX-License-Identifier: Apache-2.0
#include "server/api/routes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "codec/export/write_mesh.h"
#include "server/api/path_parameters.h"

namespace vitrine::server {
namespace {

const std::string kId = "01hf0000000000000000000000";
const std::string kSha(64, 'a');

// Returns a router for the public routes. It does not call their handlers.
Router make_router() {
  std::vector<Route> routes;
  for (const ApiRoute& route : public_routes())
    routes.push_back({.method = route.method, .path = route.path});
  return {std::move(routes), parameter_patterns()};
}

Request with(const PathParameters& parameters) {
  static const RequestHeader header;
  static const nlohmann::json body;
  static const std::string form;
  static const std::optional<Caller> caller;
  return {.header = header, .parameters = parameters, .body = body, .form = form, .caller = caller};
}

// Returns the route template that a path matches, or "" if no template matches.
std::string_view reached(const std::string& path) {
  static const Router router = make_router();
  const auto match = router.match(path);
  return match ? router.routes()[match->index].path : "";
}

TEST(Routes, AreFoundByTheirPaths) {
  EXPECT_EQ(reached("/"), "/");
  EXPECT_EQ(reached("/models/" + kId), "/models/{id}");
  EXPECT_EQ(reached("/scans/" + kId), "/scans/{id}");
  EXPECT_EQ(reached("/assets/app.js"), "/{rest}");
  EXPECT_EQ(reached("/api/v1/models"), "/api/v1/models");
  EXPECT_EQ(reached("/api/v1/models/" + kId), "/api/v1/models/{id}");
  EXPECT_EQ(reached("/api/v1/models/" + kId + "/manifest"), "/api/v1/models/{id}/manifest");
  EXPECT_EQ(reached("/api/v1/models/" + kId + "/file.pmesh"), "/api/v1/models/{id}/file.pmesh");
  EXPECT_EQ(reached("/api/v1/models/" + kId + "/tileset.json"), "/api/v1/models/{id}/tileset.json");
  for (const ExportFormat& row : kExportFormats) {
    EXPECT_EQ(reached("/api/v1/models/" + kId + "/export." + std::string(row.extension)),
              "/api/v1/models/{id}/export.{format}");
  }
  EXPECT_EQ(reached("/api/v1/chunks/" + kSha), "/api/v1/chunks/{sha256}");
}

TEST(Routes, RefuseAParameterThatIsNotOfItsType) {
  const std::string bad[] = {
      "/api/v1/models/" + kId.substr(1),       "/api/v1/models/" + kId + "0",
      "/api/v1/models/../etc/passwd",          "/api/v1/models/",
      "/api/v1/models/" + kId + "/export.",    "/api/v1/models/" + kId + "/",
      "/api/v1/models/" + kId + "/export.g/b", "/api/v1/chunks/" + kSha + "a",
      "/api/v1/chunks/" + std::string(64, 'g')};
  for (const std::string& path : bad)
    EXPECT_EQ(reached(path), "/{rest}") << path;
}

TEST(Routes, GiveTheParametersAsTypes) {
  const Router router = make_router();
  const std::string path = "/api/v1/models/" + kId + "/export.glb",
                    chunk = "/api/v1/chunks/" + kSha;
  const auto model = router.match(path);
  ASSERT_TRUE(model);
  EXPECT_EQ(id_in<ModelId>(with(model->parameters)).to_string(), kId);
  EXPECT_EQ(format_in(with(model->parameters)), "glb");
  const auto match = router.match(chunk);
  ASSERT_TRUE(match);
  EXPECT_EQ(to_hex(sha256_in(with(match->parameters))), kSha);
}

TEST(Routes, ParseNamesAndNumbers) {
  const Router router = make_router();
  const std::string path = "/api/v1/scanners/rig-2/calibrations/999999";
  const auto match = router.match(path);
  ASSERT_TRUE(match);
  EXPECT_EQ(name_in(with(match->parameters)), "rig-2");
  EXPECT_EQ(number_in(with(match->parameters)), 999'999u);
  EXPECT_EQ(reached("/api/v1/scanners/" + std::string(32, 'a')), "/api/v1/scanners/{name}");
  for (const std::string& bad :
       {std::string(), std::string(33, 'a'), std::string("Rig"), std::string("a_b"),
        std::string("a%20b"), std::string(".."), std::string("a/calibrations/0"),
        std::string("a/calibrations/01"), std::string("a/calibrations/1000000"),
        std::string("a/calibrations/-1"), std::string("a/calibrations/1a"),
        std::string("a/calibrations/")}) {
    EXPECT_EQ(reached("/api/v1/scanners/" + bad), "/{rest}") << bad;
  }
}

TEST(Routes, NeedARoleUnlessTheyAreAPublicReadOrCountAVisitOrHarvest) {
  for (const ApiRoute& route : public_routes()) {
    if (route.method == Method::kGet && route.role == Role::kNone) continue;
    EXPECT_EQ(route.quick, nullptr) << route.path;
    if (route.method == Method::kOptions) continue;  // OPTIONS only lists the methods of a path
    const bool is_open = route.path == "/api/v1/models/{id}/visits" || route.path == "/api/v1/oai";
    EXPECT_EQ(route.role == Role::kNone, is_open) << route.path;
  }
}

}  // namespace
}  // namespace vitrine::server
