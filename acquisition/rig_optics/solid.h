// SPDX-License-Identifier: Apache-2.0
// A mesh that the simulated rig can scan. Embree intersects rays with it. A painted mesh has an
// albedo that changes in sharp-edged patches.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <vector>

#include "acquisition/rig_optics/subject.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition::rig {

struct Finish {
  bool is_painted = true;  // whether dark patches are painted on the surface
  double gloss = 0.25;     // share of light reflected as a highlight; 0 is fully matt
};

class Solid final : public Subject {
 public:
  explicit Solid(const TriangleMesh& mesh, const Finish& finish = {});

  std::optional<RayHit> first_hit(const Vec3& from, const Vec3& direction) const override;
  bool shadowed(const RayHit& point, const Vec3& source) const override;
  void near_plane(const Vec3& normal, double offset, double half,
                  const std::function<void(ConvexPolygon)>& visit) const override;
  // An eighth of the resolution is enough, because ambient light is faint and the same in both
  // frames of a pair.
  int ambient_step() const override { return 8; }
  double ambient_light() const override { return 14; }

  // Returns whether the mesh blocks the straight line between two points. Ignores obstacles within
  // `margin` mm of either end.
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

}  // namespace vitrine::acquisition::rig
