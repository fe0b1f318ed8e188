// SPDX-License-Identifier: Apache-2.0
// Tests the tileset of a model, and the levels of `export.glb?lod=msft`. tests/web/exports shows
// both in other viewers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "codec/build/build_model.h"
#include "codec/build/coarser_levels.h"
#include "codec/core/bounds.h"
#include "codec/export/write_mesh.h"
#include "codec/import/read_mesh.h"
#include "codec/mesh/up_axis.h"
#include "server/api/routes.h"
#include "server/store/change.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/meshes.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/textured_mesh.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using ::testing::HasSubstr;

const BuildResult& ring_in_mm() {
  static const BuildResult ring = [] {
    const auto ply = write_mesh(test::torus(80, 60), MeshFormat::kPly, {.unit = "mm"});
    return build_model(*ply, {}, {}).value();
  }();
  return ring;
}

class TilesetApi : public testing::Test {
 protected:
  ModelId add(const BuildResult& model) {
    return publish(server_.store(), server_.catalogue(), model.file, {.title = "Ring"})->id;
  }
  HttpAnswer ask(const std::string& rest, const std::string& fields = "") {
    return test::HttpClient(server_.port()).get("/api/v1/models/" + rest, fields);
  }
  // Returns the tiles of the model, from the base mesh to the finest level.
  std::vector<json> tiles(const ModelId& id, const std::string& fields = "") {
    const HttpAnswer answer = ask(id.to_string() + "/tileset.json", fields);
    EXPECT_EQ(answer.status, 200);
    std::vector<json> all = {json::parse(answer.body)["root"]};
    while (all.back().contains("children")) {
      EXPECT_EQ(all.back()["children"].size(), 1u);
      json next = all.back()["children"][0];
      all.push_back(std::move(next));
    }
    return all;
  }
  // Returns the mesh that a tile's file contains.
  TriangleMesh mesh_of(const ModelId& id, const json& tile) {
    const HttpAnswer answer = ask(id.to_string() + "/" + tile["content"]["uri"].get<std::string>());
    EXPECT_EQ(answer.status, 200);
    auto read =
        read_mesh({reinterpret_cast<const std::uint8_t*>(answer.body.data()), answer.body.size()});
    EXPECT_TRUE(read);
    return read ? std::move(read->mesh) : TriangleMesh{};
  }
  void update(const ModelId& id, const std::function<void(ModelRecord&)>& edit) {
    ModelRecord record = server_.catalogue().find(id).value().value();
    edit(record);
    ASSERT_TRUE(change(server_.store(), server_.catalogue(), record));
    server_.services().models.refresh();
  }

  test::LocalServer server_{public_routes()};
  // Comes from the file's header, because the header stores the errors in single precision.
  const Manifest manifest_ = parse_header(ring_in_mm().file).value();
  const std::vector<LevelInfo>& levels_ = manifest_.levels;
  const std::uint32_t last_ = static_cast<std::uint32_t>(levels_.size() - 1);
  const ModelId id_ = add(ring_in_mm());
};

TEST_F(TilesetApi, HasATileForEachChosenLevelFromTheBaseMeshOn) {
  auto chosen = coarser_levels(manifest_, last_, levels_[last_].faces);
  ASSERT_GE(chosen.size(), 2u);
  std::ranges::reverse(chosen);
  chosen.push_back(last_);
  const auto all = tiles(id_);
  ASSERT_EQ(all.size(), chosen.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i]["refine"], "REPLACE");
    EXPECT_EQ(mesh_of(id_, all[i]).faces.size(), levels_[chosen[i]].faces);
    const double error = i + 1 == all.size() ? 0 : levels_[chosen[i]].max_error / 1000;
    EXPECT_DOUBLE_EQ(all[i]["geometricError"], error) << "in metres";
  }
}

TEST_F(TilesetApi, HasABoxWithZUpAroundAllLevels) {
  const json whole = json::parse(ask(id_.to_string() + "/tileset.json").body);
  EXPECT_EQ(whole["asset"], (json{{"version", "1.1"}}));
  for (const json& tile : tiles(id_)) {
    const std::vector<double> box = tile["boundingVolume"]["box"];
    ASSERT_EQ(box.size(), 12u);
    const Vec3 centre{box[0], box[1], box[2]}, half{box[3], box[7], box[11]};
    Bounds mesh{centre, centre};
    for (const Vec3& p : mesh_of(id_, tile).positions) {
      const Vec3 at = turn_y_up_to_z(p) - centre;
      EXPECT_TRUE(std::abs(at.x) <= half.x && std::abs(at.y) <= half.y && std::abs(at.z) <= half.z);
      mesh = bounds_of(std::array{mesh.low, mesh.high, turn_y_up_to_z(p)});
    }
    EXPECT_LT(length(half) * 2, 1.3 * length(mesh.high - mesh.low));
    EXPECT_NEAR(whole["geometricError"], length(mesh.high - mesh.low),
                0.1 * length(mesh.high - mesh.low));
  }
}

TEST_F(TilesetApi, TakesAModelWithoutAUnitToBeInMetres) {
  update(id_, [](ModelRecord& record) { record.unit = ""; });
  const auto all = tiles(id_);
  EXPECT_DOUBLE_EQ(all.front()["geometricError"], levels_.front().max_error);
}

TEST_F(TilesetApi, EndsAtTheLastLevelThatTheCallerMaySee) {
  update(id_, [](ModelRecord& record) { record.public_part = PublicPart{.max_level = 2}; });
  const auto shown = tiles(id_);
  EXPECT_LE(mesh_of(id_, shown.back()).faces.size(), levels_[2].faces);
  EXPECT_EQ(shown.back()["geometricError"], 0);
  const HttpAnswer owner = ask(id_.to_string() + "/tileset.json", server_.bearer(Role::kViewer));
  EXPECT_THAT(owner.body, HasSubstr(fmt::format("level={}", last_)));
  EXPECT_THAT(owner.field("cache-control"), HasSubstr("private"));
  update(id_, [](ModelRecord& record) { record.state = ModelState::kDraft; });
  EXPECT_EQ(ask(id_.to_string() + "/tileset.json").status, 404);
}

TEST_F(TilesetApi, IsAnEntityForPagesOfAllSites) {
  const std::string path = id_.to_string() + "/tileset.json";
  const HttpAnswer answer = ask(path);
  EXPECT_EQ(answer.field("content-type"), "application/json");
  EXPECT_EQ(answer.field("access-control-allow-origin"), "*");
  EXPECT_EQ(answer.field("cache-control"), "no-cache");
  EXPECT_EQ(ask(path, "If-None-Match: " + answer.field("etag") + "\r\n").status, 304);
  EXPECT_EQ(ask(ModelId::generate().to_string() + "/tileset.json").status, 404);
}

// Returns the numbers of faces of all meshes in a GLB.
std::vector<std::size_t> faces_in(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  const json file = json::parse(glb.substr(20, size));
  std::vector<std::size_t> faces;
  for (const json& mesh : file["meshes"]) {
    const std::size_t indices = mesh["primitives"][0]["indices"];
    faces.push_back(file["accessors"][indices]["count"].get<std::size_t>() / 3);
  }
  return faces;
}

TEST_F(TilesetApi, AGlbHoldsTheSameLevelsOnRequest) {
  server_.services().exports.set_capacity(1 << 24);
  const std::string path = id_.to_string() + "/export.glb";
  const std::string plain = ask(path).body;
  std::vector<std::size_t> wanted;
  for (const json& tile : tiles(id_))
    wanted.insert(wanted.begin(), mesh_of(id_, tile).faces.size());
  for (const char* compression : {"none", "meshopt", "draco"})
    EXPECT_EQ(faces_in(ask(path + "?lod=msft&compression=" + compression).body), wanted);
  EXPECT_EQ(ask(path + "?lod=none").body, plain);
  EXPECT_EQ(ask(path).body, plain) << "the cache keeps both";

  const auto smaller = faces_in(ask(path + "?lod=msft&triangles=2000").body);
  EXPECT_LE(smaller.at(0), 2000u);
  EXPECT_EQ(smaller.back(), levels_[0].faces);
  EXPECT_EQ(faces_in(ask(path + "?lod=msft&level=0").body).size(), 1u);
  for (const std::string wrong : {"glb?lod=", "glb?lod=yes", "ply?lod=msft", "obj.zip?lod=msft"})
    EXPECT_EQ(ask(id_.to_string() + "/export." + wrong).status, 400) << wrong;
}

TEST_F(TilesetApi, TheLevelsOfATexturedGlbShareItsPictures) {
  const ModelId textured = add(build_model(test::textured_torus(40, 20, 256), {}, {}).value());
  const std::string glb = ask(textured.to_string() + "/export.glb?lod=msft").body;
  EXPECT_GE(faces_in(glb).size(), 2u);
  const auto read = read_mesh({reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size()});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->texturing.pictures.size(), 1u);
  EXPECT_EQ(faces_in(ask(textured.to_string() + "/export.glb?lod=msft&texture=0").body),
            faces_in(glb));
}

}  // namespace
}  // namespace vitrine::server
