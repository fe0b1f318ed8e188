// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scanner_config.h"
#include "support/product_names.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json example_config() {
  return json::parse(R"({
    "name": "rig", "camera": {"address": "127.0.0.1"},
    "board": {"dialect": "fabscan", "vendor": "0x2341", "product": "0x0043", "port": "1-2"},
    "exposure_us": 4000, "gain_db": 1.5,
    "region": {"x": 0, "y": 0, "width": 1300, "height": 1030},
    "target": {"squares_x": 9, "squares_y": 14, "square_mm": 8, "marker_mm": 6,
               "dictionary": "DICT_4X4_100"},
    "steps": 720, "calibrations": "calibrations", "rig": {"socket": "rig.sock"}})");
}

TEST(ScannerConfig, EverythingIsRead) {
  const auto config = parse_scanner_config(example_config().dump(), "/etc/scanner/rig.json");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->name, "rig");
  EXPECT_EQ(config->camera.address, "127.0.0.1");
  EXPECT_EQ(config->board.dialect, BoardDialect::kFabScan);
  EXPECT_EQ(config->board.vendor, 0x2341);
  EXPECT_EQ(config->board.product, 0x43);
  EXPECT_EQ(config->board.port, "1-2");
  EXPECT_EQ(config->settings, (CameraSettings{4000, 1.5, {0, 0, 1300, 1030}}));
  EXPECT_EQ(config->target.squares_y, 14);
  EXPECT_EQ(config->target.dictionary, "DICT_4X4_100");
  EXPECT_EQ(config->calibrations, "/etc/scanner/calibrations");
  EXPECT_EQ(config->rig, "/etc/scanner/rig.sock");
}

TEST(ScannerConfig, AbsolutePathsStayAndARealScannerHasNoRig) {
  json object = example_config();
  object.erase("rig");
  object["calibrations"] = "/var/calibrations";
  const auto config = parse_scanner_config(object.dump(), "rig.json");
  ASSERT_TRUE(config);
  EXPECT_EQ(config->calibrations, "/var/calibrations");
  EXPECT_TRUE(config->rig.empty());
}

TEST(ScannerConfig, AFaultNamesFileAndKeyAndWhatIsExpected) {
  const auto fault = [](const char* pointer, const json& value) {
    json object = example_config();
    object[json::json_pointer(pointer)] = value;
    const auto config = parse_scanner_config(object.dump(), "rig.json");
    if (config) return std::string("accepted");
    EXPECT_EQ(std::ranges::count(config.error().message, ';'), 1) << config.error().message;
    return config.error().message;
  };
  EXPECT_THAT(fault("/camera", json::object()), HasSubstr("\"address\" must select the camera"));
  EXPECT_THAT(fault("/camera/serial", "7"), HasSubstr("must select the camera, but not both"));
  EXPECT_THAT(fault("/camera/adress", "1.2.3.4"), HasSubstr("rig.json: camera: \"adress\""));
  EXPECT_THAT(fault("/board/dialect", "marlin"), HasSubstr("\"dialect\" must be \"horus\" or"));
  EXPECT_THAT(fault("/board/vendor", 0x2341), HasSubstr("\"vendor\" must be"));
  EXPECT_THAT(fault("/board/vendor", "0x12345"), HasSubstr("\"vendor\" must be"));
  EXPECT_THAT(fault("/board/product", "0x"), HasSubstr("\"product\" must be"));
  EXPECT_THAT(fault("/exposure_us", -1), HasSubstr("\"exposure_us\" must be a number from 1"));
  EXPECT_THAT(fault("/region/width", 1e9), HasSubstr("rig.json: region: \"width\" must be"));
  EXPECT_THAT(fault("/steps", 3), HasSubstr("\"steps\""));
  EXPECT_THAT(fault("/target/squares_x", "9"), HasSubstr("\"squares_x\" must be a whole number"));
  EXPECT_THAT(fault("/target/squares_x", 1), HasSubstr("\"squares_x\" must be a whole number"));
  EXPECT_THAT(fault("/target/marker_mm", 9), HasSubstr("rig.json: target: \"marker_mm\" must be"));
  EXPECT_THAT(fault("/target/dictionary", "FOO"), HasSubstr("\"dictionary\" does not fit"));
  EXPECT_THAT(fault("/target", json::object()), HasSubstr("\"squares_x\" is missing"));
  EXPECT_THAT(fault("/camera/address", "nonsense"), HasSubstr("\"address\" must be the camera's"));
  EXPECT_THAT(fault("/board/port", "zz"), HasSubstr("\"port\" must be the bus"));
  EXPECT_EQ(fault("/board/port", "3-1.4.2"), "accepted");
  EXPECT_THAT(fault("/rig", json::object()), HasSubstr("\"socket\" must name"));
  EXPECT_THAT(fault("/laser", 1), HasSubstr("\"laser\" is an unknown key (known are name"));
  EXPECT_EQ(fault("/steps", 100), "accepted");
}

TEST(ScannerConfig, AMissingFileIsNamed) {
  EXPECT_THAT(read_scanner_config("absent.json").error().message,
              HasSubstr("cannot read absent.json: No such file or directory; check the name"));
}

}  // namespace
}  // namespace vitrine::test
