// SPDX-License-Identifier: Apache-2.0
// Tests how the real daemon exports a model that build_model() has made.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "displayed_model.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

// Returns the number after "element face " in a PLY header.
std::uint64_t ply_faces(const std::string& file) {
  constexpr std::string_view kElement = "element face ";
  const std::size_t at = file.find(kElement);
  return at == std::string::npos ? 0 : std::stoul(file.substr(at + kElement.size(), 12));
}

// Returns the value of an unlabelled sample of /metrics.
int metric(std::uint16_t admin_port, const std::string& name) {
  const std::string text = http_get(admin_port, "/metrics").body;
  return std::stoi(text.substr(text.find("\n" + name + " ") + name.size() + 2));
}

class ExportTest : public ::testing::Test, public DisplayedModel {
 protected:
  int made() const { return metric(daemon.admin_port(), "vitrine_exports_made_total"); }
  int hits() const { return metric(daemon.admin_port(), "vitrine_export_cache_hits_total"); }
  // Waits until the daemon has made three posters of the model for visitors, and has found that
  // clients with a token can get the same posters.
  void await_posters() const {
    while (hits() < 3)
      std::this_thread::yield();
    EXPECT_EQ(made(), 3);
  }
  HttpAnswer get(const std::string& rest, const std::string& fields = "") const {
    return http_get(port(), api + "/export." + rest, fields);
  }
};

TEST_F(ExportTest, GivesTheLevelThatIsAskedFor) {
  EXPECT_EQ(ply_faces(get("ply?level=lowest").body), levels.front().faces);
  EXPECT_EQ(ply_faces(get("ply?level=1").body), levels[1].faces);
  EXPECT_EQ(ply_faces(get("ply?level=highest").body), 6962u);
  EXPECT_EQ(ply_faces(get("ply").body), 6962u);
}

TEST_F(ExportTest, MeetsTrianglesBytesAndError) {
  const std::uint64_t faces = ply_faces(get("ply?triangles=3000").body);
  EXPECT_LE(faces, 3000u);
  EXPECT_GE(faces, 2700u);
  const Manifest& manifest = built_model().report.manifest;
  EXPECT_EQ(ply_faces(get("ply?bytes=" + std::to_string(manifest.cumulative_bytes(1))).body),
            levels[1].faces);
  EXPECT_EQ(ply_faces(get("ply?error=1e9").body), levels.front().faces);
  const double kilobits = static_cast<double>(manifest.cumulative_bytes(1)) * 8 / 1000;
  const std::string line = fmt::format("ply?seconds=2&kbps={}", kilobits / 2 + 0.001);
  EXPECT_EQ(ply_faces(get(line).body), levels[1].faces);
}

TEST_F(ExportTest, WritesEveryFormat) {
  EXPECT_EQ(get("glb?level=lowest").body.substr(0, 4), "glTF");
  EXPECT_EQ(get("drc?level=lowest").body.substr(0, 5), "DRACO");
  EXPECT_THAT(get("wrl?level=lowest").body, HasSubstr("#VRML V2.0 utf8"));
  EXPECT_THAT(get("obj?level=lowest").body, HasSubstr("\nf "));
  EXPECT_EQ(get("stl?level=lowest").body.size(), 84 + 50 * levels.front().faces);
  EXPECT_EQ(get("glb").field("content-type"), "model/gltf-binary");
}

TEST_F(ExportTest, IsAnEntityThatCanBeHeldAndReadInParts) {
  const HttpAnswer whole = get("ply?level=lowest");
  EXPECT_EQ(get("ply?level=lowest", "If-None-Match: " + whole.field("etag") + "\r\n").status, 304);
  EXPECT_EQ(get("ply?level=lowest", "Range: bytes=0-2\r\n").body, "ply");
  EXPECT_NE(get("ply?level=1").field("etag"), whole.field("etag"));
  EXPECT_THAT(whole.field("content-disposition"), HasSubstr(id + ".ply"));
}

TEST_F(ExportTest, RefusesParametersThatMakeNoSense) {
  for (const char* query : {"triangles=many", "triangles=-1", "error=nan", "error=-1", "level=99",
                            "level=top", "bytes=1.5", "triangles=1&level=1", "kbps=100",
                            "kbps=0&seconds=1", "kbps=100&seconds=1&level=1", "faces=100"}) {
    EXPECT_EQ(get(std::string("ply?") + query).status, 400) << query;
  }
}

TEST_F(ExportTest, PostersOfAModelThatAnotherProcessHasPublishedAreMadeBeforeAVisitorAsks) {
  await_posters();
  EXPECT_EQ(http_get(port(), api + "/poster.png").status, 200);
  EXPECT_EQ(made(), 3);
}

TEST_F(ExportTest, EqualOnesAreComputedOnceHoweverManyAskAtATime) {
  await_posters();
  std::vector<std::future<HttpAnswer>> answers;
  for (std::size_t i = 0; i < 16; ++i) {
    answers.push_back(std::async(std::launch::async, [this, i] {
      // Leading zeros make the URLs differ, but not the exports.
      return get("glb?triangles=" + std::string(i, '0') + "5000");
    }));
  }
  for (auto& answer : answers)
    EXPECT_EQ(answer.get().status, 200);
  EXPECT_EQ(made(), 3 + 1);
  EXPECT_EQ(hits(), 3 + 15);
  EXPECT_GT(metric(daemon.admin_port(), "vitrine_export_cache_bytes"), 0);
}

TEST_F(ExportTest, TheManifestForetellsWhatAnExportGives) {
  for (const std::string target :
       {"kbps=10&seconds=1.5", "triangles=3000", "error=0.2", "level=1"}) {
    const HttpAnswer answer = http_get(port(), api + "/manifest?" + target);
    ASSERT_EQ(answer.status, 200) << target;
    const auto manifest = nlohmann::json::parse(answer.body);
    const auto expect = manifest["expect"];
    const auto level = manifest["levels"][expect["level"].get<std::size_t>()];
    const auto triangles = expect["triangles"].get<double>();
    const double off = target.starts_with("triangles") ? 2 : 0;  // a split adds 1 or 2 triangles
    EXPECT_NEAR(static_cast<double>(ply_faces(get("ply?" + target).body)), triangles, off)
        << target;
    EXPECT_LE(level["faces"], triangles) << target;
    EXPECT_EQ(level["max_error"], expect["error"]) << target;
  }
}

TEST_F(ExportTest, TheManifestTellsHowLongALineTakes) {
  const auto tell = [&](const std::string& line) {
    return nlohmann::json::parse(http_get(port(), api + "/manifest?" + line).body)["expect"];
  };
  const double bytes = static_cast<double>(built_model().report.manifest.cumulative_bytes(1));
  const double kbps = bytes * 8 / 1000 / 1.5 + 0.001;
  const auto slow = tell(fmt::format("seconds=1.5&kbps={}", kbps));
  EXPECT_EQ(slow["level"], 1);
  EXPECT_EQ(slow["bytes"], bytes);
  EXPECT_NEAR(slow["seconds"].get<double>(), 1.5, 0.01);
  EXPECT_EQ(tell(fmt::format("seconds=1.5&kbps={}", 100 * kbps))["level"], levels.size() - 1);
  EXPECT_TRUE(tell("level=0")["seconds"].is_null());
  EXPECT_TRUE(tell("").is_null());
  EXPECT_EQ(http_get(port(), api + "/manifest?kbps=40").status, 400);
  EXPECT_EQ(http_get(port(), api + "/manifest?faces=40").status, 400);
}

TEST_F(ExportTest, WhoSavesDataIsToldSoAndCachesKnow) {
  const HttpAnswer saving = http_get(port(), api + "/manifest", "Save-Data: on\r\n");
  EXPECT_LE(nlohmann::json::parse(saving.body)["expect"]["bytes"], 1'000'000);
  EXPECT_EQ(saving.field("vary"), "Save-Data, Accept-Encoding");
  EXPECT_EQ(http_get(port(), api + "/manifest").field("vary"), "Accept-Encoding, Save-Data");
  EXPECT_EQ(get("ply?level=0").field("vary"), "Save-Data");
}

TEST_F(ExportTest, WhoSavesDataIsGivenWhatAsMuchBringsAndNotTheWhole) {
  await_posters();
  const HttpAnswer whole = get("ply"), saving = get("ply", "Save-Data: on\r\n");
  EXPECT_EQ(saving.body, whole.body) << "so small a model fits";
  EXPECT_EQ(made(), 3 + 2) << "by another target";
  EXPECT_EQ(get("ply?level=highest", "Save-Data: on\r\n").body, whole.body);
  EXPECT_EQ(made(), 3 + 2) << "what is said counts";
}

}  // namespace
}  // namespace vitrine::test
