// SPDX-License-Identifier: Apache-2.0
// Tests 3MF packages of the kinds that slicers and CAD programs write.
#include "codec/import/reading.h"
#include "support/packages/write_package.h"

namespace vitrine {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using vitrine::test::FilesToPack;
using vitrine::test::zip_of;
using vitrine::testing::read_text;
using vitrine::testing::refusal;

constexpr const char* kTriangle =
    "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
    "<vertex x=\"0\" y=\"0\" z=\"2\"/></vertices>"
    "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>";

std::string object(const std::string& id, const std::string& contents,
                   const std::string& attributes = "") {
  return "<object id=\"" + id + "\" " + attributes + ">" + contents + "</object>";
}

std::string part(const std::string& resources, const std::string& items,
                 const std::string& attributes = "unit=\"millimeter\"") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model " + attributes +
         " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
         "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "
         "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"><resources>" +
         resources + "</resources><build>" + items + "</build></model>";
}

std::string package(const std::string& root, const FilesToPack& more = {}) {
  FilesToPack files{{"[Content_Types].xml", "<?xml version=\"1.0\"?><Types/>"},
                    {"_rels/.rels", "<?xml version=\"1.0\"?><Relationships/>"},
                    {"3D/3dmodel.model", root}};
  files.insert(files.end(), more.begin(), more.end());
  return zip_of(files);
}

const std::string kItem = "<item objectid=\"1\"/>";

TEST(Read3mf, ATriangleIsTurnedSoThatYIsUp) {
  const ImportedMesh read = read_text(package(part(object("1", kTriangle), kItem)));
  EXPECT_EQ(read.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
  EXPECT_THAT(read.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(read.unit, "mm");
  EXPECT_THAT(read.repairs, ElementsAre());
}

TEST(Read3mf, UnitsAreKeptOrConverted) {
  const auto height_in = [](const std::string& attributes, const std::string& unit) {
    const ImportedMesh read = read_text(package(part(object("1", kTriangle), kItem, attributes)));
    EXPECT_EQ(read.unit, unit) << attributes;
    return read.mesh.positions.at(2).y;
  };
  EXPECT_EQ(height_in("unit='inch'", "in"), 2);
  EXPECT_EQ(height_in("unit=\"meter\"", "m"), 2);
  EXPECT_EQ(height_in("unit=\"foot\"", "in"), 24);
  EXPECT_DOUBLE_EQ(height_in("unit=\"micron\"", "mm"), 0.002);
  EXPECT_EQ(height_in("", "mm"), 2);
}

std::string requiring(const std::string& prefixes, const std::string& name) {
  return "requiredextensions=\"" + prefixes + "\" xmlns:x=\"http://example.org/" + name + "\"";
}

TEST(Read3mf, RequiredExtensionsThatAreNotReadAreNamed) {
  const auto with = [](const std::string& attributes) {
    return package(part(object("1", kTriangle), kItem, attributes));
  };
  EXPECT_THAT(read_text(with(requiring("m p", "y"))).repairs, ElementsAre());
  EXPECT_THAT(
      read_text(with(requiring("p x", "slice/2015/07"))).repairs,
      ElementsAre("1 required extension not read, such as 'http://example.org/slice/2015/07'; "
                  "compare the model with its source"));
  EXPECT_THAT(
      refusal(with(requiring("x", "booleanoperations/2023/07"))),
      HasSubstr("needs the extension 'http://example.org/booleanoperations/2023/07', which is "
                "not read; export it as a plain mesh"));
}

TEST(Read3mf, BeamsAreCounted) {
  const std::string lattice =
      "<b:beamlattice><b:beams><b:beam v1=\"0\" v2=\"1\"/><b:beam v1=\"1\" "
      "v2=\"2\"/></b:beams></b:beamlattice></mesh>";
  std::string mesh = kTriangle;
  mesh.replace(mesh.find("</mesh>"), 7, lattice);
  EXPECT_THAT(read_text(package(part(object("1", mesh), kItem))).repairs,
              ElementsAre("2 beams of lattices not carried; export them as a mesh"));
}

TEST(Read3mf, ColoursPaintedInASlicerAreCounted) {
  for (const std::string attribute : {"paint_color=\"8\"", "slic3rpe:mmu_segmentation=\"4\""}) {
    std::string mesh = kTriangle;
    mesh.replace(mesh.find("<triangle v1"), 9, "<triangle " + attribute);
    EXPECT_THAT(read_text(package(part(object("1", mesh), kItem))).repairs,
                ElementsAre(HasSubstr("colours painted in the slicer on 1 face not carried")))
        << attribute;
  }
}

TEST(Read3mf, LostOpacityIsCounted) {
  const std::string colours =
      "<m:colorgroup id=\"2\"><m:color color=\"#FF0000FF\"/><m:color color=\"#00FF0080\"/>"
      "</m:colorgroup>";
  const auto read =
      read_text(package(part(colours + object("1", kTriangle, "pid=\"2\" pindex=\"1\""), kItem)));
  EXPECT_THAT(read.repairs, Contains(HasSubstr("opacity of 1 colour not carried: ")));
}

TEST(Read3mf, ComponentsAreRepeatedAndMoved) {
  const std::string both =
      "<components><component objectid=\"1\"/>"
      "<component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 10 0 5\"/></components>";
  const ImportedMesh read = read_text(
      package(part(object("1", kTriangle) + object("2", both), "<item objectid=\"2\"/>")));
  EXPECT_EQ(read.mesh.positions.at(4), (Vec3{9, 5, 0}));
  EXPECT_THAT(read.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 5, 4}));
}

TEST(Read3mf, ObjectsInOtherPartsAreFound) {
  const std::string root =
      part(object("8",
                  "<components><component p:path=\"/3D/Objects/object_1.model\" objectid=\"1\"/>"
                  "</components>"),
           "<item objectid=\"8\" p:UUID=\"x\"/>");
  const FilesToPack parts{{"3D/Objects/object_1.model", part(object("1", kTriangle), "")}};
  EXPECT_THAT(read_text(package(root, parts)).mesh.faces, SizeIs(1));
  EXPECT_THAT(refusal(package(root)), HasSubstr("lacks its part '/3D/Objects/object_1.model'"));
}

TEST(Read3mf, ColoursOfMaterialsAndGroups) {
  const std::string groups =
      "<basematerials id=\"5\"><base name=\"a\" displaycolor=\"#FF0000\"/></basematerials>"
      "<m:colorgroup id=\"6\"><m:color color=\"#0000FFFF\"/></m:colorgroup>";
  const ImportedMesh red =
      read_text(package(part(groups + object("1", kTriangle, "pid=\"5\" pindex=\"0\""), kItem)));
  EXPECT_EQ(red.mesh.attributes.colours, std::vector(3, Colour{255, 0, 0}));
  std::string blue = kTriangle;
  blue.replace(blue.find("v3=\"2\""), 6, "v3=\"2\" pid=\"6\" p1=\"0\"");
  EXPECT_EQ(read_text(package(part(groups + object("1", blue), kItem))).mesh.attributes.colours,
            std::vector(3, Colour{0, 0, 255}));
  EXPECT_THAT(
      read_text(package(part(object("1", kTriangle, "pid=\"7\" pindex=\"0\""), kItem))).repairs,
      Contains(HasSubstr("textures or mixed materials of 1 face not carried")));
}

TEST(Read3mf, ColoursOfCornersAreKeptUnlessTheyDifferAtAVertex) {
  const std::string group =
      "<m:colorgroup id=\"6\"><m:color color=\"#010203\"/><m:color color=\"#0000FF\"/>"
      "<m:color color=\"#FFFFFF\"/></m:colorgroup>";
  const std::string triangle =
      "<triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"6\" p1=\"0\" p2=\"1\" p3=\"2\"/>";
  const auto read = [&](const std::string& second) {
    std::string mesh = kTriangle;
    const std::size_t begin = mesh.find("<triangle ");
    mesh.replace(begin, mesh.find("</triangles>") - begin, triangle + second);
    return read_text(package(part(group + object("1", mesh, "pid=\"6\" pindex=\"0\""), kItem)));
  };
  const ImportedMesh agreeing =
      read("<triangle v1=\"2\" v2=\"1\" v3=\"0\" pid=\"6\" p1=\"2\" p2=\"1\" p3=\"0\"/>");
  EXPECT_EQ(agreeing.mesh.attributes.colours,
            (std::vector<Colour>{{1, 2, 3}, {0, 0, 255}, {255, 255, 255}}));
  EXPECT_THAT(agreeing.repairs, Not(Contains(HasSubstr("colours"))));
  EXPECT_THAT(read("<triangle v1=\"2\" v2=\"1\" v3=\"0\" pid=\"6\" p1=\"0\"/>").repairs,
              Contains(HasSubstr("colours of 2 faces averaged at the vertices")));
}

TEST(Read3mf, ThreeMfInsideAPackageIsFoundByItsName) {
  const std::string inner = package(part(object("1", kTriangle), kItem));
  EXPECT_THAT(read_text(zip_of({{"print/bust.3mf", inner}, {"readme.txt", "x"}})).mesh.faces,
              SizeIs(1));
  EXPECT_THAT(read_text(zip_of({{"bust.3mf", inner}, {"bust.stl", "solid a"}})).repairs,
              Contains(HasSubstr("of the 2 files of the model")));
  EXPECT_THAT(refusal(zip_of({{"a.3mf", inner}, {"b.3mf", inner}})), HasSubstr("2 models"));
}

TEST(Read3mf, TheModelPartMayHaveAnyNameIfItIsTheOnlyOne) {
  const auto named = [](const std::string& name, const FilesToPack& more) {
    FilesToPack files{{"[Content_Types].xml", "<?xml version=\"1.0\"?><Types/>"},
                      {name, part(object("1", kTriangle), kItem)}};
    files.insert(files.end(), more.begin(), more.end());
    return zip_of(files);
  };
  for (const std::string name : {"3D/part_1.model", "Models/bust.model"}) {
    const ImportedMesh read = read_text(named(name, {{"a.model", "no part of 3MF"}}));
    EXPECT_THAT(read.mesh.faces, SizeIs(1)) << name;
    EXPECT_EQ(read.unit, "mm") << name;
  }
  EXPECT_THAT(refusal(named("3D/a.model", {{"3D/b.model", part(object("1", kTriangle), kItem)}})),
              HasSubstr("Word, Excel or PowerPoint"));
}

TEST(Read3mf, DecimalCommasAreRead) {
  std::string mesh = kTriangle;
  mesh.replace(mesh.find("z=\"2\""), 5, "z=\"2,5\"");
  const ImportedMesh read = read_text(package(part(
      object("1", mesh), R"(<item objectid="1" transform="1,0 0,0 0 0 1 0 0 0 1 0,5 0 0"/>)")));
  EXPECT_EQ(read.mesh.positions, (std::vector<Vec3>{{0.5, 0, 0}, {1.5, 0, 0}, {0.5, 2.5, 0}}));
}

TEST(Read3mf, FaultsAreNamed) {
  const auto fault = [](const std::string& resources) {
    return refusal(package(part(resources, kItem)));
  };
  EXPECT_THAT(fault(""), HasSubstr("lacks its object '1'"));
  EXPECT_THAT(fault(object("1", "<mesh><vertices><vertex x=\"0\" y=\"\"/></vertices></mesh>")),
              HasSubstr("vertex 0 of the 3MF lacks a coordinate"));
  EXPECT_THAT(fault(object("1", "<components><component objectid=\"1\"/></components>")),
              HasSubstr("in a cycle"));
  EXPECT_THAT(fault(object("1", "<mesh/>")), HasSubstr("places no object with triangles"));
  std::string far = kTriangle;
  far.replace(far.find("v3=\"2\""), 6, "v3=\"3\"");
  EXPECT_THAT(fault(object("1", far)), HasSubstr("face 0 of the 3MF refers to a vertex"));
  EXPECT_THAT(refusal(package(part(object("1", kTriangle), kItem) + "<")),
              HasSubstr("XML is damaged"));
}

TEST(Read3mf, RepeatedComponentsAreBounded) {
  std::string resources = object("0", kTriangle);
  for (int i = 1; i < 12; ++i) {
    std::string components;
    for (int k = 0; k < 8; ++k)
      components += "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    resources += object(std::to_string(i), "<components>" + components + "</components>");
  }
  EXPECT_THAT(refusal(package(part(resources, "<item objectid=\"11\"/>"))), HasSubstr("too many"));
}

TEST(Read3mf, CutAndFlippedAtEveryByte) {
  const std::string xml = part(
      "<basematerials id=\"5\"><base displaycolor=\"#FF0000\"/></basematerials>" +
          object("1", kTriangle, "pid=\"5\" pindex=\"0\"") +
          object("2",
                 "<components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 1 2 3\"/>"
                 "</components>"),
      "<item objectid=\"2\"/>");
  const auto expect_harmless = [](const std::string& bytes) {
    const auto read = read_mesh(testing::as_bytes(bytes));
    EXPECT_THAT(read ? "" : read.error().message, Not(HasSubstr("\n")));
  };
  for (std::size_t i = 0; i < xml.size(); ++i) {
    expect_harmless(xml.substr(0, i));
    for (const int mask : {1, 0xFF}) {
      std::string flipped = xml;
      flipped[i] = static_cast<char>(flipped[i] ^ mask);
      expect_harmless(flipped);
    }
  }
}

}  // namespace
}  // namespace vitrine
