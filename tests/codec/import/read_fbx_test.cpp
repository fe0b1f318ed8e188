// SPDX-License-Identifier: Apache-2.0
#include "codec/import/fbx_builder.h"
#include "codec/import/reading.h"
#include "codec/picture/pictures.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using vitrine::testing::as_bytes;
using vitrine::testing::fbx_array;
using vitrine::testing::fbx_id;
using vitrine::testing::fbx_layer;
using vitrine::testing::fbx_link;
using vitrine::testing::fbx_property;
using vitrine::testing::fbx_real;
using vitrine::testing::fbx_text;
using vitrine::testing::fbx_whole;
using vitrine::testing::FbxFile;
using vitrine::testing::FbxRecord;
using vitrine::testing::kBlue;
using vitrine::testing::kRed;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::refusal;
using vitrine::testing::textured_fbx;

const std::vector<Vec3> kFbxPoints{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
const std::vector<Triangle> kFbxFaces{{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 3}};

// The tetrahedron of FbxFile as a text FBX.
const std::string kTextFbx =
    "; FBX 7.4.0 project file\n"
    "FBXHeaderExtension:  {\n FBXVersion: 7400\n}\n"
    "GlobalSettings:  {\n Version: 1000\n Properties70:  {\n"
    "  P: \"UpAxis\", \"int\", \"Integer\", \"\",2\n"
    "  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",0.1\n }\n}\n"
    "Objects:  {\n Geometry: 11, \"Geometry::g; {\", \"Mesh\" {\n"
    "  Vertices: *12 {\n   a: 0,0,0,1,0,0,0,1,0,0,0,1\n  }\n"
    "  PolygonVertexIndex: *12 {\n   a: 0,2,-2,0,1,-4,1,2,-4,2,0,-4\n  }\n }\n"
    " Model: 12, \"Model::m\", \"Mesh\" {\n  Version: 232\n }\n}\n"
    "Connections:  {\n C: \"OO\",12,0\n C: \"OO\",11,12\n}\n";

TEST(ReadFbx, ATetrahedronComesBackInCentimetres) {
  for (const bool is_compressed : {false, true}) {
    const auto read = read_text(FbxFile{.is_compressed = is_compressed}.file());
    EXPECT_EQ(read.mesh.positions, kFbxPoints);
    EXPECT_EQ(read.mesh.faces, kFbxFaces);
    EXPECT_EQ(read.unit, "cm");
  }
}

TEST(ReadFbx, TextIsReadWithItsUnitAndUpAxis) {
  const auto read = read_text(kTextFbx);
  EXPECT_EQ(read.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(read.mesh.faces, kFbxFaces);
  EXPECT_EQ(read.unit, "mm");
}

TEST(ReadFbx, UnitAndUpAxisAreKept) {
  const auto read = [](double factor, int up) {
    return read_text(
        FbxFile{.settings = {fbx_property("UpAxis", "int", {fbx_whole(up)}),
                             fbx_property("UnitScaleFactor", "double", {fbx_real(factor)})}}
            .file());
  };
  EXPECT_EQ(read(100, 1).unit, "m");
  EXPECT_EQ(read(2.54, 1).unit, "in");
  EXPECT_EQ(read(0.1, 2).mesh.positions[3], (Vec3{0, 1, 0}));
  const auto feet = read(30.48, 1);
  EXPECT_EQ(feet.unit, "m");
  EXPECT_DOUBLE_EQ(feet.mesh.positions[2].x, 0.3048);
}

TEST(ReadFbx, ColoursAreKept) {
  const auto read = read_text(FbxFile{
      .layers = {fbx_layer("LayerElementColor", "Colors", {1, 0, 0, 1, 0, 0, 1, 1}, "ColorIndex",
                           {0, 1, 1, 0, 1, 1, 1, 1, 1, 1, 0,
                            1})}}.file());
  EXPECT_THAT(read.mesh.attributes.colours, ElementsAre(kRed, kBlue, kBlue, kBlue));
}

TEST(ReadFbx, LostOpacitiesOfColoursAreCounted) {
  const auto read = read_text(FbxFile{
      .layers = {fbx_layer("LayerElementColor", "Colors", {1, 0, 0, 1, 0, 0, 1, 0.5}, "ColorIndex",
                           {0, 1, 1, 0, 1, 1, 1, 1, 1, 1, 0,
                            1})}}.file());
  EXPECT_THAT(read.repairs,
              Contains(HasSubstr("opacity of 9 colours not carried: vertex colours are opaque")));
}

TEST(ReadFbx, APictureBesideOrInTheFileIsKept) {
  const std::string picture = red_and_blue();
  const std::string beside = textured_fbx("C:\\maps\\A.png").file();
  const std::string inside = textured_fbx("C:\\maps\\A.png", picture).file();
  for (const auto& read : {read_mesh(as_bytes(beside), {.beside = {{"a.png", as_bytes(picture)}}}),
                           read_mesh(as_bytes(inside))}) {
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_THAT(read->mesh.attributes.colours, ElementsAre(kRed, kRed, kRed, kBlue));
    ASSERT_EQ(read->texturing.pictures.size(), 1u);
    EXPECT_EQ(read->texturing.pictures[0].bytes,
              std::vector<std::uint8_t>(picture.begin(), picture.end()));
    EXPECT_EQ(read->texturing.coordinates[0].at(1)[2], (TextureCoordinates{0.75F, 0.5F}));
    EXPECT_EQ(read->texturing.materials[read->texturing.face_materials[0]].name, "paint");
  }
  EXPECT_THAT(read_text(beside).repairs, Contains(HasSubstr("not carried: it is not beside")));
}

// Returns a textured FBX with a material named `name`.
FbxFile with_material_name(const std::string& name, const std::string& picture) {
  FbxFile fbx = textured_fbx("a.png", picture);
  fbx.objects[0].values[1] = fbx_text(name + std::string("\0\1Material", 10));
  return fbx;
}

TEST(ReadFbx, AMaterialMayHaveTheNameOfAssimpsOwn) {
  const auto read = read_text(with_material_name("DefaultMaterial", red_and_blue()).file());
  EXPECT_THAT(read.mesh.attributes.colours, ElementsAre(kRed, kRed, kRed, kBlue));
  ASSERT_EQ(read.texturing.pictures.size(), 1u);
  EXPECT_EQ(read.texturing.materials[read.texturing.face_materials[0]].name, "DefaultMaterial");
}

TEST(ReadFbx, BlanksAfterAMaterialsNameMakeNoDifference) {
  const auto read = read_text(with_material_name("paint ", red_and_blue()).file());
  EXPECT_THAT(read.mesh.attributes.colours, ElementsAre(kRed, kRed, kRed, kBlue));
}

TEST(ReadFbx, APictureInTheFilePrecedesOneBesideIt) {
  FbxFile fbx = textured_fbx("C:\\maps\\t.png", red_and_blue());
  fbx.objects[1].inner[1].values = {fbx_text("..\\t.png")};  // the path that the texture states
  const std::string file = fbx.file(), damaged = "no picture";
  const auto read = read_mesh(as_bytes(file), {.beside = {{"t.png", as_bytes(damaged)}}});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->mesh.attributes.colours, ElementsAre(kRed, kRed, kRed, kBlue));
}

TEST(ReadFbx, NotesDoNotSpeakOfMaterialLibraries) {
  FbxFile fbx = textured_fbx("a.png", red_and_blue());
  for (FbxRecord& link : fbx.links) {
    if (link.values.size() == 4) link.values[3] = fbx_text("TransparentColor");
  }
  const auto read = read_text(fbx.file());
  EXPECT_THAT(read.repairs,
              Contains(HasSubstr("TransparentColor; bake them into the diffuse map, ")));
  EXPECT_THAT(read.repairs, Not(Contains(HasSubstr("map_Kd"))));
}

TEST(ReadFbx, AMeshWithoutAMaterialHasNoColours) {
  const auto read = read_text(FbxFile{}.file());
  EXPECT_THAT(read.mesh.attributes.colours, ::testing::IsEmpty());
}

TEST(ReadFbx, ModelsPlaceTheMesh) {
  const auto read =
      read_text(FbxFile{.placement = {fbx_property("Lcl Translation", "Lcl Translation",
                                                   {fbx_real(5), fbx_real(0), fbx_real(0)}),
                                      fbx_property("Lcl Scaling", "Lcl Scaling",
                                                   {fbx_real(-2), fbx_real(2), fbx_real(2)})}}
                    .file());
  EXPECT_THAT(read.mesh.positions, Contains(Vec3{3, 0, 0}));
  EXPECT_EQ(read.mesh.faces.size(), 4u);
}

TEST(ReadFbx, LossesAreNamed) {
  FbxFile fbx;
  fbx.objects = {{"AnimationStack", {fbx_id(30), fbx_text("a"), fbx_text("")}},
                 {"Deformer", {fbx_id(31), fbx_text("d"), fbx_text("Skin")}},
                 {"Deformer", {fbx_id(32), fbx_text("d"), fbx_text("BlendShape")}}};
  EXPECT_THAT(read_text(fbx.file()).repairs,
              ::testing::IsSupersetOf({HasSubstr("1 skin not carried"),
                                       HasSubstr("1 morph controller not carried"),
                                       HasSubstr("1 animation not carried")}));
}

TEST(ReadFbx, DamageIsNamed) {
  const std::string whole = FbxFile{}.file();
  EXPECT_THAT(refusal(whole.substr(0, 24)), HasSubstr("ends within its header"));
  EXPECT_THAT(refusal(whole.substr(0, 400)), HasSubstr("a record is cut or misplaced"));
  EXPECT_THAT(refusal(kTextFbx.substr(0, 300)), HasSubstr("it is cut short"));
  std::string old = FbxFile{}.file();
  const std::size_t version = old.find("FBXVersion") + 11;
  old.replace(version, 4, std::string("\xD4\x17\0\0", 4));  // version 6100, which is too old
  EXPECT_THAT(refusal(old), HasSubstr("the FBX is older than FBX 2011, which is not read; export "
                                      "it again as FBX 2013 or later"));
}

FbxRecord fbx_object(const std::string& kind, std::int64_t id, const std::string& type) {
  return {kind, {fbx_id(id), fbx_text("n"), fbx_text(type)}};
}

FbxRecord fbx_to_property(std::int64_t child, std::int64_t parent) {
  return {"C", {fbx_text("OP"), fbx_id(child), fbx_id(parent), fbx_text("any")}};
}

TEST(ReadFbx, CyclesAndTooManyInstancesAreRefused) {
  const auto model = [](std::int64_t id) { return fbx_object("Model", id, "Null"); };
  FbxFile cycle;
  cycle.objects = {model(20), model(21)};
  cycle.links = {fbx_link(20, 21), fbx_link(21, 20), fbx_link(20, FbxFile::kModel)};
  EXPECT_THAT(refusal(cycle.file()), HasSubstr("linked in a cycle"));
  for (const std::string link :
       {"C: \"OO\",12,12\n}", "C: \"any\",\n 12 , 12 }", "C: \"x\",12abc,12}"}) {
    std::string text = kTextFbx;
    text.replace(text.rfind('}'), 1, link);
    EXPECT_THAT(refusal(text), HasSubstr("linked in a cycle")) << link;
  }
  FbxFile doubling;
  for (std::int64_t id = 20; id < 60; ++id) {
    doubling.objects.push_back(model(id));
    for (int twice = 0; twice < 2; ++twice)
      doubling.links.push_back(fbx_link(id, id == 20 ? FbxFile::kModel : id - 1));
  }
  EXPECT_THAT(refusal(doubling.file()), HasSubstr("too many instances"));
}

// Returns kTextFbx with `id` as the ID of the model.
std::string with_model_id(const std::string& id) {
  std::string text = kTextFbx;
  for (const std::string place : {"Model: 12", "\"OO\",12", "11,12"})
    text.replace(text.find(place) + place.size() - 2, 2, id);
  return text;
}

TEST(ReadFbx, EachLinkToTheSceneIsAnInstance) {
  // The reader takes IDs modulo 2^64, so an ID that does not fit 64 bits equals a smaller one.
  for (const auto& [id, link] : {std::pair("12", "12,0"),
                                 {"12", "12,18446744073709551616"},
                                 {"11553255926290448384", "30000000000000000000,0"}}) {
    std::string text = with_model_id(id), links;
    for (int i = 0; i < 70'000; ++i)
      links += "C: \"OO\"," + std::string(link) + "\n";
    text.insert(text.rfind('}'), links);
    EXPECT_THAT(refusal(text), HasSubstr("too many instances")) << link;
  }
}

TEST(ReadFbx, EachInstanceCountsWithItsPropertiesAndMeshes) {
  FbxFile fbx;
  fbx.placement.assign(300, fbx_property("user", "int", {fbx_whole(1)}));
  for (int i = 0; i < 300; ++i)
    fbx.links.push_back(fbx_link(FbxFile::kModel, 0));
  EXPECT_THAT(refusal(fbx.file()), HasSubstr("too many instances"));
  fbx.placement.clear();
  EXPECT_EQ(read_text(fbx.file()).mesh.faces.size(), 301u * 4);
}

TEST(ReadFbx, IdsOfTextMayHaveAllBits) {
  EXPECT_EQ(read_text(with_model_id("18446744073709551615")).mesh.faces, kFbxFaces);
}

// Returns an FBX with a chain of objects. The chain repeats `kinds` `count` times. Its first object
// is linked to the model, and each later object to the one before it.
FbxFile fbx_chain(const std::vector<std::pair<std::string, std::string>>& kinds, int count) {
  FbxFile fbx;
  std::int64_t id = FbxFile::kModel;
  for (int i = 0; i < count; ++i) {
    for (const auto& [kind, type] : kinds) {
      const std::int64_t next = id == FbxFile::kModel ? 20 : id + 1;
      fbx.objects.push_back(fbx_object(kind, next, type));
      fbx.links.push_back({"C", {fbx_text("OP"), fbx_id(next), fbx_id(id), fbx_text("")}});
      id = next;
    }
  }
  return fbx;
}

TEST(ReadFbx, ChainsThatAreTooLongAreRefused) {
  const auto long_chain = HasSubstr("linked in a chain that is too long");
  EXPECT_THAT(refusal(fbx_chain({{"Model", "Null"}}, 2'000).file()), long_chain);
  EXPECT_THAT(refusal(fbx_chain({{"Texture", ""}}, 2'000).file()), long_chain);
  EXPECT_THAT(refusal(fbx_chain({{"Geometry", "Shape"},
                                 {"Deformer", "BlendShape"},
                                 {"Deformer", "BlendShapeChannel"}},
                                500)
                          .file()),
              long_chain);
  const std::vector<std::pair<std::string, std::string>> skinned{
      {"Geometry", "Shape"}, {"Deformer", "Skin"}, {"Deformer", "Cluster"}, {"Model", "Null"}};
  EXPECT_THAT(refusal(fbx_chain(skinned, 400).file()), long_chain);
  EXPECT_EQ(read_text(fbx_chain({{"Model", "Null"}}, 1'000).file()).mesh.faces, kFbxFaces);
  EXPECT_EQ(read_text(fbx_chain(skinned, 250).file()).mesh.faces, kFbxFaces);
  FbxFile animated;  // a chain: texture, animation, model, material, texture, …
  for (std::int64_t id = 20; id < 2'000; id += 3) {
    animated.objects.push_back(fbx_object("Texture", id, ""));
    animated.objects.push_back(fbx_object("AnimationCurveNode", id + 1, ""));
    animated.objects.push_back(fbx_object("Model", id + 2, "Null"));
    animated.objects.push_back(fbx_object("Material", id + 2000, ""));
    animated.links.push_back(fbx_link(id + 1, id));
    animated.links.push_back(fbx_to_property(id + 1, id + 2));
    animated.links.push_back(fbx_link(id + 2000, id + 2));
    animated.links.push_back(fbx_to_property(id + 3, id + 2000));
  }
  EXPECT_THAT(refusal(animated.file()), long_chain);
  FbxFile own_bone = fbx_chain(skinned, 1);
  own_bone.links.push_back(fbx_link(FbxFile::kModel, 22));
  EXPECT_EQ(read_text(own_bone.file()).mesh.faces, kFbxFaces);
}

FbxRecord fbx_materials(const std::vector<std::int32_t>& indices, bool is_compressed) {
  return {"LayerElementMaterial",
          {fbx_whole(0)},
          {{"MappingInformationType", {fbx_text("ByPolygon")}},
           {"ReferenceInformationType", {fbx_text("IndexToDirect")}},
           {"Materials", {fbx_array('i', indices, is_compressed)}}}};
}

TEST(ReadFbx, MeshesOfTooManyMaterialsAreRefused) {
  std::vector<std::int32_t> indices(100'000);
  std::string text = kTextFbx,
              numbers = "LayerElementMaterial: 0 { Materials: *100000 { b: 1 { }\na: 1";
  for (std::int32_t& index : indices) {
    index = static_cast<std::int32_t>(&index - indices.data());
    numbers += "," + std::to_string(index);
  }
  for (const bool is_compressed : {false, true})
    EXPECT_THAT(refusal(FbxFile{.layers = {fbx_materials(indices, is_compressed)}}.file()),
                HasSubstr("too many materials"));
  text.insert(text.find("Vertices"), numbers + "\n} }\n");
  EXPECT_THAT(refusal(text), HasSubstr("too many materials"));
  indices.resize(10'000);
  const std::vector<std::int32_t> corners(1'000'000);
  const FbxRecord large{
      "Geometry",
      {fbx_id(20), fbx_text("g"), fbx_text("Mesh")},
      {{"PolygonVertexIndex", {fbx_array('i', corners)}}, fbx_materials(indices, true)}};
  EXPECT_THAT(refusal(FbxFile{.objects = {large}}.file()), HasSubstr("too many materials"));
  indices.resize(5'000);
  FbxFile repeated{.layers = {fbx_materials(indices, true)}};
  EXPECT_EQ(read_text(repeated.file()).mesh.faces, kFbxFaces);
  for (int i = 0; i < 30'000; ++i)
    repeated.links.push_back(fbx_link(FbxFile::kGeometry, FbxFile::kModel));
  EXPECT_THAT(refusal(repeated.file()), HasSubstr("too many instances"));
}

// Returns an FBX with one morph target. Three links lead from it to the mesh, and the file states
// each of them `count` times.
FbxFile morphed_fbx(int count) {
  const std::vector<std::int64_t> path{30, 31, 32, FbxFile::kGeometry};
  FbxFile fbx;
  fbx.objects = {fbx_object("Geometry", path[0], "Shape"),
                 fbx_object("Deformer", path[1], "BlendShapeChannel"),
                 fbx_object("Deformer", path[2], "BlendShape")};
  fbx.objects[0].inner = {{"Indexes", {fbx_array<std::int32_t>('i', {0})}},
                          {"Vertices", {fbx_array<double>('d', {0, 0, 1})}},
                          {"Normals", {fbx_array<double>('d', {0, 0, 1})}}};
  for (std::size_t step = 1; step < path.size(); ++step)
    for (int i = 0; i < count; ++i)
      fbx.links.push_back(fbx_link(path[step - 1], path[step]));
  return fbx;
}

TEST(ReadFbx, CopiesOfMeshesForMorphTargetsAreBounded) {
  EXPECT_EQ(read_text(morphed_fbx(1).file()).mesh.faces, kFbxFaces);
  EXPECT_EQ(read_text(morphed_fbx(10).file()).mesh.faces, kFbxFaces);
  EXPECT_THAT(refusal(morphed_fbx(300).file()), HasSubstr("too many morph targets"));
  FbxFile large = morphed_fbx(1);  // one mesh of a million corners with 200 morph targets
  large.links.back() = fbx_link(32, 40);
  large.objects.push_back(
      {"Geometry",
       {fbx_id(40), fbx_text("g"), fbx_text("Mesh")},
       {{"PolygonVertexIndex", {fbx_array('i', std::vector<std::int32_t>(1'000'000))}}}});
  for (int i = 0; i < 200; ++i)
    large.links.push_back(fbx_link(30, 31));
  EXPECT_THAT(refusal(large.file()), HasSubstr("too many morph targets"));
}

TEST(ReadFbx, SizesAreCheckedBeforeAllocating) {
  std::string text = kTextFbx;
  text.replace(text.find("*12"), 3, "*4000000000");
  EXPECT_THAT(refusal(text), HasSubstr("an array is larger than the file"));
  std::string binary = FbxFile{.is_compressed = true}.file();
  const std::size_t array = binary.find("Vertices") + 9;
  binary.replace(array, 4, std::string("\0\0\0\x0F", 4));
  EXPECT_THAT(refusal(binary), HasSubstr("a record is cut or misplaced"));
  std::string deep = "; FBX 7.4.0\n";
  for (int i = 0; i < 100'000; ++i)
    deep += "a: {\n";
  EXPECT_THAT(refusal(deep), HasSubstr("too deep"));
}

}  // namespace
}  // namespace vitrine
