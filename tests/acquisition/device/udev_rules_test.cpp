// SPDX-License-Identifier: Apache-2.0
// Checks that deploy/60-vitrine.rules permits exactly the devices that the code supports.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "acquisition/device/serial_chip.h"
#include "acquisition/device/udev_rule.h"
#include "acquisition/device/usb_device.h"
#include "acquisition/rig_board/usb_wire.h"

namespace vitrine::acquisition {
namespace {

using rig::UsbTransport;

struct Rule {
  std::string text;
  std::vector<int> vendor, products;  // USB IDs; an empty list allows any ID

  bool allows(int of, int product) const {
    const auto names = [](const std::vector<int>& ids, int id) {
      return std::find(ids.begin(), ids.end(), id) != ids.end();
    };
    return names(vendor, of) && (products.empty() || names(products, product));
  }
};

// Returns the USB IDs that a udev match permits. For ATTR{key}=="6001|6015", these are 0x6001 and
// 0x6015.
std::vector<int> ids_in(const std::string& line, const std::string& key) {
  std::vector<int> ids;
  const std::string begin = "ATTR{" + key + "}==\"";
  const auto at = line.find(begin);
  if (at == std::string::npos) return ids;
  std::istringstream values(
      line.substr(at + begin.size(), line.find('"', at + begin.size()) - at - begin.size()));
  for (std::string id; std::getline(values, id, '|');)
    ids.push_back(std::stoi(id, nullptr, 16));
  return ids;
}

Rule rule_of(const std::string& line) {
  return {line, ids_in(line, "idVendor"), ids_in(line, "idProduct")};
}

std::vector<Rule> rules() {
  std::ifstream file(VITRINE_SOURCE_DIR "/deploy/60-vitrine.rules");
  std::vector<Rule> all;
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line.front() != '#') all.push_back(rule_of(line));
  return all;
}

bool allowed(const std::vector<Rule>& all, int vendor, int product) {
  return std::any_of(all.begin(), all.end(),
                     [&](const Rule& rule) { return rule.allows(vendor, product); });
}

TEST(UdevRules, LetTheirUsersHaveEachSimulatedBoard) {
  for (const auto transport : {UsbTransport::kCdcAcm, UsbTransport::kFtdi, UsbTransport::kCh34x}) {
    const auto [vendor, product] = rig::ids_of(transport);
    EXPECT_TRUE(allowed(rules(), vendor, product)) << fmt::format("{:04x}:{:04x}", vendor, product);
  }
}

TEST(UdevRules, NameEachCh34xThatTheCodeKnowsAndNoOther) {
  constexpr std::uint16_t kVendor = 0x1a86;
  const std::vector<Rule> all = rules();
  for (int product = 0; product <= 0xffff; ++product)
    EXPECT_EQ(allowed(all, kVendor, product),
              chip_by_id(kVendor, static_cast<std::uint16_t>(product)).has_value())
        << fmt::format("{:04x}:{:04x}", kVendor, product);
}

TEST(UdevRules, AreTheOnesThatTheCodeKnowsOf) {
  const std::vector<Rule> all = rules();
  const auto expect_same = [&](int vendor, int product) {
    EXPECT_EQ(
        has_udev_rule(static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)),
        allowed(all, vendor, product))
        << fmt::format("{:04x}:{:04x}", vendor, product);
  };
  for (int vendor = 0; vendor <= 0xffff; ++vendor)
    expect_same(vendor, 0x0043);
  for (const Rule& one : all)
    for (const Rule& other : all)
      for (const int vendor : one.vendor)
        for (const int product : other.products)
          expect_same(vendor, product);
}

TEST(UdevRules, KeepModemManagerFromBoards) {
  for (const Rule& rule : rules())
    EXPECT_NE(rule.vendor.empty(),
              rule.text.find(R"(, ENV{ID_MM_DEVICE_IGNORE}="1", )") != std::string::npos)
        << rule.text;
}

TEST(UdevRules, LackALineForOtherBoardsWhichTheErrorTells) {
  const BoardSelector other{.vendor = 0x1d50, .product = 0x6018};
  const std::string message = no_access(other).message;
  const auto begin = message.find("SUBSYSTEM");
  ASSERT_NE(begin, std::string::npos) << message;
  const Rule rule = rule_of(message.substr(begin));
  EXPECT_TRUE(rule.allows(0x1d50, 0x6018));
  EXPECT_FALSE(rule.allows(0x1d50, 0x6019));
  const Rule like = rules().front();
  EXPECT_EQ(rule.text.substr(rule.text.find(", ENV{ID_MM")),
            like.text.substr(like.text.find(", ENV{ID_MM")));
  EXPECT_TRUE(rule.text.starts_with(like.text.substr(0, like.text.find("2341"))));
  EXPECT_EQ(no_access({.vendor = 0x2341, .product = 0x43}).message.find("SUBSYSTEM"),
            std::string::npos);
}

TEST(UdevRules, LetCamerasBeUsedByTheirClass) {
  const std::vector<Rule> all = rules();
  EXPECT_EQ(std::count_if(all.begin(), all.end(),
                          [](const Rule& rule) {
                            return rule.text.find(R"(ENV{ID_USB_INTERFACES}=="*:ef0500:*")") !=
                                   std::string::npos;
                          }),
            1);
}

TEST(UdevRules, GiveTheSameRightsToAll) {
  for (const Rule& rule : rules()) {
    EXPECT_TRUE(rule.text.starts_with(R"(SUBSYSTEM=="usb", ENV{DEVTYPE}=="usb_device", )"))
        << rule.text;
    EXPECT_TRUE(rule.text.ends_with(R"(, MODE="0660", GROUP="plugdev", TAG+="uaccess")"))
        << rule.text;
  }
}

}  // namespace
}  // namespace vitrine::acquisition
