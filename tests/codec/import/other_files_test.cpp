// SPDX-License-Identifier: Apache-2.0
#include "codec/import/other_files.h"

#include "codec/import/reading.h"
#include "support/packages/write_package.h"

namespace vitrine {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using vitrine::testing::bytes_of;
using vitrine::testing::refusal;

std::string zip_with(const std::string& name) {
  return test::zip_of({{name, "contents"}});
}

struct NamedFile {
  std::string start, name, step;
};

TEST(OtherFiles, EachKindIsNamedWithItsNextStep) {
  const std::string nothing(600, '\0');
  const std::vector<NamedFile> files{
      {zip_with("scene.usdc"), "a USDZ package: ", "Blender"},
      {zip_with("[Content_Types].xml"), "a Word, Excel or PowerPoint document: ", "GLB"},
      {"PK\5\6" + nothing, "an empty ZIP package: ", "pack it again"},
      {"\x04\x22\x4D\x18" + nothing, "an LZ4 package: ", "unpack it"},
      {std::string("\x5D\0\0\x80\0", 5) + nothing, "an LZMA package: ", "unpack it"},
      {"LZIP\1" + nothing, "an lzip package: ", "unpack it"},
      {"\x1F\x9D\x90" + nothing, "a package of compress: ", "unpack it"},
      {std::string("\xE0\0\0\1", 4) + nothing, "an X3D file: ", "MeshLab"},
      {std::string(" BDV\0\0\0\0", 8) + nothing, "an OpenVDB volume: ", "Blender"},
      {"\x7FNSJb" + nothing, "a Houdini file: ", "GLB, OBJ or STL"},
      {"ObjectType = Image\nNDims = 3\n", "a MetaImage volume: ", "3D Slicer"},
      {"SIMPLE  =                    T", "a FITS file: ", "3D Slicer"},
      {std::string("\0\x10", 2) + "[MeshSerializer_v1.100]\n", "an Ogre mesh: ", "GLB, OBJ or STL"},
      {"MeshVersionFormatted 1\n", "a Medit mesh: ", "ParaView"},
      {"GOCAD TSurf 1\n", "a GOCAD surface: ", "GLB, OBJ or STL"},
      {"BB3D" + nothing, "a Blitz3D model: ", "GLB, OBJ or STL"},
      {"MS3D000000" + nothing, "a MilkShape file: ", "GLB, OBJ or STL"},
      {"IDST" + nothing, "a Half-Life model: ", "GLB, OBJ or STL"},
      {"7z\xBC\xAF\x27\x1C" + nothing, "a 7z package: ", "unpack it"},
      {"Rar!\x1A\x07" + nothing, "a RAR package: ", "unpack it"},
      {"BLENDER-v300", "a Blender file: ", "GLB"},
      {"PXR-USDC", "a USD file: ", "Blender"},
      {"#usda 1.0\n", "a USD file: ", "Blender"},
      {"#VRML V2.0 utf8\n", "a VRML file: ", "MeshLab"},
      {"MM" + bytes_of<std::uint32_t>({12}) + "abcdef", "a 3D Studio file", "Blender"},
      {"ISO-10303-21;\nHEADER;", "a STEP file: ", "FreeCAD"},
      {std::string(72, ' ') + "S      1\n", "an IGES file: ", "FreeCAD"},
      {"  0\r\nSECTION\r\n  2\r\n", "a DXF drawing: ", "GLB, OBJ or STL"},
      {"ASTM-E57" + nothing, "an E57 point cloud: ", "mesh it"},
      {"LASF" + nothing, "a LAS or LAZ point cloud: ", "mesh it"},
      {"1.5 2 3 255 0 0\n1 2 4 0 0 0\n1 2 5 0 0 0\n", "a list of points: ", "mesh it"},
      {"<?xml version=\"1.0\"?>\n<X3D>", "an X3D file: ", "MeshLab"},
      {"<?xml version=\"1.0\"?>\n<a/>", "an XML file: ", "OBJ"},
      {"\n<!DOCTYPE html>\n<html>", "a web page: ", "download the model"},
      {"<html>", "a web page: ", "download the model"},
      {"\xFF\xD8\xFF\xE0" + nothing, "a JPEG picture: ", ".mtl"},
      {"\x89PNG\r\n\x1a\n", "a PNG picture: ", ".mtl"},
      {"BM" + bytes_of<std::uint32_t>({99, 0, 54}), "a BMP picture: ", ".mtl"},
      {std::string("II+\0\b\0", 6), "a BigTIFF picture: ", ".mtl"},
      {std::string("MM\0+\0\b", 6), "a BigTIFF picture: ", ".mtl"},
      {std::string("\0\0\0\x18", 4) + "ftypheic" + nothing, "a HEIF picture: ", ".mtl"},
      {std::string("\0\0\0\x18", 4) + "ftypmif1" + nothing, "a HEIF picture: ", ".mtl"},
      {std::string("\0\0\0\x18", 4) + "ftypmsf1" + nothing, "a HEIF picture: ", ".mtl"},
      {std::string("\0\0\0\x18", 4) + "ftyphevc" + nothing, "a HEIF picture: ", ".mtl"},
      {std::string("\0\0\0\x18", 4) + "ftypisom" + nothing, "a film: ", "GLB"},
      {"%PDF-1.7\n", "a PDF document: ", "GLB"},
      {"# Blender MTL\nnewmtl a\nKd 1 1 1\n", "a material library: ", ".obj"},
      {"version https://git-lfs.github.com/spec/v1\n", "a placeholder of Git LFS: ", "pull"},
      {std::string("\xFF\xFEv\0 \0", 6), "text in UTF-16: ", "UTF-8"},
      {"QC4DC4D6" + nothing, "a Cinema 4D file: ", "GLB, OBJ or STL"},
      {"//Maya ASCII 2024 scene", "a Maya file: ", "GLB, OBJ or STL"},
      {"FOR8", "a Maya file: ", "GLB, OBJ or STL"},
      {"\xD0\xCF\x11\xE0" + nothing, "a file of 3ds Max, SolidWorks or Office: ", "GLB"},
      {"\xD0\xCF\x11\xE0" + nothing + std::string("C\0l\0a\0s\0s\0D\0i\0r\0e\0c\0t\0o\0r\0y", 27),
       "a 3ds Max file: ", "GLB, OBJ or STL"},
      {"\xD0\xCF\x11\xE0" + nothing + std::string("W\0o\0r\0d\0D\0o\0c\0u\0m\0e\0n\0t\0", 24),
       "a Word document: ", "the model itself"},
      {"\xFF\xFE\xFF\x0ES", "a SketchUp file: ", "GLB, OBJ or STL"},
      {"3D Geometry File Format ", "a Rhino file: ", "GLB, OBJ or STL"},
      {"ISO-10303-21;\nFILE_SCHEMA(('IFC4'));", "an IFC model of a building: ", "FreeCAD"},
      {"# .PCD v0.7 - Point Cloud Data", "a PCD point cloud: ", "mesh it"},
      {"2\n3\n0 0 0\n1 0 0\n0 1 0\n", "a list of points: ", "mesh it"},
      {"x,y,z\n0,0,1\n1,0,1\n0,1,1\n", "a list of points: ", "mesh it"},
      {"//X Y Z R G B\n0 0 1 9 9 9\n1 0 1 9 9 9\n1 1 1 9 9 9", "a list of points: ", "mesh it"},
      {std::string(128, '\0') + "DICM" + nothing, "a DICOM file: ", "3D Slicer"},
      {"# vtk DataFile Version 3.0\n", "a VTK file: ", "ParaView"},
      {"#X3D V3.3 utf8", "an X3D file: ", "MeshLab"},
      {"b3dm" + nothing, "a tile of 3D Tiles: ", "GLB"},
      {R"({"asset":{"version":"1.0"},"geometricError":500,"root":{}})",
       "a tileset of 3D Tiles: ", "GLB"},
      {R"({"asset":{"type":"application/si-dpo-3d.document+json","version":"1.0"},"scene":0})",
       "a scene of Smithsonian Voyager: ", ".glb"},
      {"xof 0303txt 0032", "a DirectX file: ", "GLB, OBJ or STL"},
      {"AC3Db\nMATERIAL", "an AC3D file: ", "GLB, OBJ or STL"},
      {"Metasequoia Document\n", "a Metasequoia file: ", "GLB, OBJ or STL"},
      {"\xA1\x0E\x91\x6C\x45\x45\xFB\x1A", "an OpenSceneGraph file: ", "osgconv"},
      {"IDP2" + nothing, "a Quake model: ", "GLB, OBJ or STL"},
      {"\nCASCADE Topology V1, (c) Matra-Datavision\n", "a BREP file: ", "FreeCAD"}};
  for (const NamedFile& file : files) {
    EXPECT_THAT(refusal(file.start),
                AllOf(StartsWith("this is " + file.name), HasSubstr(file.step)));
  }
}

// Returns the error that reading the file `bytes` with the name `name` gives.
std::string refusal_of(const std::string& bytes, const std::string& name) {
  const auto result = read_mesh(testing::as_bytes(bytes), {.name = name});
  return result ? "" : result.error().message;
}

TEST(OtherFiles, TheNameCountsIfTheBytesDoNotTellTheKind) {
  EXPECT_THAT(refusal_of("\1\2\3", "a/Bust.ZTL"), StartsWith("this is a ZBrush file: "));
  EXPECT_THAT(refusal_of("\xD0\xCF\x11\xE0", "a.sldprt"),
              StartsWith("this is a SolidWorks file: "));
  EXPECT_THAT(refusal_of("a,b\n1,2\n", "a.csv"), StartsWith("this is a table: "));
  EXPECT_THAT(refusal_of("Dear museum", "a.txt"), StartsWith("this is a text: "));
  EXPECT_THAT(refusal_of("%PDF-1.7", "a.ztl"), StartsWith("this is a PDF document: "));
  EXPECT_THAT(refusal_of("\1\2\3", "a.stl"), StartsWith("not a mesh file that Vitrine reads"));
  EXPECT_THAT(refusal_of(test::zip_of({{"a.ztl", "\1"}}), "b.zip"),
              StartsWith("'a.ztl' in the package: this is a ZBrush file: "));
}

TEST(OtherFiles, EachExtensionOfAnUnreadKindIsNamed) {
  for (const std::string extension :
       {"b3d", "ms3d", "smd",  "mdl", "x3db", "bgeo", "hip",   "vdb", "mha", "mrc",  "fits", "mesh",
        "inp", "bdf",  "case", "ts",  "nff",  "tri",  "mview", "iso", "lz4", "lzma", "lz",   "Z"})
    EXPECT_THAT(refusal_of("\1\2\3", "bust." + extension), StartsWith("this is a")) << extension;
}

// Returns numbers that may be facets of a binary STL file that is cut short: its count is 1,000.
std::string numbers_like_facets() {
  std::string facets;
  for (int i = 0; i < 8; ++i)
    facets += bytes_of<float>({5, 6, 7, 1, 2, 3, 4, 5, 6, 7, 8, 9}) + std::string(2, '\0');
  return std::string(80, '\0') + bytes_of<std::uint32_t>({1000}) + facets;
}

TEST(OtherFiles, TheNameCountsBeforeASuspicionOfStl) {
  EXPECT_THAT(refusal_of(numbers_like_facets(), "bust.ksplat"),
              StartsWith("this is a set of Gaussian splats: it has no surface"));
  EXPECT_THAT(refusal_of(numbers_like_facets(), "bust.stl"),
              StartsWith("the STL file is cut short: only 8 of 1000 triangles are there"));
}

TEST(OtherFiles, UnknownBytesAreNotNamed) {
  for (const std::string bytes : {"", "B", "BM", "MM", "PK", "Dear museum, 1 2 3", "1 2 3\n"})
    EXPECT_FALSE(describe_other_file(testing::as_bytes(bytes)).has_value()) << bytes;
}

}  // namespace
}  // namespace vitrine
