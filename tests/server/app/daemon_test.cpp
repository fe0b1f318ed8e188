// SPDX-License-Identifier: Apache-2.0
// Tests every route of the real daemon over sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/store/change.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class DaemonTest : public ::testing::Test {
 protected:
  HttpAnswer get(const std::string& target, const std::string& fields = "",
                 const std::string& method = "GET") const {
    return http_get(daemon.port(), target, fields, method);
  }
  std::string model_url() const { return "/api/v1/models/" + id; }
  std::string chunk_url() const {
    return "/api/v1/chunks/" + to_hex(served_pmesh().manifest.chunks[0].sha256);
  }

  const Manifest& manifest = served_pmesh().manifest;
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon{folder.path()};
};

TEST_F(DaemonTest, ListsModelsSearchesThemAndPages) {
  folder.publish("Second bust");
  folder.publish("A vase");
  const Json all = Json::parse(get("/api/v1/models").body);
  EXPECT_EQ(all["models"].size(), 3u);
  EXPECT_TRUE(all["next"].is_null());
  EXPECT_EQ(Json::parse(get("/api/v1/models?q=bust").body)["models"].size(), 2u);
  EXPECT_EQ(Json::parse(get("/api/v1/models?q=small+bust").body)["models"][0]["id"], id);
  const Json first = Json::parse(get("/api/v1/models?limit=2").body);
  EXPECT_EQ(first["models"].size(), 2u);
  const Json rest =
      Json::parse(get("/api/v1/models?limit=2&cursor=" + first["next"].get<std::string>()).body);
  ASSERT_EQ(rest["models"].size(), 1u);
  EXPECT_EQ(rest["models"][0]["id"], id) << "newest first";
}

TEST_F(DaemonTest, RefusesParametersOutOfRangeByName) {
  const HttpAnswer answer = get("/api/v1/models?limit=0&cursor=x");
  EXPECT_EQ(answer.status, 400);
  EXPECT_EQ(answer.field("content-type"), "application/problem+json");
  const Json problem = Json::parse(answer.body);
  EXPECT_EQ(problem["errors"][0]["parameter"], "limit");
  EXPECT_EQ(problem["errors"][1]["parameter"], "cursor");
  EXPECT_EQ(get("/api/v1/models?q=%zz").status, 400);
  const HttpAnswer unknown = get("/api/v1/models?draft=true");
  EXPECT_EQ(unknown.status, 400);
  EXPECT_EQ(Json::parse(unknown.body)["errors"][0]["parameter"], "draft");
}

TEST_F(DaemonTest, DescribesAModelAndItsManifest) {
  const Json model = Json::parse(get(model_url()).body);
  EXPECT_EQ(model["title"], "A small bust");
  EXPECT_EQ(model["bytes"], manifest.file_bytes);
  const HttpAnswer answer = get(model_url() + "/manifest");
  EXPECT_EQ(answer.field("cache-control"), "no-cache");
  const Json json = Json::parse(answer.body);
  EXPECT_EQ(json["levels"].size(), 2u);
  EXPECT_EQ(json["levels"][1]["cumulative_bytes"], manifest.file_bytes);
  EXPECT_EQ(json["chunks"][0]["sha256"], to_hex(manifest.chunks[0].sha256));
  EXPECT_EQ(json["head_bytes"], manifest.head_bytes());
  EXPECT_EQ(json["bounding_box"]["max"][1], manifest.lattice.to_model({10, 20, 30}).y);
  const HttpAnswer again =
      get(model_url() + "/manifest", "If-None-Match: " + answer.field("etag") + "\r\n");
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.body, "");
}

TEST_F(DaemonTest, ServesHeadChunkAndFile) {
  const HttpAnswer head = get(model_url() + "/head");
  EXPECT_EQ(head.body, file_bytes(0, manifest.head_bytes()));
  const HttpAnswer chunk = get(chunk_url());
  EXPECT_EQ(chunk.body, file_bytes(manifest.chunks[0].offset, manifest.chunks[0].length));
  EXPECT_EQ(chunk.field("cache-control"),
            "public, max-age=31536000, immutable, s-maxage=120, stale-while-revalidate=60");
  EXPECT_EQ(chunk.field("access-control-allow-origin"), "*");
  EXPECT_EQ(get("/api/v1/chunks/" + to_hex(manifest.base_sha256)).body, "a base mesh");
  EXPECT_EQ(get(model_url() + "/file.pmesh").body, file_bytes(0, manifest.file_bytes));
}

TEST_F(DaemonTest, ServesRangesOfTheFile) {
  const std::string url = model_url() + "/file.pmesh";
  const std::string size = std::to_string(manifest.file_bytes);
  const HttpAnswer part = get(url, "Range: bytes=10-19\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.field("content-range"), "bytes 10-19/" + size);
  EXPECT_EQ(part.body, file_bytes(10, 10));
  EXPECT_EQ(get(url, "Range: bytes=10-19\r\nIf-Range: \"other\"\r\n").status, 200);
  const HttpAnswer beyond = get(url, "Range: bytes=" + size + "-\r\n");
  EXPECT_EQ(beyond.status, 416);
  EXPECT_EQ(beyond.field("content-range"), "bytes */" + size);
  EXPECT_EQ(beyond.field("content-type"), "application/problem+json");
}

TEST_F(DaemonTest, HeadTellsTheLengthWithoutTheBody) {
  HttpClient client(daemon.port());
  const HttpAnswer answer = client.get(model_url() + "/file.pmesh", "", "HEAD");
  EXPECT_EQ(answer.field("content-length"), std::to_string(manifest.file_bytes));
  EXPECT_EQ(client.get(model_url()).status, 200) << "nothing followed the head";
}

TEST_F(DaemonTest, AnswersPreflightsAndRefusesOtherMethods) {
  const HttpAnswer preflight = get(chunk_url(), "Origin: https://museum.example\r\n", "OPTIONS");
  EXPECT_EQ(preflight.status, 204);
  EXPECT_THAT(preflight.field("access-control-allow-methods"), HasSubstr("GET"));
  const HttpAnswer answer = get(chunk_url(), "Content-Length: 0\r\n", "DELETE");
  EXPECT_EQ(answer.status, 405);
  EXPECT_EQ(answer.field("allow"), "GET, HEAD, OPTIONS");
}

TEST_F(DaemonTest, WhatDoesNotExistIsAProblemWithTheRequestsId) {
  const std::string none = "00000000000000000000000001";
  for (const std::string& target :
       {std::string("/nothing"), "/api/v1/models/" + none, "/api/v1/models/" + none + "/manifest",
        "/api/v1/models/" + none + "/export.glb", "/api/v1/models/" + none + "/head",
        "/models/" + none, "/api/v1/chunks/" + std::string(64, '0'), model_url() + "/export.exe",
        std::string("/api/v1/models/..%2f..%2fetc"), std::string("/../../etc/passwd")}) {
    const HttpAnswer answer = get(target);
    EXPECT_EQ(answer.status, 404) << target;
    EXPECT_EQ(Json::parse(answer.body)["request_id"], answer.field("x-request-id")) << target;
  }
}

TEST_F(DaemonTest, KeepsTheConnectionAndAnswersPipelinedRequestsInOrder) {
  HttpClient client(daemon.port());
  client.send(
      "GET " + chunk_url() + " HTTP/1.1\r\nHost: a\r\n\r\nGET " + model_url() +
      " HTTP/1.1\r\nHost: a\r\n\r\nGET /nothing HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(client.receive().body.size(), manifest.chunks[0].length);
  EXPECT_EQ(client.receive().field("content-type"), "application/json");
  EXPECT_EQ(client.receive().status, 404);
  EXPECT_TRUE(client.is_closed());
}

TEST_F(DaemonTest, KeepsAnOldClientsConnectionWhereItAsksForThatAndSaysSo) {
  HttpClient client(daemon.port());
  client.send("GET /nothing HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  EXPECT_EQ(client.receive().field("connection"), "keep-alive");
  client.send("GET /nothing HTTP/1.0\r\n\r\n");
  EXPECT_EQ(client.receive().field("connection"), "close");
  EXPECT_TRUE(client.is_closed());
}

TEST_F(DaemonTest, ClosesAfterARequestWhoseEndIsAmbiguousOrThatIsTooLarge) {
  const std::pair<std::string, int> cases[] = {
      {"GET / HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\n\r\n", 400},
      {"GET / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400},
      {"nonsense\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n", 431},
      {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1000000\r\n\r\n", 405},
      {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n1;" +
           std::string(100'000, 'x'),
       405},
      {"GET nowhere HTTP/1.1\r\nHost: a\r\n\r\n", 400},
  };
  for (const auto& [request, status] : cases) {
    HttpClient client(daemon.port());
    client.send(request + "GET /after HTTP/1.1\r\nHost: a\r\n\r\n");
    EXPECT_EQ(client.receive().status, status) << request.substr(0, 60);
    EXPECT_TRUE(client.is_closed()) << request.substr(0, 60);
  }
}

TEST_F(DaemonTest, SeesWhatAnotherProcessPublishes) {
  ASSERT_EQ(Json::parse(get("/api/v1/models").body)["models"].size(), 1u);
  const std::string other = folder.publish("From elsewhere");
  EXPECT_EQ(get("/api/v1/models/" + other).status, 200);
}

TEST_F(DaemonTest, TheAdminListenerTellsHealthAndMetricsAndVisitorsCannotReachThem) {
  EXPECT_EQ(http_get(daemon.admin_port(), "/livez").status, 200);
  EXPECT_EQ(http_get(daemon.admin_port(), "/readyz").status, 200);
  HttpClient client(daemon.port());
  // The daemon counts a request after it sends the answer, but before it reads the next request on
  // the same connection.
  for (const std::string& target : {chunk_url(), std::string("/api/v1/models/nothing")}) {
    client.send("GET " + target + " HTTP/1.1\r\nHost: a\r\n\r\n");
    client.receive();
  }
  const HttpAnswer metrics = http_get(daemon.admin_port(), "/metrics");
  EXPECT_THAT(metrics.field("content-type"), HasSubstr("text/plain; version=0.0.4"));
  EXPECT_THAT(
      metrics.body,
      HasSubstr(
          "vitrine_http_requests_total{route=\"/api/v1/chunks/{sha256}\",status=\"2xx\"} 1\n"));
  for (const char* target : {"/livez", "/readyz", "/metrics"})
    EXPECT_EQ(get(target).status, 404);
  EXPECT_EQ(http_get(daemon.admin_port(), "/api/v1/models").status, 404);
}

TEST_F(DaemonTest, MetricsTellWhatTheOperatorAsksAndDoNotGrowWithWhatVisitorsAskFor) {
  const auto lines = [&] {
    const std::string text = http_get(daemon.admin_port(), "/metrics").body;
    return std::count(text.begin(), text.end(), '\n');
  };
  const std::string text = http_get(daemon.admin_port(), "/metrics").body;
  for (const char* sample :
       {"\nvitrine_build_info{version=\"", "\nvitrine_streams 0\n", "\nvitrine_exports_made_total ",
        "\nvitrine_export_cache_bytes 0\n", "\nvitrine_jobs{state=\"queued\"} 0\n",
        "\nvitrine_jobs{state=\"cancelled\"} 0\n", "\nvitrine_data_free_bytes ",
        "\nvitrine_disk_nearly_full 0\n", "\nvitrine_refusals_not_logged_total 0\n",
        "\nvitrine_answers_not_logged_total 0\n"}) {
    EXPECT_THAT(text, HasSubstr(sample));
  }
  const auto before = lines();
  for (int i = 0; i < 40; ++i)
    get("/api/v1/models/x" + std::to_string(i) + "?y=" + std::to_string(i));
  EXPECT_EQ(lines(), before);
}

TEST_F(DaemonTest, EveryReadIsAnEntity) {
  const std::string model = "/api/v1/models/" + id;
  for (const std::string& target :
       {std::string("/api/v1/models"), model, model + "/manifest", model + "/head",
        model + "/file.pmesh", model + "/tileset.json", chunk_url(),
        "/api/v1/iiif/" + id + "/manifest.json", std::string("/api/v1/openapi.json")}) {
    const HttpAnswer whole = get(target);
    const std::string tag = whole.field("etag");
    ASSERT_EQ(whole.status, 200) << target;
    ASSERT_FALSE(tag.empty()) << target;
    const HttpAnswer head = get(target, "", "HEAD");
    EXPECT_EQ(head.field("content-length"), std::to_string(whole.body.size())) << target;
    EXPECT_EQ(head.field("etag"), tag) << target;
    EXPECT_EQ(get(target, "If-None-Match: " + tag + "\r\n").status, 304) << target;
    EXPECT_EQ(get(target, "Range: bytes=1-4\r\nIf-Range: " + tag + "\r\n").body,
              whole.body.substr(1, 4))
        << target;
    EXPECT_EQ(get(target, "Range: bytes=1-4\r\nIf-Range: \"other\"\r\n").status, 200) << target;
    EXPECT_EQ(get(target, "Range: bytes=0-1,3-4\r\n").body, whole.body) << target;
  }
}

// A data folder with one model. The model's file is damaged before the daemon starts.
class DamagedObjectTest : public ::testing::Test {
 protected:
  DamagedObjectTest() {
    std::fstream(folder.path() / "objects" / hex.substr(0, 2) / hex.substr(2, 2) / hex,
                 std::ios::in | std::ios::out | std::ios::binary)
        .seekp(-1, std::ios::end)
        .put('!');
  }
  static std::string metrics_of(const Daemon& daemon) {
    return http_get(daemon.admin_port(), "/metrics").body;
  }

  ServedFolder folder;
  const std::string model = "/api/v1/models/" + folder.publish("A small bust");
  const std::string hex = to_hex(sha256(served_pmesh().bytes));
};

TEST_F(DamagedObjectTest, IsNeverSentAndIsServedAgainOnceItIsMended) {
  const ChunkInfo& chunk = served_pmesh().manifest.chunks[0];
  const std::string chunk_url = "/api/v1/chunks/" + to_hex(chunk.sha256);
  Daemon daemon(folder.path(), {"--scrub-rate", "0"});
  for (const std::string& target : {chunk_url, model + "/head", model + "/file.pmesh",
                                    model + "/manifest", model + "/export.ply"}) {
    const HttpAnswer answer = http_get(daemon.port(), target);
    EXPECT_EQ(answer.status, 500) << target;
    EXPECT_EQ(answer.field("cache-control"), "no-store") << target;
    EXPECT_THAT(daemon.wait_for_line("event=error"), HasSubstr(hex)) << target;
  }
  EXPECT_THAT(metrics_of(daemon), HasSubstr("\nvitrine_damaged_objects 1\n"));
  folder.publish("A small bust");  // publishing the same file again replaces the damaged one
  const HttpAnswer mended = http_get(daemon.port(), chunk_url);
  EXPECT_EQ(mended.status, 200);
  EXPECT_EQ(mended.body, file_bytes(chunk.offset, chunk.length));
  EXPECT_THAT(metrics_of(daemon), HasSubstr("\nvitrine_damaged_objects 0\n"));
}

TEST_F(DamagedObjectTest, IsFoundInTheBackgroundThoughNobodyAsksForIt) {
  Daemon daemon(folder.path());
  EXPECT_THAT(daemon.wait_for_line("event=error"), HasSubstr("object " + hex));
  EXPECT_THAT(metrics_of(daemon), HasSubstr("\nvitrine_damaged_objects 1\n"));
}

std::size_t count_open_objects(pid_t process) {
  std::size_t count = 0;
  const std::filesystem::path open = "/proc/" + std::to_string(process) + "/fd";
  for (const auto& file : std::filesystem::directory_iterator(open)) {
    std::error_code closed_meanwhile;
    const auto target = std::filesystem::read_symlink(file, closed_meanwhile).string();
    count += target.find("/objects/") != target.npos ? 1 : 0;
  }
  return count;
}

// The daemon must close the files soon, even if no client sends a request after the changes.
TEST(CachedFiles, OfModelsThatWereWithdrawnReplacedOrRemovedAreClosed) {
  ServedFolder folder;
  std::vector<std::string> ids;
  for (const char* chunk : {"one", "two", "three"})
    ids.push_back(folder.publish(chunk, tiny_pmesh("a base", chunk)));
  // Without an export cache, the daemon makes no posters. Only the requests below then open models.
  Daemon daemon(folder.path(), {"--scrub-rate", "0", "--export-cache", "0"});
  for (const std::string& id : ids)
    EXPECT_EQ(http_get(daemon.port(), "/api/v1/models/" + id + "/file.pmesh").status, 200);
  WebSocketClient stream(daemon.port(), "/api/v1/models/" + ids[0] + "/stream", "pmesh.v1");
  EXPECT_EQ(stream.receive().kind, WebSocketFrame::kText);
  EXPECT_EQ(count_open_objects(daemon.pid()), 3u);
  const auto other = open_installation({.folder = folder.path()}).value();
  const auto id_of = [&](std::size_t i) { return *ModelId::parse(ids[i]); };
  ASSERT_TRUE(other.catalogue->set_state(id_of(0), ModelState::kDraft));
  ASSERT_TRUE(replace(*other.store, *other.catalogue, tiny_pmesh("a base", "four").bytes, {},
                      {.id = id_of(1)}));
  ASSERT_TRUE(other.catalogue->remove(id_of(2), std::nullopt));
  while (count_open_objects(daemon.pid()) > 0)
    std::this_thread::yield();
}

TEST(Disk, ThatIsNearlyFullIsReportedAndTakesNoUpload) {
  ServedFolder folder;
  const std::string create =
      "Authorization: Bearer " + folder.token(Role::kOperator) +
      "\r\nTus-Resumable: 1.0.0\r\nUpload-Length: 1\r\nContent-Length: 0\r\n";
  for (const std::string reserve : {"0", "9000000000000000000"}) {
    const bool is_full = reserve != "0";
    Daemon daemon(folder.path(), {"--disk-reserve", reserve});
    const HttpAnswer ready = http_get(daemon.admin_port(), "/readyz");
    EXPECT_EQ(ready.status, 200) << "models can still be served";
    EXPECT_THAT(ready.body, HasSubstr(is_full ? "nearly full" : "ready\n"));
    EXPECT_THAT(
        http_get(daemon.admin_port(), "/metrics").body,
        HasSubstr(is_full ? "\nvitrine_disk_nearly_full 1\n" : "\nvitrine_disk_nearly_full 0\n"));
    const HttpAnswer upload = http_get(daemon.port(), "/api/v1/uploads", create, "POST");
    EXPECT_EQ(upload.status, is_full ? 507 : 201) << upload.body;
    if (is_full) daemon.wait_for_line("no room");
  }
}

TEST(Disk, HasNoRoomForWhatOtherOpenUploadsWillNeed) {
  ServedFolder folder;
  Daemon daemon(folder.path(), {"--disk-reserve", "0", "--max-upload", "9000000000000000000"});
  const std::uintmax_t most = std::filesystem::space(folder.path()).available * 6 / 10;
  const std::string create = "Authorization: Bearer " + folder.token(Role::kOperator) +
                             "\r\nTus-Resumable: 1.0.0\r\nUpload-Length: " + std::to_string(most) +
                             "\r\nContent-Length: 0\r\n";
  const auto announce = [&] {
    return http_get(daemon.port(), "/api/v1/uploads", create, "POST").status;
  };
  EXPECT_EQ(announce(), 201);
  EXPECT_EQ(announce(), 507);
  daemon.wait_for_line("no room");
}

TEST(Disk, KeepsHalfOfItsRoomFromATokenWithSeveralUploads) {
  ServedFolder folder;
  Daemon daemon(folder.path(), {"--disk-reserve", "0", "--max-upload", "9000000000000000000"});
  const std::uintmax_t most = std::filesystem::space(folder.path()).available * 3 / 10;
  const auto announce = [&](const std::string& token) {
    const std::string create =
        "Authorization: Bearer " + token +
        "\r\nTus-Resumable: 1.0.0\r\nUpload-Length: " + std::to_string(most) +
        "\r\nContent-Length: 0\r\n";
    return http_get(daemon.port(), "/api/v1/uploads", create, "POST").status;
  };
  const std::string first = folder.token(Role::kOperator), other = folder.token(Role::kOperator);
  EXPECT_EQ(announce(first), 201);
  EXPECT_EQ(announce(first), 429) << "two would take six tenths";
  EXPECT_EQ(announce(other), 201);
}

}  // namespace
}  // namespace vitrine::test
