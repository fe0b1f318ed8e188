// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <future>
#include <optional>

#include "server/store/installation.h"
#include "server/store/published_model.h"
#include "server/store/uploads.h"
#include "support/packages/write_package.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST_F(VitrineCommand, AnOpenInstallationServesAModelPublishedBesideIt) {
  const std::string data = path("data");
  const auto installation = open_installation({.folder = data}).value();
  PublishedModels models(*installation.store, *installation.catalogue);
  const std::string in = write("Bust of a girl.ply", bumpy_ply(2'000));
  const nlohmann::json report = vitrine_json({"publish", in, "--data", data});
  EXPECT_EQ(report.size(), 2u);
  EXPECT_EQ(report["url"], nullptr);
  const auto id = ModelId::parse(report["id"].get<std::string>());
  ASSERT_TRUE(id);
  const auto model = models.find(*id).value();
  ASSERT_TRUE(model);
  EXPECT_EQ(model->record().title, "Bust of a girl");
  EXPECT_EQ(model->record().faces, 1'922u);
}

TEST_F(VitrineCommand, ANameInAnOldEncodingBecomesATitle) {
  const std::string in = write("B\xfcste.ply", bumpy_ply(500)), data = empty_folder("data");
  const auto id =
      ModelId::parse(vitrine_json({"publish", in, "--data", data})["id"].get<std::string>());
  const auto installation = open_installation({.folder = data}).value();
  EXPECT_EQ(installation.catalogue->find(id.value()).value()->title, "B\xc3\xbcste");
}

TEST_F(VitrineCommand, ATitleThatIsNotUtf8IsRefusedBeforeTheServerIsAsked) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const ProgramResult result =
      vitrine({"publish", in, "--server", "http://127.0.0.1:1", "--token", "t", "--title", "\xff"});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("the title is not one line of UTF-8"));
}

TEST_F(VitrineCommand, APmeshIsPublishedAsItIs) {
  const std::string file = model(800);
  const nlohmann::json report =
      vitrine_json({"publish", file, "--data", empty_folder("data"), "--title", "Torus"});
  const auto installation = open_installation({.folder = path("data")}).value();
  PublishedModels models(*installation.store, *installation.catalogue);
  const auto found = models.find(*ModelId::parse(report["id"].get<std::string>())).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->record().title, "Torus");
  const auto bytes = found->read(found->whole()).value();
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), read("model.pmesh"));
}

TEST_F(VitrineCommand, PublishingAMeshAgainGivesTheSameModelAndSaysSo) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  const nlohmann::json first = vitrine_json({"publish", in, "--data", data});
  const ProgramResult again = vitrine({"publish", in, "--data", data, "--json"});
  expect_fault(again, 0);
  EXPECT_THAT(again.errors, HasSubstr("note: " + in + " is published under this title already"));
  EXPECT_EQ(nlohmann::json::parse(again.output), first);
}

TEST_F(VitrineCommand, PublishingBesideTheDaemonKeepsToItsQuota) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  { const Daemon daemon(data, {"--quota", "100"}); }
  const std::string file = write("vitrined.conf", "data = " + data + "\nquota = 100\n");
  for (const std::string& place : {data, file}) {
    const ProgramResult refused = vitrine({"publish", in, "--data", place});
    expect_fault(refused, 1);
    EXPECT_THAT(refused.errors, HasSubstr("0 of 100 bytes are taken"));
  }
  const std::string uploads = empty_folder("uploads");
  ASSERT_TRUE(Uploads(uploads, {.bytes = 100, .per_token = 1}).create(TokenId::generate(), 60, ""));
  const std::string shared =
      write("shared.conf", "data = " + data + "\nquota = 100\nuploads = " + uploads + "\n");
  EXPECT_THAT(vitrine({"publish", in, "--data", shared}).errors,
              HasSubstr("60 of 100 bytes are taken"));
  { const Daemon daemon(data); }
  vitrine_json({"publish", in, "--data", data});
}

TEST_F(VitrineCommand, PublishingBesideTheDaemonKeepsItsDiskReserveFree) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  const std::string reserve = "9000000000000000000";
  { const Daemon daemon(data, {"--disk-reserve", reserve}); }
  const std::string file =
      write("vitrined.conf", "data = " + data + "\ndisk-reserve = " + reserve + "\n");
  for (const std::string& place : {data, file}) {
    const ProgramResult refused = vitrine({"publish", in, "--data", place});
    expect_fault(refused, 1);
    EXPECT_THAT(refused.errors, HasSubstr("keeps " + reserve + " free; remove models"));
  }
  { const Daemon daemon(data, {"--disk-reserve", "0"}); }
  vitrine_json({"publish", in, "--data", data});
  { const Daemon daemon(data, {"--disk-reserve", reserve}); }
  const ProgramResult again = vitrine({"publish", in, "--data", data});
  EXPECT_EQ(again.exit_code, 0) << again.errors;  // its file is stored already
}

TEST_F(VitrineCommand, AnUnreadableDataFolderIsNamed) {
  // The name is too long for any file system.
  const std::string folder = path(std::string(300, 'd'));
  const ProgramResult result =
      vitrine({"publish", write("in.ply", bumpy_ply(500)), "--data", folder});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("File name too long"));
}

TEST_F(VitrineCommand, AMistypedDataFolderBecomesNoInstallation) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const ProgramResult absent = vitrine({"publish", in, "--data", path("absent")});
  expect_fault(absent, 1);
  EXPECT_THAT(
      absent.errors,
      HasSubstr("absent: No such file or directory; give the folder of an installation, or start "
                "vitrined with this one once"));
  const ProgramResult other = vitrine({"publish", in, "--data", folder_.path().string()});
  expect_fault(other, 1);
  EXPECT_THAT(
      other.errors,
      HasSubstr("contains other files and no catalogue; give the folder of an installation, or "
                "start vitrined with an empty one once"));
  EXPECT_THAT(files(), testing::ElementsAre("in.ply"));
}

TEST_F(VitrineCommand, RemainsOfAnInterruptedStartAndTheDemoAreAccepted) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  for (const char* name : {"data/objects", "data/demo", "data/lost+found"})
    empty_folder(name);
  vitrine_json({"publish", in, "--data", data});
}

TEST_F(VitrineCommand, ADamagedPmeshIsNotPublished) {
  model(800);
  const std::string whole = read("model.pmesh");
  const std::string cut = whole.substr(0, whole.size() - 1);
  expect_fault(vitrine({"publish", write("bad.pmesh", cut), "--data", empty_folder("data")}), 1);
  EXPECT_TRUE(std::filesystem::is_empty(path("data")));
}

TEST_F(VitrineCommand, AMeshIsPublishedOverARestartOfTheServer) {
  const std::string data = empty_folder("data"), in = write("in.ply", bumpy_ply(40'000));
  const std::string by =
      vitrine_json({"token", "create", "--role", "operator", "--data", data}).value("token", "");
  std::optional<Daemon> daemon(std::in_place, data);
  const std::string at = "127.0.0.1:" + std::to_string(daemon->port());
  auto publishing = std::async(std::launch::async, [&] {
    return vitrine_json({"publish", in, "--server", "http://" + at, "--token", by});
  });
  daemon->wait_for_line("route=/api/v1/models ");
  daemon.reset();  // kills the daemon during the job
  daemon.emplace(data, std::vector<std::string>{"--listen", at});
  const std::string id = publishing.get().value("id", "");
  EXPECT_EQ(http_get(daemon->port(), "/api/v1/models/" + id).status, 200);
}

// A fixture with a running daemon. It can create tokens for the daemon.
class AtServer : public VitrineCommand {
 protected:
  AtServer() : daemon_(empty_folder("data")) {}

  std::string token(const std::string& role) const {
    return vitrine_json({"token", "create", "--role", role, "--data", path("data")})["token"];
  }
  std::vector<std::string> at_server(std::vector<std::string> words, const std::string& by) const {
    words.insert(words.end(), {"--server", url_, "--token", by});
    return words;
  }

  const Daemon daemon_;
  const std::string url_ = "http://127.0.0.1:" + std::to_string(daemon_.port());
};

TEST_F(AtServer, AMeshIsPublicOnReturn) {
  const std::string in = write("Bust of a girl.ply", bumpy_ply(2'000)), by = token("operator");
  const nlohmann::json report = vitrine_json(at_server({"publish", in}, by));
  EXPECT_EQ(report.size(), 2u);
  const std::string id = report["id"];
  EXPECT_EQ(report["url"], url_ + "/models/" + id);
  const auto shown = nlohmann::json::parse(http_get(daemon_.port(), "/api/v1/models/" + id).body);
  EXPECT_EQ(shown["title"], "Bust of a girl");
  EXPECT_EQ(shown["faces"], 1'922);
  const nlohmann::json other = vitrine_json(at_server({"publish", model(800), "--title", "T"}, by));
  const std::string file =
      http_get(daemon_.port(), "/api/v1/models/" + other.value("id", "") + "/file.pmesh").body;
  EXPECT_EQ(file, read("model.pmesh"));
}

TEST_F(AtServer, TheTokenMayComeFromAFileOrTheEnvironmentAndMetadataFromFlags) {
  const std::string in = write("in.ply", bumpy_ply(500)), by = token("operator");
  const std::string file = write("token.txt", by + "\n");
  const nlohmann::json first =
      vitrine_json({"publish", in, "--server", url_, "--token-file", file, "--creator", "Anna",
                    "--rights", "The museum", "--licence", "CC0-1.0"});
  const auto shown = nlohmann::json::parse(
      http_get(daemon_.port(), "/api/v1/models/" + first.value("id", "")).body);
  EXPECT_EQ(shown["creator"], "Anna");
  EXPECT_EQ(shown["rights"], "The museum");
  EXPECT_EQ(shown["licence"], "CC0-1.0");
  const ProgramResult second =
      run_program({"env", "VITRINE_TOKEN=" + by, kVitrine, "publish", in, "--server", url_});
  EXPECT_EQ(second.exit_code, 0) << second.errors;
  expect_fault(vitrine({"publish", in, "--server", url_, "--token", by, "--token-file", file}), 2);
  expect_fault(vitrine({"publish", in, "--server", url_, "--token-file", write("two", "a b")}), 2);
  expect_fault(vitrine({"publish", in, "--server", url_, "--token-file", path("absent")}), 1);
}

TEST_F(VitrineCommand, MetadataFromFlagsIsStoredInAFolderToo) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const nlohmann::json report = vitrine_json(
      {"publish", in, "--data", empty_folder("data"), "--creator", "Anna", "--licence", "CC0-1.0"});
  const auto installation = open_installation({.folder = path("data")}).value();
  PublishedModels models(*installation.store, *installation.catalogue);
  const auto found = models.find(*ModelId::parse(report["id"].get<std::string>())).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->record().creator, "Anna");
  EXPECT_EQ(found->record().licence, "CC0-1.0");
}

// Returns a mesh whose last face occurs twice.
std::string mesh_with_duplicate() {
  const std::string text = bumpy_ply(500),
                    last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  const std::string faces = "element face ";
  std::string twice = text + last;
  const std::size_t at = twice.find(faces) + faces.size();
  const std::size_t end = twice.find('\n', at);
  return twice.replace(at, end - at, std::to_string(std::stoi(twice.substr(at, end - at)) + 1));
}

TEST_F(VitrineCommand, RepairsOfAModelInAFolderAreStored) {
  const std::string data = empty_folder("data"), in = write("in.ply", mesh_with_duplicate());
  const ProgramResult result = vitrine({"publish", in, "--data", data, "--json"});
  EXPECT_THAT(result.errors, HasSubstr("in.ply: 1 duplicate face dropped"));
  const auto id = ModelId::parse(nlohmann::json::parse(result.output).at("id").get<std::string>());
  const auto installation = open_installation({.folder = data}).value();
  EXPECT_THAT(installation.catalogue->find(id.value()).value()->repairs,
              StartsWith("1 duplicate face dropped"));
}

TEST_F(AtServer, RepairsOfABuildOnThisMachineArePrintedOnceAndReachTheServer) {
  const std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\n";
  const std::string in = write("in.obj", obj + "f 1/1 2/1 3/1\nf 1/1 2/1 3/1\n"),
                    by = token("operator");
  write("a.mtl", "newmtl a\nmap_Kd missing.png\n");
  const ProgramResult result = vitrine(at_server({"publish", in, "--json"}, by));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string id = nlohmann::json::parse(result.output).at("id");
  const std::string bearer = "Authorization: Bearer " + by + "\r\n";
  const auto asked = [&](const std::string& path) {
    return nlohmann::json::parse(http_get(daemon_.port(), "/api/v1" + path, bearer).body);
  };
  const nlohmann::json repairs = asked("/models/" + id)["repairs"];
  EXPECT_THAT(repairs.dump(), HasSubstr("1 duplicate face dropped"));
  EXPECT_THAT(repairs.dump(), HasSubstr("missing.png"));
  EXPECT_EQ(asked("/jobs")["jobs"][0]["repairs"], repairs);
  for (const auto& line : repairs) {
    const std::string text = line;
    const std::size_t first = result.errors.find(text);
    EXPECT_NE(first, std::string::npos) << text;
    EXPECT_EQ(result.errors.find(text, first + 1), std::string::npos) << "twice: " << text;
  }
}

TEST_F(AtServer, WhatTheBuildChangedIsPrintedAndKeptInTheJobAndTheModel) {
  const std::string in = write("in.ply", mesh_with_duplicate()), by = token("operator");
  const std::string repair = "1 duplicate face dropped";
  const ProgramResult result = vitrine(at_server({"publish", in}, by));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.errors, HasSubstr("in.ply: " + repair));
  const std::string bearer = "Authorization: Bearer " + by + "\r\n";
  const auto jobs = nlohmann::json::parse(http_get(daemon_.port(), "/api/v1/jobs", bearer).body);
  ASSERT_EQ(jobs["jobs"][0]["repairs"].size(), 1u) << jobs;
  EXPECT_THAT(jobs["jobs"][0]["repairs"][0].get<std::string>(), HasSubstr(repair));
  const std::string path = "/api/v1/models/" + jobs["jobs"][0]["model"].get<std::string>();
  EXPECT_EQ(nlohmann::json::parse(http_get(daemon_.port(), path, bearer).body)["repairs"],
            jobs["jobs"][0]["repairs"]);
  EXPECT_THAT(vitrine({"publish", in, "--data", empty_folder("other")}).errors,
              HasSubstr("in.ply: " + repair));
}

TEST_F(AtServer, APackageIsUploadedAndUnpackedByTheServer) {
  const std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
  const FilesToPack files{{"statue/a.obj", obj}, {"statue/a.mtl", "newmtl a\nKd 1 0 0\n"}};
  const std::string in = write("Statue.tar.gz", gzip_of(tar_of(files))), by = token("operator");
  write(
      "a.mtl",
      "newmtl a\nmap_Kd missing.png\n");  // must be ignored, because the package has its own a.mtl
  const ProgramResult result = vitrine(at_server({"publish", in}, by));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("colours of 1 material baked into vertex colours"));
  const auto shown = nlohmann::json::parse(http_get(daemon_.port(), "/api/v1/models").body);
  EXPECT_EQ(shown["models"][0]["title"], "Statue");
  EXPECT_EQ(shown["models"][0]["faces"], 1);
}

TEST_F(VitrineCommand, APackageIsBuiltVerifiedAndMeasured) {
  const std::string in = write("in.zip", zip_of({{"a/bust.ply", bumpy_ply(500)}}));
  const std::string out = path("out.pmesh");
  EXPECT_EQ(vitrine({"build", in, "-o", out}).exit_code, 0);
  EXPECT_EQ(vitrine_json({"verify", out, "--against", in})["lossless"], true);
  EXPECT_EQ(vitrine({"measure", in, out}).exit_code, 0);
  const std::string two = write("two.zip", zip_of({{"a.ply", bumpy_ply(500)}, {"b.ply", "ply"}}));
  const ProgramResult refused = vitrine({"build", two, "-o", out});
  expect_fault(refused, 1);
  EXPECT_THAT(refused.errors, HasSubstr("two.zip: the package has 2 models, 'a.ply', 'b.ply'"));
}

TEST_F(AtServer, ARefusalIsReportedInTheServersWords) {
  const std::string in = write("in.ply", "no mesh"), by = token("operator");
  const ProgramResult bad = vitrine(at_server({"publish", in}, by));
  expect_fault(bad, 1);
  EXPECT_THAT(bad.errors, HasSubstr("in.ply: "));
  const ProgramResult forbidden = vitrine(at_server({"publish", in}, token("viewer")));
  expect_fault(forbidden, 1);
  EXPECT_THAT(forbidden.errors, HasSubstr("403"));
  expect_fault(vitrine({"publish", in, "--server", "museum", "--token", by}), 2);
  expect_fault(vitrine({"publish", in, "--server", url_}), 2);
}

// Returns the lines of JSON that a command printed.
std::vector<nlohmann::json> objects_in(const std::string& output) {
  std::vector<nlohmann::json> objects;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);)
    objects.push_back(nlohmann::json::parse(line));
  return objects;
}

TEST_F(AtServer, ASheetDescribesManyFilesAndTheRestArePublishedIfOneFails) {
  const std::string a = write("a.ply", bumpy_ply(500)), b = write("b.ply", bumpy_ply(800)),
                    bad = write("bad.ply", "no mesh"), by = token("operator");
  const std::string sheet = write("sheet.csv",
                                  "file;title;material;unit;licence\n"
                                  "a.ply;\"Bust; a girl\";marble;cm;\n"
                                  "bad.ply;Bad;;;\n"
                                  "b.ply;;;;CC0-1.0\n"
                                  "absent.ply;C;;;\n");
  const std::vector<std::string> words =
      at_server({"publish", a, bad, b, "--metadata", sheet, "--creator", "Anna", "--json"}, by);
  const ProgramResult result = vitrine(words);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("bad.ply: "));
  EXPECT_THAT(result.errors, HasSubstr("rows for other files: 1, first 'absent.ply'"));
  EXPECT_THAT(result.errors, HasSubstr("1 of 3 files are not published; mend them and run"));
  const auto made = objects_in(result.output);
  ASSERT_EQ(made.size(), 2u) << result.output;
  EXPECT_EQ(made[0]["file"], a);
  EXPECT_EQ(made[1]["file"], b);
  const auto shown = [&](const nlohmann::json& object) {
    const std::string id = object["id"];
    return nlohmann::json::parse(http_get(daemon_.port(), "/api/v1/models/" + id).body);
  };
  EXPECT_EQ(shown(made[0])["title"], "Bust; a girl");
  EXPECT_EQ(shown(made[0])["material"], "marble");
  EXPECT_EQ(shown(made[0])["unit"], "cm");
  EXPECT_EQ(shown(made[1])["title"], "b");
  EXPECT_EQ(shown(made[1])["creator"], "Anna");
  EXPECT_EQ(shown(made[1])["licence"], "CC0-1.0");
  EXPECT_EQ(objects_in(vitrine(words).output), made) << "published twice";
}

TEST_F(VitrineCommand, TheRowsOfASheetNameFilesOfAFolder) {
  const std::string data = empty_folder("data"), folder = empty_folder("scans");
  empty_folder("scans/hall");
  write("scans/hall/a.ply", bumpy_ply(500));
  write("scans/b.ply", bumpy_ply(800));
  write("scans/a.ply", bumpy_ply(900));
  const std::string sheet =
      write("sheet.csv", "file,title,period\na.ply,Other,\n./hall/a.ply,A,1650\nb.ply,B,\n");
  const ProgramResult one =
      vitrine({"publish", path("scans/hall/a.ply"), "--metadata", sheet, "--data", data});
  EXPECT_EQ(one.exit_code, 0) << one.errors;
  const ProgramResult result =
      vitrine({"publish", folder + "/", "--metadata", sheet, "--data", data});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto installation = open_installation({.folder = data}).value();
  EXPECT_EQ(std::ranges::count(result.output, '\n'), 3);
  const auto id = ModelId::parse(one.output.substr(0, one.output.find('\n')));
  const auto first = installation.catalogue->find(id.value()).value();
  EXPECT_EQ(first->title, "A");
  EXPECT_EQ(first->more.at("period"), "1650");
}

TEST_F(VitrineCommand, AWrongSheetIsRefusedBeforeAnythingIsPublished) {
  const std::string data = empty_folder("data"), a = write("a.ply", bumpy_ply(500)),
                    b = write("b.ply", bumpy_ply(800));
  const auto refused = [&](const std::string& sheet, const std::string& text) {
    const ProgramResult result =
        vitrine({"publish", a, b, "--metadata", write("sheet.csv", sheet), "--data", data});
    expect_fault(result, 1);
    EXPECT_THAT(result.errors, HasSubstr(text));
  };
  refused("file\na.ply\n", "has no row for '");
  refused("file\n./a.ply\nply\n", "has no row for '");
  refused("file,title\n", "has no row for '");
  refused("file,unit\na.ply,mm\nb.ply,feet\n", "line 3: unit is not mm, cm, m or in");
  refused("file,up\na.ply,y\nb.ply,x\n", "line 3: up is not y or z");
  refused("file,doi\na.ply,\nb.ply,none\n", "line 3: the doi is not ");
  refused("file,titel\n", "did you mean title?");
  const auto empty =
      vitrine({"publish", data, "--metadata", write("sheet.csv", "file\n"), "--data", data});
  EXPECT_THAT(empty.errors, HasSubstr("sheet.csv has no rows below its first line"));
  empty_folder("old");
  const std::string other = write("old/a.ply", bumpy_ply(500));
  const auto twice = vitrine(
      {"publish", a, other, "--metadata", write("sheet.csv", "file\na.ply\n"), "--data", data});
  expect_fault(twice, 1);
  EXPECT_THAT(twice.errors, HasSubstr("line 2: two files have this name"));
  expect_fault(vitrine({"publish", a, b, "--title", "T", "--data", data}), 2);
  EXPECT_TRUE(std::filesystem::is_empty(data));
}

TEST_F(AtServer, AnAdministratorMakesAndRevokesTokensRemotely) {
  const std::string admin = token("admin");
  const nlohmann::json made =
      vitrine_json(at_server({"token", "create", "--role", "viewer", "--label", "Anna"}, admin));
  EXPECT_EQ(made["role"], "viewer");
  const std::string bearer = "Authorization: Bearer " + made.value("token", "") + "\r\n";
  EXPECT_EQ(http_get(daemon_.port(), "/api/v1/jobs", bearer).status, 200);
  vitrine_json(at_server({"token", "revoke", "--id", made["id"]}, admin));
  EXPECT_EQ(http_get(daemon_.port(), "/api/v1/jobs", bearer).status, 401);
}

}  // namespace
}  // namespace vitrine::test
