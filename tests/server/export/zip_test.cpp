// SPDX-License-Identifier: Apache-2.0
#include "server/export/zip.h"

#include <gtest/gtest.h>

#include "support/packages/read_zip.h"

namespace vitrine::server {
namespace {

std::string text_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

TEST(Zip, HoldsTheFilesAndEqualFilesGiveEqualBytes) {
  std::vector<MeshFile> files = {{"bust.obj", {}}, {"bust.mtl", {}}, {"bust.jpg", {}}};
  for (std::size_t i = 0; i < 300'000; ++i)
    files[0].bytes.push_back(static_cast<std::uint8_t>(i / 1000));
  files[2].bytes = {0, 255, 0, 10};
  const auto packed = zip(files);
  ASSERT_TRUE(packed) << packed.error().message;
  EXPECT_LT(packed->size(), 30'000u) << "text is compressed";
  const auto back = test::read_zip(text_of(*packed));
  ASSERT_EQ(back.size(), files.size());
  for (const MeshFile& file : files)
    EXPECT_EQ(back.at(file.name), text_of(file.bytes)) << file.name;
  EXPECT_EQ(zip(files).value(), *packed);
}

}  // namespace
}  // namespace vitrine::server
