// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/solid.h"

#include <algorithm>
#include <cmath>

namespace vitrine::acquisition::rig {
namespace {

void add_triangles(RTCDevice device, RTCScene scene, const TriangleMesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corner = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                             mesh.positions.size()));
  for (const Vec3& p : mesh.positions) {
    *corner++ = static_cast<float>(p.x);
    *corner++ = static_cast<float>(p.y);
    *corner++ = static_cast<float>(p.z);
  }
  auto* face = static_cast<Triangle*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.faces.size()));
  std::copy(mesh.faces.begin(), mesh.faces.end(), face);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

RTCRay ray_of(const Vec3& from, const Vec3& direction, double nearest, double farthest) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x);
  ray.org_y = static_cast<float>(from.y);
  ray.org_z = static_cast<float>(from.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tnear = static_cast<float>(nearest);
  ray.tfar = static_cast<float>(farthest);
  ray.mask = ~0U;
  return ray;
}

// Returns the albedo at a point. The paint is dark where a sum of waves in four directions is high.
// Such patches cover 10 to 20 % of a surface.
double albedo_at(const Vec3& p) {
  const double wave = std::sin(0.31 * p.x + 0.11 * p.y) + std::sin(0.29 * p.y - 0.13 * p.z) +
                      std::sin(0.33 * p.z + 0.12 * p.x) + std::sin(0.2 * (p.x + p.y + p.z));
  return wave > 1.1 ? 0.42 : 0.85;
}

}  // namespace

Solid::Solid(const TriangleMesh& mesh, const Finish& finish)
    : device_(rtcNewDevice("threads=1")),
      scene_(rtcNewScene(device_.get())),
      positions_(mesh.positions),
      faces_(mesh.faces),
      finish_(finish) {
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  // Without this flag, a ray may pass between two adjacent triangles.
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  add_triangles(device_.get(), scene_.get(), mesh);
  rtcCommitScene(scene_.get());
}

std::optional<RayHit> Solid::first_hit(const Vec3& from, const Vec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit hit{ray_of(from, direction, 0, INFINITY), {}};
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context, &hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Triangle& face = faces_[hit.hit.primID];
  const Vec3& a = positions_[face[0]];
  const Vec3 across = cross(positions_[face[1]] - a, positions_[face[2]] - a);
  const Vec3 normal = across * (1 / length(across));
  // Uses Embree only to find the triangle. Computes the hit point here in double precision, because
  // Embree's single precision is too coarse.
  const double slope = dot(normal, direction);
  const double t = std::abs(slope) > 1e-3 ? dot(normal, a - from) / slope : hit.ray.tfar;
  const Vec3 at = from + direction * t;
  return RayHit{at, normal, finish_.is_painted ? albedo_at(at) : 0.85, finish_.gloss};
}

bool Solid::blocked(const Vec3& from, const Vec3& to, double margin) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const double distance = length(to - from);
  RTCRay ray = ray_of(from, (to - from) * (1 / distance), margin, distance - margin);
  rtcOccluded1(scene_.get(), &context, &ray);
  return ray.tfar < 0;
}

bool Solid::shadowed(const RayHit& point, const Vec3& source) const {
  const double side = dot(point.normal, source - point.at) < 0 ? -1 : 1;
  return blocked(point.at + point.normal * (side * 0.005), source, 0.005);
}

void Solid::near_plane(const Vec3& normal, double offset, double half,
                       const std::function<void(ConvexPolygon)>& visit) const {
  std::vector<float> distance(positions_.size());
  std::transform(positions_.begin(), positions_.end(), distance.begin(),
                 [&](const Vec3& p) { return static_cast<float>(dot(normal, p) - offset); });
  const float reach = static_cast<float>(half);
  for (const Triangle& face : faces_) {
    const auto [low, high] = std::minmax({distance[face[0]], distance[face[1]], distance[face[2]]});
    if (low > reach || high < -reach) continue;
    const Vec3 corners[] = {positions_[face[0]], positions_[face[1]], positions_[face[2]]};
    visit(corners);
  }
}

}  // namespace vitrine::acquisition::rig
