// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "server/auth/authenticator.h"
#include "server/store/installation.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

// Looks up the token as a daemon on the data folder would. Returns nullopt if it is unknown.
std::optional<Caller> find(const std::string& data, const std::string& token) {
  const auto installation = open_installation({.folder = data}).value();
  return Authenticator(*installation.catalogue).find(token).value();
}

TEST_F(VitrineCommand, ATokenIsCreatedOfflineAndShownOnce) {
  std::filesystem::create_directory(path("data"));
  const ProgramResult result =
      vitrine({"token", "create", "--role", "admin", "--data", path("data")});
  expect_fault(result, 0);  // a note has the same form as an error
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
