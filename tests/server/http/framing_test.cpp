// SPDX-License-Identifier: Apache-2.0
#include "server/messages/framing.h"

#include <gtest/gtest.h>

#include "server/http/beast.h"

namespace vitrine::server {
namespace {

struct Case {
  const char* name;
  std::string head;  // header fields after the request line
  bool accepted;
  const char* version = "1.1";
};

// Returns whether both the parser and framing_fault() accept the request.
bool accepts(const Case& test) {
  const std::string text = std::string("GET / HTTP/") + test.version + "\r\n" + test.head + "\r\n";
  beast::http::request_parser<beast::http::string_body> parser;
  boost::system::error_code error;
  parser.put(boost::asio::buffer(text), error);
  return !error && framing_fault(parser.get()).empty();
}

const Case kFramings[] = {
    {"PlainRequest", "Host: a\r\n", true},
    {"ContentLength", "Host: a\r\nContent-Length: 0\r\n", true},
    {"Chunked", "Host: a\r\nTransfer-Encoding: chunked\r\n", true},
    {"ChunkedInUpperCase", "Host: a\r\nTransfer-Encoding: Chunked\r\n", true},
    {"NoHostInOldHttp", "", true, "1.0"},
    {"NoHost", "", false},
    {"TwoHosts", "Host: a\r\nHost: a\r\n", false},
    {"LengthAndEncoding", "Host: a\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n", false},
    {"EncodingAndLength", "Host: a\r\nTransfer-Encoding: chunked\r\nContent-Length: 1\r\n", false},
    {"LengthAndUnknownEncoding", "Host: a\r\nContent-Length: 0\r\nTransfer-Encoding: x\r\n", false},
    {"TwoLengths", "Host: a\r\nContent-Length: 0\r\nContent-Length: 1\r\n", false},
    {"TwoEqualLengths", "Host: a\r\nContent-Length: 0\r\nContent-Length: 0\r\n", false},
    {"LengthList", "Host: a\r\nContent-Length: 0, 0\r\n", false},
    {"SignedLength", "Host: a\r\nContent-Length: +0\r\n", false},
    {"HexLength", "Host: a\r\nContent-Length: 0x0\r\n", false},
    {"HugeLength", "Host: a\r\nContent-Length: 99999999999999999999999\r\n", false},
    {"EncodingIdentity", "Host: a\r\nTransfer-Encoding: identity\r\n", false},
    {"EncodingGzipChunked", "Host: a\r\nTransfer-Encoding: gzip, chunked\r\n", false},
    {"EncodingChunkedChunked", "Host: a\r\nTransfer-Encoding: chunked, chunked\r\n", false},
    {"EncodingQuoted", "Host: a\r\nTransfer-Encoding: \"chunked\"\r\n", false},
    {"EncodingWithParameter", "Host: a\r\nTransfer-Encoding: chunked;q=1\r\n", false},
    {"EncodingTwice", "Host: a\r\nTransfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
     false},
    {"EncodingInOldHttp", "Host: a\r\nTransfer-Encoding: chunked\r\n", false, "1.0"},
    {"SpaceBeforeColon", "Host: a\r\nContent-Length : 0\r\n", false},
    {"ControlInName", "Host: a\r\nContent-\x01Length: 0\r\n", false},
};

class FramingTest : public ::testing::TestWithParam<Case> {};

TEST_P(FramingTest, IsAcceptedOnlyWhereTheEndOfTheRequestIsUnambiguous) {
  EXPECT_EQ(accepts(GetParam()), GetParam().accepted);
}

INSTANTIATE_TEST_SUITE_P(Table, FramingTest, ::testing::ValuesIn(kFramings),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace vitrine::server
