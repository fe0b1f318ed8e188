// SPDX-License-Identifier: Apache-2.0
#include "single_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "codec/mesh/surface_distance.h"
#include "peers.h"
#include "temporary_file.h"

namespace vitrine::bench {
namespace {

constexpr int kTargets = 14;
constexpr double kFewest = 0.004, kMost = 0.65;  // of the faces
constexpr int kFewestBits = 8, kMostBits = 12;
constexpr std::size_t kSamples = 50'000;
constexpr std::size_t kFewestPoints = 12;  // of a curve that others are held against

template <class T>
void append(Bytes& out, const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  out.insert(out.end(), bytes, bytes + values.size() * sizeof(T));
}

Bytes flat_file(const MeshoptInput& mesh) {
  Bytes out;
  append(out, std::vector{static_cast<std::uint32_t>(mesh.positions.size() / 3),
                          static_cast<std::uint32_t>(mesh.indices.size())});
  append(out, mesh.positions);
  append(out, mesh.indices);
  return out;
}

template <class T>
std::vector<T> read(std::FILE* in, std::size_t count) {
  std::vector<T> out(count);
  if (std::fread(out.data(), sizeof(T), count, in) != count)
    throw std::runtime_error("meshoptimizer did not run under Node");
  return out;
}

TriangleMesh read_mesh(std::FILE* in) {
  const auto counts = read<std::uint32_t>(in, 2);
  const auto positions = read<float>(in, 3 * std::size_t{counts[0]});
  const auto indices = read<std::uint32_t>(in, counts[1]);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < positions.size(); i += 3)
    mesh.positions.push_back({positions[i], positions[i + 1], positions[i + 2]});
  for (std::size_t i = 0; i < indices.size(); i += 3)
    mesh.faces.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return mesh;
}

// From kFewest to kMost of the faces, evenly on a logarithmic scale.
std::vector<TriangleMesh> simplified(const TriangleMesh& original) {
  const TemporaryFile file(flat_file(meshopt_input(original)));
  std::string command =
      std::string("node '" VITRINE_SOURCE_DIR "/tests/bench/codec/simplify.mjs' ") + file.path();
  for (int i = 0; i < kTargets; ++i) {
    const double share = kFewest * std::pow(kMost / kFewest, i / (kTargets - 1.0));
    command += ' ' + std::to_string(static_cast<std::size_t>(
                         share * static_cast<double>(original.faces.size())));
  }
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("Node did not start");
  std::vector<TriangleMesh> meshes;
  for (int i = 0; i < kTargets; ++i)
    meshes.push_back(read_mesh(pipe));
  ::pclose(pipe);
  return meshes;
}

double interpolate(const RatePoint& a, const RatePoint& b, double error) {
  const double t = std::log(error / a.error) / std::log(b.error / a.error);
  return a.bytes * std::pow(b.bytes / a.bytes, t);
}

}  // namespace

double rms_percent(const TriangleMesh& mesh, const TriangleMesh& original) {
  const auto distance = measure(mesh, original, {.samples = kSamples});
  if (!distance) throw std::runtime_error(distance.error().message);
  return distance->rms_percent;
}

RateCurve::RateCurve(std::vector<RatePoint> points) {
  std::ranges::sort(points, {}, &RatePoint::bytes);
  for (const RatePoint& point : points) {
    if (points_.empty() || point.error < points_.back().error) points_.push_back(point);
  }
  if (points_.size() < kFewestPoints) throw std::runtime_error("the single files are too alike");
}

double RateCurve::bytes_at(double error) const {
  if (error > points_.front().error || error < points_.back().error)
    throw std::runtime_error("no single file is as coarse or as fine as the level");
  std::size_t i = 1;
  while (i + 1 < points_.size() && points_[i].error > error)
    ++i;
  return interpolate(points_[i - 1], points_[i], error);
}

RateCurve single_files(const TriangleMesh& original) {
  std::vector<RatePoint> points;
  for (const TriangleMesh& mesh : simplified(original)) {
    for (int bits = kFewestBits; bits <= kMostBits; ++bits) {
      const Bytes file = draco_encode(mesh, bits);
      points.push_back({static_cast<double>(file.size()), rms_percent(draco_mesh(file), original)});
    }
  }
  return RateCurve(std::move(points));
}

}  // namespace vitrine::bench
