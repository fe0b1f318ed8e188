// SPDX-License-Identifier: Apache-2.0
#include "discrete_ladder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/codec/meshopt_in_node.h"
#include "checked.h"
#include "codec/core/limits.h"
#include "codec/picture/decode_picture.h"
#include "support/product_names.h"
#include "textured_draco.h"

namespace vitrine::bench {
namespace {

// Numbers of faces of the ladder's rungs, as shares of all faces.
constexpr std::array<double, 7> kRungs = {0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1};

std::vector<MeshoptInput> simplified(const MeshoptInput& mesh) {
  std::vector<std::size_t> faces;
  for (const double share : kRungs) {
    if (share < 1)
      faces.push_back(
          static_cast<std::size_t>(share * static_cast<double>(mesh.indices.size()) / 3));
  }
  std::vector<MeshoptInput> rungs;
  for (SimplifiedArrays& rung : simplify_in_node(mesh, faces))
    rungs.push_back(std::move(rung.mesh));
  rungs.push_back(mesh);
  return rungs;
}

// Returns the bits per coordinate of a rung. The finest rung has `bits`. For each doubling of the
// edge length, a rung has one bit less.
int bits_of(double share, int bits) {
  constexpr int kFewestBits = 9;
  return std::max(kFewestBits, bits + static_cast<int>(std::ceil(std::log2(share) / 2)));
}

// Returns the picture of size number `step`, or the largest picture if there are fewer sizes.
const SizedPicture& at_step(const std::vector<SizedPicture>& sizes, std::size_t step) {
  return sizes[std::min(step, sizes.size() - 1)];
}

double bytes_of(const std::vector<SizedPicture>& sizes, std::size_t step, bool has_smaller) {
  double sum = 0;
  const std::size_t last = std::min(step, sizes.size() - 1);
  for (std::size_t i = has_smaller ? 0 : last; i <= last; ++i)
    sum += static_cast<double>(sizes[i].file.size());
  return sum;
}

}  // namespace

DiscreteLadder::DiscreteLadder(const TexturedModel& model, int bits)
    : sizes_(model.texturing.pictures.size()) {
  const std::size_t materials = model.texturing.materials.size();
  const std::vector<MeshoptInput> rungs = simplified(wedge_mesh(model.mesh, model.texturing));
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    const auto files = draco_with_coordinates(rungs[i], materials, bits_of(kRungs[i], bits));
    rung_bytes_.push_back(total_bytes(files));
    rungs_.push_back(decode_draco(files));
  }
  texturing_.materials = model.texturing.materials;
  texturing_.pictures.resize(sizes_.size());
  colours_ = used_pictures(model.texturing, std::array{&Material::base_colour_map});
  normals_ = used_pictures(model.texturing, std::array{&Material::normal_map});
  for (const auto* numbers : {&colours_, &normals_}) {
    for (const std::uint32_t number : *numbers) {
      sizes_[number] = masked_pictures(model, number);
      steps_ = std::max(steps_, sizes_[number].size());
    }
  }
}

// A set with an even number holds only the base colours. A set with an odd number also holds the
// normal maps.
std::vector<Picture> DiscreteLadder::pictures_of(std::size_t set) const {
  std::vector<Picture> pictures(sizes_.size());
  const auto add = [&](const std::vector<std::uint32_t>& numbers) {
    for (const std::uint32_t number : numbers) {
      const SizedPicture& picture = at_step(sizes_[number], set / 2);
      pictures[number] = checked(decode_picture(picture.file, Limits{}.pixels));
    }
  };
  add(colours_);
  if (set % 2 != 0) add(normals_);
  return pictures;
}

double DiscreteLadder::ssim(const AppearanceReference& reference, const ModelState& state) const {
  const FacedMesh& rung = rungs_[state.geometry];
  Texturing texturing = texturing_;
  texturing.face_materials = rung.face_materials;
  texturing.coordinates[0] = rung.coordinates;
  const Textures textures(std::move(texturing), pictures_of(state.pictures));
  return checked(reference.compare({.mesh = rung.mesh, .textures = &textures})).ssim;
}

std::vector<double> DiscreteLadder::picture_bytes(bool has_smaller) const {
  std::vector<double> bytes;
  for (std::size_t step = 0; step < steps_; ++step) {
    double sum = 0;
    for (const std::uint32_t number : colours_)
      sum += bytes_of(sizes_[number], step, has_smaller);
    bytes.push_back(sum);
    for (const std::uint32_t number : normals_)
      sum += bytes_of(sizes_[number], step, has_smaller);
    bytes.push_back(sum);
  }
  return bytes;
}

StateBytes DiscreteLadder::single_files() const {
  return {rung_bytes_, picture_bytes(false)};
}

StateBytes DiscreteLadder::one_after_the_other() const {
  std::vector<double> rungs = rung_bytes_;
  for (std::size_t i = 1; i < rungs.size(); ++i)
    rungs[i] += rungs[i - 1];
  return {rungs, picture_bytes(true)};
}

}  // namespace vitrine::bench
