// SPDX-License-Identifier: Apache-2.0
// Tests `vitrine fetch` with the real daemon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "codec/build/build_model.h"
#include "codec/format/manifest.h"
#include "cutting_relay.h"
#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/on_terminal.h"
#include "support/process/certificate.h"
#include "support/process/daemon.h"
#include "support/process/run_program.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"
#include "support/wavy_sheet.h"

namespace vitrine::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

const std::vector<std::uint8_t>& sheet() {
  static const std::vector<std::uint8_t> file = [] {
    const std::string text = wavy_sheet(120);  // 28322 triangles
    return build_model({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, {},
                       [](std::string_view, double) {})
        .value()
        .file;
  }();
  return file;
}

std::vector<std::uint8_t> file_at(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class FetchTest : public ::testing::Test {
 protected:
  FetchTest() {
    const auto installation = open_installation({.folder = data.path()}).value();
    id = publish(*installation.store, *installation.catalogue, sheet(), {.title = "A sheet"})
             .value()
             .id.to_string();
  }

  std::string url(std::uint16_t port) const {
    return "http://127.0.0.1:" + std::to_string(port) + "/models/" + id;
  }
  // Runs `vitrine fetch`. `variable` is "NAME=value" for its environment.
  ProgramResult fetch(const std::string& from, const std::string& out,
                      std::vector<std::string> more = {},
                      const std::string& variable = "A=") const {
    more.insert(more.begin(), {"env", variable, VITRINE_BIN_DIR "/vitrine", "fetch", from,
                               "--force", "-o", (results.path() / out).string(), "--json"});
    return run_program(more);
  }
  // Returns the number of files in the results' folder, including partial downloads.
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(results.path()), fs::directory_iterator()));
  }

  TemporaryFolder data, results;
  std::string id;
};

TEST_F(FetchTest, FetchesTheWholeFile) {
  const Daemon daemon(data.path());
  const auto run = fetch(url(daemon.port()), "sheet.pmesh");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(file_at(results.path() / "sheet.pmesh"), sheet());
  const Json report = Json::parse(run.output);
  EXPECT_EQ(report["faces"], 28322);
  EXPECT_EQ(report["bytes"], sheet().size());
  EXPECT_EQ(report["received_bytes"], sheet().size());
  EXPECT_EQ(files(), 1u) << "what was on its way is gone";
}

TEST_F(FetchTest, WritesToStandardOutputInTheStatedFormat) {
  const Daemon daemon(data.path());
  const auto fetch_to_output = [&](const std::string& format) {
    const std::string command = "cd \"$0\" && exec \"$1\" fetch \"$2\" -o - --format " + format;
    return run_program({"sh", "-c", command, results.path().string(), VITRINE_BIN_DIR "/vitrine",
                        url(daemon.port())});
  };
  const auto whole = fetch_to_output("pmesh");
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_EQ(whole.output, std::string(sheet().begin(), sheet().end()));
  EXPECT_THAT(whole.errors, HasSubstr("28322 faces"));
  EXPECT_THAT(fetch_to_output("glb").output, ::testing::StartsWith("glTF"));
  EXPECT_EQ(fetch_to_output("doc").exit_code, 2);
  EXPECT_EQ(files(), 0u) << "what was on its way is gone";
}

TEST_F(FetchTest, FetchesThePicturesOfATexture) {
  const auto textured = tiny_pmesh("a base", "a chunk", {"small picture", "larger picture"}).bytes;
  {
    const auto installation = open_installation({.folder = data.path()}).value();
    id = publish(*installation.store, *installation.catalogue, textured, {}).value().id.to_string();
  }
  const Daemon daemon(data.path());
  const auto run = fetch(url(daemon.port()), "textured.pmesh");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(file_at(results.path() / "textured.pmesh"), textured);
  EXPECT_EQ(Json::parse(run.output)["received_bytes"], textured.size());
}

TEST_F(FetchTest, WritesTheCoarserLevelsOfAGlbOnRequest) {
  const Daemon daemon(data.path());
  const std::string from = url(daemon.port());
  const auto levels_of = [&](const std::vector<std::string>& flags) {
    const auto run = fetch(from, "a.glb", flags);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    const auto glb = file_at(results.path() / "a.glb");
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, sizeof size);
    return Json::parse(glb.begin() + 20, glb.begin() + 20 + size)["meshes"].size();
  };
  EXPECT_EQ(levels_of({}), 1u);
  const auto all = levels_of({"--lod", "msft"});
  EXPECT_GE(all, 3u);
  EXPECT_LT(levels_of({"--lod", "msft", "--level", "2"}), all);
  EXPECT_EQ(fetch(from, "a.pmesh", {"--lod", "msft"}).exit_code, 2);
}

TEST_F(FetchTest, MeetsTheDetailTarget) {
  const Daemon daemon(data.path());
  const std::string from = url(daemon.port());
  const auto triangles = fetch(from, "a.ply", {"--triangles", "9000"});
  ASSERT_EQ(triangles.exit_code, 0) << triangles.errors;
  const std::uint64_t faces = Json::parse(triangles.output)["faces"];
  EXPECT_LE(faces, 9000u);
  EXPECT_GE(faces, 8100u);
  const auto bytes = fetch(from, "b.obj", {"--bytes", "20000"});
  ASSERT_EQ(bytes.exit_code, 0) << bytes.errors;
  EXPECT_LE(Json::parse(bytes.output)["bytes"], 20000);
  const auto error = fetch(from, "c.stl", {"--error", "0.5"});
  ASSERT_EQ(error.exit_code, 0) << error.errors;
  EXPECT_LE(Json::parse(error.output)["error"], 0.5);
  const auto seconds = fetch(from, "d.glb", {"--seconds", "10"});
  ASSERT_EQ(seconds.exit_code, 0) << seconds.errors;
  EXPECT_EQ(Json::parse(seconds.output)["faces"], 28322) << "all of it comes in that time";
  EXPECT_TRUE(Json::parse(seconds.output).contains("promise"));
  EXPECT_EQ(files(), 4u);
}

TEST_F(FetchTest, TheProgressBarShowsTrianglesBytesAndError) {
  const Daemon daemon(data.path());
  OnTerminal fetch({VITRINE_BIN_DIR "/vitrine", "fetch", url(daemon.port()), "-o",
                    (results.path() / "sheet.ply").string()});
  EXPECT_EQ(fetch.finish(), 0) << fetch.seen();
  EXPECT_THAT(fetch.seen(), ContainsRegex("[0-9]+ triangles, [0-9.]+ MB, error [0-9]"));
}

TEST_F(FetchTest, FetchesTheDetailForACamera) {
  const Daemon daemon(data.path());
  const fs::path file = data.path() / "view.json";
  const auto bytes_from = [&](double height) {
    std::ofstream(file) << Json{{"camera", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 60, 60, height, 1}},
                                {"fov", 60},
                                {"width", 400},
                                {"height", 400},
                                {"pixels", 1}};
    const auto run = fetch(url(daemon.port()), "seen.ply", {"--view", file});
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return Json::parse(run.output)["bytes"].get<std::size_t>();
  };
  const std::size_t far = bytes_from(10'000), near = bytes_from(100);
  EXPECT_LT(far, near);
  EXPECT_LT(near, sheet().size());
  std::ofstream(file) << R"({"fov":60},"seconds":{)";
  const auto wrong = fetch(url(daemon.port()), "seen.ply", {"--view", file});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.errors, HasSubstr("is not a view; give"));
}

TEST_F(FetchTest, ContinuesAfterALostConnection) {
  const Daemon daemon(data.path());
  const CuttingRelay relay(daemon.port(), sheet().size() / 2);
  const auto run = fetch(url(relay.port()), "sheet.pmesh");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(relay.connections(), 2);
  EXPECT_EQ(file_at(results.path() / "sheet.pmesh"), sheet());
  EXPECT_LT(Json::parse(run.output)["received_bytes"], sheet().size() * 3 / 2)
      << "what has come does not come again, but for the chunk that was cut";
}

TEST_F(FetchTest, ContinuesAfterALossWithinTheHead) {
  const Daemon daemon(data.path());
  const std::size_t head = parse_header(sheet()).value().head_bytes();
  const CuttingRelay relay(daemon.port(), head / 2);
  const auto run = fetch(url(relay.port()), "sheet.pmesh");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(relay.connections(), 2);
  EXPECT_EQ(file_at(results.path() / "sheet.pmesh"), sheet());
}

TEST_F(FetchTest, ContinuesAnInterruptedRun) {
  const Daemon daemon(data.path());
  const auto coarse = fetch(url(daemon.port()), "sheet.ply", {"--bytes", "1"});
  EXPECT_EQ(coarse.exit_code, 1) << "the head alone is longer";
  EXPECT_THAT(coarse.errors, HasSubstr("ask for at least that many"));
  ASSERT_EQ(files(), 1u) << "but it is kept";
  const auto run = fetch(url(daemon.port()), "sheet.ply");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(Json::parse(run.output)["faces"], 28322);
  EXPECT_EQ(files(), 1u);
}

TEST_F(FetchTest, TrustsNoServerButTheOneThatItsCertificateNames) {
  const fs::path certificate = data.path() / "chain.pem", key = data.path() / "key.pem";
  write_certificate(make_certificate("Museum"), certificate, key);
  const Daemon daemon(data.path(), {"--tls-certificate", certificate, "--tls-key", key});
  const auto at = [&](const std::string& host) {
    return "https://" + host + ":" + std::to_string(daemon.port()) + "/models/" + id;
  };
  const std::string trusting = "SSL_CERT_FILE=" + certificate.string();
  const auto run = fetch(at("localhost"), "sheet.pmesh", {}, trusting);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(file_at(results.path() / "sheet.pmesh"), sheet());
  const auto unknown = fetch(at("localhost"), "a.ply");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.errors, HasSubstr("not trusted: self-signed certificate; check"));
  const auto other = fetch(at("127.0.0.1"), "a.ply", {}, trusting);
  EXPECT_EQ(other.exit_code, 1) << "the certificate is for localhost";
  EXPECT_THAT(other.errors, HasSubstr("not trusted"));
}

TEST_F(FetchTest, ReportsTheFaultAndTheNextStep) {
  const Daemon daemon(data.path());
  const std::string other = url(daemon.port()).replace(url(daemon.port()).size() - 4, 4, "0000");
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{other, "a.ply"}, "404"},
      {{url(daemon.port()), "a.txt"}, "cannot tell the output format"},
      {{url(daemon.port()), "a.ply", "--seconds", "2", "--bytes", "9"}, "give one"},
      {{url(daemon.port()), "a.pmesh", "--bytes", "9"}, "whole"},
      {{url(daemon.port()), "a.ply", "--token", "x"}, "401"},
      {{"http://127.0.0.1/", "a.ply"}, "not the URL of a model"}};
  for (const auto& [words, reason] : wrong) {
    const auto run = fetch(words[0], words[1], {words.begin() + 2, words.end()});
    EXPECT_NE(run.exit_code, 0);
    EXPECT_THAT(run.errors, HasSubstr(reason));
  }
}

}  // namespace
}  // namespace vitrine::test
