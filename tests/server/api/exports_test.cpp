// SPDX-License-Identifier: Apache-2.0
// Tests the descriptions, units, axes and compression of exported files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "codec/build/build_model.h"
#include "codec/core/bounds.h"
#include "codec/export/write_mesh.h"
#include "codec/import/read_mesh.h"
#include "server/api/routes.h"
#include "server/store/change.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/meshes.h"
#include "support/packages/gunzip.h"
#include "support/process/http_client.h"
#include "support/product_names.h"

namespace vitrine::server {
namespace {

using test::HttpAnswer;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

BuildResult torus_in(std::string_view unit) {
  const auto ply = write_mesh(test::torus(40, 20), MeshFormat::kPly, {.unit = unit});
  return build_model(*ply, {}, {}).value();
}

class ExportsApi : public testing::Test {
 protected:
  ModelId add(std::string_view unit) {
    return publish(server_.store(), server_.catalogue(), torus_in(unit).file,
                   {.title = "Bust", .creator = "Ada", .rights = "A", .licence = "CC0-1.0"})
        ->id;
  }
  HttpAnswer ask(const std::string& path, const std::string& fields = "") {
    test::HttpClient client(server_.port());
    return client.get("/api/v1/models/" + path, fields);
  }
  static Bounds bounds_in(const std::string& file) {
    const auto read = read_mesh({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
    EXPECT_TRUE(read);
    return read ? bounds_of(read->mesh.positions) : Bounds{};
  }

  test::LocalServer server_{public_routes()};
  const ModelId id_ = add("m");
  const std::string path_ = id_.to_string() + "/export.";
};

TEST_F(ExportsApi, SayWhatTheyAreAndWhereTheyAreFrom) {
  for (const std::string format : {"ply", "obj", "wrl"}) {
    const std::string file = ask(path_ + format + "?level=lowest").body;
    for (const std::string line : {"creator Ada", "licence CC0-1.0", "level 0", "error "})
      EXPECT_THAT(file, HasSubstr(line)) << format;
    EXPECT_THAT(file, HasSubstr("/models/" + id_.to_string())) << format;
  }
  EXPECT_THAT(ask(path_ + "glb").body, HasSubstr(R"("copyright":"Ada, A, CC0-1.0")"));
  EXPECT_THAT(ask(path_ + "usdz").body, HasSubstr("string creator = \"Ada\"\n"));
  EXPECT_THAT(ask(path_ + "stl").body, StartsWith("Vitrine, unit mm, up z, Bust, CC0-1.0"));
}

TEST_F(ExportsApi, ANewTitleIsInTheNextExport) {
  server_.services().exports.set_capacity(1 << 24);
  EXPECT_THAT(ask(path_ + "ply").body, HasSubstr("\ncomment title Bust\n"));
  ModelRecord record = server_.catalogue().find(id_).value().value();
  record.title = "Head";
  ASSERT_TRUE(change(server_.store(), server_.catalogue(), record));
  server_.services().models.refresh();
  EXPECT_THAT(ask(path_ + "ply").body, HasSubstr("\ncomment title Head\n"));
}

TEST_F(ExportsApi, HaveTheUnitAndTheAxisOfTheFormatOrOfTheQuery) {
  const Bounds box = bounds_in(ask(path_ + "ply").body);
  const Bounds stl = bounds_in(ask(path_ + "stl").body);
  const Vec3 size = box.high - box.low;
  EXPECT_NEAR(stl.high.x - stl.low.x, size.x * 1000, 1e-3);
  EXPECT_NEAR(stl.high.y - stl.low.y, size.z * 1000, 1e-3);
  EXPECT_NEAR(stl.high.z - stl.low.z, size.y * 1000, 1e-3);
  const Bounds asked = bounds_in(ask(path_ + "stl?unit=m&up=y").body);
  EXPECT_NEAR(asked.high.y, box.high.y, 1e-6);
  const Bounds turned = bounds_in(ask(path_ + "ply?unit=cm&up=z").body);
  EXPECT_NEAR(turned.high.z, box.high.y * 100, 1e-4);
  const Bounds printed = bounds_in(ask(path_ + "3mf").body);  // the reader turns z up to y up
  EXPECT_NEAR(printed.high.y, box.high.y * 1000, 1e-3);
  EXPECT_THAT(ask(path_ + "usdz").body, HasSubstr("metersPerUnit = 1\n"));
}

TEST_F(ExportsApi, RefuseUnitsAndAxesThatTheFormatCannotHave) {
  for (const char* wrong : {"ply?unit=yard", "ply?up=x", "glb?unit=mm", "glb?up=z", "wrl?unit=in",
                            "3mf?up=y", "usdz?unit=yard"})
    EXPECT_EQ(ask(path_ + wrong).status, 400) << wrong;
  for (const char* right : {"glb?unit=m&up=y", "3mf?unit=in&up=z", "usdz?unit=cm&up=z"})
    EXPECT_EQ(ask(path_ + right).status, 200) << right;
}

TEST_F(ExportsApi, SayThatTheUnitIsUnknown) {
  const std::string unknown = add("").to_string() + "/export.";
  EXPECT_THAT(ask(unknown + "ply").body, HasSubstr("\ncomment unit unknown\n"));
  EXPECT_THAT(ask(unknown + "stl").body, StartsWith("Vitrine, unit unknown"));
  EXPECT_THAT(ask(unknown + "glb").body, HasSubstr("one unit is written as one metre"));
  const HttpAnswer refused = ask(unknown + "ply?unit=mm");
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("the unit of this model is unknown"));
}

TEST_F(ExportsApi, TheOpenapiDocumentListsTheirMediaTypes) {
  test::HttpClient client(server_.port());
  const auto document = nlohmann::json::parse(client.get("/api/v1/openapi.json").body);
  const auto& content = document["paths"]["/api/v1/models/{id}/export.{format}"]["get"]["responses"]
                                ["200"]["content"];
  for (const ExportFormat& row : kExportFormats)
    EXPECT_TRUE(content.contains(std::string(row.media_type))) << row.media_type;
  EXPECT_TRUE(content.contains("application/zip"));
}

TEST_F(ExportsApi, TextIsCompressedForClientsThatTakeIt) {
  const std::string gzip = "Accept-Encoding: gzip\r\n";
  for (const std::string format : {"obj", "wrl"}) {
    const HttpAnswer plain = ask(path_ + format), packed = ask(path_ + format, gzip);
    EXPECT_EQ(plain.field("content-encoding"), "");
    EXPECT_EQ(packed.field("content-encoding"), "gzip");
    for (const HttpAnswer& answer : {plain, packed})
      EXPECT_EQ(answer.field("vary"), "Save-Data, Accept-Encoding");
    EXPECT_EQ(test::gunzip(packed.body), plain.body);
    EXPECT_NE(packed.field("etag"), plain.field("etag"));
    const HttpAnswer private_one = ask(path_ + format, gzip + server_.bearer(Role::kViewer));
    EXPECT_EQ(private_one.field("content-encoding"), "");
    EXPECT_EQ(ask(path_ + format, "Accept-Encoding: gzip;q=0\r\n").body, plain.body);
  }
  for (const std::string format : {"ply", "glb", "stl", "drc", "3mf", "usdz", "obj.zip"}) {
    const HttpAnswer answer = ask(path_ + format, gzip);
    EXPECT_EQ(answer.status, 200) << format;
    EXPECT_EQ(answer.field("content-encoding"), "") << format;
  }
}

TEST_F(ExportsApi, ConditionsAndRangesReferToTheCompressedText) {
  const std::string gzip = "Accept-Encoding: gzip\r\n", range = "Range: bytes=100-199\r\n";
  const HttpAnswer plain = ask(path_ + "obj"), packed = ask(path_ + "obj", gzip);
  const std::string tag = packed.field("etag"), plain_tag = plain.field("etag");
  EXPECT_EQ(ask(path_ + "obj", gzip + "If-None-Match: " + tag + "\r\n").status, 304);
  EXPECT_EQ(ask(path_ + "obj", gzip + "If-None-Match: " + plain_tag + "\r\n").status, 200);
  EXPECT_EQ(ask(path_ + "obj", "If-None-Match: " + tag + "\r\n").status, 200);
  const HttpAnswer part = ask(path_ + "obj", gzip + range + "If-Range: " + tag + "\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.field("content-encoding"), "gzip");
  EXPECT_EQ(part.body, packed.body.substr(100, 100));
  EXPECT_EQ(ask(path_ + "obj", gzip + range + "If-Range: " + plain_tag + "\r\n").body, packed.body);
  EXPECT_EQ(ask(path_ + "obj", range).body, plain.body.substr(100, 100));
}

TEST_F(ExportsApi, ATextIsCompressedOnce) {
  ExportCache& cache = server_.services().exports;
  cache.set_capacity(1 << 24);
  const std::string gzip = "Accept-Encoding: gzip\r\n";
  const HttpAnswer first = ask(path_ + "obj", gzip);
  const auto made = cache.made.load();
  EXPECT_EQ(ask(path_ + "obj", gzip).body, first.body);
  EXPECT_EQ(cache.made, made);
  EXPECT_EQ(cache.bytes(), first.body.size());  // the uncompressed text is not cached
}

TEST_F(ExportsApi, AGlbIsCompressedOnRequest) {
  const std::string plain = ask(path_ + "glb").body;
  const Bounds box = bounds_in(plain);
  for (const std::string name : {"meshopt", "draco"}) {
    const std::string file = ask(path_ + "glb?compression=" + name).body;
    EXPECT_LT(file.size(), plain.size() / 2) << name;
    EXPECT_THAT(file, HasSubstr(name));
    const Bounds found = bounds_in(file);
    EXPECT_NEAR(found.low.x, box.low.x, 1e-5);
    EXPECT_NEAR(found.high.y, box.high.y, 1e-5);
  }
  EXPECT_EQ(ask(path_ + "glb?compression=none").body, plain);
  EXPECT_EQ(ask(path_ + "glb?compression=zip").status, 400);
  EXPECT_EQ(ask(path_ + "ply?compression=draco").status, 400);
}

}  // namespace
}  // namespace vitrine::server
