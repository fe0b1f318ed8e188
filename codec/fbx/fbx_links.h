// SPDX-License-Identifier: Apache-2.0
// The objects of an FBX file and the links between them. For example, a link places one model in
// another model.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

namespace vitrine::inline codec {

class FbxLinks {
 public:
  // Adds an object. `name` is the name of its record.
  void add_object(std::int64_t id, std::string_view name);
  // Adds a property to the last object.
  void add_property() {
    if (last_ != nullptr) ++last_->properties;
  }
  // Adds the size of the last object's mesh. `corners` is an upper bound of its number of corners.
  // The size matters because the importer copies each part of the mesh for each morph target.
  void add_mesh(std::uint64_t parts, std::uint64_t corners) {
    if (last_ != nullptr) last_->mesh_size += parts + corners;
  }
  // Adds a link from `child` to the object `parent` or to one of its properties. The scene has the
  // id 0.
  void add_link(std::int64_t child, std::int64_t parent, bool is_to_property) {
    links_.push_back({child, parent, is_to_property});
  }

  // Returns the reason why the importer (Assimp) could not follow the links, or an empty text if it
  // can. The importer recurses for each link. It places a model once for each path from the scene
  // to the model, with at most `most_parts` parts for each mesh. It copies a mesh once for each
  // path from a morph target to the mesh.
  std::string_view fault(std::uint64_t most_parts) const;

 private:
  struct Object {
    unsigned kinds = 0;            // set of ObjectKind; several if the id is not unique
    unsigned needs = 0;            // kinds of linked objects that are read with this object
    std::uint64_t properties = 0;  // number of properties; each instance copies them
    std::uint64_t mesh_size = 0;   // number of parts and corners of its mesh
  };
  struct Link {
    std::int64_t child, parent;
    bool is_to_property;
  };
  struct Arrow;  // a link, directed from the object that is visited first
  struct Walked;

  template <class Visit>
  Walked walk(std::vector<Arrow> arrows, Visit visit) const;
  Object object_of(std::int64_t id) const;
  std::string_view fault_of_placing(std::uint64_t most_parts) const;
  std::string_view fault_of_reading() const;
  std::string_view fault_of_morphing() const;

  static constexpr unsigned kScene = 1;
  std::map<std::int64_t, Object> objects_{{0, {.kinds = kScene}}};
  Object* last_ = nullptr;
  std::vector<Link> links_;
};

}  // namespace vitrine::inline codec
