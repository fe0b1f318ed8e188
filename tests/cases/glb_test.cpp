// SPDX-License-Identifier: Apache-2.0
// Reads glTF files like those of real exporters: instances, skins, morph targets, sparse accessors,
// materials of other shading models, and small faults of the container.
#include "cases/kind.h"
#include "codec/import/textured_gltf.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using vitrine::testing::bytes_of;
using vitrine::testing::Case;
using vitrine::testing::glb;
using vitrine::testing::GlbBuilder;
using vitrine::testing::kBlue;
using vitrine::testing::kRed;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::refusal;
using vitrine::testing::textured;
using Json = nlohmann::json;

// A scene with one node that shows a triangle with indices.
struct Model : GlbBuilder {
  explicit Model(std::size_t corners = 3)
      : positions(floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, corners)),
        indices(accessor("SCALAR", 5123, 3,
                         {{"bufferView", view(bytes_of<std::uint16_t>({0, 1, 2}))}})) {
    mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    document["nodes"] = {{{"mesh", 0}}};
    document["scenes"] = {{{"nodes", {0}}}};
  }

  Json& primitive() { return document["meshes"][0]["primitives"][0]; }
  Json& attributes() { return primitive()["attributes"]; }
  Json& node() { return document["nodes"][0]; }

  std::size_t positions, indices;
};

std::vector<Vec3> positions_of(const GlbBuilder& model) {
  return read_text(model.file()).mesh.positions;
}

const std::vector<Vec3> kTriangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(GlbCases, LostOpacityIsCounted) {
  Model model;
  model.attributes()["COLOR_0"] =
      model.floats("VEC4", {1, 0, 0, 1, 1, 0, 0, 0.5, 1, 0, 0, 0.25}, 3);
  EXPECT_THAT(read_text(model.file()).repairs, IsEmpty());  // an opaque material ignores alpha
  model.document["materials"] = {{{"alphaMode", "BLEND"}}};
  model.primitive()["material"] = 0;
  EXPECT_THAT(read_text(model.file()).repairs,
              Contains(HasSubstr("opacity of 2 colours not carried: vertex colours are opaque; ")));
}

TEST(GlbCases, InstancesOfANodeAreAllRead) {
  Model model;
  const std::size_t places = model.floats("VEC3", {0, 0, 0, 5, 0, 0, 0, 0, 5}, 3);
  auto& attributes = model.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes = {{"TRANSLATION", places}};
  EXPECT_EQ(read_text(model.file()).mesh.faces.size(), 3u);
  EXPECT_THAT(positions_of(model), Contains(Vec3{1, 0, 5}));

  // The second instance is rotated by a quarter turn about z. The rotation is stored in bytes that
  // are not marked as normalised. The third instance is scaled by 2.
  model.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const std::string turns = bytes_of<std::int8_t>({0, 0, 0, 127, 0, 0, 90, 90, 0, 0, 0, 127});
  attributes["ROTATION"] = model.accessor("VEC4", 5120, 3, {{"bufferView", model.view(turns)}});
  attributes["SCALE"] = model.floats("VEC3", {1, 1, 1, 1, 1, 1, 2, 2, 2}, 3);
  const auto points = positions_of(model);
  ASSERT_EQ(points.size(), 9u);
  EXPECT_LT(length(points[4] - Vec3{5, 1, 0}), 1e-9);
  EXPECT_EQ(points[7], (Vec3{2, 0, 5}));

  model.node()["translation"] = {10, 0, 0};
  EXPECT_EQ(positions_of(model)[6], (Vec3{10, 0, 5}));
  attributes["SCALE"] = model.floats("VEC3", {1, 1, 1}, 1);
  EXPECT_THAT(refusal(model.file()), HasSubstr("the instances of node 0 do not match"));
}

// Adds a skin whose joint is node 1. All vertices follow that joint.
void add_skin(Model& model, const Json& joint_node) {
  model.document["nodes"].push_back(joint_node);
  model.document["scenes"][0]["nodes"] = {0, 1};
  model.document["skins"] = {{{"joints", {1}}}};
  model.node()["skin"] = 0;
  const std::string joints(12, '\0');
  model.attributes()["JOINTS_0"] =
      model.accessor("VEC4", 5121, 3, {{"bufferView", model.view(joints)}});
  model.attributes()["WEIGHTS_0"] =
      model.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 0.25, 0.25, 0, 0}, 3);
}

TEST(GlbCases, TheTransformOfASkinnedNodeIsIgnored) {
  Model model;
  model.node()["scale"] = {100, 100, 100};
  add_skin(model, Json::object());
  EXPECT_EQ(positions_of(model), kTriangle);
}

TEST(GlbCases, JointsAndTheirInverseBindMatricesPlaceASkinnedMesh) {
  Model model;
  add_skin(model, {{"scale", {2, 2, 2}}, {"translation", {0, 0, 7}}});
  EXPECT_THAT(positions_of(model), ElementsAre(Vec3{0, 0, 7}, Vec3{2, 0, 7}, Vec3{0, 2, 7}));
  model.document["skins"][0]["inverseBindMatrices"] =
      model.floats("MAT4", {0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, -3.5, 1}, 1);
  EXPECT_EQ(positions_of(model), kTriangle);
  model.document["skins"][0]["joints"] = {9};
  EXPECT_THAT(refusal(model.file()), HasSubstr("a joint of skin 0 does not exist"));
}

TEST(GlbCases, ASkinWithoutWeightsKeepsTheMeshWhereItIs) {
  Model model;
  model.node()["scale"] = {100, 100, 100};
  add_skin(model, {{"translation", {0, 0, 7}}});
  model.attributes().erase("WEIGHTS_0");
  model.attributes().erase("JOINTS_0");
  EXPECT_EQ(positions_of(model), kTriangle);
}

TEST(GlbCases, MorphTargetsAreAppliedByTheirWeights) {
  Model model;
  const std::size_t up = model.floats("VEC3", {0, 0, 2, 0, 0, 2, 0, 0, 2}, 3);
  const std::size_t aside = model.floats("VEC3", {4, 0, 0, 4, 0, 0, 4, 0, 0}, 3);
  model.primitive()["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}};
  EXPECT_EQ(positions_of(model), kTriangle);
  model.document["meshes"][0]["weights"] = {0.5, 0};
  EXPECT_THAT(positions_of(model), ElementsAre(Vec3{0, 0, 1}, Vec3{1, 0, 1}, Vec3{0, 1, 1}));
  model.node()["weights"] = {0, 0.25};
  EXPECT_EQ(positions_of(model)[0], (Vec3{1, 0, 0}));
}

TEST(GlbCases, AMorphTargetThatDoesNotMatchIsNamed) {
  Model model;
  model.primitive()["targets"] = {{{"POSITION", model.floats("VEC3", {0, 0, 2}, 1)}}};
  model.document["meshes"][0]["weights"] = {1};
  const auto result = read_text(model.file());
  EXPECT_EQ(result.mesh.positions, kTriangle);
  EXPECT_THAT(result.repairs, ElementsAre(HasSubstr("1 morph target not carried")));
}

TEST(GlbCases, AnimationsAreNamed) {
  Model model;
  model.document["animations"] = {Json::object(), Json::object()};
  EXPECT_THAT(read_text(model.file()).repairs, ElementsAre(HasSubstr("2 animations not carried")));
}

// Makes an accessor sparse: value i becomes `values`, which is one vector of floats.
void make_sparse(Model& model, std::size_t accessor, std::uint8_t i,
                 std::initializer_list<float> values) {
  const std::size_t places = model.view(bytes_of<std::uint8_t>({i}));
  const std::size_t contents = model.view(bytes_of<float>(values));
  model.document["accessors"][accessor]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", places}, {"componentType", 5121}}},
      {"values", {{"bufferView", contents}}}};
}

TEST(GlbCases, SparseValuesReplaceOthers) {
  Model model;
  make_sparse(model, model.positions, 2, {0, 8, 0});
  EXPECT_THAT(positions_of(model), ElementsAre(kTriangle[0], kTriangle[1], Vec3{0, 8, 0}));
}

TEST(GlbCases, SparseValuesReplaceZerosWhereThereIsNoBufferView) {
  Model model;
  const std::size_t target = model.accessor("VEC3", 5126, 3);
  model.primitive()["targets"] = {{{"POSITION", target}}};
  model.document["meshes"][0]["weights"] = {1};
  make_sparse(model, target, 1, {0, 0, 3});
  EXPECT_THAT(positions_of(model), ElementsAre(kTriangle[0], Vec3{1, 0, 3}, kTriangle[2]));
}

TEST(GlbCases, SparseValuesCannotStateMoreVerticesThanTheFileHasBytes) {
  for (const std::uint64_t count : {std::uint64_t{1} << 20, ~std::uint64_t{0}}) {
    Model model;
    auto& accessor = model.document["accessors"][model.positions];
    make_sparse(model, model.positions, 2, {0, 8, 0});
    accessor.erase("bufferView");
    accessor["count"] = count;
    EXPECT_THAT(refusal(model.file()), HasSubstr("accessor 0 has more values than the file"));
  }
}

TEST(GlbCases, SparseIndicesOutOfOrderAreRefused) {
  Model model;
  make_sparse(model, model.positions, 3, {0, 8, 0});
  EXPECT_THAT(refusal(model.file()), HasSubstr("accessor 0 has sparse indices that are too large"));
  model.document["accessors"][model.positions]["sparse"]["count"] = 2;
  EXPECT_THAT(refusal(model.file()), HasSubstr("sparse values that do not fit"));
}

std::vector<Colour> colours_of(const GlbBuilder& model) {
  return read_text(model.file()).mesh.attributes.colours;
}

constexpr char kGlossy[] = "KHR_materials_pbrSpecularGlossiness";

TEST(GlbCases, TheDiffuseFactorBecomesTheBaseColour) {
  Model model;
  model.primitive()["material"] = 0;
  auto& material = model.document["materials"][0];
  material["extensions"][kGlossy] = {{"diffuseFactor", {1, 0.2, 0, 1}}};
  const Colour orange{255, 124, 0};
  EXPECT_THAT(colours_of(model), ElementsAre(orange, orange, orange));
  EXPECT_THAT(read_text(model.file()).repairs,
              Contains(HasSubstr("specular colours of 1 material not carried")));
  material["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 0, 1, 1}}};
  EXPECT_THAT(colours_of(model), ElementsAre(orange, orange, orange));
}

TEST(GlbCases, TheDiffusePictureBecomesTheBaseColour) {
  GlbBuilder model = textured(red_and_blue());
  auto& material = model.document["materials"][0];
  material["extensions"][kGlossy] = {{"diffuseTexture", {{"index", 0}}},
                                     {"glossinessFactor", 0.25}};
  material.erase("pbrMetallicRoughness");
  const auto result = read_text(model.file());
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
  const Material& carried = result.texturing.materials.at(0);
  EXPECT_TRUE(carried.base_colour_map.has_value());
  EXPECT_EQ(carried.metallic, 0);
  EXPECT_EQ(carried.roughness, 0.75);
}

TEST(GlbCases, ABlackMaterialShowsItsEmission) {
  GlbBuilder model = textured(red_and_blue());
  auto& material = model.document["materials"][0];
  material = {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
              {"emissiveFactor", {1, 1, 1}},
              {"emissiveTexture", {{"index", 0}}}};
  EXPECT_THAT(colours_of(model), ElementsAre(kRed, kBlue, kRed));
  material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  EXPECT_THAT(colours_of(model), ElementsAre(kRed, kBlue, kRed));
  material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 5}};
  EXPECT_THAT(colours_of(model), ElementsAre(kRed, kBlue, kRed));
  material.erase("emissiveTexture");
  material["emissiveFactor"] = {0, 0, 1};
  EXPECT_THAT(colours_of(model), ElementsAre(kBlue, kBlue, kBlue));
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0, 0, 1};
  EXPECT_THAT(colours_of(model), ElementsAre(kRed, Colour{0, 0, 0}, kRed));
}

TEST(GlbCases, ColoursThatAreNotMarkedAsNormalised) {
  Model model;
  const std::string bytes = bytes_of<std::uint8_t>({255, 0, 0, 255, 0, 0, 255, 255, 255, 0, 0, 0});
  model.attributes()["COLOR_0"] =
      model.accessor("VEC4", 5121, 3, {{"bufferView", model.view(bytes)}});
  const auto result = read_text(model.file());
  EXPECT_THAT(result.mesh.attributes.colours, ElementsAre(kRed, kBlue, kRed));
  EXPECT_THAT(result.repairs, ElementsAre(HasSubstr("1 accessor with a wrong count")));
}

constexpr char kCorrected[] = "1 accessor with a wrong count, byte stride or normalisation";

TEST(GlbCases, IndicesDecideHowManyVerticesThereAre) {
  for (const std::size_t stated : {1, 2, 9}) {
    const auto result = read_text(Model(stated).file());
    EXPECT_EQ(result.mesh.positions, kTriangle);
    EXPECT_THAT(result.repairs, ElementsAre(HasSubstr(kCorrected)));
  }
  Model model(2);
  model.document["bufferViews"][0]["byteLength"] = 24;
  EXPECT_THAT(refusal(model.file()), HasSubstr("refers to a vertex that its primitive"));
}

TEST(GlbCases, AnAttributeMayHaveMoreValuesThanThereAreVertices) {
  Model model;
  model.attributes()["COLOR_0"] = model.floats("VEC3", {1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0}, 4);
  EXPECT_THAT(colours_of(model), ElementsAre(kRed, kBlue, kRed));
}

TEST(GlbCases, ByteStridesThatDoNotFitAreIgnored) {
  for (const int stride : {4, 16, 300}) {
    Model model;
    model.document["bufferViews"][0]["byteStride"] = stride;
    const auto result = read_text(model.file());
    EXPECT_EQ(result.mesh.positions, kTriangle);
    EXPECT_THAT(result.repairs, ElementsAre(HasSubstr(kCorrected)));
  }
}

TEST(GlbCases, CountsWrittenWithAFractionAndWrongBounds) {
  Model model;
  auto& accessor = model.document["accessors"][model.positions];
  accessor["count"] = 3.0;
  accessor["min"] = {9, 9, 9};
  accessor["max"] = Json::array();
  model.primitive()["material"] = -1;
  const auto result = read_text(model.file());
  EXPECT_EQ(result.mesh.positions, kTriangle);
  EXPECT_THAT(result.repairs, IsEmpty());
}

TEST(GlbCases, PaddingThatIsCountedButNotWritten) {
  Model model;
  model.document["bufferViews"][1]["byteLength"] = 8;
  std::string file = model.file();
  EXPECT_THAT(read_text(file).mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  file.resize(file.size() - 2);  // removes the padding that GlbBuilder adds after the indices
  const auto result = read_text(file);
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(result.repairs, ElementsAre(HasSubstr("1 buffer view longer than its buffer")));
}

TEST(GlbCases, AViewThatIsLongerThanItsBuffer) {
  Model model;
  model.document["bufferViews"][1]["byteLength"] = 99'999;
  const auto result = read_text(model.file());
  EXPECT_THAT(result.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(result.repairs,
              ElementsAre("1 buffer view longer than its buffer read as far as the buffer goes; "
                          "report it to the makers of the exporter"));
  model.document["bufferViews"][1]["byteOffset"] = 99'999;
  EXPECT_THAT(refusal(model.file()), HasSubstr("buffer view 1 lies beyond the end of its buffer"));
}

std::string u32(std::size_t n) {
  return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(n)});
}

TEST(GlbCases, ChunksWithPaddingTheyDoNotCountAndAWrongLength) {
  const Model model;
  std::string json = model.document.dump();
  const std::size_t size = json.size() % 4 == 0 ? (json += " ").size() : json.size();
  while (json.size() % 4 != 0)
    json += ' ';
  for (const std::size_t length : {0, 999'999}) {
    const std::string file = "glTF" + u32(2) + u32(length) + u32(size) + "JSON" + json +
                             u32(model.binary().size()) + std::string("BIN\0", 4) + model.binary();
    EXPECT_THAT(read_text(file).mesh.faces, ElementsAre(Triangle{0, 1, 2})) << length;
  }
}

TEST(GlbCases, AByteOrderMarkBeforeTheJsonAndBytesBehindIt) {
  const Model model;
  const std::string json = model.document.dump();
  for (const std::string& text :
       {"\xEF\xBB\xBF" + json, json + std::string(5, '\0'), json + "\n\t \r\n"}) {
    EXPECT_THAT(read_text(glb(text, model.binary()) + "trailing bytes").mesh.faces,
                ElementsAre(Triangle{0, 1, 2}));
  }
}

// Returns a case whose node has three instances with translations and, if given, `scales`.
Case instances(const std::string& situation, const Json& required, std::vector<Vec3> positions,
               std::initializer_list<float> scales = {}) {
  Model model;
  auto& attributes = model.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes["TRANSLATION"] = model.floats("VEC3", {0, 0, 0, 5, 0, 0, 0, 0, 5}, 3);
  if (scales.size() > 0) attributes["SCALE"] = model.floats("VEC3", scales, 3);
  model.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  if (!required.empty()) model.document["extensionsRequired"] = required;
  return {
      .situation = situation, .file = model.file(), .faces = 3, .positions = std::move(positions)};
}

std::vector<Case> all_instances() {
  const std::vector<Vec3> places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0},
                                 {5, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  std::vector<Vec3> scaled = places;
  scaled[7] = {2, 0, 5}, scaled[8] = {0, 2, 5};
  return {instances("used", {}, places), instances("required", {"EXT_mesh_gpu_instancing"}, places),
          instances("scaled", {}, scaled, {1, 1, 1, 1, 1, 1, 2, 2, 2})};
}

// Returns a case whose material has a diffuse factor, and also a base colour if `has_base`.
Case diffuse(const std::string& situation, const Json& factor, Colour colour, bool has_base) {
  Model model;
  model.primitive()["material"] = 0;
  auto& material = model.document["materials"][0];
  material["extensions"][kGlossy] = {{"diffuseFactor", factor}};
  if (has_base) material["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 0, 1, 1}}};
  return {.situation = situation,
          .file = model.file(),
          .faces = 1,
          .colours = std::vector(3, colour),
          .said = "specular colours of 1 material not carried"};
}

std::vector<Case> diffuse_factors() {
  return {diffuse("orange", {1, 0.2, 0, 1}, {255, 124, 0}, false),
          diffuse("orange, with a base colour", {1, 0.2, 0, 1}, {255, 124, 0}, true),
          diffuse("red", {1, 0, 0, 1}, kRed, false)};
}

// Returns a case with a green texture that uses set 0 of texture coordinates. Its triangle has only
// set 1 if `has_other_set`, and otherwise no texture coordinates.
Case without_coordinates(const std::string& situation, bool has_other_set, bool has_colours) {
  GlbBuilder model = textured(vitrine::testing::png_of({0, 255, 0}, 1));
  auto& attributes = model.document["meshes"][0]["primitives"][0]["attributes"];
  if (has_other_set) attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"];
  attributes.erase("TEXCOORD_0");
  if (has_colours) attributes["COLOR_0"] = model.floats("VEC3", {1, 1, 1, 1, 1, 1, 0, 0, 0}, 3);
  const Colour green{0, 255, 0};
  return {.situation = situation,
          .file = model.file(),
          .faces = 1,
          .colours = {green, green, has_colours ? Colour{0, 0, 0} : green},
          .said = "1 primitive without the coordinates of its texture map shows one pixel"};
}

std::vector<Case> textures_without_coordinates() {
  return {without_coordinates("none", false, false),
          without_coordinates("for another set", true, false),
          without_coordinates("none, with colours", false, true)};
}

Case vertex_colours(const std::string& situation, std::initializer_list<float> values,
                    std::vector<Colour> colours, const std::string& said) {
  Model model;
  model.attributes()["COLOR_0"] = model.floats("VEC3", values, 3);
  return {.situation = situation,
          .file = model.file(),
          .faces = 1,
          .colours = std::move(colours),
          .said = said};
}

std::vector<Case> ranges_of_colours() {
  const Colour green{0, 255, 0};
  return {vertex_colours("0 to 255", {255, 0, 0, 0, 0, 255, 0, 127.5, 0},
                         {kRed, kBlue, {0, 188, 0}}, "1 set of vertex colours read as 0 to 255"),
          vertex_colours("above 1", {1.5, 0, 0, 0, 0, 1, 0, 0.5, 0}, {kRed, kBlue, {0, 188, 0}},
                         "1 colour value above 1 clipped to 1"),
          vertex_colours("below 0", {1, -0.5, 0, 0, 0, 1, 0, 1, 0}, {kRed, kBlue, green},
                         "1 colour value below 0 or not a number became 0")};
}

std::vector<Case> contents_left_out() {
  Model hidden;
  hidden.document["nodes"].push_back({{"mesh", 0}});
  hidden.document["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  hidden.document["scenes"][0]["nodes"] = {0, 1};
  Model scenes;
  scenes.document["nodes"].push_back({{"mesh", 0}});
  scenes.document["scenes"].push_back({{"nodes", {1}}});
  Model outside;
  outside.document["nodes"].push_back({{"mesh", 0}});
  Model unused;
  unused.append("meshes", unused.document["meshes"][0]);
  Model levels;
  levels.document["nodes"].push_back({{"mesh", 0}});
  levels.node()["extensions"]["MSFT_lod"]["ids"] = {1};
  Model incomplete;
  incomplete.primitive()["indices"] = incomplete.accessor(
      "SCALAR", 5123, 5,
      {{"bufferView", incomplete.view(bytes_of<std::uint16_t>({0, 1, 2, 0, 1}))}});
  Model variants;
  variants.document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}};
  const auto case_of = [](const std::string& situation, const Model& model,
                          const std::string& said) {
    return Case{.situation = situation, .file = model.file(), .faces = 1, .said = said};
  };
  return {
      case_of("a hidden node", hidden, "1 hidden node and the nodes below not carried"),
      case_of("a node outside the scene", outside,
              "1 use of a mesh outside all scenes not carried; add it to the scene"),
      case_of("a mesh without a node", unused, "1 use of a mesh outside all scenes not carried"),
      case_of("a lower level of detail", levels, ""),
      case_of("five indices of triangles", incomplete,
              "1 primitive with a last face that lacks corners, which is not carried"),
      case_of("a second scene", scenes, "1 scene besides the default one not carried"),
      case_of("material variants", variants, "1 material variant not carried")};
}

TEST(GlbCases, AModelWhoseNodesAreAllHiddenIsRefused) {
  Model model;
  model.node()["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_THAT(refusal(model.file()),
              HasSubstr("because nodes are hidden; make them visible and export again"));
}

TEST(GlbCases, TheVersionMayBeANumber) {
  Model model;
  model.document["asset"]["version"] = 2.0;
  EXPECT_EQ(read_text(model.file()).mesh.positions, kTriangle);
  model.document["asset"]["version"] = 1.5;
  EXPECT_THAT(refusal(model.file()), HasSubstr("glTF version '1.5' is not read"));
}

}  // namespace

std::vector<testing::FileKind> testing::glb_kinds() {
  return {{"instancing_used.glb", all_instances()},
          {"specular_glossiness_factor.glb", diffuse_factors()},
          {"no_texcoord.glb", textures_without_coordinates()},
          {"colour_range.glb", ranges_of_colours()},
          {"left_out.glb", contents_left_out()}};
}

}  // namespace vitrine
