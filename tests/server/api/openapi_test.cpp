// SPDX-License-Identifier: Apache-2.0
// Compares the OpenAPI document with the routes. tests/e2e/openapi.test.mjs validates the document
// and the responses of a running daemon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "server/api/handlers.h"
#include "server/api/routes.h"
#include "server/jobs/model_order.h"
#include "server/jobs/scan_order.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

constexpr ApiRoute kOpenapiRoutes[] = {{.method = Method::kGet,
                                        .path = "/openapi.json",
                                        .handler = show_openapi,
                                        .executor = Executor::kInline}};

// Returns whether the OpenAPI document must describe the route. The document omits OPTIONS, which
// every path supports.
bool is_of_the_interface(const ApiRoute& route) {
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

TEST_F(OpenapiTest, ThePageDocumentsEveryRouteAndNothingElse) {
  std::set<std::string> served, documented;
  const Router router(bind(public_routes(), server.services()), parameter_patterns());
  for (std::size_t i = 0; i < public_routes().size(); ++i) {
    const ApiRoute& route = public_routes()[i];
    if (!is_of_the_interface(route)) continue;
    EXPECT_FALSE(route.doc.id.empty()) << route.path << ": add `.doc` to the route's record";
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

TEST_F(OpenapiTest, OnlyRoutesOfTheInterfaceHaveDocumentationEachUnderItsOwnName) {
  std::set<std::string_view> names;
  for (const ApiRoute& route : public_routes()) {
    if (route.doc.id.empty()) continue;
    EXPECT_TRUE(is_of_the_interface(route)) << route.path;
    EXPECT_TRUE(names.insert(route.doc.id).second) << route.doc.id;
  }
}

TEST_F(OpenapiTest, EveryTagIsDescribedAndUsed) {
  std::set<std::string> described, used;
  for (const auto& tag : document["tags"]) {
    described.insert(tag["name"]);
    EXPECT_FALSE(tag["description"].get<std::string>().empty()) << tag;
  }
  for (const auto& [path, methods] : document["paths"].items()) {
    for (const auto& [method, operation] : methods.items())
      used.insert(operation["tags"][0].get<std::string>());
  }
  EXPECT_EQ(described, used);
}

TEST_F(OpenapiTest, OperationsNameTheProblemsOfTheirKind) {
  const auto codes = [&](const char* path, const char* method) {
    std::vector<std::string> all;
    for (const auto& [code, response] : document["paths"][path][method]["responses"].items())
      all.push_back(code);
    return all;
  };
  EXPECT_THAT(codes("/api/v1/models", "get"), ::testing::ElementsAre("200", "400", "default"));
  EXPECT_THAT(codes("/api/v1/models/{id}", "get"),
              ::testing::ElementsAre("200", "400", "404", "default"));
  EXPECT_THAT(codes("/api/v1/models/{id}", "delete"),
              ::testing::ElementsAre("204", "400", "401", "403", "404", "default"));
}

// Expects that every schema of type "array" below `json` has `items`.
void expect_items(const nlohmann::json& json) {
  if (json.is_object() && json.contains("type") && json["type"] == "array") {
    EXPECT_TRUE(json.contains("items")) << json;
  }
  if (!json.is_structured()) return;
  for (const auto& value : json)
    expect_items(value);
}

TEST_F(OpenapiTest, NamesTheTypeOfIiif) {
  std::size_t documents = 0;
  for (const auto& [path, methods] : document["paths"].items()) {
    if (!path.starts_with("/api/v1/iiif/")) continue;
    const auto& content = methods["get"]["responses"]["200"]["content"];
    EXPECT_TRUE(content.contains("application/ld+json")) << path << content;
    ++documents;
  }
  EXPECT_EQ(documents, 5u);
}

TEST_F(OpenapiTest, AnUploadMayBeCreatedWithItsFirstPiece) {
  const auto& body = document["paths"]["/api/v1/uploads"]["post"]["requestBody"];
  EXPECT_EQ(body["required"], false);
  EXPECT_TRUE(body["content"].contains("application/offset+octet-stream")) << body;
}

TEST_F(OpenapiTest, EveryArraySchemaHasItems) {
  expect_items(document);
}

TEST(ApiNouns, NoTwoDefineTheSameComponent) {
  std::set<std::string> seen;
  for (const ApiNoun* noun : public_nouns()) {
    if (noun->components.empty()) continue;
    const auto json = nlohmann::json::parse(noun->components);
    for (const auto& [kind, entries] : json.items()) {
      for (const auto& entry : entries.items())
        EXPECT_TRUE(seen.insert(kind + "/" + entry.key()).second) << kind << "/" << entry.key();
    }
  }
}

TEST(ApiNouns, NoTwoDescribeTheSameTag) {
  std::set<std::string_view> seen;
  for (const ApiNoun* noun : public_nouns()) {
    for (const ApiTag& tag : noun->tags)
      EXPECT_TRUE(seen.insert(tag.name).second) << tag.name;
  }
}

// Calls `see` with each reference "#/components/…" in `json`.
void for_each_reference(const nlohmann::json& json, const std::function<void(std::string)>& see) {
  if (json.is_object() && json.contains("$ref")) see(json["$ref"].get<std::string>());
  if (!json.is_structured()) return;
  for (const auto& value : json)
    for_each_reference(value, see);
}

TEST_F(OpenapiTest, EveryReferenceResolvesAndEveryComponentIsUsed) {
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

// Each `order` below contains every member that a request may contain.
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
  model.repairs = "1 face dropped";
  is_described("ModelOrder", to_json_text(model));
}

TEST_F(OpenapiTest, RoutesStateTheirRoleAndTheirToken) {
  const auto& publish = document["paths"]["/api/v1/models/{id}/publish"]["post"];
  EXPECT_EQ(publish["x-role"], "operator");
  EXPECT_EQ(publish["security"].size(), 1u);
  const auto& list = document["paths"]["/api/v1/models"]["get"];
  EXPECT_FALSE(list.contains("x-role"));
  EXPECT_EQ(list["security"].size(), 2u);
}

}  // namespace
}  // namespace vitrine::test
