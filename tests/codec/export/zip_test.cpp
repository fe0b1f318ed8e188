// SPDX-License-Identifier: Apache-2.0
#include "codec/export/zip.h"

#include <gtest/gtest.h>

#include "codec/core/byte_cursor.h"
#include "support/packages/read_zip.h"

namespace vitrine {
namespace {

std::string text_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

template <class T>
T number_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return load<T>(&bytes.at(at));
}

std::vector<MeshFile> three_files() {
  std::vector<MeshFile> files = {{"bust.obj", {}}, {"3D/bust.mtl", {}}, {"bust.jpg", {}}};
  for (std::size_t i = 0; i < 300'000; ++i)
    files[0].bytes.push_back(static_cast<std::uint8_t>(i / 1000));
  files[2].bytes = {0, 255, 0, 10};
  return files;
}

void expect_files(const std::vector<std::uint8_t>& packed, const std::vector<MeshFile>& files) {
  const auto back = test::read_zip(text_of(packed));
  ASSERT_EQ(back.size(), files.size());
  for (const MeshFile& file : files)
    EXPECT_EQ(back.at(file.name), text_of(file.bytes)) << file.name;
}

TEST(Zip, HoldsTheFilesAndEqualFilesGiveEqualBytes) {
  const std::vector<MeshFile> files = three_files();
  const auto packed = zip(files);
  ASSERT_TRUE(packed) << packed.error().message;
  EXPECT_LT(packed->size(), 30'000u) << "text is compressed";
  expect_files(*packed, files);
  EXPECT_EQ(zip(files).value(), *packed);
}

TEST(StoredZip, HoldsTheFilesAndEqualFilesGiveEqualBytes) {
  const std::vector<MeshFile> files = three_files();
  const auto packed = stored_zip(files);
  ASSERT_TRUE(packed) << packed.error().message;
  EXPECT_GT(packed->size(), files[0].bytes.size());
  expect_files(*packed, files);
  EXPECT_EQ(stored_zip(files).value(), *packed);
}

// Strict readers compare the local header of each file with its entry in the directory.
TEST(Zip, LocalHeadersAgreeWithTheDirectory) {
  const std::vector<std::uint8_t> packed = zip(three_files()).value();
  const std::string text = text_of(packed);
  std::size_t entries = 0;
  for (std::size_t at = 0; (at = text.find("PK\1\2", at)) != text.npos; ++at, ++entries) {
    const std::size_t local = number_at<std::uint32_t>(packed, at + 42);
    const std::size_t shared = 24;  // bytes that both headers share, from version to name length
    ASSERT_EQ(text.substr(local, 4), "PK\3\4");
    EXPECT_EQ(text.substr(local + 4, shared), text.substr(at + 6, shared));
    EXPECT_EQ(number_at<std::uint16_t>(packed, local + 6), 0) << "no descriptor after the bytes";
  }
  EXPECT_EQ(entries, 3u);
}

// Finds the files as readers of USDZ do: from each local header to the next.
TEST(StoredZip, LocalHeadersLeadToAlignedFilesWhateverTheirNames) {
  for (std::size_t length = 1; length <= 65; ++length) {
    const std::vector<MeshFile> files = {{std::string(length, 'a'), {1, 2, 3}},
                                         {std::string(length, 'b'), {4}}};
    const std::vector<std::uint8_t> zip = stored_zip(files).value();
    expect_files(zip, files);
    std::size_t at = 0;
    for (const MeshFile& file : files) {
      ASSERT_EQ(number_at<std::uint32_t>(zip, at), 0x04034B50u);
      EXPECT_EQ(number_at<std::uint16_t>(zip, at + 6), 0) << "no descriptor after the bytes";
      EXPECT_EQ(number_at<std::uint16_t>(zip, at + 8), 0) << "stored";
      EXPECT_EQ(number_at<std::uint32_t>(zip, at + 18), file.bytes.size());
      EXPECT_EQ(number_at<std::uint32_t>(zip, at + 22), file.bytes.size());
      const std::size_t name = number_at<std::uint16_t>(zip, at + 26),
                        extra = number_at<std::uint16_t>(zip, at + 28);
      if (extra > 0) {
        ASSERT_GE(extra, 4u) << "an extra field has a header";
        EXPECT_EQ(number_at<std::uint16_t>(zip, at + 30 + name + 2), extra - 4);
      }
      at += 30 + name + extra;
      EXPECT_EQ(at % 64, 0u) << length;
      EXPECT_EQ(zip.at(at), file.bytes[0]);
      at += file.bytes.size();
    }
    EXPECT_EQ(number_at<std::uint32_t>(zip, at), 0x02014B50u) << "then comes the directory";
  }
}

}  // namespace
}  // namespace vitrine
