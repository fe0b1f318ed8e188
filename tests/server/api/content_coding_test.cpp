// SPDX-License-Identifier: Apache-2.0
#include "server/messages/content_coding.h"

#include <gtest/gtest.h>

#include "server/api/handlers.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

TEST(AcceptsGzip, WhereItIsListedAndNotRefused) {
  for (const char* list : {"gzip", "GZip", "br, gzip;q=0.5", "*", "*;q=0.1", "deflate,gzip",
                           "gzip; q=0.001", "*;q=0, gzip", "gzip \t;\tQ=1.0", ", ,gzip"})
    EXPECT_TRUE(accepts_gzip(list)) << list;
  for (const char* list :
       {"", "identity", "br", "gzip;q=0", "gzip;q=0.000", "*;q=0", "*, gzip;q=0", "gzip;q=0, *",
        "x", ";;;", "gzip;q=", "gzip;q", "gzip;level=9", "gzip;q=-1", "gzip gzip", "xgzip"})
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

}  // namespace
}  // namespace vitrine::server
