// SPDX-License-Identifier: Apache-2.0
// Every file cut at every byte and with every byte flipped is an error or a sound mesh.
#include "codec/export/write_mesh.h"
#include "codec/import/reading.h"
#include "codec/import/repair.h"
#include "codec/mesh/connectivity.h"

namespace vitrine {
namespace {

using vitrine::testing::as_text;
using vitrine::testing::coloured_tetrahedron;

struct Sample {
  std::string name, bytes;
};

std::string written(MeshFormat format) {
  return as_text(*write_mesh(coloured_tetrahedron(), format));
}

std::vector<Sample> samples() {
  return {{"PLY", written(MeshFormat::kPly)},
          {"OBJ", written(MeshFormat::kObj)},
          {"STL", written(MeshFormat::kStl)},
          {"GLB", written(MeshFormat::kGlb)},
          {"text PLY",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
          {"text STL",
           "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
           "endloop\nendfacet\nendsolid a\n"},
          {"OFF", "COFF\n3 1 0\n0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n3 0 1 2\n"}};
}

// A copy of exactly this size, so that a read past the end is seen by the address sanitizer.
void expect_error_or_sound_mesh(const std::string& bytes, const std::string& what) {
  const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  auto read = read_mesh(copy);
  if (!read) {
    EXPECT_FALSE(read.error().message.empty()) << what;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << what;
    return;
  }
  const auto repaired = repair(*std::move(read));
  if (!repaired) return;
  const auto& mesh = repaired->mesh;
  EXPECT_TRUE(Connectivity::close(static_cast<std::uint32_t>(mesh.positions.size()), mesh.faces))
      << what;
}

TEST(HostileFiles, CutAtEveryByte) {
  for (const Sample& sample : samples()) {
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
      expect_error_or_sound_mesh(sample.bytes.substr(0, size),
                                 sample.name + " cut at " + std::to_string(size));
    }
  }
}

TEST(HostileFiles, EveryBitFlipped) {
  for (const Sample& sample : samples()) {
    for (std::size_t bit = 0; bit < 8 * sample.bytes.size(); ++bit) {
      std::string bytes = sample.bytes;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
      expect_error_or_sound_mesh(bytes, sample.name + " bit " + std::to_string(bit));
    }
  }
}

TEST(HostileFiles, EveryByteReplaced) {
  for (const Sample& sample : samples()) {
    for (std::size_t at = 0; at < sample.bytes.size(); ++at) {
      for (const char value : {'\0', '\xFF', '9', '-', '\n', 'e'}) {
        std::string bytes = sample.bytes;
        bytes[at] = value;
        expect_error_or_sound_mesh(bytes, sample.name + " byte " + std::to_string(at));
      }
    }
  }
}

}  // namespace
}  // namespace vitrine
