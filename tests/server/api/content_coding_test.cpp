// SPDX-License-Identifier: Apache-2.0
#include "server/messages/content_coding.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codec/build/build_model.h"
#include "codec/export/write_mesh.h"
#include "server/api/handlers.h"
#include "server/api/routes.h"
#include "server/messages/conditional.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/meshes.h"
#include "support/packages/gunzip.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

TEST(AcceptsGzip, WhereItIsListedAndNotRefused) {
  for (const char* list :
       {"gzip", "GZip", "br, gzip;q=0.5", "*", "*;q=0.1", "deflate,gzip", "gzip; q=0.001",
        "*;q=0, gzip", "gzip \t;\tQ=1.0", ", ,gzip", "identity;q=0, gzip", "identity;q=0, *"})
    EXPECT_TRUE(accepts_gzip(list)) << list;
  for (const char* list : {"", "identity", "br", "gzip;q=0", "gzip;q=0.000", "*;q=0", "*, gzip;q=0",
                           "gzip;q=0, *", "identity;q=0", "identity, *;q=0", "x", ";;;",
                           "gzip;q=", "gzip;q", "gzip;level=9", "gzip;q=-1", "gzip gzip", "xgzip"})
    EXPECT_FALSE(accepts_gzip(list)) << list;
}

constexpr ApiRoute kRoutes[] = {{.method = Method::kGet,
                                 .path = "/{rest}",
                                 .handler = show_asset,
                                 .executor = Executor::kInline}};

class Packed : public testing::Test {
 protected:
  test::HttpAnswer get(const std::string& fields, const std::string& method = "GET") {
    return test::http_get(server_.port(), "/docs.js", fields, method);
  }

  test::LocalServer server_{kRoutes};
};

TEST_F(Packed, GoesToWhomTakesIt) {
  const auto packed = get("Accept-Encoding: gzip, br\r\n"), plain = get("");
  EXPECT_EQ(packed.body, "gz");
  EXPECT_EQ(packed.field("content-encoding"), "gzip");
  EXPECT_EQ(plain.body, "plain");
  EXPECT_EQ(plain.field("content-encoding"), "");
  for (const auto& answer : {packed, plain}) {
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.field("vary"), "Accept-Encoding");
    EXPECT_EQ(answer.field("content-type"), "text/javascript");
  }
}

TEST_F(Packed, EachFormHasATagOfItsOwn) {
  const std::string gzip = "Accept-Encoding: gzip\r\n";
  const std::string packed = get(gzip).field("etag"), plain = get("").field("etag");
  EXPECT_NE(packed, plain);
  const auto not_modified = get(gzip + "If-None-Match: " + packed + "\r\n");
  EXPECT_EQ(not_modified.status, 304);
  EXPECT_EQ(not_modified.field("vary"), "Accept-Encoding");
  EXPECT_EQ(not_modified.field("content-encoding"), "");
  EXPECT_EQ(get(gzip + "If-None-Match: " + plain + "\r\n").status, 200);
  EXPECT_EQ(get("If-None-Match: " + packed + "\r\n").body, "plain");
}

TEST_F(Packed, IsWhatItsHeadAndItsPartsAreOf) {
  const std::string gzip = "Accept-Encoding: gzip\r\n";
  const auto head = get(gzip, "HEAD"), whole = get(gzip);
  EXPECT_EQ(head.status, 200);
  for (const char* name : {"content-length", "content-encoding", "content-type", "etag", "vary"})
    EXPECT_EQ(head.field(name), whole.field(name)) << name;
  const std::string part = gzip + "Range: bytes=1-1\r\n";
  const auto second = get(part + "If-Range: " + whole.field("etag") + "\r\n");
  EXPECT_EQ(second.status, 206);
  EXPECT_EQ(second.body, "z");
  EXPECT_EQ(second.field("content-range"), "bytes 1-1/2");
  EXPECT_EQ(second.field("content-encoding"), "gzip");
  EXPECT_EQ(second.field("vary"), "Accept-Encoding");
  EXPECT_EQ(get(part + "If-Range: " + get("").field("etag") + "\r\n").body, "gz");
}

TEST(Gzip, HoldsTheBytesWithoutSpareMemory) {
  for (const std::size_t size : {0u, 1u, 1'000'000u}) {
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t i = 0; i < size; ++i)
      bytes[i] = static_cast<std::uint8_t>(i * i >> 7);
    const auto file = gzip(bytes);
    EXPECT_EQ(test::gunzip({file.begin(), file.end()}), std::string(bytes.begin(), bytes.end()));
    EXPECT_EQ(gzip(bytes), file);
    EXPECT_EQ(file.capacity(), file.size());
  }
}

// Tests which handlers' responses in_accepted_coding() compresses.
class AcceptedCoding : public testing::Test {
 protected:
  static constexpr std::size_t kMost = 10'000;

  static Response json_of(std::size_t size) {
    return revalidated("application/json", std::string(size, ' '));
  }
  bool is_compressed(Response response) const {
    const Response made = in_accepted_coding(request_, std::move(response), kMost);
    return std::ranges::any_of(made.fields,
                               [](const auto& one) { return one.first == "Content-Encoding"; });
  }

  RequestHeader request_ = [] {
    RequestHeader header;
    header.set(beast::http::field::accept_encoding, "gzip");
    return header;
  }();
};

TEST_F(AcceptedCoding, ASmallOrVeryLargeBodyStaysAsItIs) {
  EXPECT_FALSE(is_compressed(json_of(kLeastToCompress - 1)));
  EXPECT_TRUE(is_compressed(json_of(kLeastToCompress)));
  EXPECT_TRUE(is_compressed(json_of(kMost)));
  EXPECT_FALSE(is_compressed(json_of(kMost + 1)));
}

TEST_F(AcceptedCoding, OnlyJsonIsCompressed) {
  for (const char* type : {"application/json", "application/json; charset=utf-8",
                           "application/ld+json;profile=\"x\""}) {
    Response response = json_of(2'000);
    response.type = type;
    EXPECT_TRUE(is_compressed(std::move(response))) << type;
  }
  for (const char* type : {"application/octet-stream", "model/gltf-binary", "image/png",
                           "text/event-stream", "application/problem+json", "text/html", ""}) {
    Response response = json_of(2'000);
    response.type = type;
    EXPECT_FALSE(is_compressed(std::move(response))) << type;
  }
}

TEST_F(AcceptedCoding, OnlySuccessfulPublicResponsesAreCompressed) {
  for (const Caching caching : {Caching::kNever, Caching::kPrivate, Caching::kImmutable}) {
    Response response = json_of(2'000);
    response.caching = caching;
    EXPECT_FALSE(is_compressed(std::move(response)));
  }
  Response failed = json_of(2'000);
  failed.status = 404;
  EXPECT_FALSE(is_compressed(std::move(failed)));
  request_.set(beast::http::field::authorization, "Bearer x");
  EXPECT_FALSE(is_compressed(json_of(2'000)));
}

// Returns a JSON text that is one byte too long to be compressed by the thread that serves
// connections. Only a worker may compress it.
Response show_large(const Request&, Services&) {
  return revalidated("application/json", std::string(64 * 1024 + 1, ' '));
}

constexpr ApiRoute kLargeRoutes[] = {{.method = Method::kGet,
                                      .path = "/inline",
                                      .handler = show_large,
                                      .executor = Executor::kInline},
                                     {.method = Method::kGet,
                                      .path = "/worker",
                                      .handler = show_large,
                                      .executor = Executor::kWorker}};

TEST(LargeJson, IsCompressedByAWorkerOnly) {
  const test::LocalServer server(kLargeRoutes);
  const auto get = [&](const char* path) {
    return test::http_get(server.port(), path, "Accept-Encoding: gzip\r\n");
  };
  EXPECT_EQ(get("/inline").field("content-encoding"), "");
  EXPECT_EQ(get("/worker").field("content-encoding"), "gzip");
}

class PackedJson : public testing::Test {
 protected:
  test::HttpAnswer get(const std::string& fields, const std::string& path = "iiif/collection.json",
                       const std::string& method = "GET") {
    return test::http_get(server_.port(), "/api/v1/" + path, fields, method);
  }
  void SetUp() override {
    const auto ply = write_mesh(test::torus(40, 20), MeshFormat::kPly);
    const auto file = build_model(*ply, {}, {}).value().file;
    for (int k = 0; k < 5; ++k)
      id_ =
          publish(server_.store(), server_.catalogue(), file, {.title = fmt::format("Bust {}", k)})
              ->id.to_string();
  }

  test::LocalServer server_{public_routes()};
  std::string id_;  // ID of a published model
  const std::string gzip_ = "Accept-Encoding: gzip\r\n";
};

TEST_F(PackedJson, GoesToClientsThatTakeIt) {
  for (const std::string& path :
       {std::string("openapi.json"), std::string("models"), std::string("iiif/collection.json"),
        "iiif/" + id_ + "/manifest.json", "models/" + id_ + "/manifest",
        "models/" + id_ + "/manifest?level=lowest"}) {
    const auto packed = get(gzip_, path), plain = get("", path);
    EXPECT_EQ(packed.field("content-encoding"), "gzip") << path;
    EXPECT_EQ(plain.field("content-encoding"), "") << path;
    EXPECT_LT(packed.body.size(), plain.body.size() * 2 / 3) << path;
    EXPECT_EQ(test::gunzip(packed.body), plain.body) << path;
    EXPECT_NE(packed.field("etag"), plain.field("etag")) << path;
    for (const auto& answer : {packed, plain})
      EXPECT_THAT(answer.field("vary"), testing::HasSubstr("Accept-Encoding")) << path;
  }
}

TEST_F(PackedJson, IsNotSentToClientsThatDoNotTakeIt) {
  const std::string plain = get("").body;
  for (const std::string list : {"gzip;q=0", "identity", "*;q=0, identity", "gzip;q=0, *", "br"})
    EXPECT_EQ(get("Accept-Encoding: " + list + "\r\n").body, plain) << list;
  for (const std::string list : {"*", "identity;q=0, gzip", "br, gzip;q=0.1"})
    EXPECT_EQ(get("Accept-Encoding: " + list + "\r\n").field("content-encoding"), "gzip") << list;
  // [RFC9110] section 12.1 allows a server to send a response in a form that the client does not
  // accept.
  const auto refuses_all = get("Accept-Encoding: identity;q=0\r\n");
  EXPECT_EQ(refuses_all.status, 200);
  EXPECT_EQ(refuses_all.body, plain);
}

TEST_F(PackedJson, HasATagOfItsOwnThatStillNamesTheState) {
  const std::string packed = get(gzip_).field("etag"), plain = get("").field("etag");
  EXPECT_NE(packed, plain);
  const auto same = get(gzip_ + "If-None-Match: " + packed + "\r\n");
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(same.field("etag"), packed);
  EXPECT_EQ(same.field("vary"), "Accept-Encoding");
  EXPECT_EQ(get("If-None-Match: " + plain + "\r\n").status, 304);
  EXPECT_EQ(get(gzip_ + "If-None-Match: " + plain + "\r\n").status, 200);
  EXPECT_EQ(get("If-None-Match: " + packed + "\r\n").status, 200);
  EXPECT_TRUE(matches_any(packed, plain));
  EXPECT_FALSE(matches_any("W/" + packed, plain));
  EXPECT_FALSE(matches_any("\"other-gzip\"", plain));
  EXPECT_FALSE(matches_any("-gzip\"", ""));
}

TEST_F(PackedJson, IsTheBodyToWhichHeadAndRangesRefer) {
  const auto head = get(gzip_, "iiif/collection.json", "HEAD"), whole = get(gzip_);
  for (const char* name : {"content-length", "content-encoding", "content-type", "etag", "vary"})
    EXPECT_EQ(head.field(name), whole.field(name)) << name;
  EXPECT_EQ(head.field("content-length"), std::to_string(whole.body.size()));
  const std::string range = "Range: bytes=10-19\r\n";
  const auto part = get(gzip_ + range + "If-Range: " + whole.field("etag") + "\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.body, whole.body.substr(10, 10));
  EXPECT_EQ(part.field("content-range"), fmt::format("bytes 10-19/{}", whole.body.size()));
  EXPECT_EQ(part.field("content-encoding"), "gzip");
  EXPECT_EQ(part.field("etag"), whole.field("etag"));
  const auto plain = get("");
  EXPECT_EQ(get(gzip_ + range + "If-Range: " + plain.field("etag") + "\r\n").body, whole.body);
  EXPECT_EQ(get(range + "If-Range: " + whole.field("etag") + "\r\n").body, plain.body);
  EXPECT_EQ(get(range).body, plain.body.substr(10, 10));
}

TEST_F(PackedJson, IsNotMadeForTokensAndSmallBodies) {
  const std::string bearer = server_.bearer(Role::kViewer);
  for (const std::string& path : {std::string("iiif/collection.json"),
                                  "models/" + id_ + "/manifest", std::string("openapi.json")}) {
    EXPECT_EQ(get(gzip_ + bearer, path).field("content-encoding"), "") << path;
    EXPECT_EQ(get(gzip_ + bearer, path).status, 200) << path;
  }
  EXPECT_EQ(get(gzip_, "models?limit=1").field("content-encoding"), "");
}

TEST_F(PackedJson, OfAManifestIsKeptWithIt) {
  const auto first = get(gzip_, "models/" + id_ + "/manifest");
  const auto model = server_.services().models.find(ModelId::parse(id_).value()).value();
  ASSERT_TRUE(model && model->kept_manifest());
  const auto& kept = model->kept_manifest()->gzip;
  EXPECT_EQ(first.body, std::string(kept.begin(), kept.end()));
  const auto second = get(gzip_, "models/" + id_ + "/manifest");
  EXPECT_EQ(second.body, first.body);
  EXPECT_EQ(second.field("etag"), first.field("etag"));
  EXPECT_EQ(second.field("content-encoding"), "gzip");
}

TEST_F(PackedJson, IsDocumented) {
  const auto paths = nlohmann::json::parse(get("", "openapi.json").body)["paths"];
  for (const char* path : {"/api/v1/models", "/api/v1/models/{id}/manifest",
                           "/api/v1/models/{id}/export.{format}", "/api/v1/iiif/collection.json"}) {
    const auto headers = paths[path]["get"]["responses"]["200"]["headers"];
    EXPECT_TRUE(headers.contains("Content-Encoding") && headers.contains("Vary")) << path;
  }
  EXPECT_FALSE(paths["/api/v1/chunks/{sha256}"]["get"]["responses"]["200"].contains("headers"));
}

}  // namespace
}  // namespace vitrine::server
