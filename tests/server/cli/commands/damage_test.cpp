// SPDX-License-Identifier: Apache-2.0
// Tests that every kind of damage to a .pmesh file gives a one-line error.
#include "codec/format/manifest.h"
#include "support/product_names.h"
#include "support/seeds.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

std::vector<std::uint8_t> to_bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

char flipped(char byte, int bits) {
  return static_cast<char>(byte ^ bits);
}

TEST_F(VitrineCommand, AFlippedByteInAChunkIsFoundAndPlaced) {
  model();
  std::string bytes = read("model.pmesh");
  bytes[bytes.size() - 10] = flipped(bytes[bytes.size() - 10], 4);
  const ProgramResult result = vitrine({"verify", write("bad.pmesh", bytes), "--json"});
  expect_fault(result, 1);
  EXPECT_EQ(nlohmann::json::parse(result.output)["ok"], false);
  EXPECT_NE(result.errors.find("SHA-256"), std::string::npos);
}

TEST_F(VitrineCommand, APrefixStillDecodesToACoarserLevel) {
  model();
  const auto levels = vitrine_json({"info", path("model.pmesh")})["levels"];
  const std::string prefix = read("model.pmesh").substr(0, levels[1]["cumulative_bytes"]);
  const std::string file = write("prefix.pmesh", prefix);
  EXPECT_EQ(vitrine_json({"decode", file, "-o", path("out.ply"), "--level", "1"})["faces"],
            levels[1]["faces"]);
  expect_fault(vitrine({"decode", file, "-o", path("finest.ply")}), 1);
  EXPECT_FALSE(std::filesystem::exists(path("finest.ply")));
  expect_fault(vitrine({"verify", file}), 1);
}

TEST_F(VitrineCommand, EveryWayToCutTheHeadIsAnError) {
  model(600);
  const std::string bytes = read("model.pmesh");
  const std::size_t head = parse_header(to_bytes(bytes))->head_bytes();
  for (std::size_t length = 1; length < head; length += head / seeds(23)) {
    expect_fault(vitrine({"verify", write("cut.pmesh", bytes.substr(0, length))}), 1);
  }
}

TEST_F(VitrineCommand, AFileThatIsCutInItsBaseHasNoCoarserLevelToAskFor) {
  const std::string bytes = read(std::filesystem::path(model(600)).filename().string());
  const std::size_t head = parse_header(to_bytes(bytes))->head_bytes();
  const std::string cut = write("cut.pmesh", bytes.substr(0, head - 1));
  const ProgramResult result = vitrine({"decode", cut, "-o", path("out.ply"), "--level", "0"});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, ::testing::EndsWith("; fetch it again\n"));
}

// The test corrects the SHA-256, so that the damaged bytes are decoded.
TEST_F(VitrineCommand, AHostileBaseMeshIsAnErrorOrAMeshButNeverACrash) {
  model(600);
  const std::string bytes = read("model.pmesh");
  Manifest manifest = parse_header(to_bytes(bytes)).value();
  const std::uint64_t offset = manifest.base_offset, length = manifest.base_length;
  for (std::uint64_t at = 0; at < length; at += length / seeds(31) + 1) {
    std::string rest = bytes.substr(offset);
    rest[at] = flipped(rest[at], 0x55);
    manifest.base_sha256 = sha256(to_bytes(rest.substr(0, length)));
    const auto header = write_header(manifest);
    const ProgramResult result =
        vitrine({"verify", write("bad.pmesh", std::string(header.begin(), header.end()) + rest)});
    if (result.exit_code != 0) expect_fault(result, 1);
  }
}

TEST_F(VitrineCommand, AHostileDrcIsAnErrorOrAMeshButNeverACrash) {
  vitrine_json({"decode", model(600), "-o", path("good.drc")});
  const std::string bytes = read("good.drc");
  for (std::size_t at = 0; at < bytes.size(); at += bytes.size() / seeds(31) + 1) {
    std::string damaged = bytes;
    damaged[at] = flipped(damaged[at], 0x55);
    const ProgramResult result =
        vitrine({"measure", write("bad.drc", damaged), path("model.ply"), "--samples", "100"});
    if (result.exit_code != 0) expect_fault(result, 1);
  }
  const ProgramResult cut = vitrine({"measure", write("bad.drc", bytes.substr(0, bytes.size() / 2)),
                                     path("model.ply"), "--samples", "100"});
  expect_fault(cut, 1);
  EXPECT_NE(cut.errors.find("bad.drc: the Draco data cannot be decoded"), std::string::npos)
      << cut.errors;
}

TEST_F(VitrineCommand, AWrongBoxIsFoundInAFileOfOneLevel) {
  model(4);
  const std::string bytes = read("model.pmesh");
  Manifest manifest = parse_header(to_bytes(bytes)).value();
  ASSERT_EQ(manifest.levels.size(), 1u);
  const std::string rest = bytes.substr(manifest.base_offset);
  manifest.tree.nodes[0].box.high = manifest.tree.nodes[0].box.low;
  const auto header = write_header(manifest);
  const ProgramResult result =
      vitrine({"verify", write("bad.pmesh", std::string(header.begin(), header.end()) + rest)});
  expect_fault(result, 1);
  EXPECT_NE(result.errors.find("outside of the box"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace vitrine::test
