// SPDX-License-Identifier: Apache-2.0
#include "codec/package/unpack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "codec/package/gunzip.h"
#include "support/as_bytes.h"
#include "support/counting_new.h"
#include "support/packages/write_package.h"

namespace vitrine {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using vitrine::test::FilesToPack;
using vitrine::test::gzip_of;
using vitrine::test::package_of;
using vitrine::test::tar_of;
using vitrine::test::zip_of;
using vitrine::testing::as_bytes;

bool keeps_all(std::string_view) {
  return true;
}

// Returns the files of a package. Fails the test if it cannot be unpacked.
FilesToPack unpacked(std::string_view package) {
  const auto files = unpack(as_bytes(package), keeps_all);
  EXPECT_TRUE(files.has_value()) << files.error().message;
  FilesToPack out;
  for (const PackedFile& file : files.value_or(std::vector<PackedFile>()))
    out.emplace_back(file.path, std::string(file.bytes.begin(), file.bytes.end()));
  return out;
}

std::string fault_of(std::string_view package) {
  const auto files = unpack(as_bytes(package), keeps_all);
  EXPECT_FALSE(files.has_value());
  return files ? "" : files.error().message;
}

const FilesToPack kFiles{{"scene.gltf", "{}"},
                         {"textures/a b.png", std::string(100'000, 'x')},
                         {"B\xC3\xBCste/sc\xC3\xA8ne.obj", "v 0 0 0"},
                         {"empty", ""}};

TEST(Unpack, EachKindOfPackageGivesItsFiles) {
  EXPECT_EQ(unpacked(zip_of(kFiles)), kFiles);
  EXPECT_EQ(unpacked(package_of(kFiles, "zip", "zip:compression=store")), kFiles);
  for (const char* format : {"v7tar", "ustar", "gnutar", "pax"}) {
    EXPECT_EQ(unpacked(package_of(kFiles, format)), kFiles) << format;
    EXPECT_EQ(unpacked(gzip_of(package_of(kFiles, format))), kFiles) << format;
  }
}

TEST(Unpack, BytesWithAWrongSumAreNoOldTar) {
  std::string tar = package_of({{"a.obj", "v"}}, "v7tar");
  EXPECT_TRUE(is_package(as_bytes(tar)));
  ++tar[0];
  EXPECT_FALSE(is_package(as_bytes(tar)));
  EXPECT_FALSE(is_package(as_bytes(std::string(512, ' '))));
}

TEST(Unpack, AGzipFileHasNoPath) {
  EXPECT_EQ(unpacked(gzip_of("solid")), (FilesToPack{{"", "solid"}}));
}

TEST(Unpack, MembersOfAGzipFileFollowEachOther) {
  EXPECT_EQ(unpacked(gzip_of("so") + gzip_of("lid") + "\0\0"), (FilesToPack{{"", "solid"}}));
}

TEST(Unpack, PackagesInAPackageAreUnpacked) {
  EXPECT_EQ(unpacked(zip_of({{"source/a.zip", zip_of({{"b/c.obj", "v"}})},
                             {"d.ply.gz", gzip_of("ply")},
                             {"e.tgz", gzip_of(tar_of({{"f", "g"}}))}})),
            (FilesToPack{{"source/a.zip/b/c.obj", "v"}, {"d.ply", "ply"}, {"e.tgz/f", "g"}}));
}

TEST(Unpack, PackagesBelowTheThirdLevelStayPacked) {
  const std::string innermost = zip_of({{"a", "b"}});
  EXPECT_EQ(unpacked(gzip_of(gzip_of(gzip_of(innermost)))), (FilesToPack{{"", innermost}}));
}

TEST(Unpack, FilesThatAreNotWantedAreCut) {
  const std::string zip = zip_of(kFiles);
  const auto files = unpack(as_bytes(zip), [](std::string_view path) { return path == "empty"; });
  ASSERT_TRUE(files.has_value());
  ASSERT_EQ(files->size(), kFiles.size());
  EXPECT_EQ((*files)[1].bytes, std::vector<std::uint8_t>(kHeadBytes, 'x'));
}

TEST(Unpack, BackslashesSeparatePartsOfAPath) {
  EXPECT_EQ(unpacked(tar_of({{"textures\\a.png", "x"}})), (FilesToPack{{"textures/a.png", "x"}}));
}

TEST(Unpack, ControlCharactersInPathsAreReplaced) {
  EXPECT_EQ(unpacked(tar_of({{"a\n\x1B[2Jb", "x"}})), (FilesToPack{{"a??[2Jb", "x"}}));
}

TEST(Unpack, PathsThatLeadOutsideAreRefused) {
  for (const std::string path : {"../a", "a/../../b", "a/..", "/etc/passwd", "C:/a", "..\\a"}) {
    EXPECT_THAT(fault_of(tar_of({{path, "x"}})), HasSubstr("which lies outside of it")) << path;
  }
  EXPECT_EQ(unpacked(tar_of({{"a..b/...", "x"}})), (FilesToPack{{"a..b/...", "x"}}));
}

TEST(Unpack, LongPathsAreRefused) {
  EXPECT_EQ(unpacked(tar_of({{std::string(kMostPathBytes, 'a'), ""}})).size(), 1);
  EXPECT_THAT(fault_of(tar_of({{std::string(kMostPathBytes + 1, 'a'), ""}})),
              HasSubstr("shorter names"));
}

// Returns a tar whose first entry is of the given type.
std::string tar_with(char type) {
  std::string tar = tar_of({{"link", ""}, {"a", "b"}});
  constexpr std::size_t kSum = 148, kType = 156, kTarget = 157;
  tar[kType] = type;
  tar.replace(kTarget, 11, "/etc/passwd");
  std::fill_n(tar.begin() + kSum, 8, ' ');
  unsigned sum = 0;
  for (std::size_t i = 0; i < 512; ++i)
    sum += static_cast<unsigned char>(tar[i]);
  char digits[8];
  std::snprintf(digits, sizeof digits, "%06o", sum);
  tar.replace(kSum, 7, std::string(digits, 7));
  return tar;
}

TEST(Unpack, LinksAndDevicesAreIgnored) {
  for (const char type : {'1', '2', '3', '4', '5', '6'})
    EXPECT_EQ(unpacked(tar_with(type)), (FilesToPack{{"a", "b"}})) << type;
}

TEST(Unpack, ManyFilesAreRefused) {
  FilesToPack files(kMostPackedFiles, {"a", ""});
  EXPECT_EQ(unpacked(tar_of(files)).size(), kMostPackedFiles);
  files.emplace_back("a", "");
  EXPECT_THAT(fault_of(tar_of(files)), HasSubstr("over 65536 files"));
}

TEST(Unpack, APackageThatUnpacksToTooMuchIsRefused) {
  const std::string zeros(10'000'000, '\0');
  EXPECT_EQ(unpacked(gzip_of(zeros))[0].second.size(), zeros.size());
  EXPECT_EQ(unpacked(zip_of({{"a", zeros}}))[0].second.size(), zeros.size());
  for (const std::string& bomb :
       {gzip_of(gzip_of(zeros)), zip_of({{"a.zip", zip_of({{"b", zeros}})}}),
        gzip_of(tar_of({{"a", zeros}, {"b", zeros}, {"c.gz", gzip_of(zeros)}}))}) {
    const std::size_t before = test::heap_bytes();
    test::start_peak();
    EXPECT_THAT(fault_of(bomb), HasSubstr("unpacks to more than")) << bomb.size();
    EXPECT_LT(test::peak_heap_bytes() - before, 5 * kMostUnpackedPerByte * bomb.size() + (1 << 18));
  }
}

TEST(Unpack, EncryptedPackagesAreNamed) {
  std::string zip = zip_of({{"a", "b"}});
  zip[6] = static_cast<char>(zip[6] | 1);
  const std::size_t directory = zip.find("PK\1\2");
  ASSERT_NE(directory, zip.npos);
  zip[directory + 8] = static_cast<char>(zip[directory + 8] | 1);
  EXPECT_THAT(fault_of(zip), HasSubstr("encrypted; pack it again without a password"));
}

TEST(Unpack, RareMethodsAreNamed) {
  std::string zip = package_of({{"a", "b"}}, "zip", "zip:compression=store");
  constexpr char kLzma = 14;
  zip[8] = kLzma;
  zip[zip.find("PK\1\2") + 10] = kLzma;
  EXPECT_THAT(fault_of(zip), AllOf(HasSubstr("lzma"), HasSubstr("as an ordinary zip")));
}

TEST(Unpack, ChangedContentsAreRefused) {
  std::string zip = package_of({{"a", "contents"}}, "zip", "zip:compression=store");
  zip[zip.find("contents")] = 'k';
  EXPECT_THAT(fault_of(zip), HasSubstr("damaged"));
  std::string gzip = gzip_of("contents");
  gzip[gzip.size() - 8] = static_cast<char>(~gzip[gzip.size() - 8]);  // damages the checksum
  EXPECT_THAT(fault_of(gzip), HasSubstr("damaged"));
}

// Expects that unpacking a damaged package gives an error of one line, or files within the limit of
// size that applies to every package.
void expect_harmless(const std::string& package) {
  if (!is_package(as_bytes(package))) return;
  const auto files = unpack(as_bytes(package), keeps_all);
  if (!files) {
    EXPECT_EQ(files.error().message.find('\n'), std::string::npos) << files.error().message;
    return;
  }
  std::size_t total = 0;
  for (const PackedFile& file : *files)
    total += file.bytes.size();
  EXPECT_LE(total, kMostUnpackedPerByte * package.size());
}

TEST(Unpack, CutAndFlippedAtEveryByte) {
  const FilesToPack files{{"a.obj", "v 0 0 0\nv 1 0 0\n"}, {"t/b.png", "picture"}};
  for (const std::string& package :
       {zip_of(files), package_of(files, "zip", "zip:compression=store"), tar_of(files),
        package_of(files, "pax"), gzip_of(tar_of(files)), gzip_of("v 0 0 0\n")}) {
    for (std::size_t size = 0; size < package.size(); ++size)
      expect_harmless(package.substr(0, size));
    for (std::size_t i = 0; i < package.size(); ++i) {
      for (const int mask : {0x01, 0x80, 0xFF}) {
        std::string flipped = package;
        flipped[i] = static_cast<char>(flipped[i] ^ mask);
        expect_harmless(flipped);
      }
    }
  }
}

TEST(Unpack, ATruncatedPackageIsRefused) {
  const std::string zip = zip_of(kFiles), gzip = gzip_of("contents");
  for (std::size_t size = 4; size + 30 < zip.size(); size += 13)
    EXPECT_THAT(fault_of(zip.substr(0, size)), HasSubstr("damaged")) << size;
  for (std::size_t size = 3; size < gzip.size(); ++size)
    EXPECT_THAT(fault_of(gzip.substr(0, size)), HasSubstr("cut short")) << size;
}

}  // namespace
}  // namespace vitrine
