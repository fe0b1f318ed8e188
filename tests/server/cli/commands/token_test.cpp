// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "server/auth/authenticator.h"
#include "server/store/installation.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

// Looks up the token as a daemon that uses the data folder would. Returns nullopt if the token is
// unknown.
std::optional<Caller> find(const std::string& data, const std::string& token) {
  const auto installation = open_installation({.folder = data}).value();
  return Authenticator(*installation.catalogue).find(token).value();
}

TEST_F(VitrineCommand, ATokenIsCreatedOfflineAndShownOnce) {
  std::filesystem::create_directory(path("data"));
  const ProgramResult result =
      vitrine({"token", "create", "--role", "admin", "--data", path("data")});
  expect_fault(result, 0);  // exit code 0, and a note in the form of an error message
  EXPECT_THAT(result.errors, HasSubstr("is shown only now"));
  ASSERT_EQ(result.output.size(), 48u);
  const auto caller = find(path("data"), result.output.substr(0, 47));
  ASSERT_TRUE(caller);
  EXPECT_EQ(caller->role, Role::kAdmin);
  EXPECT_THAT(result.errors, HasSubstr(caller->token.to_string()));
}

TEST_F(VitrineCommand, ATokenAsJsonIsComplete) {
  std::filesystem::create_directory(path("data"));
  const nlohmann::json token = vitrine_json(
      {"token", "create", "--role", "viewer", "--data", path("data"), "--label", "Anna"});
  EXPECT_EQ(token["role"], "viewer");
  EXPECT_EQ(token["label"], "Anna");
  const auto caller = find(path("data"), token["token"].get<std::string>());
  ASSERT_TRUE(caller);
  EXPECT_EQ(caller->token.to_string(), token["id"]);
}

TEST_F(VitrineCommand, ARevokedTokenIsNotAccepted) {
  std::filesystem::create_directory(path("data"));
  const nlohmann::json token =
      vitrine_json({"token", "create", "--role", "operator", "--data", path("data")});
  const std::string id = token["id"].get<std::string>();
  EXPECT_EQ(vitrine({"token", "revoke", "--id", id, "--data", path("data")}).output, id + "\n");
  EXPECT_FALSE(find(path("data"), token["token"].get<std::string>()));
  expect_fault(vitrine({"token", "revoke", "--id", id, "--data", path("data")}), 1);
}

TEST_F(VitrineCommand, EveryChangeOfADataFolderIsAudited) {
  const std::string data = empty_folder("data"), in = write("in.ply", bumpy_ply(500));
  const auto id_of = [](const nlohmann::json& made) { return made["id"].get<std::string>(); };
  const std::string token =
      id_of(vitrine_json({"token", "create", "--role", "admin", "--data", data}));
  vitrine({"token", "revoke", "--id", token, "--data", data});
  vitrine({"token", "revoke", "--id", token, "--data", data});
  const std::string model = id_of(vitrine_json({"publish", in, "--data", data}));
  EXPECT_EQ(vitrine({"migrate", "--from", data, "--to", empty_folder("moved")}).exit_code, 0);
  vitrine_json({"backup", "--data", data, "-o", path("all.tar")});
  vitrine_json({"restore", path("all.tar"), "--data", path("restored")});
  vitrine_json({"repair", "--data", path("restored"), "--backup", path("all.tar")});
  vitrine_json({"repair", "--data", path("restored"), "--from", data});

  const auto line = [](const std::string& action, const std::string& target, const char* outcome) {
    return " action=" + action + " target=" + target + " outcome=" + outcome + "\n";
  };
  const std::string trail = read("data/audit.log");
  EXPECT_EQ(std::count(trail.begin(), trail.end(), '\n'), 4) << trail;
  EXPECT_THAT(trail, HasSubstr(" event=audit user="));
  EXPECT_THAT(trail, HasSubstr(line("\"token create admin\"", token, "done")));
  EXPECT_THAT(trail, HasSubstr(line("\"token revoke\"", token, "done")));
  EXPECT_THAT(trail, HasSubstr(line("\"token revoke\"", token, "failed")));
  EXPECT_THAT(trail, HasSubstr(line("publish", model, "done")));
  EXPECT_THAT(read("moved/audit.log"), HasSubstr(line("migrate", data, "done")));
  const std::string restored = read("restored/audit.log");
  EXPECT_THAT(restored, HasSubstr(line("restore", path("all.tar"), "done")));
  EXPECT_THAT(restored, HasSubstr(line("repair", path("all.tar"), "done")));
  EXPECT_THAT(restored, HasSubstr(line("repair", data, "done")));
}

TEST_F(VitrineCommand, AChangeThatCannotBeAuditedIsNotMade) {
  const std::string data = empty_folder("data");
  vitrine_json({"token", "create", "--role", "admin", "--data", data});
  std::filesystem::remove(data + "/audit.log");
  std::filesystem::create_directory(data + "/audit.log");
  const ProgramResult refused = vitrine({"token", "create", "--role", "admin", "--data", data});
  expect_fault(refused, 1);
  EXPECT_THAT(refused.errors, HasSubstr("cannot record the change in " + data + "/audit.log"));
  EXPECT_EQ(open_installation({.folder = data})->catalogue->tokens()->size(), 1u);
}

TEST_F(VitrineCommand, AnAuditLogThatIsALinkIsNotFollowed) {
  const std::string data = empty_folder("data"), other = write("other", "untouched");
  vitrine_json({"token", "create", "--role", "admin", "--data", data});
  std::filesystem::remove(data + "/audit.log");
  std::filesystem::create_symlink(other, data + "/audit.log");
  expect_fault(vitrine({"token", "create", "--role", "admin", "--data", data}), 1);
  EXPECT_EQ(read("other"), "untouched");
}

TEST_F(VitrineCommand, ATokenForAMistypedFolderMakesNoInstallation) {
  std::filesystem::create_directory(path("photos"));
  write("photos/a.jpg", "");
  for (const char* name : {"mistyped", "photos"}) {
    const ProgramResult result =
        vitrine({"token", "create", "--role", "admin", "--data", path(name)});
    expect_fault(result, 1);
    EXPECT_THAT(result.errors,
                HasSubstr("; give the folder of an installation, or start vitrined"));
  }
  EXPECT_FALSE(std::filesystem::exists(path("mistyped")));
  EXPECT_FALSE(std::filesystem::exists(path("photos/objects")));
}

TEST_F(VitrineCommand, ATokenNeedsAnActionARoleAndAPlace) {
  const std::vector<std::vector<std::string>> lines = {
      {"token"},
      {"token", "make", "--data", "d"},
      {"token", "create", "--data", "d"},
      {"token", "create", "--role", "root", "--data", "d"},
      {"token", "create", "--role", "admin"},
      {"token", "create", "--role", "admin", "--id", "x", "--data", "d"},
      {"token", "revoke", "--data", "d"},
      {"token", "revoke", "--id", "x", "--data", "d"},
      {"token", "revoke", "--role", "admin", "--data", "d"}};
  for (const auto& words : lines)
    expect_fault(vitrine(words), 2);
  const std::string file = write("file", "");
  expect_fault(vitrine({"token", "create", "--role", "admin", "--data", file}), 1);
  const std::vector<std::string> remote = {"token", "create",   "--role",
                                           "admin", "--server", "http://127.0.0.1:1"};
  expect_fault(vitrine(remote), 2);  // the command line names no token
  auto with_token = remote;
  with_token.insert(with_token.end(), {"--token", "t"});
  const ProgramResult unreachable = vitrine(with_token);
  expect_fault(unreachable, 1);
  EXPECT_THAT(unreachable.errors, HasSubstr("cannot reach http://127.0.0.1:1"));
  with_token.insert(with_token.end(), {"--data", "d"});
  expect_fault(vitrine(with_token), 2);
  EXPECT_THAT(files(), ::testing::ElementsAre("file"));
}

}  // namespace
}  // namespace vitrine::test
