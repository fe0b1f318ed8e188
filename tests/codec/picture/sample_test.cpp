// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/sample.h"

#include <gtest/gtest.h>

#include <limits>

#include "codec/picture/decode_picture.h"
#include "codec/picture/pictures.h"
#include "support/as_bytes.h"

namespace vitrine {
namespace {

using vitrine::testing::as_bytes;
using vitrine::testing::red_and_blue;

TEST(Sample, LiesBetweenPixelCentresInLinearLight) {
  const auto image = *decode_picture(as_bytes(red_and_blue()), 2);
  const auto at = [&](double u, Wrap wrap = Wrap::kRepeat) {
    return to_srgb(sample(image, u, 0.3, wrap, wrap));
  };
  EXPECT_EQ(at(0.25), (Colour{255, 0, 0}));
  EXPECT_EQ(at(0.75), (Colour{0, 0, 255}));
  // The mean of red and blue in linear light has the sRGB value 188.
  EXPECT_EQ(at(0.5), (Colour{188, 0, 188}));
  EXPECT_EQ(at(1.25), (Colour{255, 0, 0}));
  EXPECT_EQ(at(-0.25), (Colour{0, 0, 255}));
  EXPECT_EQ(at(1.25, Wrap::kClamp), (Colour{0, 0, 255}));
  EXPECT_EQ(at(-0.25, Wrap::kMirror), (Colour{255, 0, 0}));
  EXPECT_EQ(at(1.25, Wrap::kMirror), (Colour{0, 0, 255}));
}

TEST(Sample, CoordinatesOfAnyKindAreSampled) {
  const auto image = *decode_picture(as_bytes(red_and_blue()), 2);
  for (const double u : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e300, 1e8, -1e8,
                         std::numeric_limits<double>::infinity()}) {
    for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp}) {
      const Colour colour = to_srgb(sample(image, u, u, wrap, wrap));
      EXPECT_EQ(colour[1], 0);
    }
  }
}

}  // namespace
}  // namespace vitrine
