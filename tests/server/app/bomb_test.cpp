// SPDX-License-Identifier: Apache-2.0
// Tests small uploads that claim, or expand to, far more data than fits into memory. The job must
// fail and say why, and the daemon must not be affected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/resident_memory.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class BombTest : public ::testing::Test {
 protected:
  HttpAnswer ask(const std::string& method, const std::string& path, const std::string& fields,
                 const std::string& body = "") {
    HttpClient client(daemon.port());
    client.send(method + " " + path + " HTTP/1.1\r\nHost: a\r\n" + bearer + fields +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive();
  }

  // Starts a job that builds a model from `file`. Waits until the job has ended, and returns it.
  Json made_of(const std::string& file) {
    const std::string length = std::to_string(file.size());
    const std::string upload =
        ask("POST", "/api/v1/uploads", kTus + "Upload-Length: " + length + "\r\n")
            .field("location");
    const std::string type = "Content-Type: application/offset+octet-stream\r\n";
    EXPECT_EQ(ask("PATCH", upload, kTus + type + "Upload-Offset: 0\r\n", file).status, 204);
    const Json order = {{"upload", upload.substr(upload.rfind('/') + 1)},
                        {"publish", true},
                        {"metadata", {{"title", "A bomb"}}}};
    const HttpAnswer answer =
        ask("POST", "/api/v1/models", "Content-Type: application/json\r\n", order.dump());
    EXPECT_EQ(answer.status, 202) << answer.body;
    return ended(answer.field("location"));
  }

  void expect_refused(const std::string& file, const std::string& why) {
    [[maybe_unused]] const std::size_t before = resident_bytes(daemon.pid());
    const Json job = made_of(file);
    EXPECT_EQ(job["state"], "failed") << job;
    EXPECT_THAT(job.dump(), HasSubstr(why));
#ifndef VITRINE_SANITISED
    EXPECT_LT(resident_bytes(daemon.pid(), "VmHWM:"), before + (16 << 20));
#endif
  }

  const std::string kTus = "Tus-Resumable: 1.0.0\r\n";
  ServedFolder folder;
  const std::string bearer = "Authorization: Bearer " + folder.token(Role::kOperator) + "\r\n";
  Daemon daemon{folder.path()};

 private:
  // Waits until the stream of events ends, which means that `job` has ended. Returns the job.
  Json ended(const std::string& job) {
    HttpClient client(daemon.port());
    client.send("GET " + job + "/events HTTP/1.1\r\nHost: a\r\n" + bearer + "\r\n");
    EXPECT_EQ(client.receive(false).status, 200);
    std::string events;
    try {
      for (;;)
        events += client.read_exactly(1);
    } catch (const std::runtime_error&) {  // the stream has ended
    }
    return Json::parse(ask("GET", job, "").body);
  }
};

TEST_F(BombTest, AHeaderThatClaimsBillionsOfFacesIsRefused) {
  expect_refused(
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face 4000000000\nproperty list uchar int vertex_indices\nend_header\n" +
          std::string(64, '\0'),
      "PLY");
}

TEST_F(BombTest, AFaceThatClaimsBillionsOfCornersIsRefused) {
  expect_refused(
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uint int vertex_indices\nend_header\n" +
          std::string(36, '\0') + std::string(64, '\xff'),
      "PLY");
}

std::string little_endian(std::size_t number) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8)
    bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  return "glTF" + little_endian(2) + little_endian(28 + json.size() + binary.size()) +
         little_endian(json.size()) + "JSON" + json + little_endian(binary.size()) +
         std::string("BIN\0", 4) + binary;
}

// A file of 2 MB that expands to 100,000 instances of 3,000 triangles.
TEST_F(BombTest, AFileThatRefersToItselfOverAndOverIsRefused) {
  constexpr std::size_t kIndices = 9'000, kInstances = 100'000;
  std::string binary(36 + 2 * kIndices, '\0');
  const std::string one("\0\0\x80\x3f", 4);
  binary.replace(12, 4, one);  // x of the second corner
  binary.replace(28, 4, one);  // y of the third corner
  for (std::size_t i = 0; i < kIndices; ++i)
    binary[36 + 2 * i] = static_cast<char>(i % 3);
  std::string nodes, all;
  for (std::size_t i = 0; i < kInstances; ++i) {
    nodes += R"({"mesh":0},)";
    all += std::to_string(i) + ",";
  }
  nodes.pop_back(), all.pop_back();
  const std::string indices = std::to_string(kIndices), bytes = std::to_string(2 * kIndices);
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + all + R"(]}],"nodes":[)" +
      nodes +
      R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
      R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
      R"({"bufferView":1,"componentType":5123,"type":"SCALAR","count":)" +
      indices + R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},)" +
      R"({"buffer":0,"byteOffset":36,"byteLength":)" + bytes + R"(}],"buffers":[{"byteLength":)" +
      std::to_string(binary.size()) + "}]}";
  expect_refused(glb(json, binary), "instances make too many");
}

}  // namespace
}  // namespace vitrine::test
