// SPDX-License-Identifier: Apache-2.0
#include "server/export/export_kind.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(ExportKind, TheEndOfAFileNameChoosesIt) {
  for (const ExportFormat& row : kExportFormats) {
    const std::string name = "some.folder/bust." + std::string(row.extension);
    const auto plain = export_kind_of(name), packed = export_kind_of(name + ".zip");
    ASSERT_TRUE(plain) << name;
    EXPECT_EQ(plain->format, row.format);
    EXPECT_FALSE(plain->is_zip);
    ASSERT_EQ(packed.has_value(), has_companions(row.format)) << name;
    if (packed) {
      EXPECT_EQ(packed->format, row.format);
      EXPECT_TRUE(packed->is_zip);
    }
  }
  EXPECT_TRUE(export_kind_of("BUST.OBJ.ZIP"));
  for (const char* other : {"", "bust", "bust.zip", "bust.obj.gz", "bust.zip.obj.png", "obj"})
    EXPECT_FALSE(export_kind_of(other)) << other;
}

TEST(ExportKind, TheStemLacksFolderAndExtensions) {
  EXPECT_EQ(stem_of_export("a/b.c/bust.ply"), "bust");
  EXPECT_EQ(stem_of_export("bust.v2.obj.zip"), "bust.v2");
  EXPECT_EQ(stem_of_export("bust.OBJ.ZIP"), "bust");
}

TEST(ExportKind, TheTextsListTheZips) {
  EXPECT_EQ(std::string_view(kZipSuffixes), ".ply.zip, .obj.zip, .wrl.zip");
  EXPECT_EQ(std::string_view(kZipExtensions), "ply.zip, obj.zip or wrl.zip");
  EXPECT_EQ(std::string_view(kZipChoice), "ply.zip|obj.zip|wrl.zip");
}

}  // namespace
}  // namespace vitrine::server
