// SPDX-License-Identifier: Apache-2.0
#include "codec/fbx/fbx_scene.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <set>
#include <stdexcept>
#include <string>

#include "codec/repair/raw_mesh.h"

// Debian builds Assimp with its assertions, which end the process. This definition replaces
// Assimp's own. It turns a failed assertion into an error of Importer::ReadFile().
namespace Assimp {
void aiAssertViolation(const char* expression, const char* file, int line);
void aiAssertViolation(const char* expression, const char*, int) {
  throw std::runtime_error(std::string("failed check ") + expression);
}
}  // namespace Assimp

namespace vitrine::inline codec {
namespace {

constexpr const char* kFileName = "model.fbx";

// A file system with a single file, the FBX file in memory. Assimp can open no other file.
class OneFile : public Assimp::IOSystem {
 public:
  explicit OneFile(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool Exists(const char* name) const override { return std::string_view(name) == kFileName; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    if (!Exists(name)) return nullptr;
    return new Assimp::MemoryIOStream(bytes_.data(), bytes_.size(), false);
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::span<const std::uint8_t> bytes_;
};

// Removes all importers except the FBX importer, so that no other importer reads untrusted bytes.
void keep_fbx_alone(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* candidate = importer.GetImporter(i);
    std::set<std::string> extensions;
    candidate->GetExtensionList(extensions);
    if (extensions.contains("fbx")) continue;
    importer.UnregisterLoader(candidate);
    delete candidate;
  }
}

void leave_out_the_rest(Assimp::Importer& importer) {
  for (const char* property :
       {AI_CONFIG_IMPORT_FBX_READ_CAMERAS, AI_CONFIG_IMPORT_FBX_READ_LIGHTS,
        AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, AI_CONFIG_IMPORT_FBX_READ_WEIGHTS})
    importer.SetPropertyBool(property, false);
}

Unexpected not_imported(const std::string& reason) {
  // the importer reports this for files of a version before 7.1
  if (reason.find("old format version") != reason.npos)
    return bad_input(
        "the FBX is older than FBX 2011, which is not read; export it again as FBX 2013 or later, "
        "or as GLB");
  return bad_input("the FBX is damaged or of an unusual kind (" + in_quotes(reason) +
                   "); export it again as FBX 2013 or later, or as GLB");
}

}  // namespace

Expected<FbxScene> FbxScene::import(std::span<const std::uint8_t> bytes) {
  try {
    Assimp::Importer importer;
    keep_fbx_alone(importer);
    leave_out_the_rest(importer);
    importer.SetIOHandler(new OneFile(bytes));  // the importer owns it
    if (importer.ReadFile(kFileName, 0) == nullptr) return not_imported(importer.GetErrorString());
    FbxScene out;
    out.scene_.reset(importer.GetOrphanedScene());
    return out;
  } catch (const std::exception& fault) {
    return not_imported(fault.what());
  }
}

}  // namespace vitrine::inline codec
