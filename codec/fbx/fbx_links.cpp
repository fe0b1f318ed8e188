// SPDX-License-Identifier: Apache-2.0
#include "codec/fbx/fbx_links.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vitrine::inline codec {
namespace {

enum ObjectKind : unsigned {
  kModel = 1,
  kGeometry = 2,
  kDeformer = 4,
  kAttribute = 8,
  kMaterial = 16,
  kCurveNode = 32,
  kOther = 64,
  kAny = 127
};

// A kind of object, and the kinds of linked objects that the importer reads together with it.
struct KindOfObject {
  std::string_view name;
  unsigned kind, needs;
};
constexpr std::array<KindOfObject, 8> kKinds{
    {{"Model", kModel, kGeometry | kMaterial | kAttribute},
     {"Geometry", kGeometry, kDeformer},
     {"Deformer", kDeformer, kDeformer | kGeometry | kModel},
     {"NodeAttribute", kAttribute, 0},
     {"Material", kMaterial, kAny},
     {"Texture", kOther, kAny},
     {"LayeredTexture", kOther, kAny},
     {"AnimationCurveNode", kCurveNode, 0}}};
// Kinds of objects with properties that can be animated. The importer reads such an object together
// with the animation.
constexpr unsigned kAnimated = kModel | kAttribute | kDeformer;

constexpr std::uint64_t kMost = std::uint64_t{1} << 32;  // sums are clamped to this
constexpr std::uint64_t kMostInstances = 1 << 16;  // not counting the first instance of each model
constexpr std::uint64_t kMostSteps = 1 << 27;
constexpr std::uint64_t kMostMorphed = 1 << 27;  // parts and corners of all copies of meshes
// The importer takes about 2 KB of stack for each object in a chain.
constexpr std::uint64_t kLongestChain = 1024;

constexpr std::string_view kTooDeep = "its objects are linked in a chain that is too long";

}  // namespace

struct FbxLinks::Arrow {
  std::int64_t from, to;
};

// Like the importer, compares only as many characters as the shorter of the two names has.
void FbxLinks::add_object(std::int64_t id, std::string_view name) {
  last_ = &objects_[id];
  last_->kinds |= kOther;
  for (const KindOfObject& known : kKinds) {
    if (!name.starts_with(known.name) && !known.name.starts_with(name)) continue;
    last_->kinds |= known.kind;
    last_->needs |= known.needs;
  }
}

FbxLinks::Object FbxLinks::object_of(std::int64_t id) const {
  const auto object = objects_.find(id);
  return object == objects_.end() ? Object{} : object->second;
}

struct FbxLinks::Walked {
  std::uint64_t deepest;  // length of the longest chain of arrows
  std::uint64_t left;     // number of objects not visited because of cycles
};

// Visits the arrows in topological order: each arrow after all arrows that lead to its start.
template <class Visit>
FbxLinks::Walked FbxLinks::walk(std::vector<Arrow> arrows, Visit visit) const {
  std::ranges::sort(arrows, {}, &Arrow::from);
  // Per object: the number of arrows to it that are not yet visited, and the object's depth.
  std::map<std::int64_t, std::uint64_t> open, depths;
  for (const Arrow& arrow : arrows)
    ++open[arrow.to];
  std::vector<std::int64_t> ready;
  for (const auto& [id, object] : objects_) {
    if (!open.contains(id)) ready.push_back(id);
  }
  Walked walked{.deepest = 0, .left = objects_.size()};
  while (!ready.empty()) {
    const std::int64_t from = ready.back();
    ready.pop_back();
    --walked.left;
    const std::uint64_t depth = depths[from];
    walked.deepest = std::max(walked.deepest, depth);
    auto arrow = std::ranges::lower_bound(arrows, from, {}, &Arrow::from);
    for (; arrow != arrows.end() && arrow->from == from; ++arrow) {
      visit(*arrow);
      depths[arrow->to] = std::max(depths[arrow->to], depth + 1);
      if (--open[arrow->to] == 0) ready.push_back(arrow->to);
    }
  }
  return walked;
}

std::string_view FbxLinks::fault_of_placing(std::uint64_t most_parts) const {
  std::vector<Arrow> arrows;
  for (const auto& [child, parent, is_to_property] : links_) {
    const bool is_placed = object_of(child).kinds != 0 && child != 0 && !is_to_property;
    if (is_placed && (object_of(parent).kinds & kModel) != 0) arrows.push_back({parent, child});
  }
  std::uint64_t most_instances = kMostInstances, instances = 0, steps = 0;
  for (const auto& [id, object] : objects_)
    most_instances += 1 + object.properties;
  std::map<std::int64_t, std::uint64_t> ways{{0, 1}};  // number of paths from the scene
  const Walked walked = walk(std::move(arrows), [&](const Arrow& arrow) {
    const Object& child = objects_.at(arrow.to);
    const std::uint64_t more = ways[arrow.from];
    ways[arrow.to] = std::min(ways[arrow.to] + more, kMost);
    steps = std::min(steps + more, kMost);
    if ((child.kinds & kModel) != 0)
      instances = std::min(instances + more * (1 + child.properties), kMost);
  });
  if (walked.left > 0) return "its models are linked in a cycle";
  if (instances > most_instances || steps > kMostSteps / most_parts)
    return "its models have too many instances";
  return walked.deepest > kLongestChain ? kTooDeep : std::string_view();
}

// Before the importer reads an object, it reads the objects that this object needs, in nested
// calls. It ends a cycle at the first object that it has already read.
std::string_view FbxLinks::fault_of_reading() const {
  std::vector<Arrow> arrows;
  for (const auto& [child, parent, is_to_property] : links_) {
    const Object low = object_of(child), high = object_of(parent);
    if ((high.needs & low.kinds) != 0) arrows.push_back({child, parent});
    if (is_to_property && (low.kinds & kCurveNode) != 0 && (high.kinds & kAnimated) != 0)
      arrows.push_back({parent, child});
  }
  const Walked walked = walk(std::move(arrows), [](const Arrow&) {});
  return walked.deepest + walked.left > kLongestChain ? kTooDeep : std::string_view();
}

// A morph target is a geometry. Three links lead from it to the mesh: to a channel, to a blend
// shape, and to the geometry of the mesh. Channels and blend shapes are deformers.
std::string_view FbxLinks::fault_of_morphing() const {
  constexpr unsigned kSteps[][2] = {
      {kGeometry, kDeformer}, {kDeformer, kDeformer}, {kDeformer, kGeometry}};
  std::map<std::int64_t, std::uint64_t> paths;  // number of paths from morph targets
  for (const auto& [id, object] : objects_) {
    if ((object.kinds & kGeometry) != 0) paths[id] = 1;
  }
  for (const auto& [low, high] : kSteps) {
    std::map<std::int64_t, std::uint64_t> longer;
    for (const auto& [child, parent, is_to_property] : links_) {
      const auto path = paths.find(child);
      if (is_to_property || path == paths.end() || (object_of(child).kinds & low) == 0 ||
          (object_of(parent).kinds & high) == 0)
        continue;
      std::uint64_t& count = longer[parent];
      count = std::min(count + path->second, kMost);
    }
    paths = std::move(longer);
  }
  std::uint64_t left = kMostMorphed;
  for (const auto& [id, count] : paths) {
    const std::uint64_t size = 1 + object_of(id).mesh_size;
    if (count > left / size) return "its meshes have too many morph targets";
    left -= count * size;
  }
  return {};
}

std::string_view FbxLinks::fault(std::uint64_t most_parts) const {
  for (const std::string_view fault :
       {fault_of_placing(most_parts), fault_of_reading(), fault_of_morphing()})
    if (!fault.empty()) return fault;
  return {};
}

}  // namespace vitrine::inline codec
