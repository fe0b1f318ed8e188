// SPDX-License-Identifier: Apache-2.0
#include "codec/import/dae_builder.h"
#include "codec/import/reading.h"
#include "codec/picture/pictures.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using vitrine::testing::as_bytes;
using vitrine::testing::dae_material;
using vitrine::testing::dae_source;
using vitrine::testing::DaeFile;
using vitrine::testing::kBlue;
using vitrine::testing::kDaeDressed;
using vitrine::testing::kRed;
using vitrine::testing::read_text;
using vitrine::testing::red_and_blue;
using vitrine::testing::refusal;
using vitrine::testing::textured_dae;

const std::vector<Triangle> kDaeFaces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

TEST(ReadDae, ATetrahedronComesBackInMetres) {
  const auto read = read_text(DaeFile{}.text());
  EXPECT_EQ(read.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(read.mesh.faces, kDaeFaces);
  EXPECT_EQ(read.unit, "m");
  EXPECT_THAT(read.repairs, IsEmpty());
}

TEST(ReadDae, UnitAndUpAxisAreKept) {
  const auto asset = [](const std::string& meter, const std::string& up) {
    return read_text(
        DaeFile{.asset = "<unit name=\"u\" meter=\"" + meter + "\"/><up_axis>" + up + "</up_axis>"}
            .text());
  };
  const auto z_up = asset("0.01", "Z_UP");
  EXPECT_EQ(z_up.unit, "cm");
  EXPECT_EQ(z_up.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}}));
  EXPECT_EQ(z_up.mesh.faces, kDaeFaces);
  const auto x_up = asset("0.0254", "X_UP");
  EXPECT_EQ(x_up.unit, "in");
  EXPECT_EQ(x_up.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}));
  const auto feet = asset("0.3048", "Y_UP");
  EXPECT_EQ(feet.unit, "m");
  EXPECT_EQ(feet.mesh.positions[1], (Vec3{0.3048, 0, 0}));
  EXPECT_EQ(asset("0,001", "Y_UP").unit, "mm");
  EXPECT_EQ(asset("-1", "Y_UP").unit, "m");
}

// Returns the DAE with the prefix "c:" before the names of all elements.
std::string with_prefix(std::string dae) {
  for (std::size_t at = dae.find("<COLLADA"); (at = dae.find('<', at)) != dae.npos; ++at)
    dae.insert(at + (dae[at + 1] == '/' ? 2 : 1), "c:");
  return dae;
}

TEST(ReadDae, ALongCommentAndAPrefixOfTheNamespaceAreRead) {
  const std::string text = DaeFile{.asset = "<unit name=\"u\" meter=\"0.01\"/>"}.text();
  const std::size_t root = text.find("<COLLADA");
  const std::string commented = text.substr(0, root) + "<!-- a <b> " + std::string(5000, '-') +
                                " --><!DOCTYPE x>\n" + text.substr(root);
  for (const std::string& file : {commented, with_prefix(text)}) {
    const auto read = read_text(file);
    EXPECT_EQ(read.mesh.faces, kDaeFaces);
    EXPECT_EQ(read.unit, "cm");
    EXPECT_THAT(read.repairs, IsEmpty());
  }
  EXPECT_THAT(refusal("<?xml version=\"1.0\"?><!-- <COLLADA> --><a/>"), HasSubstr("an XML file"));
}

TEST(ReadDae, DeclarationsInTheDocumentTypeAreSkipped) {
  const std::string text = DaeFile{}.text();
  const std::size_t root = text.find("<COLLADA");
  for (const std::string type : {"<!DOCTYPE COLLADA [<!ENTITY a \"b\">]>",
                                 "<!DOCTYPE COLLADA SYSTEM \"c.dtd\" [\n"
                                 "<!ENTITY a \"b\">\n<!ENTITY c \"d\">\n] >\n",
                                 "<!DOCTYPE COLLADA []>"}) {
    const auto read = read_text(text.substr(0, root) + type + text.substr(root));
    EXPECT_EQ(read.mesh.faces, kDaeFaces) << type;
  }
  for (const std::string type : {"<!DOCTYPE COLLADA [<!ENTITY a \"b\">", "<!DOCTYPE COLLADA []"})
    EXPECT_THAT(refusal("<?xml version=\"1.0\"?>" + type), HasSubstr("an XML file")) << type;
}

TEST(ReadDae, TheUnitIsThatOfTheElementAndNotOfAComment) {
  const std::string unit = "<unit name=\"u\" meter=\"0.01\"/>";
  const std::string comments =
      "<contributor><comments>Scale:unit is inch, meter=1</comments></contributor>";
  const std::string text = DaeFile{.asset = comments + unit}.text();
  EXPECT_EQ(read_text(text).unit, "cm");
  EXPECT_EQ(read_text(with_prefix(text)).unit, "cm");
}

TEST(ReadDae, AStatedUnitOverridesTheFile) {
  const std::string text = DaeFile{}.text();
  const auto read = read_mesh(as_bytes(text), {.unit = "mm"});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->unit, "mm");
}

TEST(ReadDae, VertexColoursAreKept) {
  const auto read = read_text(DaeFile{
      .sources = dae_source("c", "1 0 0 1 0 0 1 1", 4),
      .inputs =
          R"(<input semantic="VERTEX" source="#v" offset="0"/><input semantic="COLOR" source="#c" offset="1"/>)",
      .lists = "<p>0 0 2 1 1 1 0 0 1 1 3 1 1 1 2 1 3 1 2 1 0 0 3 1</p>"}
                                  .text());
  EXPECT_THAT(read.mesh.attributes.colours, ElementsAre(kRed, kBlue, kBlue, kBlue));
}

TEST(ReadDae, APictureAndItsCoordinatesAreKept) {
  const std::string text = textured_dae("./maps/a%20b.PNG").text(), picture = red_and_blue();
  const auto read = read_mesh(as_bytes(text), {.beside = {{"a b.png", as_bytes(picture)}}});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->mesh.attributes.colours, ElementsAre(kRed, kRed, kRed, kBlue));
  ASSERT_EQ(read->texturing.pictures.size(), 1u);
  EXPECT_EQ(std::string(read->texturing.pictures[0].bytes.begin(),
                        read->texturing.pictures[0].bytes.end()),
            picture);
  const auto& first = read->texturing.coordinates[0].at(0);
  EXPECT_EQ(first[0], (TextureCoordinates{0.25F, 0.5F}));
  EXPECT_EQ(read->texturing.coordinates[0].at(1)[2], (TextureCoordinates{0.75F, 0.5F}));
  EXPECT_EQ(read->texturing.materials[read->texturing.face_materials[0]].name, "m");
}

TEST(ReadDae, AMissingPictureIsNamed) {
  EXPECT_THAT(
      read_text(textured_dae("a.png").text()).repairs,
      Contains(HasSubstr("1 texture map 'a.png' not carried: it is not beside the mesh file")));
}

TEST(ReadDae, BlanksAroundTextsAreIgnored) {
  std::string text = textured_dae("\n  a.png\n").text();
  for (const std::string name : {">i<", ">s<"})
    text.replace(text.find(name), name.size(), ">\n  " + name.substr(1, 1) + "\n<");
  EXPECT_THAT(read_text(text).repairs,
              Contains(HasSubstr("1 texture map 'a.png' not carried: it is not beside")));
}

TEST(ReadDae, MaterialColoursAreKept) {
  const auto dressed = [](const std::string& shader) {
    return read_text(DaeFile{.libraries = dae_material("", shader),
                             .attributes = R"(material="x")",
                             .nodes = kDaeDressed}
                         .text());
  };
  const auto red = dressed("<phong><diffuse><color>1 0 0 1</color></diffuse></phong>");
  EXPECT_THAT(red.mesh.attributes.colours, ::testing::Each(kRed));
  EXPECT_THAT(red.repairs,
              ElementsAre("colours of 1 material baked into vertex colours; use texture maps to "
                          "keep their borders sharp"));
  EXPECT_THAT(dressed("<constant><emission><color>0 0 1 1</color></emission></constant>")
                  .mesh.attributes.colours,
              ::testing::Each(kBlue));
  const auto glass = dressed(
      R"(<blinn><diffuse><color>1 1 1 1</color></diffuse><transparent opaque="A_ONE"><color>1 1 1 1</color></transparent><transparency><float>0.25</float></transparency></blinn>)");
  ASSERT_EQ(glass.texturing.materials.size(), 1u);
  EXPECT_EQ(glass.texturing.materials[0].base_colour[3], 0.25);
  EXPECT_EQ(glass.texturing.materials[0].alpha_mode, AlphaMode::kBlend);
}

TEST(ReadDae, NodesPlaceTheGeometry) {
  const auto placed = [](const std::string& nodes) {
    return read_text(DaeFile{.nodes = nodes}.text());
  };
  const auto moved = placed(
      R"(<node><translate>5 0 0</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale><node><matrix>1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></node>)");
  ASSERT_EQ(moved.mesh.positions.size(), 4u);
  EXPECT_NEAR(moved.mesh.positions[1].x, 5, 1e-12);
  EXPECT_NEAR(moved.mesh.positions[1].y, 4, 1e-12);
  const auto twice = placed(
      R"(<node id="n"><instance_geometry url="#g"/></node><node><translate>9 0 0</translate><instance_node url="#n"/></node>)");
  EXPECT_EQ(twice.mesh.faces.size(), 8u);
  const auto mirrored =
      placed(R"(<node><scale>-1 1 1</scale><instance_geometry url="#g"/></node>)");
  EXPECT_EQ(mirrored.mesh.positions[1], (Vec3{-1, 0, 0}));
  EXPECT_EQ(mirrored.mesh.faces[0], (Triangle{1, 2, 0}));
}

TEST(ReadDae, AllKindsOfPolygonsAreRead) {
  const auto faces = [](const std::string& primitive, const std::string& lists) {
    return read_text(DaeFile{.primitive = primitive, .lists = lists}.text()).mesh.faces;
  };
  EXPECT_EQ(faces("polylist", "<vcount>3 3 3 3</vcount><p>0 2 1 0 1 3 1 2 3 2 0 3</p>"), kDaeFaces);
  EXPECT_EQ(faces("polygons", "<p>0 2 1</p><p>0 1 3</p><p>1 2 3</p><p>2 0 3</p>"), kDaeFaces);
  EXPECT_THAT(faces("trifans", "<p>3 0 1 2</p>"),
              ElementsAre(Triangle{3, 0, 1}, Triangle{3, 1, 2}));
  EXPECT_THAT(faces("tristrips", "<p>0 1 2 3</p>"),
              ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
  EXPECT_EQ(faces("polylist", "<vcount>4</vcount><p>0 1 2 3</p>").size(), 2u);
}

TEST(ReadDae, LossesAreNamed) {
  const auto notes = [](const DaeFile& file) { return read_text(file.text()).repairs; };
  EXPECT_THAT(
      notes({.libraries = R"(<library_animations><animation id="a"/></library_animations>)"}),
      ElementsAre(HasSubstr("1 animation not carried")));
  EXPECT_THAT(
      notes(
          {.libraries =
               R"(<library_controllers><controller id="c"><skin source="#g"><bind_shape_matrix>1 0 0 7 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix></skin></controller></library_controllers>)",
           .nodes = R"(<node><instance_controller url="#c"/></node>)"}),
      ElementsAre(HasSubstr("1 skin not carried: the mesh is shown in its bind pose")));
  EXPECT_THAT(
      notes(
          {.sources = dae_source("a", "0 0", 2) + dae_source("b", "0 0", 2),
           .inputs =
               R"(<input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#a" offset="1" set="1"/><input semantic="TEXCOORD" source="#b" offset="1" set="0"/>)",
           .lists = "<p>0 0 2 0 1 0 0 0 1 0 3 0 1 0 2 0 3 0 2 0 0 0 3 0</p>"}),
      ElementsAre(HasSubstr("1 further set of texture coordinates not carried")));
  EXPECT_THAT(
      notes(
          {.libraries = R"(<controller id="c"><skin source="parts.dae#g"/></controller>)",
           .nodes =
               R"(<node><instance_geometry url="#g"/><instance_geometry url="parts.dae#g"/><instance_node url="#none"/><instance_controller url="#c"/></node>)"}),
      Contains(HasSubstr("3 instances dropped, because the file has no polygons for them")));
  EXPECT_THAT(
      notes(
          {.sources = dae_source("c", "1 0 0 1 0 0 1 0.5", 4),
           .inputs =
               R"(<input semantic="VERTEX" source="#v" offset="0"/><input semantic="COLOR" source="#c" offset="1"/>)",
           .lists = "<p>0 0 2 1 1 1 0 0 1 1 3 1 1 1 2 1 3 1 2 1 0 0 3 1</p>"}),
      ElementsAre(HasSubstr("opacity of 1 colour not carried")));
}

TEST(ReadDae, DecimalCommasAreRead) {
  std::string text = DaeFile{}.text();
  const std::string numbers = "0 0 0 1 0 0 0 1 0 0 0 1";
  text.replace(text.find(numbers), numbers.size(), "0,0 0 0 1,5 0 0 0 1 0 0 0 1");
  EXPECT_EQ(read_text(text).mesh.positions[1], (Vec3{1.5, 0, 0}));
}

TEST(ReadDae, FaultsAreNamed) {
  EXPECT_THAT(refusal("<COLLADA><asset>"), HasSubstr("the DAE is damaged: the XML is damaged"));
  EXPECT_THAT(refusal("<COLLADA></COLLADA>"), HasSubstr("places no geometry with faces"));
  const auto fault = [](const DaeFile& file) { return refusal(file.text()); };
  EXPECT_THAT(fault({.lists = "<p>0 2 1 0</p>"}), HasSubstr("ends within a face"));
  EXPECT_THAT(fault({.lists = "<p>0 2 4</p>"}), HasSubstr("a vertex that its mesh does not have"));
  EXPECT_THAT(fault({.lists = "<p>0 2 -1</p>"}), HasSubstr("a vertex that its mesh does not have"));
  EXPECT_THAT(fault({.lists = "<p>0 2 ;</p>"}), HasSubstr("something else"));
  EXPECT_THAT(fault({.inputs = ""}), HasSubstr("no input VERTEX"));
  EXPECT_THAT(fault({.inputs = R"(<input semantic="VERTEX" source="#v" offset="4294967295"/>)"}),
              HasSubstr("offset above 255"));
  EXPECT_THAT(fault({.primitive = "polylist", .lists = "<vcount>99</vcount><p>0 2 1</p>"}),
              HasSubstr("fewer corners than its vcount states"));
  const auto polylist = [&](const std::string& lists) {
    return fault({.primitive = "polylist", .lists = lists});
  };
  EXPECT_THAT(polylist("<vcount>3</vcount><p>0 2 1 0 1 3</p>"),
              HasSubstr("more corners than its vcount states"));
  EXPECT_THAT(polylist("<p>0 2 1</p>"), HasSubstr("more corners than its vcount states"));
  EXPECT_THAT(fault({.nodes = R"(<node id="n"><instance_node url="#n"/></node>)"}),
              HasSubstr("in a cycle"));
}

TEST(ReadDae, InstancesCannotMultiplyWithoutEnd) {
  std::string nodes = R"(<node id="n0"><instance_geometry url="#g"/></node>)";
  for (int i = 1; i < 40; ++i) {
    const std::string inner = "<instance_node url=\"#n" + std::to_string(i - 1) + "\"/>";
    nodes += "<node id=\"n" + std::to_string(i) + "\">" + inner + inner + "</node>";
  }
  EXPECT_THAT(refusal(DaeFile{.nodes = nodes}.text()), HasSubstr("too many"));
}

std::string repeated(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i)
    out += text;
  return out;
}

TEST(ReadDae, ElementsCannotBeReadAgainWithoutEnd) {
  const auto expect_refusal = [](const std::string& text) {
    EXPECT_THAT(refusal(text), HasSubstr("refers to its elements too often"));
  };
  const std::string others = repeated("<a/>", 2'000);
  const std::string instances =
      "<node>" + repeated(R"(<instance_geometry url="#g"/>)", 2'000) + "</node>";
  expect_refusal(DaeFile{.sources = others, .nodes = instances}.text());
  expect_refusal(
      DaeFile{.lists = "<p>0 2 1" + std::string(20'000, ' ') + "0 1 3</p>", .nodes = instances}
          .text());
  expect_refusal(DaeFile{.nodes = R"(<node id="n"><instance_geometry url="#g"/>)" + others +
                                  "</node><node>" +
                                  repeated(R"(<instance_node url="#n"/>)", 2'000) + "</node>"}
                     .text());
  std::string inputs = DaeFile{.inputs = repeated(R"(<input semantic="VERTEX"/>)", 3'000)}.text();
  inputs.insert(inputs.find("</vertices>"), repeated("<a/>", 3'000));
  expect_refusal(inputs);
}

TEST(ReadDae, MaterialsCannotReadAnEffectWithoutEnd) {
  DaeFile dae{.libraries = R"(<effect id="e"><newparam>)" + std::string(100'000, 'a') +
                           "</newparam></effect>"};
  for (int i = 0; i < 1'000; ++i) {
    const std::string id = "\"m" + std::to_string(i) + "\"";
    dae.libraries += "<material id=" + id + R"(><instance_effect url="#e"/></material>)";
    dae.sources += "<triangles material=" + id + R"(><input semantic="VERTEX"/></triangles>)";
  }
  EXPECT_THAT(refusal(dae.text()), HasSubstr("refers to its elements too often"));
}

}  // namespace
}  // namespace vitrine
