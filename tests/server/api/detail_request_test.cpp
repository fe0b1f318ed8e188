// SPDX-License-Identifier: Apache-2.0
#include "server/api/detail_request.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

Manifest large_manifest() {
  Manifest manifest;
  manifest.levels.resize(3);
  manifest.levels.back().faces = 1'000'000;
  manifest.file_bytes = 2'000'000;
  return manifest;
}

DetailRequest request_of(std::string_view query, const char* save_data = nullptr) {
  RequestHeader header;
  if (save_data != nullptr) header.set("Save-Data", save_data);
  return read_detail_request(Query::parse(query).value(), header, large_manifest()).value();
}

TEST(DetailRequest, WithoutAWordItIsTheWhole) {
  EXPECT_EQ(std::get<WantLevel>(request_of("").want).level, 2u);
  EXPECT_FALSE(request_of("").is_stated);
  EXPECT_EQ(std::get<WantLevel>(request_of("", "off").want).level, 2u);
}

TEST(DetailRequest, WhoSavesDataGetsAMegabyteUnlessTheyAskForMore) {
  EXPECT_EQ(std::get<WantBytes>(request_of("", "on").want).bytes, kSavedDataBytes);
  EXPECT_EQ(std::get<WantBytes>(request_of("", "ON").want).bytes, kSavedDataBytes);
  EXPECT_EQ(std::get<WantLevel>(request_of("level=highest", "on").want).level, 2u);
}

TEST(DetailRequest, ALineCarriesItsKilobitsInItsSeconds) {
  const DetailRequest detail = request_of("kbps=800&seconds=2.5");
  EXPECT_EQ(std::get<WantBytes>(detail.want).bytes, 250'000u);
  EXPECT_EQ(detail.kbps, 800);
}

TEST(DetailRequest, EqualOnesHaveEqualKeys) {
  const auto key = [](std::string_view query) {
    return key_of(request_of(query).want, large_manifest());
  };
  EXPECT_EQ(key("triangles=2000000"), key("triangles=1000000"));
  EXPECT_EQ(key("error=0.50"), key("error=.5"));
  EXPECT_EQ(key("level=highest"), key("level=2"));
  EXPECT_NE(key("triangles=10"), key("bytes=10"));
}

}  // namespace
}  // namespace vitrine::server
