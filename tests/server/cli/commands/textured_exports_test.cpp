// SPDX-License-Identifier: Apache-2.0
// Tests the files that `vitrine decode` writes for a textured model.
#include <gmock/gmock.h>

#include "codec/build/build_model.h"
#include "codec/import/read_mesh.h"
#include "support/packages/read_zip.h"
#include "support/product_names.h"
#include "support/textured_mesh.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

std::span<const std::uint8_t> span_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class TexturedExports : public VitrineCommand {
 protected:
  TexturedExports() {
    const auto built = build_model(textured_torus(40, 20, 256), {}, {}).value();
    write("model.pmesh", {built.file.begin(), built.file.end()});
    before_ = files();
  }
  json decode(const std::string& out, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"decode", path("model.pmesh"), "-o", path(out)});
    return vitrine_json(more);
  }
  // Returns the names of the files that were written since the test began.
  std::vector<std::string> written() const {
    std::vector<std::string> names = files();
    std::erase_if(names,
                  [&](const std::string& name) { return std::ranges::count(before_, name) > 0; });
    return names;
  }
  // Reads `mesh` with the companion files `by`. Expects texture coordinates and one picture.
  static void expect_textured(const std::string& mesh,
                              const std::map<std::string, std::string>& by) {
    ReadOptions options;
    for (const auto& [name, bytes] : by)
      options.beside[companion_key(name)] = span_of(bytes);
    const auto back = read_mesh(span_of(mesh), options);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->texturing.pictures.size(), 1u);
    EXPECT_EQ(back->texturing.coordinates[0].size(), back->mesh.faces.size());
  }

 private:
  std::vector<std::string> before_;
};

TEST_F(TexturedExports, DecodeWritesThePicturesBesideTheMesh) {
  const json obj = decode("my bust.obj");
  EXPECT_EQ(obj["companions"], (json{"my_bust.mtl", "my_bust_base_colour.jpg"}));
  EXPECT_EQ(written(),
            (std::vector<std::string>{"my bust.obj", "my_bust.mtl", "my_bust_base_colour.jpg"}));
  expect_textured(read("my bust.obj"),
                  {{"my_bust.mtl", read("my_bust.mtl")},
                   {"my_bust_base_colour.jpg", read("my_bust_base_colour.jpg")}});
  EXPECT_EQ(decode("a.ply")["companions"], json{"a_base_colour.jpg"});
  expect_textured(read("a.ply"), {{"a_base_colour.jpg", read("a_base_colour.jpg")}});
  EXPECT_EQ(decode("b.wrl")["companions"], json{"b_base_colour.jpg"});
  EXPECT_THAT(read("b.wrl"), HasSubstr("url \"b_base_colour.jpg\""));
  EXPECT_THAT(vitrine({"decode", path("model.pmesh"), "-o", path("a.ply")}).output,
              HasSubstr(", with a_base_colour.jpg\n"));
}

TEST_F(TexturedExports, NoFileIsReplacedWithoutForce) {
  const auto decode_unforced = [&](const std::string& out) {
    return run_program({kVitrine, "decode", path("model.pmesh"), "-o", path(out)});
  };
  for (const std::string kept : {"bust.mtl", "bust_base_colour.jpg", "bust.obj"}) {
    write(kept, "mine");
    const ProgramResult refused = decode_unforced("bust.obj");
    expect_fault(refused, 1);
    EXPECT_THAT(refused.errors, HasSubstr(kept + " exists; choose another name, or replace it "
                                                 "with --force"));
    EXPECT_EQ(written(), std::vector<std::string>{kept});
    EXPECT_EQ(read(kept), "mine");
    std::filesystem::remove(path(kept));
  }
  write("bust.mtl", "mine");
  decode("bust.obj");
  EXPECT_THAT(read("bust.mtl"), HasSubstr("newmtl"));
  expect_fault(run_program({kVitrine, "build", path("bust.obj"), "-o", path("model.pmesh")}), 1);
}

TEST_F(TexturedExports, TheOriginalsAreInAGlbOnly) {
  EXPECT_EQ(decode("source.glb", {"--originals"})["pictures"], 1);
  const ImportedMesh source = textured_torus(40, 20, 256);
  const auto back = read_mesh(span_of(read("source.glb")));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->texturing.pictures.at(0).bytes, source.texturing.pictures[0].bytes);
  EXPECT_EQ(back->texturing.materials.at(0).name, "clay");
  expect_fault(vitrine({"decode", path("model.pmesh"), "-o", path("a.obj"), "--originals"}), 2);
  expect_fault(
      vitrine({"decode", path("model.pmesh"), "-o", path("a.glb"), "--originals", "--level", "1"}),
      2);
  EXPECT_THAT(vitrine({"info", path("model.pmesh")}).output, HasSubstr("originals of the source"));
}

TEST_F(TexturedExports, DecodePacksThemIntoAZip) {
  for (const std::string format : {"obj", "ply"}) {
    decode("bust." + format + ".zip", {"--texture", "64"});
    const auto packed = read_zip(read("bust." + format + ".zip"));
    EXPECT_EQ(packed.size(), format == "obj" ? 3u : 2u);
    expect_textured(packed.at("bust." + format), packed);
  }
  EXPECT_EQ(written(), (std::vector<std::string>{"bust.obj.zip", "bust.ply.zip"}));
}

TEST_F(TexturedExports, AFileThatNeedsNoPicturesIsAlone) {
  EXPECT_EQ(decode("a.obj", {"--texture", "0"})["companions"], json::array());
  EXPECT_EQ(decode("a.glb")["companions"], json::array());
  EXPECT_EQ(decode("a.usdz")["companions"], json::array());
  EXPECT_EQ(read_zip(read("a.usdz")).count("a_base_colour.jpg"), 1u);
  EXPECT_EQ(written(), (std::vector<std::string>{"a.glb", "a.obj", "a.usdz"}));
  EXPECT_THAT(read("a.obj"), Not(HasSubstr("mtllib")));
}

}  // namespace
}  // namespace vitrine::test
