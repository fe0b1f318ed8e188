// SPDX-License-Identifier: Apache-2.0
#include "codec/render/material_pictures.h"

#include <gtest/gtest.h>

#include "codec/picture/write_picture.h"

namespace vitrine {
namespace {

EncodedPicture png(const std::string& name, const Picture& picture) {
  return {.name = name, .bytes = write_png(picture).value()};
}

const Picture kRedPicture{1, 1, {255, 0, 0, 255}}, kBluePicture{1, 1, {128, 128, 255, 255}};

Texturing with_two_maps(EncodedPicture colours, EncodedPicture normals) {
  Texturing texturing;
  texturing.pictures = {std::move(colours), {.name = "unused", .bytes = {1}}, std::move(normals)};
  texturing.materials.push_back(
      {.base_colour_map = TextureMap{.picture = 0}, .normal_map = TextureMap{.picture = 2}});
  return texturing;
}

TEST(MaterialPictures, OnlyThoseOfTheMapsAreDecoded) {
  const auto texturing = with_two_maps(png("c", kRedPicture), png("n", kBluePicture));
  const auto pictures = decode_pictures(texturing, kShownMaps, 2);
  ASSERT_TRUE(pictures.has_value()) << pictures.error().message;
  ASSERT_EQ(pictures->size(), 3u);
  EXPECT_EQ(pictures->at(0).pixels, kRedPicture.pixels);
  EXPECT_TRUE(pictures->at(1).pixels.empty());
  EXPECT_EQ(pictures->at(2).pixels, kBluePicture.pixels);
}

TEST(MaterialPictures, ADamagedPictureIsNamed) {
  const auto damaged = with_two_maps(png("c", kRedPicture), {.name = "n.png", .bytes = {1, 2}});
  const auto fault = decode_pictures(damaged, kShownMaps, 2);
  ASSERT_FALSE(fault.has_value());
  EXPECT_EQ(fault.error().message.find("picture n.png is "), 0u) << fault.error().message;
  const auto nameless = decode_pictures(with_two_maps({}, png("n", kBluePicture)), kShownMaps, 2);
  ASSERT_FALSE(nameless.has_value());
  EXPECT_EQ(nameless.error().message.find("picture 0 is "), 0u) << nameless.error().message;
}

TEST(MaterialPictures, TheLimitHoldsForAllTogether) {
  const auto texturing = with_two_maps(png("c", kRedPicture), png("n", kBluePicture));
  const auto fault = decode_pictures(texturing, kShownMaps, 1);
  ASSERT_FALSE(fault.has_value());
  EXPECT_EQ(fault.error().code, ErrorCode::kLimit);
}

}  // namespace
}  // namespace vitrine
