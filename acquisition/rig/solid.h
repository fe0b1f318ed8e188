// SPDX-License-Identifier: Apache-2.0
// A mesh as a subject: rays by Embree, and patches of another albedo with sharp edges, as paint
// has.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <vector>

#include "acquisition/rig/subject.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::rig {

struct Finish {
  bool painted = true;  // with patches; otherwise of one albedo
  double gloss = 0.25;  // 0: matt all over
};

class Solid final : public Subject {
 public:
  explicit Solid(const TriangleMesh& mesh, const Finish& finish = {});

  std::optional<SurfacePoint> first_hit(const Vec3& from, const Vec3& direction) const override;
  bool shadowed(const SurfacePoint& point, const Vec3& source) const override;
  void near_plane(const Vec3& normal, double offset, double half,
                  const std::function<void(Corners)>& visit) const override;
  // Ambient light is faint and both frames of a pair have it: an eighth of the sharpness will do.
  int ambient_step() const override { return 8; }
  double ambient_light() const override { return 14; }

  // Whether anything is on the straight way between two points, ends excluded by `margin` mm.
  bool blocked(const Vec3& from, const Vec3& to, double margin) const;

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
  std::vector<Vec3> positions_;
  std::vector<Triangle> faces_;
  Finish finish_;
};

}  // namespace vitrine::rig
