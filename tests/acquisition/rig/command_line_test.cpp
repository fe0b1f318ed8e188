// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "acquisition/rig/fault.h"
#include "acquisition/rig/operator_socket.h"
#include "support/process/run_program.h"
#include "support/product_names.h"
#include "support/rig_operator.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kRig = VITRINE_BIN_DIR "/vitrine-rig";

ProgramResult rig(std::vector<std::string> words) {
  words.insert(words.begin(), kRig);
  return run_program(words);
}

ProgramResult rig_with(const std::string& script, std::vector<std::string> options = {}) {
  options.insert(options.begin(), {"--empty", "--private-network"});
  options.insert(options.end(), {"--", "sh", "-c", script});
  return rig(options);
}

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(RigCommandLine, HelpAndVersionAreAnswered) {
  EXPECT_THAT(rig({"--help"}).output, StartsWith("Usage: vitrine-rig"));
  EXPECT_THAT(rig({"--version"}).output, StartsWith("vitrine-rig 0."));
}

TEST(RigCommandLine, WrongUsageIsOneLineThatSaysWhatToGive) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--empty"}, "after --"},
      {{"--", "true"}, "--mesh FILE or --empty"},
      {{"--mesh", "a.ply", "--empty", "--", "true"}, "--mesh FILE or --empty"},
      {{"--empty", "--bogus", "--", "true"}, "--help"},
      {{"--empty", "--seed"}, "needs a value"},
      {{"--empty", "--seed", "x", "--", "true"}, "whole number"},
      {{"--empty", "--fault", "fire@3", "--", "true"}, "motor-stall"},
      {{"--empty", "--fault", "drift@x", "--", "true"}, "NAME@STEP"},
      {{"--empty", "--speckle", "0.1", "--", "true"}, "0.33"},
      {{"--empty", "--degrees-per-second", "0", "--", "true"}, "1 to 10000"},
      {{"--empty", "--up", "w", "--", "true"}, "-z"},
      {{"--empty", "--dialect", "morse", "--", "true"}, "fabscan"},
      {{"--empty", "--write-truth", "t.ply", "--", "true"}, "--mesh"},
      {{"--mesh", "a.ply", "--height-mm", "0", "--", "true"}, "95"}};
  for (const auto& [words, advice] : cases) {
    const ProgramResult result = rig(words);
    EXPECT_EQ(result.exit_code, 2) << advice;
    EXPECT_EQ(lines(result.errors), 1) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(advice));
  }
}

TEST(RigCommandLine, AMeshThatCannotBeReadIsNamed) {
  const ProgramResult result = rig({"--mesh", "/no/such.ply", "--", "true"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("/no/such.ply"));
  EXPECT_EQ(lines(result.errors), 1);
}

TEST(RigCommandLine, ItExitsAsTheCommandDoes) {
  EXPECT_EQ(rig_with("exit 0").exit_code, 0);
  EXPECT_EQ(rig_with("exit 7").exit_code, 7);
  EXPECT_EQ(rig_with("kill -9 $$").exit_code, 137);
  EXPECT_EQ(rig({"--empty", "--private-network", "--", "/no/such/program"}).exit_code, 127);
}

TEST(RigCommandLine, TheCommandRunsWhereTheBusIsSimulated) {
  EXPECT_THAT(rig_with("echo $LD_PRELOAD").output, HasSubstr("umockdev"));
}

TEST(RigCommandLine, WhatTheCommandLeavesBehindIsEnded) {
  const ProgramResult result = rig_with("sleep 1000 >/dev/null 2>&1 & echo $!");
  EXPECT_EQ(result.exit_code, 0);
  const pid_t left = std::stoi(result.output);
  EXPECT_EQ(::kill(left, 0), -1);
}

TEST(RigCommandLine, TermEndsTheCommandAndThenTheRig) {
  const TemporaryFolder folder;
  const std::string ready = folder.path() / "ready";
  ASSERT_EQ(::mkfifo(ready.c_str(), 0600), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string script = "echo $$ > " + ready + "; exec sleep 1000";
    ::execl(kRig.c_str(), "vitrine-rig", "--empty", "--private-network", "--", "sh", "-c",
            script.c_str(), nullptr);
    ::_exit(127);
  }
  pid_t command = 0;
  std::ifstream(ready) >> command;  // blocks until the command runs and writes to the pipe
  ASSERT_GT(command, 0);
  ::kill(child, SIGTERM);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
  EXPECT_EQ(::kill(command, 0), -1);
}

TEST(RigCommandLine, TheConfigSaysWhereThingsAreAndNothingOfTheOptics) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "rig.json";
  const ProgramResult result =
      rig_with("test -S \"$(sed -n 's/.*\"socket\": \"\\(.*\\)\".*/\\1/p' " + path.string() + ")\"",
               {"--write-config", path, "--steps", "90", "--name", "left"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(std::ifstream(path));
  EXPECT_EQ(json["name"], "left");
  EXPECT_EQ(json["camera"]["address"], "127.0.0.1");
  EXPECT_EQ(json["steps"], 90);
  EXPECT_EQ(json["region"]["width"], 1300);
  EXPECT_EQ(json["region"]["height"], 1030);
  EXPECT_EQ(json["target"]["dictionary"], "DICT_4X4_100");
  EXPECT_EQ(json["calibrations"], (folder.path() / "calibrations").string());
  EXPECT_EQ(json["board"]["dialect"], "horus");
  EXPECT_FALSE(std::filesystem::exists(json["rig"]["socket"].get<std::string>()));
  EXPECT_EQ(json.size(), 10U);
}

TEST(RigCommandLine, AFileThatCannotBeWrittenIsNamed) {
  for (const std::string option : {"--write-config", "--write-commands"}) {
    const ProgramResult result = rig_with("true", {option, "/nowhere/file"});
    EXPECT_EQ(result.exit_code, 1) << option;
    EXPECT_THAT(result.errors, HasSubstr("cannot write /nowhere/file: No such file"));
    EXPECT_EQ(lines(result.errors), 1) << result.errors;
  }
}

TEST(RigCommandLine, AFileThatHoldsNoAngleOfATableIsNamed) {
  const TemporaryFolder folder;
  const auto table = folder.path() / "table";
  for (const std::string text : {"", "12", "12 \n", "north\n", "nan\n"}) {
    std::ofstream(table) << text;
    const ProgramResult result = rig_with("true", {"--table", table});
    EXPECT_EQ(result.exit_code, 1) << text;
    EXPECT_THAT(result.errors,
                HasSubstr(table.string() + " does not contain the table's angle; remove it"));
    EXPECT_EQ(lines(result.errors), 1) << result.errors;
  }
  std::ofstream(table) << "-12.5\n";
  EXPECT_EQ(rig_with("true", {"--table", table}).exit_code, 0);
}

TEST(RigCommandLine, TheTruthStandsOnTheTableAtItsHeight) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "truth.ply";
  const ProgramResult result = rig({"--mesh", VITRINE_SOURCE_DIR "/tests/models/skull.obj",
                                    "--height-mm", "60", "--write-truth", path});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::ifstream in(path, std::ios::binary);
  std::string line;
  std::size_t count = 0;
  while (std::getline(in, line) && line != "end_header") {
    if (line.starts_with("element vertex ")) count = std::stoul(line.substr(15));
  }
  ASSERT_GT(count, 1000U);
  double low = 1e9, high = -1e9;
  std::size_t seen = 0;
  for (std::size_t v = 0; v < count; ++v) {
    double p[3];
    char flag = 0;
    in.read(reinterpret_cast<char*>(p), sizeof p);
    in.get(flag);
    low = std::min(low, p[2]);
    high = std::max(high, p[2]);
    seen += flag == 1;
  }
  EXPECT_NEAR(low, 0, 1e-9);
  EXPECT_NEAR(high, 60, 1e-9);
  EXPECT_GT(seen, count / 2);
  EXPECT_LT(seen, count);
}

TEST(OperatorSocket, CommandsChangeWhatIsOnTheTable) {
  const TemporaryFolder folder;
  const auto socket = folder.path() / "rig.sock";
  rig::Stage stage;
  {
    const auto listener = rig::open_operator_socket(socket, stage);
    ASSERT_TRUE(listener) << listener.error().message;
    EXPECT_EQ(said(socket, "poses\n"), "ok 30 1\n");
    EXPECT_EQ(said(socket, "target 30\n"), "ok\n");
    EXPECT_EQ(stage.now().target, 30);
    EXPECT_THAT(said(socket, "target 31\n"), StartsWith("error: no pose 31; give 0 to 30"));
    EXPECT_THAT(said(socket, "target x\n"), StartsWith("error: "));
    EXPECT_THAT(said(socket, "dance\n"), StartsWith("error: unknown command"));
    EXPECT_EQ(stage.now().target, 30);
    EXPECT_EQ(said(socket, "object\n"), "ok\n");
    EXPECT_EQ(stage.now().target, std::nullopt);
    // The rig closes the connection without an answer, because the line is too long.
    EXPECT_EQ(said(socket, std::string(5000, 'x')), "");
  }
  EXPECT_FALSE(std::filesystem::exists(socket));
}

TEST(OperatorSocket, WhoLooksSeesLaserMotorAndTable) {
  const TemporaryFolder folder;
  const auto socket = folder.path() / "rig.sock";
  rig::Stage stage;
  const auto listener = rig::open_operator_socket(socket, stage);
  ASSERT_TRUE(listener) << listener.error().message;
  EXPECT_EQ(said(socket, "look\n"), "ok off off 0.000\n");
  stage.laser(true);
  stage.passes(12.5);
  EXPECT_EQ(said(socket, "look\n"), "ok on off 12.500\n");
  stage.laser(false);
  stage.motor(true);
  stage.turned_to(-20);
  EXPECT_EQ(said(socket, "look\n"), "ok off on -20.000\n");
  EXPECT_EQ(stage.now().turns, 1) << "what the table passes is no turn";
}

TEST(OperatorSocket, ASocketThatCannotBeMadeIsAnError) {
  rig::Stage stage;
  EXPECT_FALSE(rig::open_operator_socket("/no/such/folder/rig.sock", stage));
  EXPECT_FALSE(rig::open_operator_socket(std::string(200, 'x'), stage));
}

}  // namespace
}  // namespace vitrine::test
