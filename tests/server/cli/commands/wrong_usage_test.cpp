// SPDX-License-Identifier: Apache-2.0
// Tests wrong usage. Every error must be one line with the cause and the next step, have the right
// exit code, and leave no half-written file.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <regex>

#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST_F(VitrineCommand, WrongUsageIsExitCode2) {
  const std::vector<std::vector<std::string>> lines = {
      {},
      {"bild"},
      {"build"},
      {"build", "in.ply"},
      {"build", "in.ply", "-o"},
      {"build", "in.ply", "-o", "out.ply"},
      {"build", "in.ply", "-o", "out.pmesh", "--bits", "9"},
      {"build", "in.ply", "-o", "out.pmesh", "--bits", "17"},
      {"build", "in.ply", "-o", "out.pmesh", "--placement", "centre"},
      {"build", "in.ply", "-o", "out.pmesh", "--threads", "0"},
      {"decode", "in.pmesh", "-o", "out.xyz"},
      {"decode", "in.pmesh", "-o", "out.ply", "--level", "1", "--bytes", "5"},
      {"decode", "in.pmesh", "-o", "out.ply", "--error", "-1"},
      {"build", "in.ply", "-o", "out.pmesh", "--unit", "ft"},
      {"build", "in.ply", "-o", "out.pmesh", "--up", "x"},
      {"measure", "only-one.ply"},
      {"measure", "a.ply", "b.ply", "--samples", "0"},
      {"measure", "a.ply", "b.ply", "--appearance", "--align"},
      {"measure", "a.ply", "b.ply", "--appearance", "--samples", "9"},
      {"publish", "in.ply"}};
  for (const auto& words : lines)
    expect_fault(vitrine(words), 2);
}

TEST_F(VitrineCommand, AMistypedCommandOrFlagIsAnsweredWithTheRightOne) {
  EXPECT_THAT(vitrine({"verfy", "x"}).errors, HasSubstr("did you mean verify?"));
  EXPECT_THAT(vitrine({"info", "x", "--jsno"}).errors, HasSubstr("did you mean --json?"));
}

TEST_F(VitrineCommand, HelpOfACommandIsTheSameInBothForms) {
  const ProgramResult help = vitrine({"help", "build"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.output, vitrine({"build", "--help"}).output);
  EXPECT_THAT(help.output, HasSubstr("\nExamples:\n  vitrine build "));
  EXPECT_THAT(vitrine({"help", "bild"}).errors, HasSubstr("did you mean build?"));
  EXPECT_EQ(vitrine({"-V"}).output, vitrine({"--version"}).output);
}

TEST_F(VitrineCommand, HelpOfEveryCommandHasAnExampleOfIt) {
  const std::string help = vitrine({"--help"}).output;
  const std::regex command("\n  ([a-z]+) +[A-Z]");
  std::size_t commands = 0;
  for (std::sregex_iterator found(help.begin(), help.end(), command), end; found != end; ++found) {
    const std::string name = (*found)[1];
    const std::string text = vitrine({name, "--help"}).output;
    const std::size_t examples = text.find("\nExamples:\n");
    ASSERT_NE(examples, text.npos) << name;
    EXPECT_THAT(text.substr(examples), HasSubstr("vitrine " + name + " "));
    ++commands;
  }
  EXPECT_EQ(commands, 18u) << help;
}

TEST_F(VitrineCommand, HelpOfFetchNamesEachMemberOfAView) {
  const std::string help =
      std::regex_replace(vitrine({"help", "fetch"}).output, std::regex("\\s+"), " ");
  for (const char* member : {"camera (", "fov (", "width and height (", "pixels (", "bytes ("})
    EXPECT_THAT(help, HasSubstr(member));
  EXPECT_THAT(help, Not(HasSubstr("PROTOCOL.md"))) << "is not installed with the program";
}

TEST_F(VitrineCommand, BashCompletesCommandsFlagsAndChoices) {
  const auto completed = [](const std::string& words, int at) {
    const std::string script = "source <(\"$0\" completion bash); COMP_WORDS=(" + words +
                               "); COMP_CWORD=" + std::to_string(at) +
                               "; _vitrine; echo ${COMPREPLY[*]}";
    return run_program({"bash", "-c", script, kVitrine}).output;
  };
  EXPECT_EQ(completed("vitrine fu", 1), "fuse\n");
  EXPECT_EQ(completed("vitrine build in.ply --pl", 3), "--placement\n");
  EXPECT_EQ(completed("vitrine build --placement ''", 3), "midpoint pyramid\n");
  EXPECT_EQ(completed("vitrine token cr", 2), "create\n");
  EXPECT_EQ(completed("vitrine build -o ''", 3), "\n");
  expect_fault(vitrine({"completion", "dos"}), 2);
  EXPECT_THAT(vitrine({"completion"}).errors, HasSubstr("bash|zsh|fish is missing"));
}

TEST_F(VitrineCommand, ZshAndFishCompleteFromTheSameTable) {
  const std::string zsh = vitrine({"completion", "zsh"}).output;
  EXPECT_THAT(zsh, AllOf(HasSubstr("#compdef vitrine\n"), HasSubstr("bashcompinit\n"),
                         HasSubstr(vitrine({"completion", "bash"}).output)));
  const std::string of_build = "complete -c vitrine -n '__fish_seen_subcommand_from build' ";
  EXPECT_THAT(vitrine({"completion", "fish"}).output,
              AllOf(HasSubstr(of_build + "-l placement -x -a 'midpoint pyramid'\n"),
                    HasSubstr(of_build + "-s o -r\n"), HasSubstr(of_build + "-l json\n"),
                    HasSubstr("-n __fish_use_subcommand -a '")));
}

TEST_F(VitrineCommand, AMissingFileIsNamed) {
  for (const std::string command : {"build", "info", "decode", "verify", "publish"}) {
    std::vector<std::string> words = {command, path("absent.ply")};
    if (command == "build") words.insert(words.end(), {"-o", path("o.pmesh")});
    if (command == "decode") words.insert(words.end(), {"-o", path("o.ply")});
    if (command == "publish") words.insert(words.end(), {"--data", path("data")});
    const ProgramResult result = vitrine(words);
    expect_fault(result, 1);
    EXPECT_THAT(result.errors, HasSubstr("absent.ply: No such file or directory; check its name"));
  }
  EXPECT_THAT(files(), ElementsAre());
}

TEST_F(VitrineCommand, InputsThatAreNoMeshAreRefusedAndNothingIsWritten) {
  const std::vector<std::pair<std::string, std::string>> inputs = {
      {"empty.ply", ""},
      {"text.ply", "Dear Sir or Madam,\nplease find attached no mesh at all.\n"},
      {"cut.ply", bumpy_ply(500).substr(0, 3'000)},
      {"huge.ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 10737418240\nproperty float x\n"
       "property float y\nproperty float z\nelement face 10737418240\n"
       "property list uchar int vertex_indices\nend_header\n0123456789"},
      {"huge.stl", std::string(80, ' ') + "\xFF\xFF\xFF\xFF" + std::string(50, '\0')}};
  const std::string data = empty_folder("data");
  for (const auto& [name, contents] : inputs) {
    const std::string in = write(name, contents);
    const ProgramResult built = vitrine({"build", in, "-o", path("out.pmesh")});
    expect_fault(built, 1);
    EXPECT_THAT(built.errors, HasSubstr(name));
    const ProgramResult published = vitrine({"publish", in, "--data", data});
    expect_fault(published, 1);
    EXPECT_THAT(published.errors, HasSubstr(name));
    expect_fault(vitrine({"measure", in, in}), 1);
    expect_fault(vitrine({"info", in}), 1);
    std::filesystem::remove(in);
  }
  EXPECT_THAT(files(), ElementsAre("data"));
  EXPECT_TRUE(std::filesystem::is_empty(data));
}

TEST_F(VitrineCommand, ALineEndInANameDoesNotBreakTheMessage) {
  expect_fault(vitrine({"info", path("two\nlines.ply")}), 1);
}

TEST_F(VitrineCommand, AFolderIsNoInput) {
  expect_fault(vitrine({"info", folder_.path().string()}), 1);
}

TEST_F(VitrineCommand, APipeIsNoInputAndIsNotWaitedFor) {
  ASSERT_EQ(::mkfifo(path("pipe.ply").c_str(), 0600), 0);
  expect_fault(vitrine({"info", path("pipe.ply")}), 1);
}

TEST_F(VitrineCommand, AFolderOrDeviceIsNotReplacedByTheOutput) {
  const std::string in = write("in.ply", bumpy_ply(500));
  std::filesystem::create_directory(path("out.pmesh"));
  expect_fault(vitrine({"build", in, "-o", path("out.pmesh")}), 1);
  ASSERT_EQ(::mkfifo(path("pipe.pmesh").c_str(), 0600), 0);
  expect_fault(vitrine({"build", in, "-o", path("pipe.pmesh")}), 1);
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe.pmesh")));
}

TEST_F(VitrineCommand, TheInputIsNeverReplacedByTheOutput) {
  const std::string mesh = bumpy_ply(500);
  const std::string in = write("in.pmesh", mesh);
  const ProgramResult result = vitrine({"build", in, "-o", path("./in.pmesh")});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("is the input itself"));
  EXPECT_EQ(read("in.pmesh"), mesh);
}

TEST_F(VitrineCommand, AModelGivenInPlaceOfAMeshIsNamedWithTheNextStep) {
  const std::string file = model(500);
  const std::vector<std::vector<std::string>> lines = {{"build", file, "-o", path("again.pmesh")},
                                                       {"verify", file, "--against", file}};
  for (const auto& words : lines) {
    const ProgramResult result = vitrine(words);
    expect_fault(result, 1);
    EXPECT_THAT(result.errors,
                HasSubstr("model.pmesh is a .pmesh file, not a mesh; give the mesh"));
  }
}

TEST_F(VitrineCommand, AMeshIsNotReplacedByFusedScans) {
  const std::string out = write("out.ply", "precious");
  const ProgramResult result =
      vitrine({"fuse", path("a"), path("b"), "--config", path("rig.json"), "-o", out});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("out.ply exists; choose another name"));
  EXPECT_EQ(read("out.ply"), "precious");
}

TEST_F(VitrineCommand, AMeshIsNotReplacedByAModel) {
  const std::string in = write("in.ply", bumpy_ply(500)), other = write("other.obj", "v 0 0 0\n");
  const ProgramResult result = vitrine({"build", in, "-o", other});
  expect_fault(result, 2);
  EXPECT_THAT(result.errors, HasSubstr("must end in .pmesh; vitrine decode"));
  EXPECT_EQ(read("other.obj"), "v 0 0 0\n");
}

TEST_F(VitrineCommand, ANameThatIsNotUtf8DoesNotBreakTheJson) {
  const std::string damaged = write("damaged\xFF.pmesh", "PMSH");
  const ProgramResult result = vitrine({"verify", damaged, "--json"});
  expect_fault(result, 1);
  EXPECT_EQ(nlohmann::json::parse(result.output)["ok"], false);
}

TEST_F(VitrineCommand, ClosedStandardStreamsCostNothingButTheirText) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const ProgramResult built = run_program(
      {"sh", "-c", "\"$0\" build \"$1\" -o \"$2\" <&- >&- 2>&-", kVitrine, in, path("out.pmesh")});
  EXPECT_EQ(built.exit_code, 0);
  EXPECT_EQ(vitrine({"verify", path("out.pmesh"), "--against", in}).exit_code, 0);
  EXPECT_EQ(run_program({"sh", "-c", "\"$0\" info absent 2>/dev/full", kVitrine}).exit_code, 1);
}

TEST_F(VitrineCommand, AMissingOutputFolderIsNamed) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const ProgramResult result = vitrine({"build", in, "-o", path("absent/out.pmesh")});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("create the folder"));
}

TEST_F(VitrineCommand, AFullStdoutIsAnError) {
  const ProgramResult result =
      run_program({"sh", "-c", "\"$0\" info \"$1\" > /dev/full", kVitrine, model(500)});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("No space left on device"));
}

TEST_F(VitrineCommand, AClosedStdoutEndsTheCommandSilently) {
  const std::string file = model(500);
  const std::string into_nothing = "exec 3> >(:); wait $!; \"$0\" \"$@\" >&3";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", file}, {"info", file, "--json"}, {"--help"}}) {
    std::vector<std::string> line = {"bash", "-c", into_nothing, kVitrine};
    line.insert(line.end(), words.begin(), words.end());
    const ProgramResult result = run_program(line);
    EXPECT_EQ(result.exit_code, 128 + SIGPIPE);
    EXPECT_EQ(result.errors, "");
  }
}

// Mounts a small disk at `out`, in a private mount namespace, and runs the command. `prepare` runs
// before the command. Appends the names of the files left on the disk to the output.
ProgramResult run_on_small_disk(const std::string& prepare, const std::string& out,
                                const std::vector<std::string>& words) {
  std::vector<std::string> line = {"unshare"};
  if (::geteuid() != 0) line.emplace_back("--map-root-user");
  const std::string script = "out=$1; shift; mount -t tmpfs -o size=1m tmpfs \"$out\" && " +
                             prepare + " && { \"$@\"; code=$?; ls -A \"$out\"; exit $code; }";
  line.insert(line.end(), {"--mount", "sh", "-c", script, "sh", out, kVitrine});
  line.insert(line.end(), words.begin(), words.end());
  return run_program(line);
}

TEST_F(VitrineCommand, AFullDiskIsAnErrorAndLeavesNoPartOfAFile) {
  const std::string in = write("in.ply", bumpy_ply(20'000));
  std::filesystem::create_directory(path("out"));
  const ProgramResult result =
      run_on_small_disk("head -c 1040000 /dev/zero > \"$out/filler\"", path("out"),
                        {"build", in, "-o", path("out/model.pmesh")});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("No space left on device; free some space"));
  EXPECT_EQ(result.output, "filler\n");
}

TEST_F(VitrineCommand, AFullDiskUnderAnInstallationIsNamed) {
  const std::string in = write("in.ply", bumpy_ply(500));
  std::filesystem::create_directory(path("out"));
  const std::string publish_and_fill = "mkdir \"$out/data\" && \"$1\" publish '" + in +
                                       "' --data \"$out/data\" > \"$out/published\" && "
                                       "{ head -c 2000000 /dev/zero > \"$out/filler\"; } 2>&-";
  const ProgramResult result = run_on_small_disk(publish_and_fill + " || true", path("out"),
                                                 {"publish", in, "--data", path("out/data")});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("cannot open the catalogue"));
  EXPECT_THAT(result.errors, HasSubstr("No space left on device; free some space"));
  EXPECT_EQ(result.output, "data\nfiller\npublished\n");
}

TEST_F(VitrineCommand, AReadOnlyFolderIsAnError) {
  const std::string in = write("in.ply", bumpy_ply(500));
  std::filesystem::create_directory(path("out"));
  for (const std::string command : {"build", "publish"}) {
    const ProgramResult result =
        run_on_small_disk("mount -o remount,ro \"$out\"", path("out"),
                          {command, in, command == "build" ? "-o" : "--data",
                           path(command == "build" ? "out/model.pmesh" : "out/data")});
    expect_fault(result, 1);
    EXPECT_THAT(result.errors,
                HasSubstr("Read-only file system; choose a folder you may write to"));
    EXPECT_EQ(result.output, "");
  }
}

TEST_F(VitrineCommand, AReadOnlyInstallationIsNamedWithTheNextStep) {
  const std::string in = write("in.ply", bumpy_ply(500));
  std::filesystem::create_directory(path("out"));
  const ProgramResult result =
      run_on_small_disk("mkdir \"$out/objects\" && mount -o remount,ro \"$out\"", path("out"),
                        {"publish", in, "--data", path("out")});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("Read-only file system; choose a folder you may write to"));
}

TEST_F(VitrineCommand, AnOlderOutputSurvivesAFailure) {
  const std::string out = write("out.pmesh", "precious");
  expect_fault(vitrine({"build", write("in.ply", "ply\n"), "-o", out}), 1);
  EXPECT_EQ(read("out.pmesh"), "precious");
}

}  // namespace
}  // namespace vitrine::test
