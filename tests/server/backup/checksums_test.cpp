// SPDX-License-Identifier: Apache-2.0
#include "server/backup/checksums.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

std::optional<Checksums> parse(std::string_view text) {
  return parse_checksums({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(Checksums, ComeBackAsTheyWere) {
  const Checksums sums = {{"a/b c", sha256({})}, {"d", Sha256{1, 2, 3}}};
  EXPECT_EQ(parse(to_text(sums)), sums);
  EXPECT_EQ(parse(""), Checksums{});
}

TEST(Checksums, AMalformedLineIsRefused) {
  const std::string hash(64, 'a');
  EXPECT_TRUE(parse(hash + "  name\n"));
  for (const std::string& text :
       {hash, hash + "  ", hash + " name", hash.substr(1) + "  name", hash + "  name\n\n",
        std::string(64, 'g') + "  name", hash + "  name\n" + hash + "  name\n"}) {
    EXPECT_FALSE(parse(text)) << text;
  }
}

}  // namespace
}  // namespace vitrine::server
