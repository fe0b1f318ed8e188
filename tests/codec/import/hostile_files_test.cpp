// SPDX-License-Identifier: Apache-2.0
// Every file cut at every byte and with every byte flipped is an error or a sound mesh, and takes
// memory within a multiple of its bytes.
#include "codec/export/write_mesh.h"
#include "codec/import/reading.h"
#include "codec/import/repair.h"
#include "codec/mesh/connectivity.h"
#include "support/counting_new.h"

namespace vitrine {
namespace {

using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;

// For the messages of errors and repairs, whatever the size of the file.
constexpr std::size_t kHeapAlways = 512;

struct Sample {
  std::string name, bytes;
  std::size_t heap_per_byte;
};

std::string written(MeshFormat format) {
  return as_text(*write_mesh(coloured_tetrahedron(), format));
}

// One byte a number, and faces in no order on few vertices, which repair splits.
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

// The multiples are measured and rounded up. GLB needs its own for the tree of its JSON, text PLY
// for its header; the others for repair where a change makes edges of many faces, most so where
// every number is a single byte: in memory it is a double or 32 bits, and corners become vertices.
// Counts in text have leading zeros, so that one bit makes them millions.
std::vector<Sample> samples() {
  return {
      {"PLY", written(MeshFormat::kPly), 4},
      {"OBJ", written(MeshFormat::kObj), 7},
      {"STL", written(MeshFormat::kStl), 1},
      {"GLB", written(MeshFormat::kGlb), 7},
      {"densest PLY", densest_ply(), 52},
      {"text PLY",
       "ply\nformat ascii 1.0\nelement vertex 00000003\nproperty float x\nproperty float y\n"
       "property float z\nelement face 00000001\nproperty list uchar int "
       "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
       2},
      {"text STL",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
       "endloop\nendfacet\nendsolid a\n",
       1},
      {"OFF", "COFF\n00000003 00000001 0\n0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n00000003 0 1 2\n",
       1}};
}

Expected<RepairedMesh> read_and_repair(std::span<const std::uint8_t> bytes) {
  auto read = read_mesh(bytes);
  if (!read) return Unexpected(read.error());
  return repair(*std::move(read));
}

// Reads a copy of exactly this size: the address sanitizer sees a read past the end.
void expect_error_or_sound_mesh(const Sample& sample, const std::string& bytes,
                                const std::string& change) {
  SCOPED_TRACE(sample.name + change);
  const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  test::start_peak();
  const std::size_t before = test::heap_bytes();
  const auto repaired = read_and_repair(copy);
  EXPECT_LE(test::peak_heap_bytes() - before, kHeapAlways + sample.heap_per_byte * copy.size());
  if (!repaired) {
    EXPECT_FALSE(repaired.error().message.empty());
    EXPECT_EQ(repaired.error().message.find('\n'), std::string::npos);
    return;
  }
  const auto& mesh = repaired->mesh;
  EXPECT_TRUE(Connectivity::close(static_cast<std::uint32_t>(mesh.positions.size()), mesh.faces));
}

TEST(HostileFiles, CutAtEveryByte) {
  for (const Sample& sample : samples()) {
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
      expect_error_or_sound_mesh(sample, sample.bytes.substr(0, size),
                                 " cut at " + std::to_string(size));
    }
  }
}

TEST(HostileFiles, EveryBitFlipped) {
  for (const Sample& sample : samples()) {
    for (std::size_t bit = 0; bit < 8 * sample.bytes.size(); ++bit) {
      std::string bytes = sample.bytes;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
      expect_error_or_sound_mesh(sample, bytes, " bit " + std::to_string(bit));
    }
  }
}

TEST(HostileFiles, EveryByteReplaced) {
  for (const Sample& sample : samples()) {
    for (std::size_t at = 0; at < sample.bytes.size(); ++at) {
      for (const char value : {'\0', '\xFF', '9', '-', '\n', 'e'}) {
        std::string bytes = sample.bytes;
        bytes[at] = value;
        expect_error_or_sound_mesh(sample, bytes, " byte " + std::to_string(at));
      }
    }
  }
}

}  // namespace
}  // namespace vitrine
