// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/usb_device.h"

#include <gmock/gmock.h>

#include <utility>

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

constexpr char kClosed[] = "may not be opened";

// Returns devices with these serial numbers, in this order. A null pointer stands for a device that
// cannot be opened.
std::vector<Expected<UsbDevice>> devices(std::initializer_list<const char*> serials) {
  std::vector<Expected<UsbDevice>> all;
  for (const char* serial : serials) {
    if (serial == nullptr)
      all.push_back(fail(ErrorCode::kIo, kClosed));
    else
      all.push_back(UsbDevice{.handle = nullptr, .serial = serial, .port = "1-2"});
  }
  return all;
}

// Returns the serial number of the chosen device, or the error's message.
std::string chosen(std::initializer_list<const char*> serials, const std::string& wanted) {
  const auto device = choose(devices(serials), {.serial = wanted});
  return device ? device->serial : device.error().message;
}

TEST(UsbDevice, ThatIsNamedByItsSerialNumberIsFoundBesideOneThatMayNotBeOpened) {
  EXPECT_EQ(chosen({nullptr, "A"}, "A"), "A");
  EXPECT_EQ(chosen({"A", nullptr}, "A"), "A");
  EXPECT_EQ(chosen({"A", "B"}, "B"), "B");
}

TEST(UsbDevice, ThatMayNotBeOpenedIsTheFaultWhereItMayBeTheOneNamed) {
  EXPECT_EQ(chosen({nullptr}, ""), kClosed);
  EXPECT_EQ(chosen({nullptr, "A"}, "B"), kClosed);
  EXPECT_EQ(chosen({nullptr, nullptr}, "B"), kClosed);
}

TEST(UsbDevice, ThatIsNotTheOnlyOneIsNamed) {
  for (const auto& several :
       {std::pair("A", "B"), std::pair<const char*, const char*>("A", nullptr)})
    EXPECT_THAT(chosen({several.first, several.second}, ""), HasSubstr("2 devices match"));
  EXPECT_THAT(chosen({"A", "A"}, "A"), HasSubstr("2 devices match"));
}

TEST(UsbDevice, ThatIsNotThereIsTold) {
  EXPECT_THAT(chosen({}, ""), HasSubstr("is not there"));
  EXPECT_THAT(chosen({"A"}, "B"), HasSubstr("with serial number B is not there"));
}

}  // namespace
}  // namespace vitrine::acquisition
