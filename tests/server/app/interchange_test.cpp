// SPDX-License-Identifier: Apache-2.0
// Tests how the real daemon describes a model to other software: posters, IIIF, oEmbed and link
// previews.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "codec/picture/decode_picture.h"
#include "displayed_model.h"
#include "server/auth/authenticator.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

class InterchangeTest : public ::testing::Test, public DisplayedModel {
 protected:
  InterchangeTest()
      : DisplayedModel({.title = "Sheet \"A\" <b>",
                        .creator = "Maker",
                        .rights = "Ask first",
                        .licence = "http://creativecommons.org/licenses/by/4.0/"},
                       {"--public-url", "https://museum.example/"}) {}

  HttpAnswer get(const std::string& target, const std::string& fields = "") const {
    return http_get(port(), target, fields);
  }
  Json json(const std::string& target) const { return Json::parse(get(target).body); }

  const std::string origin = "https://museum.example";
  const std::string page = origin + "/models/" + id;
};

// Returns the width and height from a PNG's header (big-endian, at bytes 16 and 20).
std::pair<unsigned, unsigned> png_size(const std::string& file) {
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<unsigned char>(file.at(at + i));
    return value;
  };
  return {number(16), number(20)};
}

TEST_F(InterchangeTest, APosterIsAPictureOfTheSizeAskedFor) {
  const HttpAnswer poster = get(api + "/poster.png?width=240");
  EXPECT_EQ(poster.field("content-type"), "image/png");
  EXPECT_THAT(poster.body, StartsWith("\x89PNG\r\n"));
  EXPECT_EQ(png_size(poster.body), std::pair(240u, 240u));
  EXPECT_EQ(png_size(get(api + "/poster.png").body), std::pair(480u, 480u));
  EXPECT_EQ(get(api + "/poster.png?width=241").status, 400);
  const std::string held = "If-None-Match: " + poster.field("etag") + "\r\n";
  EXPECT_EQ(get(api + "/poster.png?width=240", held).status, 304);
  EXPECT_EQ(get(api + "/poster.png?width=240", "Range: bytes=1-3\r\n").body, "PNG");
}

TEST_F(InterchangeTest, APosterShowsTheModelBeforeNothing) {
  const std::string file = get(api + "/poster.png?width=240").body;
  const Picture image =
      decode_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, 240 * 240)
          .value();
  std::set<std::uint8_t> shades;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4)
    shades.insert(image.pixels[i]);
  EXPECT_GT(shades.size(), 20u) << "light falls on a wavy sheet";
}

TEST_F(InterchangeTest, WhatIsMadeOfADraftIsForNobodyElse) {
  const auto installation = open_installation({.folder = folder.path()}).value();
  const auto token = create_token(*installation.catalogue, Role::kOperator, "").value();
  const std::string who = "Authorization: Bearer " + token.text + "\r\n";
  EXPECT_EQ(http_get(port(), api + "/unpublish", who, "POST").status, 200);
  for (const std::string& target :
       {api + "/export.ply", api + "/poster.png", "/api/v1/iiif/" + id + "/manifest.json"}) {
    EXPECT_EQ(get(target).status, 404) << target;
    const HttpAnswer own = get(target, who);
    EXPECT_EQ(own.status, 200) << target;
    EXPECT_EQ(own.field("cache-control"), "private, no-store") << target;
    EXPECT_EQ(own.field("access-control-allow-origin"), "") << target;
  }
  EXPECT_EQ(get("/api/v1/oembed?url=" + page).status, 404);
  EXPECT_EQ(get("/api/v1/oembed?url=" + page, who).status, 404) << "frames are for everybody";
}

TEST_F(InterchangeTest, AnIiifManifestShowsThePosterAndOffersTheModel) {
  const HttpAnswer answer = get("/api/v1/iiif/" + id + "/manifest.json");
  EXPECT_THAT(answer.field("content-type"), StartsWith("application/ld+json"));
  EXPECT_EQ(answer.field("access-control-allow-origin"), "*");
  const Json manifest = Json::parse(answer.body);
  EXPECT_EQ(manifest["id"], origin + "/api/v1/iiif/" + id + "/manifest.json");
  EXPECT_EQ(manifest["label"]["none"][0], "Sheet \"A\" <b>");
  EXPECT_EQ(manifest["rights"], "http://creativecommons.org/licenses/by/4.0/");
  const Json& painted = manifest["items"][0]["items"][0]["items"][0];
  EXPECT_EQ(painted["target"], manifest["items"][0]["id"]);
  EXPECT_EQ(painted["body"]["id"], origin + api + "/poster.png?width=960");
  EXPECT_EQ(manifest["items"][0]["height"], painted["body"]["height"]);
  const std::string thumbnail = manifest["thumbnail"][0]["id"];
  ASSERT_THAT(thumbnail, StartsWith(origin));
  const auto size = png_size(get(thumbnail.substr(origin.size())).body);
  EXPECT_EQ(manifest["thumbnail"][0]["width"], size.first);
  const Json& model = manifest["rendering"][0];
  EXPECT_EQ(model["type"], "Model");
  EXPECT_THAT(get(model["id"].get<std::string>().substr(origin.size())).body, StartsWith("glTF"));
}

TEST_F(InterchangeTest, ASceneOfIiifFourShowsTheModel) {
  const std::string target = "/api/v1/iiif/4/" + id + "/manifest.json";
  const HttpAnswer answer = get(target);
  EXPECT_THAT(answer.field("content-type"), HasSubstr("presentation/4/context.json"));
  const Json manifest = Json::parse(answer.body);
  EXPECT_EQ(manifest["id"], origin + target);
  const Json& scene = manifest["items"][0];
  EXPECT_EQ(scene["type"], "Scene");
  const Json& painted = scene["items"][0]["items"][0];
  EXPECT_EQ(painted["target"]["id"], scene["id"]);
  EXPECT_EQ(painted["body"]["type"], "Model");
  EXPECT_THAT(get(painted["body"]["id"].get<std::string>().substr(origin.size())).body,
              StartsWith("glTF"));
}

TEST_F(InterchangeTest, ACollectionListsTheManifestsOfPublishedModels) {
  const Json collection = json("/api/v1/iiif/collection.json");
  EXPECT_EQ(collection["type"], "Collection");
  ASSERT_EQ(collection["items"].size(), 1u);
  EXPECT_EQ(collection["items"][0]["id"], json("/api/v1/iiif/" + id + "/manifest.json")["id"]);
}

TEST_F(InterchangeTest, TheShortAddressOfAManifestLeadsToIt) {
  const HttpAnswer answer = get("/iiif/" + id + "/manifest.json");
  EXPECT_EQ(answer.status, 308);
  EXPECT_EQ(answer.field("location"), origin + "/api/v1/iiif/" + id + "/manifest.json");
}

TEST_F(InterchangeTest, OembedFramesThePageWithinTheRoomThereIs) {
  const Json embed = json("/api/v1/oembed?format=json&maxwidth=500&url=" + page);
  EXPECT_EQ(embed["version"], "1.0");
  EXPECT_EQ(embed["width"], 500);
  EXPECT_EQ(embed["height"], 480);
  EXPECT_EQ(embed["author_name"], "Maker");
  EXPECT_THAT(embed["html"].get<std::string>(),
              HasSubstr("src=\"" + page +
                        "\" width=\"500\" height=\"480\" "
                        "title=\"Sheet &quot;A&quot; &lt;b&gt;\""));
  EXPECT_EQ(embed["thumbnail_width"], 240);
  EXPECT_FALSE(json("/api/v1/oembed?maxheight=100&url=" + page).contains("thumbnail_url"));
}

TEST_F(InterchangeTest, OembedKnowsItsOwnPagesAlone) {
  const auto status = [&](const std::string& query) {
    return get("/api/v1/oembed" + query).status;
  };
  EXPECT_EQ(status("?url=" + page + "?x=1"), 200);
  EXPECT_EQ(status(""), 400);
  EXPECT_EQ(status("?url=" + page + "&maxwidth=0"), 400);
  EXPECT_EQ(status("?url=" + page + "&format=xml"), 501);
  EXPECT_EQ(status("?url=https://elsewhere.example/models/" + id), 404);
  EXPECT_EQ(status("?url=" + origin + ".elsewhere.example/models/" + id), 404);
  EXPECT_EQ(status("?url=" + origin + "/models/"), 404);
}

TEST(Origin, WithoutASettingItIsWhatTheRequestSays) {
  const DisplayedModel shown;
  const std::string target = "/api/v1/iiif/" + shown.id + "/manifest.json";
  const auto id_at = [&](const std::string& host) -> std::string {
    HttpClient client(shown.port());
    client.send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    return Json::parse(client.receive().body)["id"];
  };
  EXPECT_EQ(id_at("museum.example:8080"), "http://museum.example:8080" + target);
  EXPECT_EQ(id_at("a\"b"), target);
}

}  // namespace
}  // namespace vitrine::test
