// SPDX-License-Identifier: Apache-2.0
#include "codec/import/glb_builder.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using vitrine::testing::bytes_of;
using vitrine::testing::expect_first_dropped;
using vitrine::testing::expect_first_named;
using vitrine::testing::glb;
using vitrine::testing::GlbBuilder;
using vitrine::testing::kNotFinite;
using vitrine::testing::read_text;
using vitrine::testing::refusal;

// The positions of a triangle's corners, at byte 0 of the buffer. Tests append their own data at
// byte 36.
const std::string kCorners = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
constexpr char kViews[] =
    R"("buffers":[{"byteLength":99}],"bufferViews":[{"buffer":0,"byteLength":36},)";
constexpr char kPositions[] = R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3})";
constexpr char kOneMesh[] = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])";

std::string plain(std::string extra) {
  return glb(std::string("{") + kViews + R"({}],"accessors":[)" + kPositions + "]," + kOneMesh +
                 extra + "}",
             kCorners);
}

TEST(ReadGlb, TrianglesWithoutIndices) {
  const auto result = read_text(plain(""));
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(result.mesh.positions[1], (Vec3{1, 0, 0}));
}

TEST(ReadGlb, TrianglesWithoutIndicesShareTheirCorners) {
  const std::string two = kCorners + bytes_of<float>({1, 0, 0, 1, 1, 0, 0, 1, 0});
  const auto result = read_text(
      glb(std::string(R"({"buffers":[{"byteLength":72}],)") +
              R"("bufferViews":[{"buffer":0,"byteLength":72}],"accessors":[)" +
              R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":6}],)" + kOneMesh + "}",
          two));
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("2 repeated vertices welded")));
}

TEST(ReadGlb, IndicesOfEveryType) {
  const std::pair<int, std::string> kinds[] = {{5121, bytes_of<std::uint8_t>({2, 0, 1})},
                                               {5123, bytes_of<std::uint16_t>({2, 0, 1})},
                                               {5125, bytes_of<std::uint32_t>({2, 0, 1})}};
  for (const auto& [type, indices] : kinds) {
    const auto result = read_text(
        glb(std::string("{") + kViews + R"({"buffer":0,"byteOffset":36,"byteLength":)" +
                std::to_string(indices.size()) + R"(}],"accessors":[)" + kPositions +
                R"(,{"bufferView":1,"componentType":)" + std::to_string(type) +
                R"(,"type":"SCALAR","count":3}],)"
                R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]})",
            kCorners + indices));
    EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{2, 0, 1})) << type;
  }
}

std::string triangle_of_four(float x, std::initializer_list<std::uint16_t> corners) {
  GlbBuilder builder;
  const auto positions = builder.floats("VEC3", {x, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0}, 4);
  const auto indices =
      builder.accessor("SCALAR", 5123, 3, {{"bufferView", builder.view(bytes_of(corners))}});
  builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  return builder.file();
}

TEST(ReadGlb, CoordinatesThatAreNotFinite) {
  for (const auto& [text, value] : kNotFinite) {
    SCOPED_TRACE(text);
    expect_first_dropped(read_text(triangle_of_four(value, {1, 2, 3})));
    expect_first_named(triangle_of_four(value, {0, 1, 2}));
  }
}

TEST(ReadGlb, ColoursAreLinearLightInAnyTypeAndStride) {
  const std::string colours = bytes_of<std::uint8_t>({0,   0,  0, 255, 9, 9, 9, 9,  //
                                                      255, 55, 0, 255, 9, 9, 9, 9, 0, 0, 255, 255});
  const auto result = read_text(glb(
      std::string("{") + kViews +
          R"({"buffer":0,"byteOffset":36,"byteLength":20,"byteStride":8}],"accessors":[)" +
          kPositions +
          R"(,{"bufferView":1,"componentType":5121,"normalized":true,"type":"VEC4","count":3}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1}}]}]})",
      kCorners + colours));
  EXPECT_THAT(result.mesh.attributes.colours,
              ElementsAre(Colour{0, 0, 0}, Colour{255, 128, 0}, Colour{0, 0, 255}));
}

TEST(ReadGlb, NodesPlaceTheirMeshesAndAMirrorKeepsTheOutside) {
  const auto result = read_text(
      plain(R"(,"scenes":[{"nodes":[0]}],"nodes":[{"translation":[10,0,0],"children":[1,2]},)"
            R"({"mesh":0,"rotation":[0,0,0.7071067811865476,0.7071067811865476]},)"
            R"({"mesh":0,"scale":[1,1,-2]}])"));
  ASSERT_EQ(result.mesh.faces.size(), 2u);
  std::vector<double> ups;
  for (const auto& [a, b, c] : result.mesh.faces) {
    const auto& p = result.mesh.positions;
    ups.push_back(cross(p[b] - p[a], p[c] - p[a]).z);
  }
  EXPECT_THAT(ups, ::testing::UnorderedElementsAre(::testing::DoubleNear(1, 1e-12), -1));
}

TEST(ReadGlb, SharesVerticesBetweenPrimitivesAndWeldsSeams) {
  const auto result = read_text(glb(
      std::string("{") + kViews + R"({"buffer":0,"byteLength":72}],"accessors":[)" + kPositions +
          R"(,{"bufferView":1,"componentType":5126,"type":"VEC3","count":6}],"images":[{},{}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":1,"NORMAL":1}}]}]})",
      kCorners + bytes_of<float>({1, 0, 0, 1, 1, 0, 0, 1, 0})));
  EXPECT_EQ(result.mesh.positions.size(), 4u);
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("2 texture maps not carried; ")));
  EXPECT_THAT(result.repairs, Contains(HasSubstr("2 repeated vertices welded")));
}

TEST(ReadGlb, RefusesByName) {
  for (const std::string name :
       {"KHR_meshopt_compression", "KHR_gaussian_splatting", "EXT_mesh_primitive_restart",
        "MPEG_accessor_timed", "WEB3D_quantized_attributes", "NV_displacement_micromap"})
    EXPECT_THAT(refusal(plain(R"(,"extensionsRequired":[")" + name + "\"]")),
                HasSubstr("needs the extension '" + name + "', which is not read; export"));
  EXPECT_THAT(refusal(plain(R"(,"scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}])")),
              HasSubstr("two parents"));
  EXPECT_THAT(refusal(glb("{}", "")), HasSubstr("no vertices"));
  EXPECT_THAT(refusal(glb("[[[", "")), HasSubstr("not JSON"));
  EXPECT_THAT(refusal(glb(std::string(100'000, '['), "")), HasSubstr("nested too deeply"));
}

TEST(ReadGlb, RequiredExtensionsWithoutGeometryAreNoted) {
  for (const std::string name :
       {"KHR_lights_punctual", "KHR_xmp_json_ld", "KHR_animation_pointer", "EXT_lights_image_based",
        "KHR_node_visibility", "EXT_mesh_features", "MSFT_lod"}) {
    const auto result =
        read_text(plain(R"(,"extensionsRequired":[")" + name + R"(","KHR_mesh_quantization"])"));
    EXPECT_EQ(result.mesh.faces.size(), read_text(plain("")).mesh.faces.size());
    EXPECT_THAT(result.repairs, Contains("1 required extension not read, such as '" + name +
                                         "'; compare the model with its source, or export the file "
                                         "without it"));
  }
}

TEST(ReadGlb, AFileThatIsCutIsToBeCopiedAgain) {
  for (const std::size_t size : {8, 40}) {
    EXPECT_THAT(refusal(plain("").substr(0, size)), EndsWith("; it is cut short, copy it again"));
  }
}

TEST(ReadGlb, PointsAndLinesAreCountedWhereThereIsNothingElse) {
  GlbBuilder builder;
  for (const int mode : {0, 3}) {
    const auto points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    builder.mesh({{"mode", mode}, {"attributes", {{"POSITION", points}}}});
  }
  EXPECT_THAT(refusal(builder.file()), HasSubstr("has 6 points but no faces"));
}

TEST(ReadGlb, ADefaultSceneWithoutMeshesIsNamed) {
  const std::string nodes = R"(,"nodes":[{"children":[1]},{},{"children":[3]},{"mesh":0}])";
  const std::string alone = plain(nodes + R"(,"scenes":[{"nodes":[0]}])");
  EXPECT_THAT(refusal(alone), HasSubstr("scene 0 shows none of the file's meshes; export"));
  const std::string roots = R"(,"scenes":[{"nodes":[2]},{},{"nodes":[0]}])";
  EXPECT_THAT(refusal(plain(nodes + roots + R"(,"scene":1)")),
              HasSubstr("scene 1 shows none of the file's meshes, but scene 0 does; make that"));
  EXPECT_EQ(read_text(plain(nodes + roots)).mesh.faces.size(), 1u);
}

TEST(ReadGlb, ANodeThatIsNotPlacedByNumbersIsNamed) {
  for (const std::string fault :
       {R"("translation":[1,2])", R"("translation":[1,"2",3])", R"("rotation":"x")", R"("scale":2)",
        R"("matrix":[1,0,0,1])", R"("matrix":{})"}) {
    const std::string key = fault.substr(1, fault.find('"', 1) - 1);
    EXPECT_THAT(
        refusal(plain(R"(,"scenes":[{"nodes":[1]}],"nodes":[{},{"mesh":0,)" + fault + "}]")),
        HasSubstr("the " + key + " of node 1 is not "));
  }
}

TEST(ReadGlb, AnotherVersionOfGltfIsRefused) {
  const auto with = [](const std::string& asset) { return plain(R"(,"asset":)" + asset); };
  EXPECT_THAT(refusal(with(R"({"version":"1.0"})")), HasSubstr("glTF version '1.0' is not read"));
  EXPECT_THAT(refusal(with(R"({"version":"20.0"})")), HasSubstr("'20.0'"));
  EXPECT_THAT(refusal(with(R"({"version":1.0})")), HasSubstr("'1.0'"));
  EXPECT_THAT(refusal(with(R"({"version":"2.1","minVersion":"2.1"})")), HasSubstr("'2.1'"));
  read_text(with(R"({"version":"2.1","minVersion":"2.0"})"));
  read_text(with(R"({"version":"2.7"})"));
}

TEST(ReadGlb, RefusesAnAccessorBeyondTheBuffer) {
  std::string file = plain("");
  file.replace(file.find("\"count\":3"), 9, "\"count\":4");
  EXPECT_THAT(refusal(file), HasSubstr("accessor 0 does not fit its buffer view"));
  file.replace(file.find("\"byteLength\":36"), 15, "\"byteLength\":88");
  EXPECT_THAT(refusal(file), HasSubstr("accessor 0 does not fit its buffer view"));
}

TEST(ReadGlb, RefusesInstancesThatMakeMoreThanTheFileHasBytes) {
  const std::string primitive = R"({"attributes":{"POSITION":0}})";
  std::string primitives = primitive, nodes = R"({"mesh":0})", list = "0";
  for (int i = 1; i < 100; ++i) {
    primitives += "," + primitive;
    nodes += R"(,{"mesh":0})";
    list += "," + std::to_string(i);
  }
  EXPECT_THAT(
      refusal(glb(std::string("{") + kViews + R"({}],"accessors":[)" + kPositions +
                      R"(],"meshes":[{"primitives":[)" + primitives +
                      R"(]}],"scenes":[{"nodes":[)" + list + R"(]}],"nodes":[)" + nodes + "]}",
                  kCorners)),
      HasSubstr("instances make too many faces"));
}

}  // namespace
}  // namespace vitrine
