// SPDX-License-Identifier: Apache-2.0
// The OpenAPI document and the table of routes say the same. That it is valid and that answers
// keep to it is tested at the real daemon (tests/e2e/openapi.test.mjs).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "local_server.h"
#include "server/http/handlers.h"
#include "server/http/route_docs.h"
#include "server/http/routes.h"
#include "server/jobs/model_order.h"
#include "server/jobs/scan_order.h"
#include "support/http_client.h"

namespace vitrine::test {
namespace {

constexpr Route kOpenapiRoutes[] = {{Method::kGet, "/openapi.json", show_openapi, Place::kInline}};

// OPTIONS is answered everywhere, and nobody is told of it.
bool is_of_the_interface(const Route& route) {
  return route.path.starts_with("/api/v1/") && route.method != Method::kOptions;
}

class OpenapiTest : public ::testing::Test {
 protected:
  LocalServer server{kOpenapiRoutes};
  const nlohmann::json document =
      nlohmann::json::parse(http_get(server.port(), "/openapi.json").body);
};

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

TEST_F(OpenapiTest, EveryRouteIsDocumentedAndNothingElse) {
  std::set<std::string> served, documented;
  const Router router(public_routes());
  for (std::size_t i = 0; i < router.routes().size(); ++i) {
    const Route& route = router.routes()[i];
    if (!is_of_the_interface(route)) continue;
    EXPECT_NE(find_doc(route.handler), nullptr)
        << route.path << ": add a line to server/http/route_docs.cpp";
    std::istringstream methods(router.allow({i, {}}));
    for (std::string method; std::getline(methods >> std::ws, method, ',');) {
      if (method != "HEAD" && method != "OPTIONS")
        served.insert(std::string(route.path) + " " + method);
    }
  }
  for (const auto& [path, methods] : document["paths"].items()) {
    for (const auto& [method, operation] : methods.items())
      documented.insert(path + " " + upper(method));
  }
  EXPECT_EQ(served, documented);
}

TEST_F(OpenapiTest, EveryLineDescribesARouteAndHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (const RouteDoc& doc : route_docs()) {
    EXPECT_TRUE(names.insert(doc.id).second) << doc.id;
    EXPECT_TRUE(std::ranges::any_of(public_routes(), [&](const Route& route) {
      return route.handler == doc.handler && is_of_the_interface(route);
    })) << doc.id;
  }
}

// Calls `see` with each "#/components/…" in `json`.
void for_each_reference(const nlohmann::json& json, const std::function<void(std::string)>& see) {
  if (json.is_object() && json.contains("$ref")) see(json["$ref"].get<std::string>());
  if (!json.is_structured()) return;
  for (const auto& value : json)
    for_each_reference(value, see);
}

TEST_F(OpenapiTest, WhatIsReferredToIsThereAndNothingIsThereInVain) {
  std::set<std::string> used;
  for_each_reference(document, [&](const std::string& ref) {
    used.insert(ref);
    EXPECT_TRUE(document.contains(nlohmann::json::json_pointer(ref.substr(1)))) << ref;
  });
  for (const char* kind : {"schemas", "parameters", "responses"}) {
    for (const auto& [name, value] : document["components"][kind].items())
      EXPECT_TRUE(used.contains(std::string("#/components/") + kind + "/" + name)) << name;
  }
}

// `order`: with all that it may say.
TEST_F(OpenapiTest, EveryMemberOfAnOrderIsDescribed) {
  const auto is_described = [&](const std::string& schema, const std::string& order) {
    const nlohmann::json& schemas = document["components"]["schemas"];
    nlohmann::json members = schemas[schema]["properties"];
    if (schemas[schema].contains("allOf")) members.update(schemas["Processing"]["properties"]);
    const nlohmann::json said = nlohmann::json::parse(order);
    for (const auto& [name, value] : said.items())
      EXPECT_TRUE(members.contains(name)) << schema << ": " << name;
  };
  ScanOrder scan;
  scan.request.exposure_us = 1;
  scan.calibration = 1;
  scan.webhook = "http://a";
  is_described("ScanOrder", to_json_text(scan));
  is_described("CalibrationOrder", to_json_text(CalibrationOrder{.webhook = "http://a"}));
  ModelOrder model;
  model.replace = ModelId();
  model.webhook = "http://a";
  model.unit = "mm";
  is_described("ModelOrder", to_json_text(model));
}

TEST_F(OpenapiTest, ARoleIsToldAndATokenAskedFor) {
  const auto& publish = document["paths"]["/api/v1/models/{id}/publish"]["post"];
  EXPECT_EQ(publish["x-role"], "operator");
  EXPECT_EQ(publish["security"].size(), 1u);
  const auto& list = document["paths"]["/api/v1/models"]["get"];
  EXPECT_FALSE(list.contains("x-role"));
  EXPECT_EQ(list["security"].size(), 2u);
}

}  // namespace
}  // namespace vitrine::test
