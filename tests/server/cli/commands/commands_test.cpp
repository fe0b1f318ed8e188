// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>

#include "server/metadata/text.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST_F(VitrineCommand, BuildReportsWhatItReadAndWrote) {
  const std::string in = write("in.ply", bumpy_ply(3'000));
  const json report = vitrine_json({"build", in, "-o", path("out.pmesh"), "--bits", "12"});
  EXPECT_EQ(report["input"]["faces"], 2'888);
  EXPECT_EQ(report["input"]["vertices"], 1'444);
  EXPECT_EQ(report["input"]["boundary_edges"], 0);
  EXPECT_EQ(report["input"]["components"], 1);
  EXPECT_EQ(report["input"]["repairs"], json::array());
  EXPECT_EQ(report["bits"], 12);
  const json& bytes = report["bytes"];
  EXPECT_EQ(bytes["total"], std::filesystem::file_size(path("out.pmesh")));
  EXPECT_EQ(bytes["total"].get<int>(),
            bytes["header"].get<int>() + bytes["base"].get<int>() + bytes["layers"].get<int>());
  EXPECT_NEAR(report["bits_per_vertex"].get<double>(), bytes["total"].get<int>() * 8 / 1'444.0,
              1e-6);
  for (const char* stage : {"read", "simplify", "encode", "write"}) {
    EXPECT_GE(report["seconds"][stage].get<double>(), 0) << stage;
  }
  EXPECT_GT(report["peak_rss_bytes"].get<std::uint64_t>(), 1'000'000u);
  EXPECT_EQ(report["levels"].back()["faces"], 2'888);
  EXPECT_EQ(report["levels"].back()["cumulative_bytes"], bytes["total"]);
}

TEST_F(VitrineCommand, InfoPrintsTheLevelsThatBuildPrinted) {
  const std::string in = write("in.ply", bumpy_ply(2'000));
  const json built = vitrine_json({"build", in, "-o", path("out.pmesh")});
  const json info = vitrine_json({"info", path("out.pmesh")});
  EXPECT_EQ(info["levels"], built["levels"]);
  EXPECT_EQ(info["bytes"], built["bytes"]);
  EXPECT_EQ(info["bits"], built["bits"]);
}

TEST_F(VitrineCommand, BuildAndInfoPrintTheLatticeStepInTheModelsUnit) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const ProgramResult plain = vitrine({"build", in, "-o", path("plain.pmesh"), "--bits", "10"});
  const ProgramResult metric =
      vitrine({"build", in, "-o", path("mm.pmesh"), "--bits", "11", "--unit", "mm"});
  const auto step = [&](const char* file) {
    return fmt::format("{:.6g}", vitrine_json({"info", path(file)})["step"].get<double>());
  };
  const std::string units = "10 bits, step " + step("plain.pmesh") + " units",
                    millimetres = "11 bits, step " + step("mm.pmesh") + " mm";
  EXPECT_THAT(plain.output, HasSubstr(units));
  EXPECT_THAT(vitrine({"info", path("plain.pmesh")}).output, HasSubstr(units));
  EXPECT_THAT(metric.output, HasSubstr(millimetres));
  EXPECT_THAT(vitrine({"info", path("mm.pmesh")}).output, HasSubstr(millimetres));
}

TEST_F(VitrineCommand, InfoReportsHowMuchOfATruncatedFileExists) {
  const std::string whole = model();
  EXPECT_THAT(vitrine({"info", whole}).output, Not(HasSubstr("cut off")));
  const json levels = vitrine_json({"info", whole})["levels"];
  const auto bytes = levels[1]["cumulative_bytes"].get<std::size_t>();
  const std::string part = write("part.pmesh", read("model.pmesh").substr(0, bytes));
  EXPECT_THAT(vitrine({"info", part}).output,
              StartsWith("cut off at byte " + std::to_string(bytes) +
                         ": level 1 and all coarser levels are complete\n"));
}

TEST_F(VitrineCommand, CountsAndBytesRiseWithTheLevels) {
  const json levels = vitrine_json({"info", model()})["levels"];
  ASSERT_GE(levels.size(), 3u);
  for (std::size_t l = 1; l < levels.size(); ++l) {
    for (const char* key : {"faces", "vertices", "cumulative_bytes"}) {
      EXPECT_GT(levels[l][key], levels[l - 1][key]);
    }
  }
}

TEST_F(VitrineCommand, VerifyProvesLosslessOnlyAgainstTheInput) {
  const std::string file = model();
  EXPECT_EQ(vitrine_json({"verify", file})["lossless"], nullptr);
  const json report = vitrine_json({"verify", file, "--against", path("model.ply")});
  EXPECT_EQ(report["ok"], true);
  EXPECT_EQ(report["lossless"], true);
  EXPECT_EQ(report["faces"], 2'888);
}

TEST_F(VitrineCommand, VerifyDetectsAMovedVertexAndLostColours) {
  const std::string file = model();
  std::string text = read("model.ply");
  text[text.find("end_header\n") + 11] = '3';  // replaces the 4 that starts the first coordinate
  const ProgramResult moved =
      vitrine({"verify", file, "--against", write("moved.ply", text), "--json"});
  expect_fault(moved, 1);
  EXPECT_EQ(json::parse(moved.output)["ok"], false);
  EXPECT_EQ(json::parse(moved.output)["lossless"], false);
  const std::string coloured = write("coloured.ply", bumpy_ply(3'000, false, true));
  expect_fault(vitrine({"verify", file, "--against", coloured}), 1);
}

TEST_F(VitrineCommand, VerifyDetectsAMissingFace) {
  const std::string file = model(3'000, true);
  std::string text = read("model.ply");
  text.erase(text.rfind("3 ", text.size() - 3));
  const std::string count = "element face 2812";
  text.replace(text.find(count), count.size(), "element face 2811");
  expect_fault(vitrine({"verify", file, "--against", write("other.ply", text)}), 1);
}

TEST_F(VitrineCommand, DecodeGivesEachLevelAsTheTableSays) {
  const std::string file = model();
  const json levels = vitrine_json({"info", file})["levels"];
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const json report =
        vitrine_json({"decode", file, "-o", path("out.ply"), "--level", std::to_string(l)});
    EXPECT_EQ(report["faces"], levels[l]["faces"]);
    EXPECT_EQ(report["vertices"], levels[l]["vertices"]);
    EXPECT_EQ(report["bytes"], levels[l]["cumulative_bytes"]);
  }
}

TEST_F(VitrineCommand, DecodeGivesTheFinestLevelByDefault) {
  EXPECT_EQ(vitrine_json({"decode", model(), "-o", path("out.ply")})["faces"], 2'888);
}

TEST_F(VitrineCommand, DecodeMeetsANumberOfTriangles) {
  const std::string file = model();
  for (const int wanted : {1'000, 1'234, 2'500}) {
    const json report = vitrine_json(
        {"decode", file, "-o", path("out.ply"), "--triangles", std::to_string(wanted)});
    EXPECT_LE(report["faces"].get<int>(), wanted);
    EXPECT_GE(report["faces"].get<int>(), wanted * 0.9);
  }
}

TEST_F(VitrineCommand, DecodeMeetsBytesAndError) {
  const std::string file = model();
  const json levels = vitrine_json({"info", file})["levels"];
  const int budget = levels[2]["cumulative_bytes"].get<int>() - 1;
  const json by_bytes =
      vitrine_json({"decode", file, "-o", path("out.ply"), "--bytes", std::to_string(budget)});
  EXPECT_LE(by_bytes["bytes"].get<int>(), budget);
  EXPECT_GE(by_bytes["bytes"], levels[1]["cumulative_bytes"]);
  const std::string error = levels[1]["max_error"].dump();
  const json by_error = vitrine_json({"decode", file, "-o", path("out.ply"), "--error", error});
  EXPECT_LE(by_error["faces"], levels[1]["faces"]);
}

TEST_F(VitrineCommand, ADetailTargetThatNoLevelMeetsIsRefused) {
  const std::string file = model();
  const std::vector<std::vector<std::string>> wants = {
      {"--level", "99"}, {"--triangles", "3"}, {"--bytes", "10"}, {"--error", "0"}};
  for (auto words : wants) {
    words.insert(words.begin(), {"decode", file, "-o", path("out.ply")});
    expect_fault(vitrine(words), 1);
    EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
  }
}

TEST_F(VitrineCommand, TheErrorOfTheTableBoundsWhatMeasureFinds) {
  const std::string file = model();
  const json levels = vitrine_json({"info", file})["levels"];
  vitrine_json({"decode", file, "-o", path("out.ply"), "--level", "1"});
  const json measured =
      vitrine_json({"measure", path("out.ply"), path("model.ply"), "--samples", "20000"});
  EXPECT_LE(measured["max"].get<double>(), levels[1]["max_error"].get<double>());
  EXPECT_GT(measured["max"].get<double>(), 0);
}

TEST_F(VitrineCommand, MeasureReadsModelsAndMeshes) {
  const std::string file = model();
  const json measured = vitrine_json({"measure", file, path("model.ply"), "--samples", "5000"});
  EXPECT_LT(measured["rms_percent"].get<double>(), 0.2);
  EXPECT_GE(measured["max_percent"].get<double>(), measured["rms_percent"].get<double>());
  for (const char* side : {"a_to_b", "b_to_a"}) {
    for (const char* key : {"rms", "p95", "max"})
      EXPECT_TRUE(measured[side][key].is_number());
  }
}

TEST_F(VitrineCommand, MeasureReadsTheDrcThatDecodeWrites) {
  const std::string file = model(3'000, true, true);
  vitrine_json({"decode", file, "-o", path("out.drc")});
  const json measured = vitrine_json({"measure", path("out.drc"), file, "--samples", "5000"});
  EXPECT_LT(measured["max_percent"].get<double>(), 0.2);
  EXPECT_GT(measured["max"].get<double>(), 0);
}

TEST_F(VitrineCommand, MeasureWritesAMapOfTheDistances) {
  const std::string file = model(), map = path("map.ply");
  vitrine_json({"decode", file, "-o", path("coarse.ply"), "--level", "1"});
  const json measured = vitrine_json({"measure", path("coarse.ply"), file, "--map", map});
  EXPECT_EQ(measured["map"]["file"], map);
  EXPECT_GT(measured["map"]["range"].get<double>(), 0);
  EXPECT_LE(measured["map"]["range"].get<double>(), measured["a_to_b"]["max"].get<double>());
  EXPECT_THAT(read("map.ply"), HasSubstr("property uchar red"));
  expect_fault(vitrine({"measure", file, file, "--map", map}), 1);  // the map file already exists
}

TEST_F(VitrineCommand, MeasureRefusesAMapThatCannotHaveColours) {
  const std::string file = model();
  const std::vector<std::vector<std::string>> wrong = {{"--map", path("map.stl")},
                                                       {"--map", path("map")},
                                                       {"--range", "2"},
                                                       {"--map", path("map.ply"), "--range", "0"},
                                                       {"--map", path("map.ply"), "--appearance"}};
  for (auto words : wrong) {
    words.insert(words.begin(), {"measure", file, file});
    expect_fault(vitrine(words), 2);
  }
}

TEST_F(VitrineCommand, RepairsAreListed) {
  std::string text = bumpy_ply(500);
  const std::size_t face = text.find("\n3 ", text.find("end_header")) + 1;
  const std::string line = text.substr(face, text.find('\n', face) - face + 1);
  const std::string count = "element face 450";
  text.replace(text.find(count), count.size(), "element face 451");
  const std::string in = write("in.ply", text + line);  // the file contains one face twice
  const json report = vitrine_json({"build", in, "-o", path("out.pmesh")});
  EXPECT_EQ(report["input"]["repairs"].size(), 1u) << report["input"]["repairs"];
  EXPECT_EQ(report["input"]["faces"], 450);
}

// An octahedron with one face flipped, one duplicate face, one face without area, a fin and a stray
// point.
constexpr const char* kDamagedObj =
    "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nv 2 2 0\nv 9 9 9\n"
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 6 4\n"
    "f 3 5 1\nf 2 2 4\nf 1 3 7\n";

TEST_F(VitrineCommand, EveryRepairOfAFileWithManyFaultsIsListed) {
  const std::string in = write("in.obj", kDamagedObj);
  const json input = vitrine_json({"build", in, "-o", path("out.pmesh")})["input"];
  EXPECT_EQ(
      input["repairs"],
      json::array({"1 degenerate face dropped, first at face 9; remove such parts in the source",
                   "1 duplicate face dropped, first at face 8; remove such parts in the source",
                   "1 face reversed to agree with neighbours, first at face 7; unify the normals "
                   "in the source",
                   "1 non-manifold edge split, first at face 0; separate the surfaces in the "
                   "source, if they are not one object",
                   "2 vertices split to part fans, first at vertex 0; separate the surfaces in the "
                   "source, if they are not one object",
                   "1 unreferenced vertex dropped; remove such parts in the source"}));
  EXPECT_EQ(input["faces"], 9);
  EXPECT_EQ(vitrine_json({"verify", path("out.pmesh"), "--against", in})["lossless"], true);
}

TEST_F(VitrineCommand, AUnitGoesThroughTheModelIntoWhatIsExported) {
  const std::string in = write("in.ply", bumpy_ply(500));
  EXPECT_EQ(vitrine_json({"build", in, "-o", path("out.pmesh")})["unit"], "");
  const json built = vitrine_json({"build", in, "-o", path("out.pmesh"), "--unit", "mm"});
  EXPECT_EQ(built["unit"], "mm");
  EXPECT_EQ(vitrine_json({"info", path("out.pmesh")})["unit"], "mm");
  vitrine_json({"decode", path("out.pmesh"), "-o", path("out.ply")});
  EXPECT_NE(read("out.ply").find("comment unit mm\n"), std::string::npos);
  vitrine_json({"decode", path("out.pmesh"), "-o", path("out.glb")});
  EXPECT_EQ(vitrine_json({"build", path("out.glb"), "-o", path("2.pmesh")})["unit"], "m");
  const json distance =
      vitrine_json({"measure", path("out.glb"), path("out.ply"), "--samples", "1000"});
  EXPECT_LT(distance["max_percent"].get<double>(), 1e-3);
}

TEST_F(VitrineCommand, AUnitThatContradictsTheFileIsNoted) {
  const std::string in = write("in.ply", bumpy_ply(500));
  vitrine_json({"build", in, "-o", path("mm.pmesh"), "--unit", "mm"});
  vitrine_json({"decode", path("mm.pmesh"), "-o", path("in.glb")});
  vitrine_json({"decode", path("mm.pmesh"), "-o", path("mm.ply")});
  const std::string out = path("out.pmesh"), note = "note: the file states m, but --unit is ";
  const ProgramResult built =
      vitrine({"build", path("in.glb"), "-o", out, "--unit", "mm", "--json"});
  expect_fault(built, 0);
  EXPECT_THAT(built.errors, HasSubstr(note + "mm; leave --unit out"));
  EXPECT_EQ(json::parse(built.output)["unit"], "mm");
  const ProgramResult published =
      vitrine({"publish", path("in.glb"), "--data", empty_folder("data"), "--unit", "in"});
  expect_fault(published, 0);
  EXPECT_THAT(published.errors, HasSubstr(note + "in; "));
  EXPECT_THAT(vitrine({"build", path("mm.ply"), "-o", out, "--unit", "cm"}).errors,
              HasSubstr("the file states mm, but --unit is cm; "));
  for (const std::string same : {"in.glb", "mm.ply"})
    vitrine_json({"build", path(same), "-o", out, "--unit", same == "in.glb" ? "m" : "mm"});
}

TEST_F(VitrineCommand, MeasureNotesThatOnlyOneOfTwoStatesItsUnit) {
  const std::string in = write("in.ply", bumpy_ply(500));
  vitrine_json({"build", in, "-o", path("mm.pmesh"), "--unit", "mm"});
  const ProgramResult mixed =
      vitrine({"measure", path("mm.pmesh"), in, "--samples", "1000", "--json"});
  expect_fault(mixed, 0);
  EXPECT_NE(mixed.errors.find("note: B states no unit, and A is in mm"), std::string::npos);
  EXPECT_TRUE(json::parse(mixed.output).contains("note"));
  EXPECT_EQ(vitrine({"measure", in, in, "--samples", "1000"}).errors, "");
}

TEST_F(VitrineCommand, AModelThatWasTurnedUpIsLosslessOnlyAgainstTheTurnedInput) {
  const std::string in = write("in.ply", bumpy_ply(500));
  vitrine_json({"build", in, "-o", path("out.pmesh"), "--up", "z"});
  EXPECT_EQ(vitrine_json({"verify", path("out.pmesh"), "--against", in, "--up", "z"})["lossless"],
            true);
  const ProgramResult other = vitrine({"verify", path("out.pmesh"), "--against", in});
  expect_fault(other, 1);
  EXPECT_NE(other.errors.find("give the --up that it was built with"), std::string::npos);
}

TEST_F(VitrineCommand, AModelThatWasTurnedUpIsMeasuredAgainstTheTurnedInput) {
  const std::string in = write("in.ply", bumpy_ply(500));
  vitrine_json({"build", in, "-o", path("out.pmesh"), "--up", "z"});
  const json turned = vitrine_json({"measure", path("out.pmesh"), in, "--up", "z"});
  EXPECT_LT(turned["max_percent"].get<double>(), 0.1);
  const json other = vitrine_json({"measure", path("out.pmesh"), in});
  EXPECT_GT(other["max_percent"].get<double>(), 1);
}

TEST_F(VitrineCommand, VerticesMovedBySinglePrecisionAreNoted) {
  const std::string in =
      write("far.obj", "v 456789 5432109 0\nv 456790 5432109 0\nv 456789 5432110 0\nf 1 2 3\n");
  vitrine_json({"build", in, "-o", path("far.pmesh"), "--unit", "m"});
  for (const std::string format : {"stl", "drc"}) {
    const ProgramResult moved = vitrine({"decode", path("far.pmesh"), "-o", path("far." + format)});
    expect_fault(moved, 0);  // exit code 0, and a note in the form of an error message
    EXPECT_THAT(moved.errors, HasSubstr("by up to 0.25; write PLY, OBJ or GLB"));
  }
  for (const std::string format : {"ply", "obj", "glb", "wrl"})
    vitrine_json({"decode", path("far.pmesh"), "-o", path("far." + format)});
}

TEST_F(VitrineCommand, MaterialsThatLieBesideAnObjColourTheModel) {
  write("Bust.MTL", "newmtl stone\nKd 0.2 0.4 0.6\n");
  const std::string in = write("in.obj",
                               "mtllib C:\\scans\\bust.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                               "usemtl stone\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const json report = vitrine_json({"build", in, "-o", path("out.pmesh")});
  EXPECT_EQ(report["input"]["repairs"],
            json::array(
                {"colours of 1 material baked into vertex colours; use texture maps to keep their "
                 "borders sharp"}));
  EXPECT_EQ(vitrine_json({"verify", path("out.pmesh"), "--against", in})["lossless"], true);
  vitrine_json({"decode", path("out.pmesh"), "-o", path("out.ply")});
  EXPECT_NE(read("out.ply").find("property uchar red"), std::string::npos);
}

TEST_F(VitrineCommand, AFolderWithOneModelIsBuiltWithItsFiles) {
  const std::string data = empty_folder("statue"), out = path("out.pmesh");
  empty_folder("statue/source"), empty_folder("statue/textures");
  write("statue/textures/stone.mtl", "newmtl stone\nKd 0.2 0.4 0.6\n");
  write("statue/.hidden.ply", "ply");
  write("statue/source/bust.obj",
        "mtllib stone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl stone\nf 1 2 3\n");
  EXPECT_THAT(vitrine_json({"build", data, "-o", out})["input"]["repairs"].dump(),
              HasSubstr("colours of 1 material baked"));
  const ProgramResult published = vitrine({"publish", data + "/", "--data", empty_folder("data")});
  EXPECT_EQ(published.exit_code, 0) << published.errors;
  EXPECT_THAT(published.errors, HasSubstr("colours of 1 material baked"));

  write("statue/vase.ply", bumpy_ply(500));
  const ProgramResult two = vitrine({"build", data, "-o", out});
  expect_fault(two, 1);
  EXPECT_THAT(two.errors, HasSubstr("the folder has 2 models, 'source/bust.obj', 'vase.ply'; give "
                                    "one folder or file for each of them"));
  EXPECT_THAT(vitrine({"build", data + "/textures", "-o", out}).errors,
              HasSubstr("is a folder without a model"));
}

TEST_F(VitrineCommand, AnEmptyFileIsNotReplacedWithoutForce) {
  const std::string in = write("in.ply", bumpy_ply(500)), out = write("out.pmesh", "");
  const ProgramResult result = run_program({kVitrine, "build", in, "-o", out});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("out.pmesh exists"));
  EXPECT_EQ(read("out.pmesh"), "");
}

// A name with a letter and its mark apart, as macOS writes it, finds the file of the composed name.
TEST_F(VitrineCommand, PicturesAreFoundByDecomposedNames) {
  write("f\xC3\xBCnf.mtl", "newmtl stone\nKd 0.2 0.4 0.6\n");
  const std::string in = write(
      "in.obj", "mtllib fu\xCC\x88nf.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl stone\nf 1 2 3\n");
  EXPECT_THAT(vitrine_json({"build", in, "-o", path("out.pmesh")})["input"]["repairs"].dump(),
              HasSubstr("colours of 1 material baked"));
}

// A glTF triangle. The file "My buffer.bin" contains its corners as floats.
const std::string kGltf = R"({"asset": {"version": "2.0"},
  "buffers": [{"uri": "data/My%20buffer.bin", "byteLength": 36}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})";

TEST_F(VitrineCommand, AGltfIsBuiltWithTheFilesInItsFolderAndBelow) {
  const std::string in = write("in.gltf", kGltf), out = path("out.pmesh");
  EXPECT_THAT(vitrine({"build", in, "-o", out}).errors,
              HasSubstr("glTF buffer 0 is the file 'data/My buffer.bin', which is not beside"));
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  empty_folder("data");
  write("data/My buffer.bin", {reinterpret_cast<const char*>(corners), sizeof corners});
  EXPECT_EQ(vitrine_json({"build", in, "-o", out})["input"]["faces"], 1);
}

TEST_F(VitrineCommand, HelpAndVersionGoToStdout) {
  for (const char* command : {"build", "info", "decode", "verify", "measure", "publish"}) {
    const ProgramResult help = vitrine({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.output.find("Usage: vitrine " + std::string(command)), std::string::npos);
    EXPECT_NE(vitrine({"--help"}).output.find(command), std::string::npos);
  }
  EXPECT_EQ(vitrine({"--version"}).output.rfind("vitrine ", 0), 0u);
}

TEST_F(VitrineCommand, NoLineOfHelpIsLongerThan100Columns) {
  std::vector<std::vector<std::string>> pages = {{"--help"}};
  for (const char* command :
       {"build", "decode", "fetch", "measure", "migrate", "publish", "scan", "token"})
    pages.push_back({command, "--help"});
  for (const auto& page : pages) {
    std::istringstream help(vitrine(page).output);
    for (std::string line; std::getline(help, line);)
      EXPECT_LE(line.size(), 100u) << line;
  }
}

TEST_F(VitrineCommand, NamesThatAreNotUtf8AreShownAsPlainText) {
  const std::string odd = path("b\xfcste\n\x1b[2J.ply"), out = path("out.pmesh");
  const std::vector<std::vector<std::string>> lines = {
      {"b\xfcld"},
      {"info", odd, "--js\xffn"},
      {"info", odd, "--json"},
      {"build", odd, "-o", out, "--json"},
      {"build", odd, "-o", out, "--unit", "\xff"},
      {"decode", odd, "-o", out},
      {"verify", odd, "--json"},
      {"measure", odd, odd, "--json"},
      {"publish", odd, "--data", odd, "--json"},
      {"backup", odd, "--data", odd},
      {"token", "create", "--data", odd, "--role", "\xff"}};
  for (const auto& words : lines) {
    const ProgramResult result = vitrine(words);
    ASSERT_TRUE(result.errors.ends_with('\n')) << words[0];
    const std::string_view line =
        std::string_view(result.errors).substr(0, result.errors.size() - 1);
    EXPECT_TRUE(is_plain_text(line)) << line;
    EXPECT_TRUE(result.output.empty() || nlohmann::json::accept(result.output)) << result.output;
  }
  const ProgramResult doctor = vitrine({"doctor", "--data", empty_folder("b\xfcste"), "--json"});
  EXPECT_TRUE(nlohmann::json::accept(doctor.output)) << doctor.output;
}

}  // namespace
}  // namespace vitrine::test
