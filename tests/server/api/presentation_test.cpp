// SPDX-License-Identifier: Apache-2.0
// Tests that a model's presentation can be changed, and that everything that shows the model obeys
// it: manifest, head, dimensions, exports, tileset and posters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "codec/build/build_model.h"
#include "codec/core/bounds.h"
#include "codec/export/write_mesh.h"
#include "codec/import/read_mesh.h"
#include "codec/picture/decode_picture.h"
#include "server/api/routes.h"
#include "server/store/change.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/meshes.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/read_export.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using ::testing::HasSubstr;

const double kHalf = std::sqrt(0.5);
// Turns z up to y up.
const json kZUp = {-kHalf, 0, 0, kHalf};
const json kOblique = {0.1, 0.2, 0.3, std::sqrt(1 - 0.14)};

// Returns the model of a torus whose bounding box has three different side lengths.
std::vector<std::uint8_t> ring(int around) {
  TriangleMesh mesh = test::torus(around, 20);
  for (Vec3& p : mesh.positions)
    p = {p.x * 3, p.y * 2, p.z};
  const auto ply = write_mesh(mesh, MeshFormat::kPly, {.unit = "mm"});
  return build_model(*ply, {}, {}).value().file;
}

void expect_near(const Bounds& box, const Bounds& wanted, const std::string& what) {
  const double most = 1e-4 * wanted.longest_side();
  EXPECT_LT(length(box.low - wanted.low), most) << what;
  EXPECT_LT(length(box.high - wanted.high), most) << what;
}

class PresentationApi : public testing::Test {
 protected:
  HttpAnswer get(const std::string& rest, const std::string& fields = "") {
    return test::HttpClient(server_.port()).get("/api/v1/models/" + id_.to_string() + rest, fields);
  }
  HttpAnswer patch(const json& presentation, const std::string& fields = "") {
    test::HttpClient client(server_.port());
    const std::string body = json{{"presentation", presentation}}.dump();
    client.send("PATCH /api/v1/models/" + id_.to_string() + " HTTP/1.1\r\nHost: a\r\n" +
                (fields.empty() ? operator_ : fields) + "Content-Type: application/json\r\n" +
                fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body));
    return client.receive();
  }
  void present(const json& presentation) {
    const HttpAnswer answer = patch(presentation);
    ASSERT_EQ(answer.status, 200) << answer.body;
  }
  json shown(const std::string& rest = "") { return json::parse(get(rest).body); }
  Presentation stored() { return server_.catalogue().find(id_).value().value().presentation; }

  Bounds exported(MeshFormat format, const std::string& query = "") {
    const std::string name(row_of(format).extension);
    const std::string up = row_of(format).has_fixed_up ? "" : "up=y";
    const HttpAnswer answer = get("/export." + name + "?" + up + query);
    EXPECT_EQ(answer.status, 200) << answer.body;
    const std::span file(reinterpret_cast<const std::uint8_t*>(answer.body.data()),
                         answer.body.size());
    return bounds_of(test::read_export(file, format).positions);
  }
  // Returns the box of the pixels of the poster that are not transparent.
  Bounds silhouette() {
    const std::string file = get("/poster.png?width=240").body;
    const Picture picture =
        decode_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, 1 << 24)
            .value();
    std::vector<Vec3> drawn;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
      for (std::uint32_t x = 0; x < picture.width; ++x) {
        if (picture.pixels[4 * (std::size_t{y} * picture.width + x) + 3] > 127)
          drawn.push_back({double(x), double(y), 0});
      }
    }
    return drawn.empty() ? Bounds{} : bounds_of(drawn);
  }

  test::LocalServer server_{public_routes()};
  const std::string operator_ = server_.bearer(Role::kOperator);
  const ModelId id_ =
      publish(server_.store(), server_.catalogue(), ring(40), {.title = "Ring"})->id;
};

TEST_F(PresentationApi, IsChangedWithoutANewFile) {
  const json before = shown();
  EXPECT_EQ(before["presentation"]["rotation"], (json{0, 0, 0, 1}));
  EXPECT_EQ(before["presentation"]["view"], nullptr);
  const std::string head = get("/head").body, file = get("/file.pmesh").field("etag");
  present({{"rotation", kZUp}, {"scale", 2}, {"view", {{"azimuth", 90}}}});
  const json after = shown();
  EXPECT_EQ(after["presentation"]["scale"], 2);
  EXPECT_EQ(after["presentation"]["view"]["azimuth"], 90);
  EXPECT_EQ(after["bytes"], before["bytes"]);
  EXPECT_EQ(shown("/manifest")["presentation"], after["presentation"]);
  EXPECT_EQ(get("/head").body, head);
  EXPECT_EQ(get("/file.pmesh").field("etag"), file);
  present(nullptr);
  EXPECT_EQ(shown()["presentation"], before["presentation"]);
}

TEST_F(PresentationApi, ComesWithTheHeadSoThatNoSecondRequestIsNeeded) {
  const HttpAnswer plain = get("/head");
  EXPECT_EQ(plain.field("vitrine-presentation"), "");
  present({{"scale", 2}});
  const HttpAnswer turned = get("/head", "Origin: https://other.example\r\n");
  EXPECT_EQ(json::parse(turned.field("vitrine-presentation")), shown()["presentation"]);
  EXPECT_THAT(turned.field("access-control-expose-headers"), HasSubstr("Vitrine-Presentation"));
  EXPECT_NE(turned.field("etag"), plain.field("etag"));
  const std::string known = "If-None-Match: " + plain.field("etag") + "\r\n";
  EXPECT_EQ(get("/head", known).status, 200) << "a kept head would be shown as before";
  present(nullptr);
  EXPECT_EQ(get("/head", known).status, 304);
}

TEST_F(PresentationApi, NeedsAnOperatorAndTheStateThatWasRead) {
  EXPECT_EQ(patch({{"scale", 2}}, "X: y\r\n").status, 401);
  EXPECT_EQ(patch({{"scale", 2}}, server_.bearer(Role::kViewer)).status, 403);
  const std::string read = "If-Match: " + get("").field("etag") + "\r\n";
  EXPECT_EQ(patch({{"scale", 2}}, operator_ + read).status, 200);
  EXPECT_EQ(patch({{"scale", 3}}, operator_ + read).status, 412);
  EXPECT_EQ(stored().scale, 2);
}

TEST_F(PresentationApi, NamesTheWrongFieldAndChangesNothing) {
  const HttpAnswer answer = patch({{"scale", 2}, {"view", {{"zoom", -1}}}});
  EXPECT_EQ(answer.status, 422);
  EXPECT_EQ(json::parse(answer.body)["errors"][0]["parameter"], "presentation.view.zoom");
  const HttpAnswer none = patch(3);
  EXPECT_EQ(json::parse(none.body)["errors"][0]["parameter"], "presentation");
  EXPECT_TRUE(stored().is_default());
}

TEST_F(PresentationApi, ExportsOfAllFormatsObeyIt) {
  for (const json& rotation : {kZUp, kOblique}) {
    present(nullptr);
    std::map<MeshFormat, Bounds> before;
    for (const ExportFormat& row : kExportFormats)
      before[row.format] = exported(row.format);
    present({{"rotation", rotation}, {"scale", 2}});
    const PresentationTransform placement(stored());
    for (const ExportFormat& row : kExportFormats) {
      const Bounds box = exported(row.format), plain = before[row.format];
      if (placement.keeps_axes()) {
        expect_near(box, placement.of(plain), std::string(row.name));
      } else {
        const Bounds ply = exported(MeshFormat::kPly);
        const double factor = plain.longest_side() / before[MeshFormat::kPly].longest_side();
        expect_near(box, {ply.low * factor, ply.high * factor}, std::string(row.name));
      }
    }
  }
}

TEST_F(PresentationApi, PositionsOfExportsAreThoseOfTheFileTurnedAndScaled) {
  const auto positions = [&] {
    const std::string file = get("/export.ply").body;
    return read_mesh({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()})
        ->mesh.positions;
  };
  const std::vector<Vec3> before = positions();
  present({{"rotation", kOblique}, {"scale", 3}});
  const std::vector<Vec3> after = positions();
  const PresentationTransform placement(stored());
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i)
    ASSERT_LT(length(after[i] - placement(before[i])), 1e-4 * length(before[i])) << i;
}

TEST_F(PresentationApi, CompressedFilesAndFilesOfSeveralLevelsObeyIt) {
  present({{"rotation", kOblique}, {"scale", 2}});
  const Bounds plain = exported(MeshFormat::kGlb);
  const std::string draco = get("/export.glb?compression=draco").body;
  const auto read = read_mesh({reinterpret_cast<const std::uint8_t*>(draco.data()), draco.size()});
  ASSERT_TRUE(read);
  const Bounds box = bounds_of(read->mesh.positions);
  EXPECT_LT(length(box.high - box.low - (plain.high - plain.low)), 1e-2 * plain.longest_side());
  const std::string levels = get("/export.glb?lod=msft").body;
  std::uint32_t size = 0;
  std::memcpy(&size, levels.data() + 12, sizeof size);
  int meshes = 0;
  const json file = json::parse(levels.substr(20, size));
  for (const json& accessor : file["accessors"]) {
    if (!accessor.contains("min") || accessor["type"] != "VEC3") continue;
    ++meshes;
    const double height = accessor["max"][1].get<double>() - accessor["min"][1].get<double>();
    EXPECT_NEAR(height, plain.high.y - plain.low.y, 0.2 * (plain.high.y - plain.low.y));
  }
  EXPECT_GT(meshes, 1);
}

TEST_F(PresentationApi, ExportsStateTheirErrorInTheirUnit) {
  const auto error = [&] {
    const std::string file = get("/export.ply?level=lowest").body;
    return std::stod(file.substr(file.find("comment error ") + 14));
  };
  const double before = error();
  present({{"scale", 10}});
  EXPECT_NEAR(error(), 10 * before, 1e-3 * before);
}

TEST_F(PresentationApi, DimensionsAreThoseOfExportedFiles) {
  for (const json& rotation : {kZUp, kOblique}) {
    present({{"rotation", rotation}, {"scale", 2}});
    const Bounds box = exported(MeshFormat::kPly);
    const Vec3 size = box.high - box.low;
    const json dimensions = shown()["dimensions"];
    EXPECT_NEAR(dimensions["width"], size.x, 1e-3 * size.x) << rotation;
    EXPECT_NEAR(dimensions["height"], size.y, 1e-3 * size.y) << rotation;
    EXPECT_NEAR(dimensions["depth"], size.z, 1e-3 * size.z) << rotation;
  }
  const double width = shown()["dimensions"]["width"];
  present({{"scale", 4}});  // the rotation stays
  EXPECT_NEAR(shown()["dimensions"]["width"], 2 * width, 1e-3 * width);
}

TEST_F(PresentationApi, TheTilesetEnclosesThePresentedModel) {
  present({{"rotation", kOblique}, {"scale", 2}});
  const std::vector<double> box = shown("/tileset.json")["root"]["boundingVolume"]["box"];
  const Bounds glb = exported(MeshFormat::kGlb);  // in metres, with y up
  const Vec3 centre = glb.centre(), size = glb.high - glb.low;
  EXPECT_NEAR(box[0], centre.x, 1e-3 * size.x);
  EXPECT_NEAR(box[1], -centre.z, 1e-3 * size.z);
  EXPECT_NEAR(box[2], centre.y, 1e-3 * size.y);
  EXPECT_GE(box[3], size.x / 2 * 0.999);
  EXPECT_GE(box[11], size.y / 2 * 0.999);
  EXPECT_LT(box[3], size.x);
}

TEST_F(PresentationApi, PostersShowTheModelUprightAndFromTheChosenSide) {
  const HttpAnswer first = get("/poster.png?width=240");
  const auto expect_ratio = [&](double width, double height, const char* what) {
    const Vec3 drawn = silhouette().high - silhouette().low;
    EXPECT_NEAR(drawn.y, drawn.x * height / width, 3) << what << ", in pixels";
  };
  present({{"view", {{"azimuth", 0}, {"elevation", 0}}}});
  EXPECT_NE(get("/poster.png?width=240").field("etag"), first.field("etag"));
  Bounds box = exported(MeshFormat::kPly);
  expect_ratio(box.high.x - box.low.x, box.high.y - box.low.y, "from the front");
  present({{"rotation", kZUp}});
  box = exported(MeshFormat::kPly);
  expect_ratio(box.high.x - box.low.x, box.high.y - box.low.y, "upright");
  present({{"poster", {{"azimuth", 90}, {"elevation", 0}}}});
  expect_ratio(box.high.z - box.low.z, box.high.y - box.low.y, "from the side");
  const double before = silhouette().longest_side();
  present({{"poster", {{"zoom", 0.5}}}});
  EXPECT_NEAR(silhouette().longest_side(), before / 2, 3);
  present(nullptr);
  EXPECT_EQ(get("/poster.png?width=240").field("etag"), first.field("etag"));
}

TEST_F(PresentationApi, StaysWithCapsWithdrawalAndANewFile) {
  present({{"rotation", kOblique}});
  const auto edit = [&](const std::function<void(ModelRecord&)>& change_it) {
    ModelRecord record = server_.catalogue().find(id_).value().value();
    change_it(record);
    ASSERT_TRUE(change(server_.store(), server_.catalogue(), record));
    server_.services().models.refresh();
  };
  edit([](ModelRecord& record) { record.public_part = PublicPart{.max_level = 1}; });
  const json visitors = shown("/manifest");
  EXPECT_LT(visitors["levels"].size(),
            json::parse(get("/manifest", operator_).body)["levels"].size());
  EXPECT_NE(visitors["presentation"]["rotation"], (json{0, 0, 0, 1}));
  edit([](ModelRecord& record) { record.public_part.reset(); });
  const Bounds first = stored().turned_box.value();
  ASSERT_TRUE(replace(server_.store(), server_.catalogue(), ring(12), {}, {.id = id_}));
  server_.services().models.refresh();
  EXPECT_NE(stored().turned_box->low, first.low) << "belongs to the file before";
  const Bounds box = exported(MeshFormat::kPly);
  EXPECT_NEAR(shown()["dimensions"]["height"], box.high.y - box.low.y, 1e-3 * box.longest_side());
  ASSERT_TRUE(server_.catalogue().set_state(id_, ModelState::kDraft));
  server_.services().models.refresh();
  for (const char* rest : {"", "/manifest", "/head", "/poster.png", "/export.ply"})
    EXPECT_EQ(get(rest).status, 404) << rest;
}

}  // namespace
}  // namespace vitrine::server
