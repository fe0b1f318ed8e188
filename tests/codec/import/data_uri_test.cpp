// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/data_uri.h"

#include <gtest/gtest.h>

#include <string>

namespace vitrine {
namespace {

std::string read(const std::string& uri) {
  const auto bytes = data_in_uri(uri);
  return bytes ? std::string(bytes->begin(), bytes->end()) : "nothing";
}

TEST(DataUri, Base64IsThatOfRfc4648) {
  const std::pair<std::string, std::string> vectors[] = {{"", ""},
                                                         {"Zg==", "f"},
                                                         {"Zm8=", "fo"},
                                                         {"Zm9v", "foo"},
                                                         {"Zm9vYg==", "foob"},
                                                         {"Zm9vYmE=", "fooba"},
                                                         {"Zm9vYmFy", "foobar"},
                                                         {"+/+/", "\xFB\xFF\xBF"}};
  for (const auto& [text, bytes] : vectors)
    EXPECT_EQ(read("data:image/png;base64," + text), bytes) << text;
}

TEST(DataUri, AnythingElseIsNothing) {
  for (const std::string uri :
       {"", "data:", "data:,Zm9v", "skin.png", "x;base64,Zm9v", "data:;base64,Z",
        "data:;base64,Zm8", "data:;base64,Z===", "data:;base64,Zm=v", "data:;base64,Zm-_",
        "data:;base64,Zm 9v", "data:;base64,\xFF\xFF"}) {
    EXPECT_EQ(read(uri), "nothing") << uri;
  }
}

}  // namespace
}  // namespace vitrine
