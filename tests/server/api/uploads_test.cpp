// SPDX-License-Identifier: Apache-2.0
// Tests resumable uploads according to the protocol tus 1.0.0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using test::HttpAnswer;
using test::HttpClient;
using test::LocalServer;
using testing::HasSubstr;
using Json = nlohmann::json;

class UploadRoutes : public testing::Test {
 protected:
  HttpAnswer ask(const std::string& method, const std::string& path, const std::string& fields,
                 const std::string& body = "") {
    HttpClient client(server_.port());
    client.send(method + " " + path + " HTTP/1.1\r\nHost: a\r\n" + fields +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive(method != "HEAD");
  }
  HttpAnswer create(std::size_t length, const std::string& more = "") {
    return ask("POST", "/api/v1/uploads",
               who_ + kTus + "Upload-Length: " + std::to_string(length) + "\r\n" + more);
  }
  std::string created(std::size_t length) { return create(length).field("location"); }
  HttpAnswer patch(const std::string& path, std::size_t offset, const std::string& body,
                   const std::string& more = "") {
    return ask("PATCH", path, who_ + kTus + kPiece + at(offset) + more, body);
  }
  HttpAnswer head(const std::string& path) { return ask("HEAD", path, who_ + kTus); }
  static std::string at(std::size_t offset) {
    return "Upload-Offset: " + std::to_string(offset) + "\r\n";
  }
  std::string stored(const std::string& path) {
    const auto file = server_.uploads().open(*UploadId::parse(path.substr(path.rfind('/') + 1)));
    if (!file) return "not whole";
    std::string bytes(2 << 20, '\0');
    bytes.resize(static_cast<std::size_t>(::pread(file->get(), bytes.data(), bytes.size(), 0)));
    return bytes;
  }
  static std::string some_bytes(std::size_t count) {
    std::string bytes(count, '\0');
    for (std::size_t i = 0; i < count; ++i)
      bytes[i] = static_cast<char>(i * 7 + i / 251);
    return bytes;
  }

  static constexpr const char* kTus = "Tus-Resumable: 1.0.0\r\n";
  static constexpr const char* kPiece = "Content-Type: application/offset+octet-stream\r\n";
  LocalServer server_{public_routes(), std::chrono::seconds(2)};
  const std::string who_ = server_.bearer(Role::kOperator);
};

TEST_F(UploadRoutes, OptionsTellWhatIsSpoken) {
  const HttpAnswer answer = ask("OPTIONS", "/api/v1/uploads", "");
  EXPECT_EQ(answer.status, 204);
  EXPECT_EQ(answer.field("tus-resumable"), "1.0.0");
  EXPECT_EQ(answer.field("tus-version"), "1.0.0");
  EXPECT_THAT(answer.field("tus-extension"), HasSubstr("creation"));
  EXPECT_EQ(answer.field("tus-max-size"), std::to_string(1 << 20));
}

TEST_F(UploadRoutes, AFileArrivesInPiecesLargerThanMemoryBuffers) {
  const std::string bytes = some_bytes(300'000);
  const HttpAnswer made = create(bytes.size(), "Upload-Metadata: filename YS5vYmo=\r\n");
  ASSERT_EQ(made.status, 201) << made.body;
  const std::string path = made.field("location");
  EXPECT_FALSE(made.field("upload-expires").empty());
  const HttpAnswer first = patch(path, 0, bytes.substr(0, 200'000));
  EXPECT_EQ(first.status, 204) << first.body;
  EXPECT_EQ(first.field("upload-offset"), "200000");
  const HttpAnswer now = head(path);
  EXPECT_EQ(now.status, 200);
  EXPECT_EQ(now.field("upload-offset"), "200000");
  EXPECT_EQ(now.field("upload-length"), "300000");
  EXPECT_EQ(now.field("upload-metadata"), "filename YS5vYmo=");
  EXPECT_EQ(now.field("cache-control"), "no-store");
  EXPECT_EQ(patch(path, 200'000, bytes.substr(200'000)).status, 204);
  EXPECT_EQ(stored(path), bytes);
}

TEST_F(UploadRoutes, ABodyInChunksWithoutALengthIsTakenToo) {
  const std::string path = created(8);
  HttpClient client(server_.port());
  client.send("PATCH " + path + " HTTP/1.1\r\nHost: a\r\n" + who_ + kTus + kPiece + at(0) +
              "Transfer-Encoding: chunked\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(client.receive().status, 100);
  client.send("3\r\nabc\r\n5\r\ndefgh\r\n0\r\n\r\n");
  EXPECT_EQ(client.receive().status, 204);
  EXPECT_EQ(stored(path), "abcdefgh");
  EXPECT_EQ(client.get(path, who_ + kTus, "HEAD").status, 200);  // the connection is still open
}

TEST_F(UploadRoutes, WhatCameBeforeTheLineBrokeIsKept) {
  const std::string bytes = some_bytes(100'000), path = created(bytes.size());
  {
    HttpClient client(server_.port());
    client.send("PATCH " + path + " HTTP/1.1\r\nHost: a\r\n" + who_ + kTus + kPiece + at(0) +
                "Content-Length: 100000\r\n\r\n" + bytes.substr(0, 90'000));
  }
  std::size_t offset = 0;
  while (offset < 90'000)
    offset = std::stoul(head(path).field("upload-offset"));
  EXPECT_EQ(offset, 90'000u);
  EXPECT_EQ(patch(path, offset, bytes.substr(offset)).status, 204);
  EXPECT_EQ(stored(path), bytes);
}

TEST_F(UploadRoutes, ACallWhosePeerHasGoneIsAuditedAndCounted) {
  const std::string path = created(1'000);
  const std::string publish = "/api/v1/models/" + ModelId::generate().to_string() + "/publish";
  for (const std::string& call : {"PATCH " + path, "POST " + publish}) {
    HttpClient client(server_.port());
    client.send(call + " HTTP/1.1\r\nHost: a\r\n" + who_ + kTus + kPiece + at(0) +
                "Content-Length: 1000\r\n\r\nabc");
  }
  const auto line = [](const std::string& target) { return "target=" + target + " status=499"; };
  std::string told;
  while (told.find(line(path)) == told.npos || told.find(line(publish)) == told.npos) {
    EXPECT_EQ(head(path).status, 200);  // the server still answers other requests
    told = server_.events();
  }
  head(path);  // once this request is answered, the metrics count the aborted requests
  EXPECT_THAT(server_.metrics().text(),
              HasSubstr(R"(route="/api/v1/models/{id}/publish",status="4xx"} 1)"));
}

TEST_F(UploadRoutes, WhoSendsNothingIsCutAndTheRestStays) {
  const std::string path = created(1'000);
  HttpClient client(server_.port());
  client.send("PATCH " + path + " HTTP/1.1\r\nHost: a\r\n" + who_ + kTus + kPiece + at(0) +
              "Content-Length: 1000\r\n\r\n" + std::string(10, 'x'));
  EXPECT_TRUE(client.is_closed());
  EXPECT_EQ(head(path).field("upload-offset"), "10");
}

TEST_F(UploadRoutes, APieceAtAnotherOffsetIsAConflict) {
  const std::string path = created(10);
  EXPECT_EQ(patch(path, 4, "abc").status, 409);
  EXPECT_EQ(patch(path, 0, "abc").status, 204);
  EXPECT_EQ(patch(path, 0, "abc").status, 409);
  EXPECT_EQ(ask("PATCH", path, who_ + kTus + kPiece + "Upload-Offset: -3\r\n", "a").status, 400);
  EXPECT_EQ(ask("PATCH", path, who_ + kTus + kPiece + "Upload-Offset: 3x\r\n", "a").status, 400);
  EXPECT_EQ(
      ask("PATCH", path, who_ + kTus + kPiece + "Upload-Offset: 99999999999999999999\r\n", "a")
          .status,
      400);
  EXPECT_EQ(head(path).field("upload-offset"), "3");
}

TEST_F(UploadRoutes, AClientFindsItsLostUploadAndEndsIt) {
  const std::string other = server_.bearer(Role::kOperator), admin = server_.bearer(Role::kAdmin);
  const auto list = [&](const std::string& who, const std::string& query = "") {
    return Json::parse(ask("GET", "/api/v1/uploads" + query, who).body);
  };
  EXPECT_EQ(list(who_), Json::parse(R"({"uploads": [], "next": null})"));
  std::string lost = create(10, "Upload-Metadata: filename YS5vYmo=\r\n").field("location");
  lost = lost.substr(lost.rfind('/') + 1);
  EXPECT_EQ(patch("/api/v1/uploads/" + lost, 0, "abc").status, 204);
  created(20);
  ASSERT_EQ(ask("POST", "/api/v1/uploads", other + kTus + "Upload-Length: 5\r\n").status, 201);

  const Json own = list(who_);
  ASSERT_EQ(own["uploads"].size(), 2u);
  const Json& found = own["uploads"][own["uploads"][0]["id"] == lost ? 0 : 1];
  EXPECT_EQ(found["id"], lost);
  EXPECT_EQ(found["offset"], 3);
  EXPECT_EQ(found["length"], 10);
  EXPECT_EQ(found["metadata"], "filename YS5vYmo=");
  EXPECT_EQ(list(other)["uploads"].size(), 1u);
  EXPECT_EQ(list(admin)["uploads"].size(), 3u);
  const Json first = list(admin, "?limit=2");
  EXPECT_EQ(first["uploads"].size(), 2u);
  EXPECT_EQ(list(admin, "?cursor=" + first["next"].get<std::string>())["uploads"].size(), 1u);
  EXPECT_EQ(ask("GET", "/api/v1/uploads", server_.bearer(Role::kViewer)).status, 403);
  EXPECT_EQ(ask("GET", "/api/v1/uploads", "").status, 401);

  EXPECT_EQ(ask("DELETE", "/api/v1/uploads/" + lost, other + kTus).status, 404);
  EXPECT_EQ(ask("DELETE", "/api/v1/uploads/" + lost, who_ + kTus).status, 204);
  EXPECT_EQ(list(who_)["uploads"].size(), 1u);
}

TEST(ShortAddresses, StandInTheAuditLogIfTheOperatorWishes) {
  LocalServer server(public_routes(), std::chrono::seconds(2), {}, {.shortens_addresses = true});
  HttpClient client(server.port());
  client.send("POST /api/v1/uploads HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n");
  EXPECT_EQ(client.receive().status, 401);
  client.get("/api/v1/uploads");  // once this is answered, the first call is logged
  EXPECT_THAT(server.events(), HasSubstr(" remote=127.0.0.0/24 "));
  EXPECT_THAT(server.events(), testing::Not(HasSubstr("127.0.0.1")));
}

TEST_F(UploadRoutes, AnotherVersionOrTypeIsRefused) {
  const std::string path = created(10);
  const HttpAnswer other = ask("HEAD", path, who_ + "Tus-Resumable: 0.2.2\r\n");
  EXPECT_EQ(other.status, 412);
  EXPECT_EQ(other.field("tus-version"), "1.0.0");
  EXPECT_EQ(ask("POST", "/api/v1/uploads", who_ + "Upload-Length: 5\r\n").status, 412);
  EXPECT_EQ(ask("PATCH", path, who_ + kTus + at(0) + "Content-Type: text/plain\r\n", "a").status,
            415);
  EXPECT_EQ(ask("POST", "/api/v1/uploads", who_ + kTus).status, 400);
}

TEST_F(UploadRoutes, NothingGoesBeyondTheLimitsOfSizeAndNumber) {
  EXPECT_EQ(create((1 << 20) + 1).status, 413);
  const std::string path = created(5);
  EXPECT_EQ(patch(path, 0, "abcdef").status, 413);
  HttpClient client(server_.port());  // sends more bytes than announced, in chunks
  client.send("PATCH " + path + " HTTP/1.1\r\nHost: a\r\n" + who_ + kTus + kPiece + at(0) +
              "Transfer-Encoding: chunked\r\n\r\n6\r\nabcdef\r\n0\r\n\r\n");
  EXPECT_EQ(client.receive().status, 413);
  EXPECT_EQ(head(path).field("upload-offset"), "0");
  created(1), created(1);
  EXPECT_EQ(create(1).status, 429);
  EXPECT_EQ(ask("DELETE", path, who_ + kTus).status, 204);
  EXPECT_EQ(ask("DELETE", path, who_ + kTus).status, 404);
  EXPECT_EQ(create(1).status, 201);
}

TEST_F(UploadRoutes, WhatIsAnnouncedCountsForTheQuota) {
  const std::string path = created(1 << 20);
  created(1 << 20), created(1 << 20);
  const std::string other = server_.bearer(Role::kOperator) + kTus + "Upload-Length: 1\r\n";
  EXPECT_EQ(ask("POST", "/api/v1/uploads", other).status, 507);
  EXPECT_EQ(ask("DELETE", path, who_ + kTus).status, 204);
  EXPECT_EQ(ask("POST", "/api/v1/uploads", other).status, 201);
}

TEST_F(UploadRoutes, ACreationWhosePieceIsRefusedLeavesNoUpload) {
  const auto creation = [&](const std::string& fields, const std::string& piece) {
    return ask("POST", "/api/v1/uploads", who_ + kTus + kPiece + "Upload-Length: 3\r\n" + fields,
               piece)
        .status;
  };
  EXPECT_EQ(creation("", "abcdef"), 413);
  EXPECT_EQ(creation("Upload-Checksum: sha1\r\n", "abc"), 400);
  EXPECT_EQ(creation("Upload-Checksum: sha1 qZk+NkcGgWq6PiVxeFDCbJzQ2J0=\r\n", "xyz"), 460);
  HttpClient client(server_.port());  // sends more bytes than announced, in chunks
  client.send("POST /api/v1/uploads HTTP/1.1\r\nHost: a\r\n" + who_ + kTus + kPiece +
              "Upload-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\n6\r\nabcdef\r\n0\r\n\r\n");
  EXPECT_EQ(client.receive().status, 413);
  EXPECT_TRUE(server_.uploads().list().value().empty());
  EXPECT_EQ(creation("Upload-Checksum: sha1 qZk+NkcGgWq6PiVxeFDCbJzQ2J0=\r\n", "abc"), 201);
}

TEST_F(UploadRoutes, AnUploadIsItsTokensAlone) {
  const std::string path = created(5);
  EXPECT_EQ(ask("HEAD", path, kTus).status, 401);
  EXPECT_EQ(ask("HEAD", path, server_.bearer(Role::kViewer) + kTus).status, 403);
  EXPECT_EQ(ask("HEAD", path, server_.bearer(Role::kOperator) + kTus).status, 404);
  EXPECT_EQ(ask("HEAD", path, server_.bearer(Role::kAdmin) + kTus).status, 200);
  EXPECT_EQ(head("/api/v1/uploads/01234567890123456789abcdef").status, 404);
}

TEST_F(UploadRoutes, TheFirstPieceMayComeWithTheCreation) {
  const HttpAnswer made =
      ask("POST", "/api/v1/uploads", who_ + kTus + kPiece + "Upload-Length: 6\r\n", "abc");
  EXPECT_EQ(made.status, 201);
  EXPECT_EQ(made.field("upload-offset"), "3");
  EXPECT_EQ(patch(made.field("location"), 3, "def").status, 204);
  EXPECT_EQ(stored(made.field("location")), "abcdef");
}

TEST_F(UploadRoutes, BytesWithAnotherChecksumAreTakenBack) {
  const std::string path = created(6), sha1_of_abc = "sha1 qZk+NkcGgWq6PiVxeFDCbJzQ2J0=";
  EXPECT_EQ(patch(path, 0, "abc", "Upload-Checksum: " + sha1_of_abc + "\r\n").status, 204);
  EXPECT_EQ(patch(path, 3, "xyz", "Upload-Checksum: " + sha1_of_abc + "\r\n").status, 460);
  EXPECT_EQ(head(path).field("upload-offset"), "3");
  for (const char* malformed : {"sha1", "sha1 abc", "crc32 qZk+NkcGgWq6PiVxeFDCbJzQ2J0="})
    EXPECT_EQ(patch(path, 3, "abc", std::string("Upload-Checksum: ") + malformed + "\r\n").status,
              400);
  const std::string md5_of_def = "md5 TtlAdjDrEADA9rY4Qt76fQ==";
  EXPECT_EQ(patch(path, 3, "def", "Upload-Checksum: md5 TtlAdjDrEADA9rY4Qt76fA==\r\n").status, 460);
  EXPECT_EQ(patch(path, 3, "def", "Upload-Checksum: " + md5_of_def + "\r\n").status, 204);
  EXPECT_EQ(stored(path), "abcdef");
}

TEST_F(UploadRoutes, TheLengthMayBeStatedLaterAndOnce) {
  const HttpAnswer made =
      ask("POST", "/api/v1/uploads", who_ + kTus + "Upload-Defer-Length: 1\r\n");
  ASSERT_EQ(made.status, 201) << made.body;
  const std::string path = made.field("location");
  EXPECT_EQ(head(path).field("upload-defer-length"), "1");
  EXPECT_EQ(head(path).field("upload-length"), "");
  EXPECT_EQ(patch(path, 0, "abc").status, 204);
  EXPECT_EQ(patch(path, 3, "", "Upload-Length: 2\r\n").status, 413);
  EXPECT_EQ(patch(path, 3, "", "Upload-Length: 9999999\r\n").status, 413);
  EXPECT_EQ(stored(path), "not whole");
  EXPECT_EQ(patch(path, 3, "def", "Upload-Length: 6\r\n").status, 204);
  EXPECT_EQ(patch(path, 6, "", "Upload-Length: 7\r\n").status, 409);
  EXPECT_EQ(head(path).field("upload-length"), "6");
  EXPECT_EQ(stored(path), "abcdef");
  EXPECT_EQ(create(6, "Upload-Defer-Length: 1\r\n").status, 400);
}

TEST_F(UploadRoutes, AClientThatCanOnlyPostNamesItsMethod) {
  const std::string path = created(3);
  const std::string patch = "X-HTTP-Method-Override: PATCH\r\n";
  EXPECT_EQ(ask("POST", path, who_ + kTus + kPiece + at(0) + patch, "abc").status, 204);
  EXPECT_EQ(stored(path), "abc");
  EXPECT_EQ(ask("POST", path, who_ + kTus + "X-HTTP-Method-Override: DELETE\r\n").status, 204);
  EXPECT_EQ(head(path).status, 404);
  EXPECT_EQ(ask("POST", path, who_ + kTus + "X-HTTP-Method-Override: GET\r\n").status, 405);
}

TEST_F(UploadRoutes, AListLinksToItsNextPage) {
  for (int i = 0; i < 3; ++i)
    ASSERT_EQ(create(1).status, 201);
  const HttpAnswer first = ask("GET", "/api/v1/uploads?limit=2", who_);
  const std::string next = Json::parse(first.body).at("next");
  EXPECT_EQ(first.field("link"), "</api/v1/uploads?limit=2&cursor=" + next + ">; rel=\"next\"");
  const HttpAnswer last = ask("GET", "/api/v1/uploads?limit=2&cursor=" + next, who_);
  EXPECT_EQ(Json::parse(last.body).at("uploads").size(), 1u);
  EXPECT_EQ(last.field("link"), "");
}

}  // namespace
}  // namespace vitrine::server
