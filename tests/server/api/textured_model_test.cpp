// SPDX-License-Identifier: Apache-2.0
// Tests how the REST interface shows a textured model: its manifest, blocks, exports and poster.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "codec/build/build_model.h"
#include "codec/import/read_mesh.h"
#include "codec/picture/decode_picture.h"
#include "server/api/routes.h"
#include "server/store/change.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/packages/read_zip.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/textured_mesh.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using ::testing::HasSubstr;
using ::testing::Not;

const BuildResult& torus_model() {
  static const BuildResult model = build_model(test::textured_torus(40, 20, 512), {}, {}).value();
  return model;
}

class TexturedModelApi : public testing::Test {
 protected:
  HttpAnswer ask(const std::string& path) {
    test::HttpClient client(server_.port());
    return client.get(path);
  }
  json manifest() { return json::parse(ask(api_ + "/manifest").body); }
  void limit_to_level(std::uint32_t level) {
    ModelRecord record = server_.catalogue().find(id_).value().value();
    record.public_part = PublicPart{.max_level = level};
    ASSERT_TRUE(change(server_.store(), server_.catalogue(), record));
    server_.services().models.refresh();
  }

  test::LocalServer server_{public_routes()};
  const TextureInfo& texture_ = torus_model().report.manifest.texture;
  const ModelId id_ =
      publish(server_.store(), server_.catalogue(), torus_model().file, {.title = "A"})->id;
  const std::string api_ = "/api/v1/models/" + id_.to_string();
};

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST_F(TexturedModelApi, TheManifestNamesTheAtlasAndThePictures) {
  const json texture = manifest()["texture"];
  EXPECT_EQ(texture["side"], texture_.side);
  EXPECT_EQ(texture["alpha_mode"], "opaque");
  EXPECT_EQ(texture["atlas"]["length"], texture_.atlas_length);
  ASSERT_EQ(texture["pictures"].size(), texture_.pictures.size());
  EXPECT_EQ(texture["pictures"][0]["role"], "base_colour");
  EXPECT_EQ(texture["pictures"][0]["in_head"], true);
  EXPECT_EQ(texture["pictures"].back()["in_head"], false);
  for (const json& picture : texture["pictures"]) {
    const HttpAnswer answer = ask("/api/v1/chunks/" + picture["sha256"].get<std::string>());
    ASSERT_EQ(answer.status, 200);
    EXPECT_THAT(answer.field("cache-control"), HasSubstr("immutable"));
    const auto decoded = decode_picture(bytes_of(answer.body), 1 << 24);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->width, picture["side"]);
  }
}

TEST_F(TexturedModelApi, TheModelCountsItsTextures) {
  std::uint64_t bytes = 0;
  for (const PictureInfo& picture : texture_.pictures)
    bytes += picture.length;
  const json expected = {
      {"count", 1}, {"largest_side", texture_.pictures.back().side}, {"bytes", bytes}};
  EXPECT_EQ(json::parse(ask(api_).body)["textures"], expected);
  EXPECT_EQ(json::parse(ask("/api/v1/models").body)["models"][0]["textures"], expected);
}

TEST_F(TexturedModelApi, TheOriginalsAreServedToThoseWhoAskForThem) {
  const json originals = manifest()["originals"];
  ASSERT_EQ(originals["pictures"].size(), 1u);
  for (const json& block : {originals["description"], originals["pictures"][0]}) {
    const std::string body = ask("/api/v1/chunks/" + block["sha256"].get<std::string>()).body;
    EXPECT_EQ(body.size(), block["length"].get<std::size_t>());
    EXPECT_EQ(to_hex(sha256({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()})),
              block["sha256"].get<std::string>());
  }
}

TEST_F(TexturedModelApi, TheHeadHasTheFirstPicture) {
  const std::string head = ask(api_ + "/head").body;
  const PictureInfo& first = texture_.pictures[0];
  ASSERT_EQ(head.size(), first.offset + first.length);
  EXPECT_TRUE(decode_picture(bytes_of(head).subspan(first.offset), 1 << 24));
}

TEST_F(TexturedModelApi, AGlbHasTheTextureUnlessItIsDeclined) {
  const auto pictures = [&](const std::string& query) {
    const HttpAnswer answer = ask(api_ + "/export.glb" + query);
    EXPECT_EQ(answer.status, 200) << query;
    const auto mesh = read_mesh(bytes_of(answer.body));
    EXPECT_TRUE(mesh);
    std::vector<std::uint32_t> widths;
    for (const EncodedPicture& picture : mesh->texturing.pictures)
      widths.push_back(decode_picture(picture.bytes, 1 << 24).value().width);
    return widths;
  };
  const std::uint32_t coarsest = texture_.pictures.front().side,
                      finest = texture_.pictures.back().side;
  ASSERT_LT(coarsest, finest);
  EXPECT_EQ(pictures(""), std::vector{finest});
  EXPECT_EQ(pictures("?level=lowest"), std::vector{coarsest});
  EXPECT_EQ(pictures("?texture=" + std::to_string(coarsest)), std::vector{coarsest});
  EXPECT_TRUE(pictures("?texture=0").empty());
  EXPECT_TRUE(test::read_zip(ask(api_ + "/export.usdz").body)
                  .contains(id_.to_string() + "_base_colour.jpg"));
  for (const char* wrong : {"-1", "large", "16385"})
    EXPECT_EQ(ask(api_ + "/export.glb?texture=" + wrong).status, 400) << wrong;
}

TEST_F(TexturedModelApi, AZipHasTheMeshAndThePicturesThatItNames) {
  const auto names = [](const std::map<std::string, std::string>& files) {
    std::vector<std::string> all;
    for (const auto& [name, bytes] : files)
      all.push_back(name.substr(name.find_first_of("._")));
    return all;
  };
  const std::uint32_t coarsest = texture_.pictures.front().side;
  const std::string query = "?texture=" + std::to_string(coarsest);
  for (const std::string format : {"obj", "ply", "wrl"}) {
    const HttpAnswer answer = ask(api_ + "/export." + format + ".zip" + query);
    ASSERT_EQ(answer.status, 200);
    EXPECT_EQ(answer.field("content-type"), "application/zip");
    EXPECT_THAT(answer.field("content-disposition"),
                HasSubstr("filename=\"A." + format + ".zip\""));
    const auto files = test::read_zip(answer.body);
    std::vector<std::string> expected = {"." + format, "_base_colour.jpg"};
    if (format == "obj") expected.insert(expected.begin(), ".mtl");
    EXPECT_EQ(names(files), expected);
    const std::string& picture = files.at(id_.to_string() + "_base_colour.jpg");
    EXPECT_EQ(decode_picture(bytes_of(picture), 1 << 24).value().width, coarsest);
    if (format == "wrl") continue;
    ReadOptions options;
    for (const auto& [name, bytes] : files)
      options.beside[companion_key(name)] = bytes_of(bytes);
    const auto mesh = read_mesh(bytes_of(files.at(id_.to_string() + "." + format)), options);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->texturing.pictures.size(), 1u);
    EXPECT_EQ(mesh->texturing.coordinates[0].size(), mesh->mesh.faces.size());
  }
  EXPECT_EQ(test::read_zip(ask(api_ + "/export.ply.zip?texture=0").body).size(), 1u);
  for (const char* unknown : {"/export.glb.zip", "/export.zip", "/export.obj.gz"})
    EXPECT_EQ(ask(api_ + unknown).status, 404) << unknown;
}

TEST_F(TexturedModelApi, ASingleFileThatCannotHoldPicturesNamesNone) {
  for (const std::string format : {"obj", "ply", "wrl"}) {
    const HttpAnswer answer = ask(api_ + "/export." + format + "?texture=100");
    ASSERT_EQ(answer.status, 200);
    EXPECT_THAT(answer.body, Not(HasSubstr("_base_colour"))) << format;
  }
}

TEST_F(TexturedModelApi, ALimitedModelShowsOnlyThePictureOfItsHead) {
  limit_to_level(0);
  EXPECT_EQ(manifest()["texture"]["pictures"].size(), 1u);
  EXPECT_EQ(json::parse(ask(api_).body)["textures"]["bytes"], texture_.pictures.front().length);
  EXPECT_EQ(ask("/api/v1/chunks/" + to_hex(texture_.pictures.back().sha256)).status, 404);
  EXPECT_EQ(ask("/api/v1/chunks/" + to_hex(texture_.pictures.front().sha256)).status, 200);
  EXPECT_EQ(ask(api_ + "/export.glb").status, 200);
}

TEST_F(TexturedModelApi, ALimitHidesTheOriginalsEvenAtTheFinestLevel) {
  const json originals = manifest()["originals"];
  const auto finest = static_cast<std::uint32_t>(torus_model().report.manifest.levels.size() - 1);
  EXPECT_THAT(ask(api_ + "/file.pmesh").body, HasSubstr("picture.png"));
  for (const std::uint32_t level : {0u, finest}) {
    limit_to_level(level);
    EXPECT_TRUE(manifest()["originals"].is_null());
    EXPECT_THAT(ask(api_ + "/file.pmesh").body, Not(HasSubstr("picture.png")));
    for (const json& block : {originals["description"], originals["pictures"][0]}) {
      for (const std::string& route : {std::string("/api/v1"), api_})
        EXPECT_EQ(ask(route + "/chunks/" + block["sha256"].get<std::string>()).status, 404);
    }
  }
  EXPECT_EQ(manifest()["texture"]["pictures"].size(), texture_.pictures.size());
}

TEST_F(TexturedModelApi, ThePosterShowsTheTexture) {
  const std::string poster = ask(api_ + "/poster.png?width=240").body;
  const Picture picture = decode_picture(bytes_of(poster), 1 << 24).value();
  std::set<std::uint8_t> hues;  // green minus blue of each opaque pixel; only 0 in a grey picture
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
    if (picture.pixels[i + 3] == 255)
      hues.insert(static_cast<std::uint8_t>(picture.pixels[i + 1] - picture.pixels[i + 2]));
  }
  EXPECT_GT(hues.size(), 30u);
}

}  // namespace
}  // namespace vitrine::server
