// SPDX-License-Identifier: Apache-2.0
#include "codec/import/other_files.h"

#include <algorithm>
#include <string_view>

#include "codec/core/byte_cursor.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

using std::string_view_literals::operator""sv;

// The next steps that messages recommend. Each one fits several kinds of files.
constexpr std::string_view kBlender = "open it in Blender and export it as GLB",
                           kMeshLab = "open it in MeshLab and export it as PLY",
                           kCad = "open it in FreeCAD, mesh the body there and export it as OBJ",
                           kCloud =
                               "it has points but no faces; mesh it in CloudCompare or MeshLab and "
                               "export it as PLY",
                           kVolume =
                               "it is a volume; make a surface of it in 3D Slicer and export it as "
                               "STL or PLY",
                           kParaView = "open it in ParaView and export the surface as PLY",
                           kProject = "export the model from the program, as OBJ, PLY or GLB",
                           kUnpack = "unpack it and give the model inside",
                           kOwnProgram =
                               "open it in the program that wrote it and export it as "
                               "GLB, OBJ or STL",
                           kPicture =
                               "give the model; a picture belongs beside it, under the name "
                               "that the model or its .mtl file states",
                           kDocument = "export the model itself, as GLB",
                           kTiles = "export the whole model as one GLB",
                           kWebPage =
                               "it may be the page of a download or a login; download the model "
                               "itself",
                           kXml =
                               "if it is a model, open it in the program that wrote it and export "
                               "it as GLB, OBJ or STL",
                           kJson = "export the model as GLB";

// A kind of file that Vitrine does not read. Its files begin with `magic`, where '?' stands for any
// byte. If several kinds begin alike, a file of this kind also contains the text `contains`.
struct UnreadKind {
  std::string_view name;
  std::string_view magic;
  std::string_view advice;
  std::string_view contains = {};
};

// The first bytes of Microsoft's compound file format (old Office documents).
constexpr std::string_view kCompound = "\xD0\xCF\x11\xE0";

// The first row that matches a file decides its kind.
constexpr UnreadKind kBinaryKinds[] = {
    {"a USDZ package", "PK\3\4"sv, kBlender, ".usdc"sv},
    {"a USDZ package", "PK\3\4"sv, kBlender, ".usda"sv},
    {"a Word, Excel or PowerPoint document", "PK\3\4"sv, kDocument, "[Content_Types].xml"sv},
    {"a FreeCAD document", "PK\3\4"sv, kCad, "Document.xml"sv},
    {"an empty ZIP package", "PK\5\6"sv, "pack it again, with the model"sv},
    {"a bzip2 package", "BZh"sv, kUnpack},
    {"an xz package",
     "\xFD"
     "7zXZ\0"sv,
     kUnpack},
    {"a Zstandard package", "\x28\xB5\x2F\xFD"sv,
     "unpack it and give the model inside; a .blend file is exported as GLB from Blender"sv},
    {"an LZ4 package", "\x04\x22\x4D\x18"sv, kUnpack},
    {"an LZMA package", "\x5D\0\0"sv, kUnpack},
    {"an lzip package", "LZIP"sv, kUnpack},
    {"a package of compress", "\x1F\x9D"sv, kUnpack},
    {"a cabinet of Windows", "MSCF"sv, kUnpack},
    {"a 7z package", "7z\xBC\xAF\x27\x1C"sv, kUnpack},
    {"a RAR package", "Rar!\x1A\7"sv, kUnpack},
    {"a Blender file", "BLENDER"sv, kBlender},
    {"a USD file", "PXR-USDC"sv, kBlender},
    {"a USD file", "#usda"sv, kBlender},
    {"an Alembic file", "Ogawa"sv, kBlender},
    {"an Alembic or other HDF5 file", "\x89HDF\r\n"sv, kBlender},
    {"a Cinema 4D file", "QC4DC4D6"sv, kOwnProgram},
    {"a Cinema 4D file", "FORM????FC4D"sv, kOwnProgram},
    {"a Modo file", "FORM????LXOB"sv, kOwnProgram},
    {"a VRML file", "#VRML"sv, kMeshLab},
    {"an X3D file", "#X3D"sv, kMeshLab},
    {"an X3D file", "\xE0\0\0\1"sv, kMeshLab},
    {"a VTK file", "# vtk"sv, kParaView},
    {"an OpenVDB volume", " BDV\0\0\0\0"sv, kBlender},
    {"a Houdini file", "\x7FNSJb"sv, kOwnProgram},
    {"a Houdini file", "BgeoV"sv, kOwnProgram},
    {"a MetaImage volume", "ObjectType = Image"sv, kVolume},
    {"a FITS file", "SIMPLE  ="sv, kVolume},
    {"an Ogre mesh", "\0\x10[MeshSerializer"sv, kOwnProgram},
    {"a Medit mesh", "MeshVersionFormatted"sv, kParaView},
    {"a GOCAD surface", "GOCAD TSurf"sv, kOwnProgram},
    {"a NRRD volume", "NRRD0"sv, kVolume},
    {"a voxel model of MagicaVoxel", "VOX "sv, kOwnProgram},
    {"a Gmsh mesh", "$MeshFormat"sv, kParaView},
    {"an Open Inventor file", "#Inventor"sv, kMeshLab},
    {"a Draco file", "DRACO"sv, "convert it to PLY with draco_decoder"sv},
    {"an OpenCTM file", "OCTM"sv, kMeshLab},
    {"a Nexus file", " sxN"sv, "give the mesh from which it was built"sv},
    {"a U3D file", "U3D\0"sv, kMeshLab},
    {"a LightWave file", "????????LWO"sv, kBlender},
    {"a Maya file", "//Maya ASCII"sv, kOwnProgram},
    {"a Maya file", "FOR4"sv, kOwnProgram},
    {"a Maya file", "FOR8"sv, kOwnProgram},
    {"a Rhino file", "3D Geometry File Format"sv, kOwnProgram},
    {"a SketchUp file", "\xFF\xFE\xFF\x0E"sv, kOwnProgram},
    {"a 3ds Max file", kCompound, kOwnProgram, "C\0l\0a\0s\0s\0D\0i\0r\0e\0c\0t\0o\0r\0y"sv},
    {"a SolidWorks file", kCompound, kOwnProgram, "S\0w\0D\0o\0c\0"sv},
    {"an Inventor file", kCompound, kOwnProgram, "R\0S\0e\0S\0t\0o\0r\0a\0g\0e\0"sv},
    {"a Word document", kCompound, kDocument, "W\0o\0r\0d\0D\0o\0c\0u\0m\0e\0n\0t\0"sv},
    {"an Excel table", kCompound, kDocument, "W\0o\0r\0k\0b\0o\0o\0k\0"sv},
    {"a PowerPoint presentation", kCompound, kDocument, "P\0o\0w\0e\0r\0P\0o\0i\0n\0t\0"sv},
    {"a DWG drawing", "AC10"sv, kOwnProgram},
    {"an IFC model of a building", "ISO-10303-21"sv, kCad, "FILE_SCHEMA(('IFC"sv},
    {"a STEP file", "ISO-10303-21"sv, kCad},
    {"a DirectX file", "xof 03"sv, kOwnProgram},
    {"an AC3D file", "AC3D"sv, kOwnProgram},
    {"a Metasequoia file", "Metasequoia Document"sv, kOwnProgram},
    {"an OpenSceneGraph file", "\xA1\x0E\x91\x6C"sv, "convert it to OBJ with osgconv"sv},
    {"a Blitz3D model", "BB3D"sv, kOwnProgram},
    {"a MilkShape file", "MS3D000000"sv, kOwnProgram},
    {"a Quake model", "IDPO"sv, kOwnProgram},
    {"a Half-Life model", "IDST"sv, kOwnProgram},
    {"a Quake model", "IDP2"sv, kOwnProgram},
    {"a Quake model", "IDP3"sv, kOwnProgram},
    {"a BREP file", "DBRep_DrawableShape"sv, kCad},
    {"a BREP file", "CASCADE Topology"sv, kCad},
    {"a Parasolid file", "**ABCDEFGHIJKLMNOPQRSTUVWXYZ"sv, kCad},
    {"a JT file", "Version ??.? JT"sv, kOwnProgram},
    {"a JT file", "Version ?.? JT"sv, kOwnProgram},
    {"a CATIA file", "V5_CFV2"sv, kOwnProgram},
    {"an E57 point cloud", "ASTM-E57"sv, kCloud},
    {"a LAS or LAZ point cloud", "LASF"sv, kCloud},
    {"a PCD point cloud", "# .PCD"sv, kCloud},
    {"a PCD point cloud", "VERSION .7"sv, kCloud},
    {"a tile of 3D Tiles", "b3dm"sv, kTiles},
    {"a tile of 3D Tiles", "i3dm"sv, kTiles},
    {"a tile of 3D Tiles", "cmpt"sv, kTiles},
    {"a point cloud of 3D Tiles", "pnts"sv, kCloud},
    {"a JPEG picture", "\xFF\xD8\xFF"sv, kPicture},
    {"a PNG picture", "\x89PNG"sv, kPicture},
    {"a GIF picture", "GIF8"sv, kPicture},
    {"a WebP picture", "????????WEBP"sv, kPicture},
    {"a TIFF picture", "II*\0"sv, kPicture},
    {"a TIFF picture", "MM\0*"sv, kPicture},
    {"a BigTIFF picture", "II+\0\b\0"sv, kPicture},
    {"a BigTIFF picture", "MM\0+\0\b"sv, kPicture},
    {"a HEIF picture", "????ftyphei"sv, kPicture},
    {"a HEIF picture", "????ftyphev"sv, kPicture},
    {"a HEIF picture", "????ftypmif1"sv, kPicture},
    {"a HEIF picture", "????ftypmsf1"sv, kPicture},
    {"an AVIF picture", "????ftypavif"sv, kPicture},
    {"a film", "????ftyp"sv, kDocument},
    {"a Photoshop picture", "8BPS"sv, kPicture},
    {"an OpenEXR picture", "\x76\x2F\x31\x01"sv, kPicture},
    {"a DDS picture", "DDS "sv, kPicture},
    {"a KTX picture", "\xABKTX"sv, kPicture},
    {"a PDF document", "%PDF"sv, kDocument},
    {"a PostScript document", "%!PS"sv, kDocument},
    {"an SQLite database", "SQLite format 3"sv, kDocument},
    {"a program",
     "\x7F"
     "ELF"sv,
     kDocument},
    {"a Windows program", "MZ\x90"sv, kDocument},
    {"a Windows shortcut", "L\0\0\0\1\x14\2"sv, "give the file to which it leads"sv},
    {"a file of attributes that macOS keeps beside another file", "\0\5\x16\7"sv,
     "give the file whose name lacks the \"._\""sv},
    {"a placeholder of Git LFS", "version https://git-lfs"sv,
     "fetch the file itself with git lfs pull"sv},
    {"text in UTF-16", "\xFF\xFE"sv, "save it as UTF-8"sv},
    {"text in UTF-16", "\xFE\xFF"sv, "save it as UTF-8"sv},
};

// Kinds of XML and other text files. Each is recognised by a text near the start of the file,
// compared in lower case.
constexpr UnreadKind kTextKinds[] = {
    {"an X3D file", "<x3d"sv, kMeshLab},
    {"an AMF file", "<amf"sv, kMeshLab},
    {"a BREP file", "cascade topology v"sv, kCad},
    {"a tileset of 3D Tiles", "\"geometricerror\""sv, kTiles},
    {"a scene of Smithsonian Voyager", "si-dpo-3d"sv, "give the .glb file that it names"sv},
    {"a KML file", "<kml"sv, kDocument},
    {"a CityGML file", "citygml"sv, kBlender},
    {"an SVG picture", "<svg"sv, kPicture},
    {"a web page", "<html"sv, kWebPage},
    {"a web page", "<!doctype html"sv, kWebPage},
    {"a VTK file", "<vtkfile"sv, kParaView},
    {"an XML file", "<?xml"sv, kXml},
    {"a material library", "newmtl"sv, "give the .obj file, with this file beside it"sv},
};

// Kinds of files that cannot be recognised by their bytes, only by the extensions of their names.
struct NamedKind {
  std::string_view name, extension, advice;
};
constexpr NamedKind kNamedKinds[] = {
    {"a ZBrush file", ".ztl", kOwnProgram},
    {"a ZBrush file", ".zpr", kOwnProgram},
    {"a 3ds Max file", ".max", kOwnProgram},
    {"a Cinema 4D file", ".c4d", kOwnProgram},
    {"a SketchUp file", ".skp", kOwnProgram},
    {"a SolidWorks file", ".sldprt", kOwnProgram},
    {"a SolidWorks file", ".sldasm", kOwnProgram},
    {"an Inventor file", ".ipt", kOwnProgram},
    {"an Inventor file", ".iam", kOwnProgram},
    {"an ACIS file", ".sat", kCad},
    {"an ACIS file", ".sab", kCad},
    {"a Parasolid file", ".x_b", kCad},
    {"an IGES file", ".igs", kCad},
    {"an IGES file", ".iges", kCad},
    {"a project of Metashape", ".psx", kProject},
    {"a project of Metashape", ".psz", kProject},
    {"a project of RealityCapture", ".rcproj", kProject},
    {"a project of ReCap", ".rcp", kCloud},
    {"a point cloud of ReCap", ".rcs", kCloud},
    {"a point cloud of Faro", ".fls", kCloud},
    {"a point cloud of Z+F", ".zfs", kCloud},
    {"a list of points", ".xyz", kCloud},
    {"a list of points", ".pts", kCloud},
    {"a list of points", ".ptx", kCloud},
    {"a list of points", ".asc", kCloud},
    {"a set of Gaussian splats", ".ksplat", "it has no surface; give the mesh of the object"},
    {"a set of Gaussian splats", ".splat", "it has no surface; give the mesh of the object"},
    {"a set of Gaussian splats", ".spz", "it has no surface; give the mesh of the object"},
    {"a Nexus file", ".nxz", "give the mesh from which it was built"},
    {"a Blitz3D model", ".b3d", kOwnProgram},
    {"a MilkShape file", ".ms3d", kOwnProgram},
    {"a model of the Source engine", ".smd", kOwnProgram},
    {"a model of a game", ".mdl", kOwnProgram},
    {"an X3D file", ".x3db", kMeshLab},
    {"a Houdini file", ".bgeo", kOwnProgram},
    {"a Houdini file", ".hip", kOwnProgram},
    {"an OpenVDB volume", ".vdb", kBlender},
    {"a MetaImage volume", ".mha", kVolume},
    {"a volume of electron microscopy", ".mrc", kVolume},
    {"a FITS file", ".fits", kVolume},
    {"a mesh of Ogre or of a simulation", ".mesh", kOwnProgram},
    {"an Abaqus file", ".inp", kParaView},
    {"a Nastran file", ".bdf", kParaView},
    {"an EnSight file", ".case", kParaView},
    {"a GOCAD surface", ".ts", kOwnProgram},
    {"a Neutral File Format scene", ".nff", kOwnProgram},
    {"a list of triangles", ".tri", kOwnProgram},
    {"a Marmoset scene", ".mview", kProject},
    {"an image of a disc", ".iso", kUnpack},
    {"an LZ4 package", ".lz4", kUnpack},
    {"an LZMA package", ".lzma", kUnpack},
    {"an lzip package", ".lz", kUnpack},
    {"a package of compress", ".z", kUnpack},
    {"a table", ".csv", kDocument},
    {"a text", ".txt", kDocument},
    {"a text", ".md", kDocument},
    {"a TGA picture", ".tga", kPicture},
    {"a raw picture of a camera", ".dng", kPicture},
};

std::string_view file_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool fits(const UnreadKind& kind, std::string_view file) {
  const auto agrees = [](char expected, char byte) { return expected == '?' || expected == byte; };
  return file.size() >= kind.magic.size() &&
         std::ranges::equal(kind.magic, file.substr(0, kind.magic.size()), agrees) &&
         (kind.contains.empty() || file.find(kind.contains) != file.npos);
}

// Whether the first line is that of an IGES file: 80 columns, with "S" in column 73.
bool is_iges(std::string_view file) {
  constexpr std::size_t kSection = 72, kColumns = 80;
  return file.size() > kColumns && file[kSection] == 'S' && file.substr(kColumns - 1, 1) == "1" &&
         (file[kColumns] == '\n' || file[kColumns] == '\r');
}

// Returns how many numbers the current line has, or 0 if the line contains anything else. Moves to
// the next line.
int numbers_in_line(TextCursor& text) {
  int numbers = 0;
  double value = 0;
  while (text.read_number(value))
    ++numbers;
  if (!text.line_is_done()) numbers = 0;
  text.next_line();
  return numbers;
}

// Whether the text begins with lines of at least three numbers, such as x y z and colours. Commas
// or semicolons may separate the numbers. A line of names, or one or two lines with one number
// each, may precede the points.
bool is_list_of_points(std::string_view file) {
  constexpr std::size_t kStart = 2048;
  constexpr int kLines = 3, kMostBefore = 2;
  std::string start(file.substr(0, kStart));
  std::ranges::replace_if(
      start, [](char c) { return c == ',' || c == ';'; }, ' ');
  TextCursor text({reinterpret_cast<const std::uint8_t*>(start.data()), start.size()});
  int points = 0;
  for (int line = 0; points < kLines && line < kLines + kMostBefore && text.seek_word(); ++line) {
    const bool is_name = line == 0 && start.find_first_of("xX") < 8;
    const int numbers = numbers_in_line(text);
    if (numbers >= 3)
      ++points;
    else if (points > 0 || (numbers != 1 && !is_name))
      return false;
  }
  return points == kLines;
}

// Whether the file is a volume of medical imaging, whose signature is not at its start.
bool is_dicom(std::string_view file) {
  return file.substr(std::min<std::size_t>(128, file.size())).starts_with("DICM");
}

bool is_nifti(std::string_view file) {
  return file.substr(std::min<std::size_t>(344, file.size())).starts_with("n+1");
}

// Whether the file is one 3D Studio chunk: its first bytes state the type 0x4D4D and the file's
// size.
bool is_3ds(std::span<const std::uint8_t> bytes) {
  return file_text(bytes).starts_with("MM") && bytes.size() >= 6 &&
         load<std::uint32_t>(&bytes[2]) == bytes.size();
}

// Whether the file begins like a BMP picture: with "BM", the file's size, and four bytes of zero.
bool is_bmp(std::string_view file) {
  return file.starts_with("BM") &&
         file.substr(std::min<std::size_t>(6, file.size()), 4) == std::string_view("\0\0\0\0", 4);
}

bool is_dxf(std::string_view file) {
  const std::size_t begin = file.find_first_not_of(" \t");
  if (begin == file.npos || file[begin] != '0') return false;
  const std::size_t word = file.find_first_not_of(" \t\r\n", begin + 1);
  return word != file.npos && file.substr(word).starts_with("SECTION");
}

OtherFile described(std::string_view name, std::string_view advice) {
  constexpr std::string_view kForOthers[] = {kPicture, kDocument, kWebPage, kXml, kJson};
  return {"this is " + std::string(name) + ": " + std::string(advice),
          std::ranges::find(kForOthers, advice) == std::end(kForOthers)};
}

// Describes a file by a signature: its first bytes, or bytes at a fixed place.
std::optional<OtherFile> describe_by_signature(std::span<const std::uint8_t> bytes) {
  const std::string_view file = file_text(bytes);
  for (const UnreadKind& kind : kBinaryKinds) {
    if (fits(kind, file)) return described(kind.name, kind.advice);
  }
  if (is_3ds(bytes)) return described("a 3D Studio file (3DS)", kBlender);
  if (is_bmp(file)) return described("a BMP picture", kPicture);
  if (is_iges(file)) return described("an IGES file", kCad);
  if (is_dxf(file)) return described("a DXF drawing", kOwnProgram);
  if (is_dicom(file)) return described("a DICOM file", kVolume);
  if (is_nifti(file)) return described("a NIfTI file", kVolume);
  return std::nullopt;
}

std::optional<OtherFile> describe_by_text(std::string_view file) {
  constexpr std::size_t kStart = 1024;
  const std::string start = lower_case(file.substr(0, kStart));
  for (const UnreadKind& kind : kTextKinds) {
    if (start.find(kind.magic) != start.npos) return described(kind.name, kind.advice);
  }
  const std::size_t first = file.find_first_not_of(" \t\r\n");
  if (first != file.npos && file[first] == '{') return described("JSON that is not glTF", kJson);
  if (is_list_of_points(file)) return described("a list of points", kCloud);
  return std::nullopt;
}

std::optional<OtherFile> describe_by_name(std::string_view name) {
  const std::string key = lower_case(name);
  for (const NamedKind& kind : kNamedKinds) {
    if (key.ends_with(kind.extension)) return described(kind.name, kind.advice);
  }
  return std::nullopt;
}

}  // namespace

std::optional<OtherFile> describe_other_file(std::span<const std::uint8_t> bytes,
                                             std::string_view name) {
  const std::string_view file = file_text(bytes);
  if (auto kind = describe_by_signature(bytes)) return kind;
  if (auto kind = describe_by_text(file)) return kind;
  if (auto kind = describe_by_name(name)) return kind;
  if (file.starts_with(kCompound))
    return described("a file of 3ds Max, SolidWorks or Office", kOwnProgram);
  return std::nullopt;
}

}  // namespace vitrine::inline codec
