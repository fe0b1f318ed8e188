// SPDX-License-Identifier: Apache-2.0
// The calibration target: a ChArUco board printed on a stiff sheet, and the poses it is put in.
#pragma once

#include <vector>

#include "acquisition/rig/subject.h"
#include "acquisition/rig/view.h"

namespace vitrine::rig {

// OpenCV's names.
struct TargetSpec {
  int squares_x = 9, squares_y = 14;
  double square_mm = 8, marker_mm = 6;
};

inline constexpr const char* kTargetDictionary = "DICT_4X4_100";

// The sheet is the part of z = 0 around the origin, its front towards z, its top towards y.
class Target final : public Subject {
 public:
  explicit Target(const TargetSpec& spec = {});

  std::optional<SurfacePoint> first_hit(const Vec3& from, const Vec3& direction) const override;
  bool shadowed(const SurfacePoint&, const Vec3&) const override { return false; }
  void near_plane(const Vec3& normal, double offset, double half,
                  const std::function<void(Corners)>& visit) const override;
  int ambient_step() const override { return 1; }
  // An operator who takes pictures of a target switches a lamp on.
  double ambient_light() const override { return 75; }

 private:
  double brightness(double x, double y) const;

  int columns_ = 0, rows_ = 0;      // of the print
  double half_x_ = 0, half_y_ = 0;  // mm, of the sheet
  std::vector<float> albedo_;
};

// A pose is held in the world, as by a stand beside the table, or stands on the table and turns.
struct TargetPose {
  Placement placement;  // at 0 degrees
  bool on_table = false;
};

inline constexpr int kHeldPoses = 30, kTablePoses = 1;  // those held come first

// Poses of a hand that is not steady: near and far, tilted, all crossed by the laser sheet.
std::vector<TargetPose> target_poses(std::uint64_t seed);

}  // namespace vitrine::rig
