// SPDX-License-Identifier: Apache-2.0
// Resumable uploads according to the protocol tus 1.0.0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "server/api/routes.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using test::HttpAnswer;
using test::HttpClient;
using test::LocalServer;
using testing::HasSubstr;

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
  head(path);  // once this is answered, the metrics count the aborted requests
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

}  // namespace
}  // namespace vitrine::server
