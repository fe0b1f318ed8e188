// SPDX-License-Identifier: Apache-2.0
// Opens files that have a damaged base mesh.
#include "codec/build/open_model.h"

#include <gtest/gtest.h>

#include <span>

#include "codec/build/build_model.h"
#include "codec/export/write_mesh.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

class HostileBaseMesh : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto built = build_model(*write_mesh(torus(40, 20), MeshFormat::kPly), {}, {});
    ASSERT_TRUE(built);
    file_ = built->file;
    base_ = built->report.manifest.base_offset;
    end_ = base_ + built->report.manifest.base_length;
  }

  void expect_refusal(std::span<const std::uint8_t> bytes, std::size_t at) {
    const auto refiner = open_model(bytes);
    ASSERT_FALSE(refiner) << "byte " << at;
    EXPECT_EQ(refiner.error().code, ErrorCode::kBadInput) << "byte " << at;
    EXPECT_NE(refiner.error().message.find("base mesh"), std::string::npos)
        << refiner.error().message;
  }

  std::vector<std::uint8_t> file_;
  std::size_t base_ = 0, end_ = 0;  // begin and end of the base mesh, in bytes
};

TEST_F(HostileBaseMesh, NamesABaseMeshThatIsCutAtAnyByte) {
  for (std::size_t size = base_; size < end_; ++size)
    ASSERT_NO_FATAL_FAILURE(expect_refusal(std::span(file_).first(size), size));
  EXPECT_TRUE(open_model(std::span(file_).first(end_)));
}

TEST_F(HostileBaseMesh, NamesABaseMeshThatIsChangedAtAnyByte) {
  for (std::size_t i = base_; i < end_; ++i) {
    for (const int flip : {0x01, 0x80, 0xFF}) {
      auto bytes = file_;
      bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
      ASSERT_NO_FATAL_FAILURE(expect_refusal(bytes, i));
    }
  }
}

}  // namespace
}  // namespace vitrine::test
