// SPDX-License-Identifier: Apache-2.0
// Exports of the real daemon, of a model that was really built.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "server/jobs/build_model.h"
#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/daemon.h"
#include "support/http_client.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

// A wavy sheet of 2 * 59 * 59 = 6962 triangles as OBJ.
std::string wavy_sheet() {
  constexpr int kSide = 60;
  std::string text;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
              std::to_string(std::sin(0.3 * x) * std::cos(0.2 * y)) + "\n";
    }
  }
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const int a = y * kSide + x + 1, b = a + 1, c = a + kSide, d = c + 1;
      for (const auto& [p, q, r] : {std::array{a, b, d}, std::array{a, d, c}}) {
        text += "f " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
      }
    }
  }
  return text;
}

const BuildResult& built() {
  static const BuildResult result = [] {
    const std::string text = wavy_sheet();
    auto model = build_model({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, {},
                             [](std::string_view, double) {});
    if (!model) throw std::runtime_error(model.error().message);
    return std::move(*model);
  }();
  return result;
}

// The number after "element face " in a PLY header.
std::uint64_t ply_faces(const std::string& file) {
  constexpr std::string_view kElement = "element face ";
  const std::size_t at = file.find(kElement);
  return at == std::string::npos ? 0 : std::stoul(file.substr(at + kElement.size(), 12));
}

class ExportTest : public ::testing::Test {
 protected:
  ExportTest() {
    Installation installation = open_installation(folder.path()).value();
    const auto published = publish(*installation.store, *installation.catalogue, built().file, {});
    if (!published) throw std::runtime_error(published.error().message);
    id = published->id.to_string();
    daemon.emplace(folder.path());
  }

  HttpAnswer get(const std::string& rest, const std::string& fields = "") const {
    return http_get(daemon->port(), "/api/v1/models/" + id + "/export." + rest, fields);
  }

  const std::vector<LevelInfo>& levels = built().report.manifest.levels;
  TemporaryFolder folder;
  std::string id;
  std::optional<Daemon> daemon;
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
  const Manifest& manifest = built().report.manifest;
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

}  // namespace
}  // namespace vitrine::test
