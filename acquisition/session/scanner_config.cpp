// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scanner_config.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <charconv>
#include <regex>

#include "acquisition/session/region_json.h"
#include "acquisition/session/scan_request.h"
#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"

namespace vitrine::acquisition {
namespace {

// Reads a hexadecimal number such as "0x2341". Also accepts a number without the prefix, as lsusb
// prints it.
std::uint16_t usb_number(JsonMembers& members, std::string_view key) {
  const std::string text = members.text(key);
  const char* first = text.data() + (text.starts_with("0x") ? 2 : 0);
  const char* end = text.data() + text.size();
  std::uint16_t value = 0;
  const auto [last, error] = std::from_chars(first, end, value, 16);
  if (error != std::errc{} || last != end)
    members.fault(key, "must be the USB number as a hexadecimal string, such as \"0x2341\"");
  return value;
}

CameraSelector camera_in(JsonMembers& root) {
  auto members = root.object("camera", {"address", "serial"});
  CameraSelector camera{.address = members.text("address"), .serial = members.text("serial")};
  if (camera.address.empty() == camera.serial.empty())
    members.fault("serial", "or \"address\" must select the camera, but not both");
  in_addr address{};
  if (!camera.address.empty() && ::inet_pton(AF_INET, camera.address.c_str(), &address) != 1)
    members.fault("address", "must be the camera's IP address, such as \"192.168.0.20\"");
  root.adopt(members);
  return camera;
}

BoardSelector board_in(JsonMembers& root) {
  auto members =
      root.object("board", {"dialect", "vendor", "product", "serial", "port", "steps_per_turn"});
  BoardSelector board;
  if (const auto dialect = parse_board_dialect(members.text("dialect"))) {
    board.dialect = *dialect;
  } else {
    members.fault("dialect", "must be \"horus\" or \"fabscan\"");
  }
  board.vendor = usb_number(members, "vendor");
  board.product = usb_number(members, "product");
  board.serial = members.text("serial");
  board.port = members.text("port");
  static const std::regex kPort("([0-9]+-[0-9]+(\\.[0-9]+)*)?");
  if (!std::regex_match(board.port, kPort))
    members.fault("port", "must be the bus and the ports, such as \"1-2.4\"");
  board.steps_per_turn = members.whole("steps_per_turn", 8, 1 << 20, board.steps_per_turn);
  root.adopt(members);
  return board;
}

void check_members(const CharucoTarget& target, JsonMembers& members) {
  for (const char* key : {"squares_x", "squares_y"}) {
    if (!members.has(key)) members.fault(key, "is missing");
  }
  if (!(target.marker_mm > 0 && target.marker_mm < target.square_mm))
    members.fault("marker_mm", "must be larger than 0 and smaller than \"square_mm\"");
  if (const auto known = check_target(target); !known) {
    // The error message. Its remedy is cut off below, because fault() adds its own remedy.
    const std::string& reason = known.error().message;
    members.fault("dictionary",
                  fmt::format("does not fit: {}", reason.substr(0, reason.rfind("; "))));
  }
}

// Reads the target. It may be absent, because a scanner that is calibrated from known points needs
// no target.
CharucoTarget target_in(JsonMembers& root) {
  constexpr int kLeastSquares = 3, kMostSquares = 64;
  constexpr double kLargest = 1'000;  // limit of each length, in mm
  auto members =
      root.object("target", {"squares_x", "squares_y", "square_mm", "marker_mm", "dictionary"});
  CharucoTarget target{.squares_x = members.whole("squares_x", kLeastSquares, kMostSquares, 0),
                       .squares_y = members.whole("squares_y", kLeastSquares, kMostSquares, 0),
                       .square_mm = members.number("square_mm", 0, kLargest, 0),
                       .marker_mm = members.number("marker_mm", 0, kLargest, 0),
                       .dictionary = members.text("dictionary")};
  if (root.has("target")) check_members(target, members);
  root.adopt(members);
  return target;
}

std::filesystem::path beside(const std::filesystem::path& config, const std::string& name) {
  return name.empty() ? std::filesystem::path() : folder_of(config) / name;
}

std::filesystem::path rig_in(JsonMembers& root, const std::filesystem::path& config) {
  auto members = root.object("rig", {"socket"});
  if (root.has("rig") && members.text("socket").empty())
    members.fault("socket", "must name the rig's socket");
  root.adopt(members);
  return beside(config, members.text("socket"));
}

}  // namespace

Expected<ScannerConfig> parse_scanner_config(std::string_view text,
                                             const std::filesystem::path& path) {
  const auto object = parse_json_object(text, path.string());
  if (!object) return tl::unexpected(object.error());
  JsonMembers members(*object, path.string(),
                      {"name", "camera", "board", "exposure_us", "gain_db", "region", "target",
                       "steps", "calibrations", "rig"});
  ScannerConfig config;
  config.name = members.text("name", path.stem().string());
  config.camera = camera_in(members);
  config.board = board_in(members);
  config.settings = {
      .exposure_us = members.number("exposure_us", 1, kMostExposure, config.settings.exposure_us),
      .gain_db = members.number("gain_db", -100, 100, config.settings.gain_db),
      .region = region_in(members)};
  config.target = target_in(members);
  config.steps = members.whole("steps", kLeastSteps, kMostSteps, config.steps);
  config.calibrations = beside(path, members.text("calibrations", "calibrations"));
  config.rig = rig_in(members, path);
  if (auto checked = members.check(); !checked) return tl::unexpected(checked.error());
  return config;
}

Expected<ScannerConfig> read_scanner_config(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxJsonBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_scanner_config({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path);
}

}  // namespace vitrine::acquisition
