// SPDX-License-Identifier: Apache-2.0
// Tests requests whose end two parsers could see at different places. Sends them to the daemon
// directly and through a real nginx. The daemon must see exactly one request for each request that
// nginx forwards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <regex>

#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/process/nginx.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

struct Attack {
  const char* name;
  std::string bytes;  // the request for "/NAME", usually followed by one for "/hidden"
  bool refused;       // whether the daemon answers 400 and closes the connection
};

const std::string kHidden = "GET /hidden HTTP/1.1\r\nHost: a\r\n\r\n";

std::string post(const std::string& name, const std::string& fields, const std::string& body = "",
                 const std::string& version = "1.1") {
  return "POST /" + name + " HTTP/" + version + "\r\nHost: a\r\n" + fields + "\r\n" + body;
}

std::vector<Attack> attacks() {
  const std::string chunked = "Transfer-Encoding: chunked\r\n", none = "0\r\n\r\n";
  const std::string size = std::to_string(kHidden.size());
  const auto with = [](const char* name, const std::string& fields, const std::string& body,
                       bool refused = true, const std::string& version = "1.1") {
    return Attack{name, post(name, fields, body, version), refused};
  };
  return {
      with("length-then-encoding", "Content-Length: 5\r\n" + chunked, none + kHidden),
      with("encoding-then-length", chunked + "Content-Length: 5\r\n", none + kHidden),
      with("length-of-all", "Content-Length: " + size + "\r\n" + chunked, none + kHidden),
      with("two-lengths", "Content-Length: 0\r\nContent-Length: " + size + "\r\n", kHidden),
      with("two-equal-lengths", "Content-Length: 0\r\nContent-Length: 0\r\n", kHidden),
      with("list-of-lengths", "Content-Length: 0, " + size + "\r\n", kHidden),
      with("signed-length", "Content-Length: +" + size + "\r\n", kHidden),
      with("hexadecimal-length", "Content-Length: 0x10\r\n", kHidden),
      with("negative-length", "Content-Length: -1\r\n", kHidden),
      with("folded-length", "Content-Length:\r\n 0 " + size + "\r\n", kHidden),
      with("length-with-space", "Content-Length : " + size + "\r\n", kHidden),
      with("unknown-encoding", "Transfer-Encoding: xchunked\r\n", none + kHidden),
      with("two-encodings", "Transfer-Encoding: identity, chunked\r\n", none + kHidden),
      with("encoding-twice", chunked + "Transfer-Encoding: identity\r\n", none + kHidden),
      with("encoding-with-tab", "Transfer-Encoding:\tchunked, \r\n", none + kHidden),
      with("encoding-with-vertical-tab",
           "Transfer-Encoding: \x0b"
           "chunked\r\n",
           none + kHidden),
      with("encoding-with-space", "Transfer-Encoding : chunked\r\n", none + kHidden),
      with("encoding-of-old-http", chunked, none + kHidden, true, "1.0"),
      with("encoding-in-quotes", "Transfer-Encoding: \"chunked\"\r\n", none + kHidden),
      with("two-hosts", "Host: b\r\n", kHidden),
      with("bare-return-in-value", "X: a\rTransfer-Encoding: chunked\r\n", kHidden),
      with("zero-in-value", std::string("X: a\0b\r\n", 8), kHidden),
      with("field-without-colon", "nonsense\r\n", kHidden),
      with("field-without-name", ": a\r\n", kHidden),
      // The leading space makes this line a continuation of the Host field.
      with("space-before-name", " Content-Length: 0\r\n", kHidden, false),
      {"bare-newlines", "GET /bare-newlines HTTP/1.1\nHost: a\n\n" + kHidden, true},
      {"no-host", "GET /no-host HTTP/1.1\r\n\r\n" + kHidden, true},
      {"bad-version", "GET /bad-version HTTP/1.1 HTTP/1.1\r\nHost: a\r\n\r\n" + kHidden, true},
      {"old-version", "GET /old-version\r\n\r\n" + kHidden, true},
      {"lower-case-method", "get /lower-case-method HTTP/1.1\r\nHost: a\r\n\r\n", false},
      // Requests whose header is unambiguous. The daemon answers them as usual.
      with("chunked", chunked, "1\r\nx\r\n" + none, false),
      with("chunk-extension", chunked, "1;a=\"b\"\r\nx\r\n" + none, false),
      with("chunk-of-zeros", chunked, "00000\r\n\r\n", false),
      with("trailer", chunked, "0\r\nX: a\r\n\r\n", false),
      with("bad-chunk-size", chunked, "1x\r\nx\r\n" + none + kHidden, false),
      with("huge-chunk-size", chunked, "ffffffffffffffff1\r\nx\r\n" + none + kHidden, false),
      with("chunk-without-end", chunked, "1\r\nxy\r\n" + none + kHidden, false),
      {"absolute-form", "GET http://b/absolute-form HTTP/1.1\r\nHost: a\r\n\r\n", false},
      {"get-with-a-body", "GET /get-with-a-body HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\n\r\nx",
       false},
      {"escaped-lines", "GET /escaped-lines%0d%0aX:%20a HTTP/1.1\r\nHost: a\r\n\r\n", false},
  };
}

// Returns the statuses of all responses until the connection ends.
std::vector<int> statuses(std::uint16_t port, const std::string& bytes) {
  HttpClient client(port);
  client.send(bytes);
  std::vector<int> all;
  try {
    while (true)
      all.push_back(client.receive().status);
  } catch (const std::runtime_error&) {
  }
  return all;
}

std::vector<std::string> found(const std::string& text, const std::regex& line) {
  std::vector<std::string> all;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), line); at != std::sregex_iterator();
       ++at)
    all.push_back((*at)[1]);
  return all;
}

class SmugglingTest : public ::testing::Test {
 protected:
  ServedFolder folder;
  Daemon daemon{folder.path(), {"--idle-timeout", "1"}};
  const std::string last = "GET /last HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n";
};

TEST_F(SmugglingTest, AnAmbiguousRequestIsRefusedAndEndsTheConnection) {
  for (const Attack& attack : attacks()) {
    const std::vector<int> answers = statuses(daemon.port(), attack.bytes + last);
    ASSERT_FALSE(answers.empty()) << attack.name;
    EXPECT_EQ(answers.front() == 400, attack.refused) << attack.name << ": " << answers.front();
    EXPECT_TRUE(!attack.refused || answers.size() == 1) << attack.name;
  }
}

TEST_F(SmugglingTest, TheDaemonSeesOneRequestForEachThatNginxForwards) {
  const std::string upstream = "127.0.0.1:" + std::to_string(daemon.port());
  const Nginx nginx(
      "access_log access.log forwarded;\nlocation / { proxy_pass http://daemon; "
      "proxy_http_version 1.1; proxy_set_header Connection \"\"; proxy_request_buffering off; }",
      "upstream daemon { server " + upstream +
          "; keepalive 1; }\nlog_format forwarded 'up=$upstream_addr target=$request_uri';\n"
          "client_header_timeout 1s; client_body_timeout 1s; lingering_close off;");
  std::size_t answered = 0;
  for (const Attack& attack : attacks())
    answered += statuses(nginx.port(), attack.bytes + last).size();
  EXPECT_GT(answered, 10u);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
  const std::regex forwarded("up=" + upstream + " target=(\\S+)");
  const std::regex received("event=access .* target=(\\S+) status");
  const auto sent = found(nginx.log("access.log"), forwarded);
  EXPECT_GT(sent.size(), 5u);
  EXPECT_THAT(found(daemon.access_log(), received), ::testing::UnorderedElementsAreArray(sent));
}

}  // namespace
}  // namespace vitrine::test
