// SPDX-License-Identifier: Apache-2.0
// Simulated scans of shapes whose surface is known exactly. Each shape is star-shaped about the
// origin, and each scan sees it from above in one of several poses.
#pragma once

#include <functional>

#include "acquisition/alignment/scan_pair.h"

namespace vitrine::acquisition {

// Returns the distance of the surface from the origin, in mm, in a direction (a unit vector).
using Radius = std::function<double(const Vec3& direction)>;

// A sphere of about 20 mm radius with bumps that make every pose unique.
double bumpy(const Vec3& direction);
// A body of revolution about z with mouldings, like a turned vase.
double vase(const Vec3& direction);
// A cube with an edge of 30 mm.
double cube(const Vec3& direction);

RigidMotion rotation_about(const Vec3& axis, double degrees, const Vec3& shift = {});

// Returns a scan of the shape after it was moved by `pose`. The scan covers the directions that
// have a z of at least `from` after the pose's rotation. All sight lines pass through the shape's
// origin.
PoseScan scan_of(const Radius& radius, const RigidMotion& pose, double from,
                 const std::string& name = "scan");

}  // namespace vitrine::acquisition
