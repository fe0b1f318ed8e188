// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/rig_file.h"

#include <nlohmann/json.hpp>

#include "acquisition/rig_optics/sensor.h"
#include "acquisition/rig_optics/target.h"

namespace vitrine::acquisition::rig {

std::string to_json(const RigFile& rig) {
  using Json = nlohmann::ordered_json;
  const TargetSpec target;
  const Json json{
      {"name", rig.name},
      {"camera", {{"address", rig.camera_address}}},
      {"board",
       {{"dialect", rig.board.dialect},
        {"vendor", rig.board.vendor},
        {"product", rig.board.product},
        {"serial", rig.board.serial}}},
      {"exposure_us", kExposureUs},
      {"gain_db", 0},
      {"region", {{"x", 0}, {"y", 0}, {"width", kSensorWidth}, {"height", kSensorHeight}}},
      {"target",
       {{"squares_x", target.squares_x},
        {"squares_y", target.squares_y},
        {"square_mm", target.square_mm},
        {"marker_mm", target.marker_mm},
        {"dictionary", kTargetDictionary}}},
      {"steps", rig.steps},
      {"calibrations", rig.calibrations.string()},
      {"rig", {{"socket", rig.socket.string()}}}};
  return json.dump(2) + "\n";
}

}  // namespace vitrine::acquisition::rig
