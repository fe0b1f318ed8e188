// SPDX-License-Identifier: Apache-2.0
// The calibration target: a ChArUco board printed on a stiff sheet, and its poses.
#pragma once

#include <vector>

#include "acquisition/rig_optics/local_optics.h"
#include "acquisition/rig_optics/subject.h"

namespace vitrine::acquisition::rig {

// The dimensions of the board, named as in OpenCV.
struct TargetSpec {
  int squares_x = 9, squares_y = 14;
  double square_mm = 8, marker_mm = 6;
};

inline constexpr const char* kTargetDictionary = "DICT_4X4_100";

// The calibration target, printed on a sheet. The sheet lies in the plane z = 0, centred at the
// origin. Its front faces z, and its top points to y.
class PrintedTarget final : public Subject {
 public:
  explicit PrintedTarget(const TargetSpec& spec = {});

  std::optional<RayHit> first_hit(const Vec3& from, const Vec3& direction) const override;
  bool shadowed(const RayHit&, const Vec3&) const override { return false; }
  void near_plane(const Vec3& normal, double offset, double half,
                  const std::function<void(ConvexPolygon)>& visit) const override;
  int ambient_step() const override { return 1; }
  // The ambient light is strong, because operators switch a lamp on for pictures of the target.
  double ambient_light() const override { return 75; }

 private:
  double brightness(double x, double y) const;

  int columns_ = 0, rows_ = 0;      // size of the picture of the printed board, in pixels
  double half_x_ = 0, half_y_ = 0;  // half of the sheet's size, in mm
  std::vector<float> albedo_;
};

// A pose of the target. The target either stays fixed in the world, as on a stand beside the table,
// or stands on the table and turns with it.
struct TargetPose {
  SubjectFrame frame;  // frame with the table at 0 degrees
  bool stands_on_table = false;
};

// Numbers of poses held in the air and standing on the table. The held poses come first.
inline constexpr int kHeldPoses = 30, kTablePoses = 1;

// Returns poses like those of an operator who holds the target by hand: near, far and tilted. The
// laser sheet crosses the target in all of them.
std::vector<TargetPose> target_poses(std::uint64_t seed);

}  // namespace vitrine::acquisition::rig
