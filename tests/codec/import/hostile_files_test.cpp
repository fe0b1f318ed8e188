// SPDX-License-Identifier: Apache-2.0
// Reads files that are truncated after each byte, or in which one byte is changed. The result must
// be an error or a valid mesh. The memory used must stay within a multiple of the file's size.
#include "codec/export/write_mesh.h"
#include "codec/import/dae_builder.h"
#include "codec/import/fbx_builder.h"
#include "codec/import/textured_gltf.h"
#include "codec/mesh/connectivity.h"
#include "codec/repair/repair.h"
#include "support/counting_new.h"
#include "support/heap_bound.h"

namespace vitrine {
namespace {

using vitrine::testing::as_bytes;
using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;
using vitrine::testing::dae_source;
using vitrine::testing::DaeFile;
using vitrine::testing::GlbBuilder;
using vitrine::testing::png_of;
using vitrine::testing::textured;
using vitrine::testing::textured_dae;
using vitrine::testing::textured_fbx;

// Heap bytes allowed for error and repair messages, in addition to the multiple of the file's size.
constexpr std::size_t kHeapAlways = 512;
// Heap bytes that Assimp needs for any FBX file.
constexpr std::size_t kHeapOfAssimp = 1 << 18;

struct IntactFile {
  std::string name, bytes;
  std::size_t heap_per_byte;  // allowed heap bytes per byte of the file and its companions
  Companions beside = {};
  std::size_t heap_always = kHeapAlways;
};

std::string written(MeshFormat format) {
  return as_text(*write_mesh(coloured_tetrahedron(), format));
}

// Returns a PLY in which each number takes one byte. Its faces join vertices at random, so repair
// must split many vertices.
std::string densest_ply() {
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 50\nproperty uchar x\n"
      "property uchar y\nproperty uchar z\nelement face 100\n"
      "property list uchar uchar vertex_indices\nend_header\n";
  for (int v = 0; v < 50; ++v)
    ply += {static_cast<char>(v), static_cast<char>(v * v), static_cast<char>(v * 77)};
  for (int f = 0; f < 100; ++f)
    ply += {3, static_cast<char>(f % 50), static_cast<char>(f * f % 47),
            static_cast<char>(f * 31 % 43)};
  return ply;
}

// Returns a GLB with two triangles. The first has a sparse morph target and two instances; the
// second has a skin.
std::string posed_glb() {
  GlbBuilder builder;
  const auto points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  const auto places = builder.floats("VEC3", {0, 0, 0, 0, 0, 5}, 2);
  const auto number = builder.view(std::string(1, '\1'));
  const GlbBuilder::Json sparse{{"count", 1},
                                {"indices", {{"bufferView", number}, {"componentType", 5121}}},
                                {"values", {{"bufferView", 0}}}};
  const auto target = builder.accessor("VEC3", 5126, 3, {{"sparse", sparse}});
  const auto joints = builder.accessor("VEC4", 5121, 3, {{"bufferView", 1}});
  const auto weights = builder.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 3);
  builder.mesh({{"attributes", {{"POSITION", points}}}, {"targets", {{{"POSITION", target}}}}});
  builder.mesh(
      {{"attributes", {{"POSITION", points}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}});
  builder.document["nodes"] = {
      {{"mesh", 0},
       {"weights", {1}},
       {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}},
      {{"mesh", 1}, {"skin", 0}}};
  builder.document["skins"] = {{{"joints", {0}}}};
  builder.document["scenes"] = {{{"nodes", {0, 1}}}};
  return builder.file();
}

const std::string kPicture = png_of({1, 2, 3, 4, 5, 6}, 2);
const std::string kLibrary = "newmtl a\nmap_Kd p\nnewmtl b\nPm 1\nnorm p\n";

Companions picture_and_library() {
  return {{"p", as_bytes(kPicture)}, {"m", as_bytes(kLibrary)}};
}

// Returns an OBJ with as few bytes per face as possible. The faces have texture coordinates and
// materials.
std::string densest_textured_obj() {
  std::string obj = "mtllib m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\nusemtl a\nf 1/1 2/1 3/1\nf";
  for (int i = 0; i < 100; ++i)
    obj += ' ' + std::to_string(i % 3 + 1);
  return obj + "\nusemtl b\nf 1 2 3\nusemtl a\nf 3 2 1\n";
}

// Returns a PLY in which each number takes one byte. Its faces alternate between two materials.
std::string densest_textured_ply() {
  std::string ply =
      "ply\nformat binary_little_endian 1.0\ncomment TextureFile p\ncomment TextureFile q\n"
      "element vertex 50\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
      "element face 101\nproperty list uchar uchar vertex_indices\n"
      "property list uchar uchar texcoord\nproperty uchar texnumber\nend_header\n";
  for (int v = 0; v < 50; ++v)
    ply += {static_cast<char>(v), static_cast<char>(v * v), static_cast<char>(v * 77)};
  ply += std::string({3, 0, 1, 2, 6, 0, 0, 1, 0, 0, 1, 0});
  for (int f = 0; f < 100; ++f)
    ply += {4,
            static_cast<char>(f % 50),
            static_cast<char>(f * f % 47),
            static_cast<char>(f * 31 % 43),
            static_cast<char>(f * 7 % 41),
            0,
            static_cast<char>(f % 2)};
  return ply;
}

// The number in each row is the allowed memory as a multiple of the file's size. It was measured
// and rounded up. GLB and glTF files need memory for their JSON tree, and text PLY files for their
// header. Other formats need memory for repair if a change gives an edge many faces, or for the
// names of unknown statements if a change makes the file an OBJ.
//
// Files in which each number is a single byte need the most memory per byte. In memory, numbers are
// doubles or have 32 bits, and repair turns corners into vertices.
//
// Counts in text files have leading zeros. A change of one bit can therefore turn 3 into millions.
std::vector<IntactFile> intact_files() {
  return {
      {"PLY", written(MeshFormat::kPly), 4},
      {"OBJ", written(MeshFormat::kObj), 7},
      {"STL", written(MeshFormat::kStl), 1},
      {"GLB", written(MeshFormat::kGlb), 7},
      {"glTF",
       R"({"asset":{},"buffers":[{"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
       "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,
       "type":"VEC3","count":3}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})",
       30},
      {"densest PLY", densest_ply(), 52},
      {"textured GLB", textured(kPicture).file(), 8},
      {"posed GLB", posed_glb(), 16},
      {"densest textured PLY", densest_textured_ply(), 43, picture_and_library()},
      {"densest textured OBJ", densest_textured_obj(), 30, picture_and_library()},
      {"text PLY",
       "ply\nformat ascii 1.0\nelement vertex 00000003\nproperty float x\nproperty float y\n"
       "property float z\nelement face 00000001\nproperty list uchar int "
       "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
       3},
      {"text STL",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
       "endloop\nendfacet\nendsolid a\n",
       2},
      {"OFF", "COFF\n00000003 00000001 0\n0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n00000003 0 1 2\n",
       1},
      {"DAE", textured_dae("p").text(), 4, picture_and_library()},
      {"FBX", textured_fbx("p", kPicture).file(), 8, {}, kHeapOfAssimp}};
}

Expected<RepairedMesh> read_and_repair(std::span<const std::uint8_t> bytes,
                                       const Companions& beside) {
  auto read = read_mesh(bytes, {.beside = beside});
  if (!read) return tl::unexpected(read.error());
  return repair(*std::move(read));
}

std::size_t size_of(const Companions& beside) {
  std::size_t size = 0;
  for (const auto& [name, bytes] : beside)
    size += bytes.size();
  return size;
}

// Expects an error or a valid mesh. Reads a copy of exactly the right size, so that the address
// sanitizer detects reads past the end.
void expect_error_or_sound_mesh(const IntactFile& file, const std::string& bytes,
                                const std::string& change) {
  SCOPED_TRACE(file.name + change);
  const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  test::start_peak();
  const std::size_t before = test::heap_bytes();
  const auto repaired = read_and_repair(copy, file.beside);
  const std::size_t size = copy.size() + size_of(file.beside);
  EXPECT_LE(test::peak_heap_bytes() - before, file.heap_always + file.heap_per_byte * size);
  if (!repaired) {
    EXPECT_FALSE(repaired.error().message.empty());
    EXPECT_EQ(repaired.error().message.find('\n'), std::string::npos);
    return;
  }
  const auto& mesh = repaired->mesh;
  EXPECT_TRUE(Connectivity::close(static_cast<std::uint32_t>(mesh.positions.size()), mesh.faces));
}

TEST(HostileFiles, CutAtEveryByte) {
  for (const IntactFile& file : intact_files()) {
    for (std::size_t size = 0; size < file.bytes.size(); ++size) {
      expect_error_or_sound_mesh(file, file.bytes.substr(0, size),
                                 " cut at " + std::to_string(size));
    }
  }
}

TEST(HostileFiles, EveryBitFlipped) {
  for (const IntactFile& file : intact_files()) {
    for (std::size_t bit = 0; bit < 8 * file.bytes.size(); ++bit) {
      std::string bytes = file.bytes;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
      expect_error_or_sound_mesh(file, bytes, " bit " + std::to_string(bit));
    }
  }
}

TEST(HostileFiles, EveryByteReplaced) {
  for (const IntactFile& file : intact_files()) {
    for (std::size_t at = 0; at < file.bytes.size(); ++at) {
      for (const char value : {'\0', '\xFF', '9', '-', '\n', 'e'}) {
        std::string bytes = file.bytes;
        bytes[at] = value;
        expect_error_or_sound_mesh(file, bytes, " byte " + std::to_string(at));
      }
    }
  }
}

// A mesh of which a scene shows `count` instances. Its primitives alternate between two materials.
// Each primitive has `vertices` vertices and `faces` faces. Primitives with the same material share
// vertices.
struct Instances {
  std::size_t count, primitives, vertices, faces;

  std::size_t all_vertices() const {
    return count * std::min<std::size_t>(primitives, 2) * vertices;
  }
  std::size_t all_faces() const { return count * primitives * faces; }
};

// Returns a GLB that is read as about one vertex and one face per byte of the file. Vertices have
// both sets of texture coordinates and a colour from a texture. All attributes are views of the
// same few bytes.
std::string densest_instances(const Instances& instances) {
  using Json = GlbBuilder::Json;
  GlbBuilder builder = textured(kPicture);
  std::string numbers;
  for (std::size_t i = 0; i < 3 * instances.vertices; ++i)
    numbers += static_cast<char>(i % instances.vertices);
  const Json view{{"bufferView", builder.view(numbers)}};
  const auto points = builder.accessor("VEC3", 5121, instances.vertices, view);
  const auto places = builder.accessor("VEC2", 5121, instances.vertices, view);
  const auto indices = builder.accessor("SCALAR", 5121, instances.faces + 2, view);
  builder.document["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
  builder.append("materials", Json(builder.document["materials"][0]));
  Json& primitives = builder.document["meshes"][0]["primitives"] = Json::array();
  for (std::size_t p = 0; p < instances.primitives; ++p) {
    primitives.push_back(
        {{"attributes", {{"POSITION", points}, {"TEXCOORD_0", places}, {"TEXCOORD_1", places}}},
         {"material", p % 2},
         {"indices", indices},
         {"mode", 5}});
  }
  builder.append("scenes", {{"nodes", Json::array()}});
  for (std::size_t i = 0; i < instances.count; ++i)
    builder.document["scenes"][0]["nodes"].push_back(builder.append("nodes", {{"mesh", 0}}));
  const std::size_t size = builder.file().size();
  EXPECT_LT(size, instances.all_vertices());
  builder.place(std::string(instances.all_vertices() - size, '\0'));
  return builder.file();
}

// The numbers of vertices and faces are just above powers of two. At these sizes, a std::vector
// that doubles its capacity wastes the most memory.
TEST(HostileFiles, InstancesWithBothSetsOfCoordinatesKeepTheBoundOfReading) {
  for (const Instances& instances :
       {Instances{.count = 257, .primitives = 1, .vertices = 64, .faces = 64},
        Instances{.count = 513, .primitives = 1, .vertices = 32, .faces = 32},
        Instances{.count = 257, .primitives = 64, .vertices = 32, .faces = 1}}) {
    const std::string file = densest_instances(instances);
    test::start_peak();
    const std::size_t before = test::heap_bytes();
    const auto read = read_mesh(as_bytes(file));
    const std::size_t peak = test::peak_heap_bytes() - before;
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->texturing.coordinates[0].size(), instances.all_faces());
    EXPECT_EQ(read->texturing.coordinates[1].size(), instances.all_faces());
    EXPECT_LE(peak, test::kReadingGlbHeap.of(file.size()))
        << static_cast<double>(peak) / static_cast<double>(file.size()) << " bytes per byte";
  }
}

// Many <source> elements of a DAE file refer to the same long array.
TEST(HostileFiles, SourcesThatShareAnArrayKeepTheBoundOfReading) {
  std::string numbers;
  for (int i = 0; i < 20'000; ++i)
    numbers += "0 ";
  DaeFile dae{.sources = dae_source("n", numbers, 1)};
  for (int i = 0; i < 500; ++i) {
    const std::string id = "t" + std::to_string(i);
    dae.sources += "<source id=\"" + id +
                   R"("><technique_common><accessor source="#na"/></technique_common></source>)";
    dae.inputs += R"(<input semantic="TEXCOORD" source="#)" + id + "\"/>";
  }
  const std::string file = dae.text();
  test::start_peak();
  const std::size_t before = test::heap_bytes();
  const auto read = read_mesh(as_bytes(file));
  const std::size_t peak = test::peak_heap_bytes() - before;
  EXPECT_TRUE(read) << read.error().message;
  EXPECT_LE(peak, test::kReadingHeap.of(file.size()));
}

}  // namespace
}  // namespace vitrine
