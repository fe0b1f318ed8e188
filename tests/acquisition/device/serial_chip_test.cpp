// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/serial_chip.h"

#include <gtest/gtest.h>

namespace vitrine::acquisition {
namespace {

std::vector<std::uint8_t> payload(SerialChip chip, const std::vector<std::uint8_t>& transfer) {
  std::vector<std::uint8_t> out;
  append_payload(chip, transfer, 4, out);
  return out;
}

TEST(SerialChip, IsKnownByItsNumbers) {
  EXPECT_EQ(chip_by_id(0x0403, 0x6001), SerialChip::kFtdi);
  EXPECT_EQ(chip_by_id(0x1a86, 0x7523), SerialChip::kCh34x);
  EXPECT_EQ(chip_by_id(0x2341, 0x0043), std::nullopt);
}

// The expected values are those of the Linux drivers for these chips.
TEST(SerialChip, IsSetToTheBaudRatesOfTheDialects) {
  EXPECT_EQ(set_up(SerialChip::kFtdi, 115200, 0)[1],
            (ControlRequest{.type = 0x40, .request = 3, .value = 0x001a, .index = 0}));
  EXPECT_EQ(set_up(SerialChip::kFtdi, 57600, 0)[1],
            (ControlRequest{.type = 0x40, .request = 3, .value = 0xc034, .index = 0}));
  EXPECT_EQ(set_up(SerialChip::kCh34x, 115200, 0)[1],
            (ControlRequest{.type = 0x40, .request = 0x9a, .value = 0x1312, .index = 0xcc83}));
  EXPECT_EQ(set_up(SerialChip::kCh34x, 57600, 0)[1],
            (ControlRequest{.type = 0x40, .request = 0x9a, .value = 0x1312, .index = 0x9883}));
  EXPECT_EQ(set_up(SerialChip::kCdcAcm, 115200, 2)[0],
            (ControlRequest{.type = 0x21,
                            .request = 0x20,
                            .value = 0,
                            .index = 2,
                            .data = {0x00, 0xc2, 0x01, 0x00, 0, 0, 8}}));
}

TEST(SerialChip, OfFtdiPutsTwoBytesOfStatusAheadOfEachPacket) {
  EXPECT_EQ(payload(SerialChip::kFtdi, {1, 96, 'a', 'b', 1, 96, 'c', 'd', 1, 96, 'e'}),
            (std::vector<std::uint8_t>{'a', 'b', 'c', 'd', 'e'}));
  EXPECT_TRUE(payload(SerialChip::kFtdi, {1, 96}).empty());
  EXPECT_TRUE(payload(SerialChip::kFtdi, {1}).empty());
  EXPECT_EQ(payload(SerialChip::kCdcAcm, {1, 96, 'a'}), (std::vector<std::uint8_t>{1, 96, 'a'}));
}

}  // namespace
}  // namespace vitrine::acquisition
